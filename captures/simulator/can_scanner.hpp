// SPDX-License-Identifier: MIT
// A DeviceNet scanner: allocates its slaves, sets packet rates, polls in a fixed period, and speaks explicit messages
// between the polls (DeviceNet link layer).
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "captures/simulator/can_fragments.hpp"
#include "captures/simulator/can_medium.hpp"

namespace servotrace::simulator {

class Scanner : public Station {
 public:
  struct Node {
    std::uint8_t mac_id = 0;
    bool polled = false;
    ByteVector command;                  // what the next poll carries
    bool fragmented = false;             // its command is above eight bytes
    std::uint64_t polls = 0;             // sent
    std::uint64_t responses = 0;         // whole ones received
    std::optional<ByteVector> response;  // the last one
    unsigned idle_polls = 0;             // so many polls go out empty
    unsigned xid = 0;
    bool answered = false;  // the last explicit request
    ByteVector answer;      // its whole response, header first
    IoAssembler io;
    ExplicitAssembler explicit_in{300};
    std::vector<ByteVector> out;  // fragments of a request not yet acknowledged
    std::size_t out_next = 0;
  };
  // Changes to what goes out or comes in, put in by a scenario.
  struct Options {
    bool wait = true;  // for the answer
    DurationNs timeout_ns = kSecondNs;
    std::optional<unsigned> xid;
    std::optional<std::uint8_t> master;  // in the header
    bool unconnected = false;            // on 406+8n instead of 404+8n
    DurationNs fragment_pause_ns = 0;    // before each fragment but the first
    std::optional<std::size_t> stop_after_fragments;
  };

  Scanner(CanBus& bus, std::uint8_t mac_id, DurationNs period_ns);

  Node& node(std::uint8_t mac_id) { return nodes_[mac_id]; }
  std::uint8_t mac_id() const { return mac_id_; }
  DurationNs period_ns() const { return period_ns_; }
  void set_period(DurationNs period_ns) { period_ns_ = period_ns; }

  void receive(const CanFrame& frame) override;

  // Polling of all nodes marked `polled` goes on in the background from the first call.
  void start_polling();
  // Runs until the node has been polled `count` times more and its response had time to come.
  void poll(std::uint8_t node_mac_id, std::uint64_t count);
  // `message` from the service on. True where an answer came.
  bool request(std::uint8_t node_mac_id, Bytes message, const Options& options);
  bool request(std::uint8_t node_mac_id, Bytes message) { return request(node_mac_id, message, Options{}); }
  bool allocate(std::uint8_t node_mac_id, std::uint8_t choice_bits, std::optional<std::uint8_t> as_master = {});
  bool set_packet_rate(std::uint8_t node_mac_id, std::uint8_t connection, std::uint16_t epr_ms);

  // Explicit acknowledges of responses: so many are not sent; the next one says another count, or another status.
  unsigned withhold_acknowledges = 0;
  std::optional<std::uint8_t> acknowledge_count;
  std::optional<std::uint8_t> acknowledge_status;

 private:
  void poll_all(std::uint64_t turn);
  void send_request_fragment(Node& node, std::uint32_t identifier, const Options& options);
  void receive_explicit(Node& node, const CanFrame& frame);

  CanBus& bus_;
  std::uint8_t mac_id_;
  DurationNs period_ns_;
  bool polling_ = false;
  std::map<std::uint8_t, Node> nodes_;
  Options options_;  // of the request under way
};

}  // namespace servotrace::simulator
