// SPDX-License-Identifier: MIT
// A Group 2 only DeviceNet slave: Duplicate MAC ID check, predefined connection set (explicit and poll), explicit
// messages with fragments, connection object, watchdog (DeviceNet link layer). A drive model derives from it and adds
// its poll data and its objects.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "captures/simulator/can_fragments.hpp"
#include "captures/simulator/can_medium.hpp"

namespace servotrace::simulator {

struct Identity {
  std::uint16_t vendor_id = 0;
  std::uint16_t device_type = 0;
  std::uint16_t product_code = 0;
  std::uint8_t major = 1;
  std::uint8_t minor = 0;
  std::uint32_t serial_number = 0;
  std::string product_name;
};

struct ExplicitRequest {
  std::uint8_t service = 0;
  std::uint8_t class_id = 0;
  std::uint8_t instance = 0;
  Bytes data;  // behind the instance: attribute number and value, or what the service wants
};

struct ExplicitReply {
  std::uint8_t general = 0;  // 0: success
  std::uint8_t additional = 0xFF;
  ByteVector data;

  static ExplicitReply error(std::uint8_t general_status, std::uint8_t additional_status = 0xFF) {
    return {general_status, additional_status, {}};
  }
};

// Services and general status codes a slave needs (DeviceNet link layer).
namespace service {
inline constexpr std::uint8_t kGetAttributesAll = 0x01;
inline constexpr std::uint8_t kSetAttributesAll = 0x02;
inline constexpr std::uint8_t kReset = 0x05;
inline constexpr std::uint8_t kGetAttributeSingle = 0x0E;
inline constexpr std::uint8_t kSetAttributeSingle = 0x10;
inline constexpr std::uint8_t kErrorResponse = 0x14;
inline constexpr std::uint8_t kAllocate = 0x4B;
inline constexpr std::uint8_t kRelease = 0x4C;
}  // namespace service
namespace status {
inline constexpr std::uint8_t kResourceUnavailable = 0x02;
inline constexpr std::uint8_t kServiceNotSupported = 0x08;
inline constexpr std::uint8_t kInvalidAttributeValue = 0x09;
inline constexpr std::uint8_t kAlreadyInState = 0x0B;
inline constexpr std::uint8_t kObjectStateConflict = 0x0C;
inline constexpr std::uint8_t kAttributeNotSettable = 0x0E;
inline constexpr std::uint8_t kNotEnoughData = 0x13;
inline constexpr std::uint8_t kAttributeNotSupported = 0x14;
inline constexpr std::uint8_t kTooMuchData = 0x15;
inline constexpr std::uint8_t kObjectDoesNotExist = 0x16;
}  // namespace status
namespace choice {
inline constexpr std::uint8_t kExplicit = 0x01;
inline constexpr std::uint8_t kPoll = 0x02;
}  // namespace choice

class Slave : public Station {
 public:
  struct Settings {
    std::uint8_t mac_id = 0;
    Identity identity;
    std::uint8_t command_size = 0;   // bytes of poll data it takes
    std::uint8_t response_size = 0;  // bytes of poll data it gives
    DurationNs poll_latency_ns = 400 * kMicrosecondNs;
    DurationNs explicit_latency_ns = 3 * kMillisecondNs;
  };

  Slave(CanBus& bus, Settings settings);

  // Sends `checks` Duplicate MAC ID requests, one second apart, then goes on line. What it kept is lost.
  void power_up(unsigned checks = 2);
  // Was on line before the capture began, and where `master` >= 0 allocated (explicit and poll) by it.
  void was_running(int master, std::uint16_t epr_ms);
  void power_off();
  bool on_line() const { return state_ == State::kOnLine; }

  void receive(const CanFrame& frame) override;

  const Settings& settings() const { return settings_; }

  // Faults put in by a scenario; each counts down to 0.
  unsigned leave_polls_unanswered = 0;
  unsigned leave_explicit_unanswered = 0;
  unsigned answer_idle = 0;                          // zero-length poll responses
  unsigned withhold_acknowledges = 0;                // of explicit fragments it receives
  std::optional<ExplicitReply> next_reply;           // instead of the next answer to an explicit request
  std::optional<ExplicitReply> next_allocate_reply;  // likewise to an allocation
  DurationNs extra_explicit_latency_ns = 0;
  std::optional<std::uint8_t> acknowledge_status;  // of the next explicit fragment received
  std::optional<std::uint8_t> acknowledge_count;

 protected:
  CanBus& bus() { return bus_; }
  TimeNs now_ns() const { return bus_.now_ns(); }
  // Whole poll data of the right length came.
  virtual void take_command(Bytes command) = 0;
  virtual ByteVector make_response() = 0;
  // A request for an object other than 01h, 03h, 05h.
  virtual ExplicitReply serve(const ExplicitRequest& request) = 0;
  // Power came, or Reset was served: RAM is as after power-up.
  virtual void restart() {}
  // The poll connection timed out or was released.
  virtual void lose_master() {}

 private:
  enum class State : std::uint8_t { kOff, kChecking, kOnLine, kFault };

  void check_mac_id(unsigned left);
  void receive_mac_check(const CanFrame& frame);
  void receive_unconnected(const CanFrame& frame);
  void receive_explicit(const CanFrame& frame);
  void receive_poll(const CanFrame& frame);
  void answer_poll();
  void serve_message(Bytes message, bool unconnected);
  ExplicitReply serve_any(const ExplicitRequest& request, std::uint8_t header, bool unconnected);
  ExplicitReply allocate(const ExplicitRequest& request);
  ExplicitReply release(const ExplicitRequest& request);
  ExplicitReply identity(const ExplicitRequest& request);
  ExplicitReply devicenet(const ExplicitRequest& request);
  ExplicitReply connection(const ExplicitRequest& request);
  void reply(std::uint8_t header, std::uint8_t service_code, const ExplicitReply& reply);
  void send_fragment();
  void arm_watchdog();
  std::uint32_t explicit_response_id() const { return 0x403U + 8U * settings_.mac_id; }
  bool has(std::uint8_t bit) const { return (allocated_ & bit) != 0; }

  CanBus& bus_;
  Settings settings_;
  State state_ = State::kOff;
  std::uint64_t life_ = 0;  // counts starts and stops: what was planned before one is void after it
  std::uint8_t owner_ = 0;
  std::uint8_t allocated_ = 0;  // choice bits
  std::uint16_t poll_epr_ms_ = 0;
  std::uint16_t explicit_epr_ms_ = 2500;
  bool poll_established_ = false;
  bool polled_ = false;
  std::uint64_t watchdog_ = 0;
  IoAssembler io_;
  ExplicitAssembler requests_;
  std::deque<ByteVector> out_;  // fragments of an answer not yet acknowledged
  std::uint64_t out_turn_ = 0;
  bool out_repeated_ = false;
};

}  // namespace servotrace::simulator
