// SPDX-License-Identifier: MIT
// One CAN bus: its nodes, its connections, and what is found on it. One file a subject: bus.cpp (frames, errors, time),
// start.cpp (Duplicate MAC ID check), poll.cpp, io.cpp (the other I/O connections), explicit.cpp (requests and
// responses), effects.cpp (what a successful service changes), attributes.cpp (object tables), unconnected.cpp,
// summary.cpp.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "decoder/devicenet/evidence.hpp"
#include "decoder/devicenet/node.hpp"
#include "decoder/link/socketcan.hpp"
#include "decoder/pipeline/context.hpp"
#include "decoder/pipeline/summary.hpp"

namespace servotrace::devicenet {

// A CAN data frame on its way through the bus.
struct Arrival {
  const Context& context;
  const can::Frame& can;
  Identifier id;

  TimeNs now_ns() const { return context.frame.time_ns; }
  std::uint64_t number() const { return context.frame.number; }
  ByteRange bytes(std::size_t offset, std::size_t length) const {
    return {can.data_offset + static_cast<std::uint32_t>(offset), static_cast<std::uint32_t>(length)};
  }
  ByteRange all() const { return bytes(0, can.data.size()); }
};

// time + duration, saturated: hostile timestamps must not overflow.
constexpr TimeNs after_ns(TimeNs time_ns, DurationNs duration_ns) {
  TimeNs result = 0;
  return __builtin_add_overflow(time_ns, duration_ns, &result) ? INT64_MAX : result;
}

// A whole explicit message and where it lies.
struct Whole {
  Bytes bytes;
  Buffer buffer = Buffer::kFrame;
  std::uint32_t offset = 0;
  std::uint64_t first_frame = 0;
  TimeNs first_time_ns = 0;
  bool fragmented = false;
};

class Bus {
 public:
  Bus(const Settings& settings, const BusRef& ref, Findings& findings);

  void push(const Context& context, const can::Frame& frame);
  // The same for a data frame of 11 bits that nobody looks at.
  void push_plain(const Context& context, const can::Frame& frame);
  void assume();
  bool is_devicenet() const { return devicenet_; }
  void gap();
  void finish(const Context& context);
  void summarise(BusSummary& summary) const;

 private:
  // bus.cpp
  void push_any(const Context& context, const can::Frame& frame);
  void push_data(const Arrival& arrival);
  void push_predefined(const Arrival& arrival, Node* entry);
  bool push_of_node(const Arrival& arrival, Node& node);
  void push_error(const Context& context, const can::Frame& frame);
  void invalid(const Context& context, const can::Frame& frame, std::int64_t kind);
  void show_identifier(const Arrival& arrival, const Node* node) const;
  void show_plain(const Arrival& arrival, const Node& node, const Layout& layout) const;
  Node& node(std::int16_t mac_id) {
    Node* const known = nodes_[static_cast<std::size_t>(mac_id)].get();
    return known != nullptr ? *known : make_node(mac_id);
  }
  Node& make_node(std::int16_t mac_id);
  void check_deadlines(const Context& context);
  void note_deadline(TimeNs deadline_ns) {
    if (deadline_ns < next_deadline_ns_) next_deadline_ns_ = deadline_ns;
    if (deadline_ns < plain_until_ns_) plain_until_ns_ = deadline_ns;
  }
  void note_transfer(const Transfer& transfer);
  bool raise(const Context& context, const Report& report);
  void checked(RuleId rule) {
    if (devicenet_) findings_.checked(rule);
  }
  // The capture, or what follows a gap, began so recently that a message may have begun before it.
  bool mid_stream(TimeNs now_ns) const { return elapsed_ns(known_since_ns_, now_ns) < fragment_limit_ns(); }
  DurationNs fragment_limit_ns() const { return milliseconds(settings_.limits.fragment_ms); }
  DurationNs ack_limit_ns() const { return milliseconds(settings_.limits.fragment_ack_ms); }
  void make_session(Node& node, const DriveProfile& profile, Recognised how, std::uint64_t frame);
  void report_fragment(const Context& context, OwnerId owner, const FragmentResult& result, std::int64_t transfer,
                       FragmentType type, std::uint8_t count, ByteRange where, Actor sender);
  void show_fragments(const Arrival& arrival, const Transfer& transfer, const NodeRef& ref) const;
  static void derive(Dissection* dissection, const Field& field, std::int64_t value, const NodeRef& ref,
                     std::string_view text = {}) {
    if (dissection != nullptr) [[unlikely]]
      add_derived(*dissection, field, value, ref, text);
  }
  static void add_derived(Dissection& dissection, const Field& field, std::int64_t value, const NodeRef& ref,
                          std::string_view text);

  // start.cpp
  void push_mac_check(const Arrival& arrival);
  void transmitted(const Arrival& arrival, Node& node) {
    if (node.start != StartState::kOnLine) [[unlikely]]
      step_start(arrival, node);
    node.heard = true;
    node.active = true;
    node.active_time_ns = arrival.now_ns();
  }
  void step_start(const Arrival& arrival, Node& node);
  void started(const Arrival& arrival, Node& node, bool certain);
  void tell_starts(const Context& context);

  // poll.cpp
  struct Size {
    bool known = false;
    bool fragmented = false;
    std::uint32_t bytes = 0;
  };
  Size io_size(const Node& node, bool command) const;
  void push_poll(const Arrival& arrival, Node& node, bool command);
  void push_fragmented_poll(const Arrival& arrival, Node& node, bool command);
  void deliver_whole(const Arrival& arrival, Node& node, bool command, const Transfer& transfer);
  inline bool push_next_fragment(const Arrival& arrival, Node& node, bool command);
  void push_ambiguous_poll(const Arrival& arrival, Node& node, bool command);
  void guess(const Arrival& arrival, Node& node, bool command, const Transfer& transfer);
  void forget_guess(Node& node);
  void poll_begins(const Arrival& arrival, Node& node);
  void poll_answered(const Arrival& arrival, Node& node);
  void deliver(const Arrival& arrival, Node& node, bool command, const Message& message);
  void step(Node& node, PollEvent event);
  void watch(Node& node);
  void check_watchdog(const Context& context, Node& node);
  TimeNs watchdog_deadline_ns(const Node& node) const;

  // io.cpp
  void push_io(const Arrival& arrival, Node& node, IoStream& stream, std::int64_t transfer);

  // explicit.cpp
  void push_explicit(const Arrival& arrival, Node& node, ExplicitChannel& channel, bool request);
  void push_explicit_fragment(const Arrival& arrival, Node& node, ExplicitChannel& channel, bool request);
  void request_begins(const Arrival& arrival, Node& node, ExplicitChannel& channel, std::uint8_t header);
  void handle_request(const Arrival& arrival, Node& node, ExplicitChannel& channel, const Whole& whole);
  void handle_response(const Arrival& arrival, Node& node, ExplicitChannel& channel, const Whole& whole,
                       PendingRequest* answered);
  PendingRequest* match(ExplicitChannel& channel, std::uint8_t header, std::uint8_t service, bool is_error);
  PendingRequest& free_slot(ExplicitChannel& channel);
  void answered(const Arrival& arrival, Node& node, PendingRequest& pending, bool link);
  void unrequested(const Arrival& arrival, Node& node, std::uint8_t header, std::uint8_t service);
  void unanswered(const Context& context, Node& node, PendingRequest& pending, TimeNs now_ns);
  void check_requests(const Context& context, Node& node, ExplicitChannel& channel);
  void check_connection(const Arrival& arrival, Node& node, const Request& request, PendingRequest& pending);
  void malformed(const Arrival& arrival, OwnerId owner, Malformation why);
  void error_response(const Arrival& arrival, Node& node, OwnerId owner, const PendingRequest* pending,
                      const Response& response);
  Cause cause_of(const Node& node, std::uint64_t frame) const;
  OwnerId owner_of(const Arrival& arrival, const Node& node) const;

  // effects.cpp
  void succeeded(const Arrival& arrival, Node& node, ExplicitChannel& channel, const PendingRequest& pending,
                 const Response& response, Bytes message);
  void allocated(const Arrival& arrival, Node& node, ExplicitChannel& channel, const PendingRequest& pending,
                 const Response& response, Bytes message);
  void released(Node& node, std::uint32_t choice);
  void was_reset(const Arrival& arrival, Node& node);
  void size_told(const Arrival& arrival, Node& node, const Request& request, Bytes data);
  void packet_rate_set(const Arrival& arrival, Node& node, const PendingRequest& pending, Bytes data);
  void identity_read(const Arrival& arrival, Node& node, const PendingRequest& pending, Bytes data);
  void check_motion(const Arrival& arrival, Node& node, const Request& request, Bytes data);

  // attributes.cpp
  void check_attribute(const Arrival& arrival, Node& node, const Request& request, Bytes data);
  void check_get_of_set_only(const Arrival& arrival, Node& node, const PendingRequest& pending);
  const Layout* value_layout(const Node& node, const Request& request, std::size_t size) const;
  Values request_values(const Node& node, const Request& request, std::size_t size) const;
  Values response_values(const Node& node, const Request& request, std::size_t size) const;
  bool shown_by_session(const Node& node, const Request& request) const;
  void show_names(const Arrival& arrival, const Node& node, const Request& request) const;

  // unconnected.cpp
  void push_unconnected(const Arrival& arrival, bool request);
  void unconnected_request(const Arrival& arrival, std::uint8_t header, std::uint8_t service);
  void unconnected_response(const Arrival& arrival, Node& sender, std::uint8_t header, std::uint8_t service);
  void opened(const Arrival& arrival, const PendingOpen& open);
  DynamicConnection* opened_on(const Identifier& id);
  void push_dynamic(const Arrival& arrival, DynamicConnection& connection);

  const Settings& settings_;
  BusRef ref_;
  Findings& findings_;
  OwnerId owner_{};          // of the bus
  OwnerId capture_owner_{};  // of the interface: CP103
  bool configured_ = false;
  bool devicenet_ = false;
  EvidenceKind evidence_kind_ = EvidenceKind::kNone;
  std::uint64_t evidence_frame_ = 0;
  Evidence evidence_;

  bool begun_ = false;
  TimeNs begin_ns_ = 0;        // of the bus's first frame
  TimeNs known_since_ns_ = 0;  // the bus's first frame, or the first after a gap
  bool gap_pending_ = false;
  bool gap_seen_ = false;
  TimeNs last_ns_ = 0;
  bool error_seen_ = false;
  TimeNs error_ns_ = 0;
  TimeNs next_deadline_ns_ = INT64_MAX;
  TimeNs plain_until_ns_ = INT64_MIN;  // until then nothing but the connection has to be looked at: push_plain()
  std::uint64_t bits_ = 0;             // of all frames, stuff bits not counted

  std::array<std::unique_ptr<Node>, kMacIds> nodes_;
  std::vector<Node*> sessions_;     // nodes with a drive session
  bool starts_untold_ = false;      // a node with a session may not have heard of its start
  DriveSession* served_ = nullptr;  // the session this frame was handed to
  std::vector<DynamicConnection> dynamic_;
  std::array<PendingOpen, 16> opens_ = {};
  std::uint8_t next_open_ = 0;
};

}  // namespace servotrace::devicenet
