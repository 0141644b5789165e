// SPDX-License-Identifier: MIT
#include "decoder/devicenet/bus.hpp"

#include <utility>

#include "decoder/devicenet/derived.hpp"
#include "decoder/profiles/profile.hpp"
#include "decoder/profiles/profiles.hpp"

namespace servotrace::devicenet {
namespace {

constexpr std::int64_t kInvalidIdentifier = 0;  // argument 0 of DN101
constexpr std::int64_t kExtendedFrame = 1;
constexpr std::int64_t kRemoteFrame = 2;
constexpr std::int64_t kChangeOfStateTransfer = 4;  // argument 0 of DN301 and DN302
constexpr std::int64_t kMulticastTransfer = 5;
constexpr DurationNs kErrorPause = kSecondNs;  // error frames closer together are one finding

// SocketCAN error classes (the low bits of an error frame's identifier) and the controller's details (data byte 1).
constexpr std::uint32_t kClassLostArbitration = 0x002;
constexpr std::uint32_t kClassController = 0x004;
constexpr std::uint32_t kClassNoAck = 0x020;
constexpr std::uint32_t kClassBusOff = 0x040;
constexpr std::uint32_t kClassRestarted = 0x100;
constexpr std::uint32_t kClassCounters = 0x200;
constexpr std::uint32_t kControllerReceiveOverflow = 0x01;
constexpr std::uint32_t kControllerActive = 0x40;

// The poll identifiers carry change-of-state and cyclic messages of a node that is allocated so.
std::string_view name_of_message(const Identifier& id, const Node* node) {
  if (node == nullptr || !node->change_of_state_only()) return id.row->name;
  if (id.kind() == MessageKind::kPollCommand) return "Change-of-state or cyclic command";
  if (id.kind() == MessageKind::kPollResponse) return "Change-of-state or cyclic acknowledge";
  return id.row->name;
}

}  // namespace

Bus::Bus(const Settings& settings, const BusRef& ref, Findings& findings)
    : settings_(settings),
      ref_(ref),
      findings_(findings),
      owner_(findings.owner(NodeRef{.bus = ref, .protocol = Protocol::kDevicenet})),
      capture_owner_(findings.owner(NodeRef{.bus = BusRef{.interface_id = ref.interface_id}})) {
  configured_ = settings.devicenet.assumed;
  devicenet_ = configured_;
}

void Bus::assume() {
  configured_ = true;
  devicenet_ = true;
}

bool Bus::raise(const Context& context, const Report& report) {
  if (!devicenet_) return false;
  return findings_.raise(context.frame, report);
}

void Bus::add_derived(Dissection& dissection, const Field& field, std::int64_t value, const NodeRef& ref,
                      std::string_view text) {
  dissection.derived.push_back({.field = &field, .protocol = "dnet", .value = value, .text = text, .node = ref});
}

Node& Bus::make_node(std::int16_t mac_id) {
  std::unique_ptr<Node>& place = nodes_[static_cast<std::size_t>(mac_id)];
  place = std::make_unique<Node>();
  Node& made = *place;
  const auto mac = static_cast<unsigned>(mac_id);
  made.ref = NodeRef{.bus = ref_, .protocol = Protocol::kDevicenet, .mac_id = mac_id};
  const auto owner = [&](Channel channel) {
    NodeRef ref = made.ref;
    ref.channel = channel;
    return findings_.owner(ref);
  };
  made.owner = owner(Channel::kNone);
  made.poll_owner = owner(Channel::kPoll);
  made.explicit_owner = owner(Channel::kExplicit);
  made.unconnected_owner = owner(Channel::kUnconnected);
  made.channel.request_id = group2_id(mac, 4);
  made.channel.unconnected_id = group2_id(mac, 6);
  made.channel.response_id = group2_id(mac, 3);
  if (const DevicenetNodeSettings* entry = settings_.node(mac_id)) {
    if (!entry->profile.empty()) made.recognised = Recognised::kConfigured;
    for (const DriveProfile* profile : profiles()) {
      if (profile->key == entry->profile) make_session(made, *profile, Recognised::kConfigured, 0);
    }
  }
  return made;
}

void Bus::make_session(Node& node, const DriveProfile& profile, Recognised how, std::uint64_t frame) {
  if (node.profile == &profile && node.recognised >= how) return;
  node.profile = &profile;
  node.recognised = how;
  node.recognised_frame = frame;
  findings_.set_drive_basis(node.owner, node.drive_basis());
  node.session.reset();
  std::erase(sessions_, &node);
  if (profile.make_session == nullptr) return;
  node.session = profile.make_session(settings_, node.ref, node.owner, how == Recognised::kGuessed);
  if (node.session) sessions_.push_back(&node);
  starts_untold_ = true;
  plain_until_ns_ = INT64_MIN;
}

void Bus::gap() {
  plain_until_ns_ = INT64_MIN;
  gap_pending_ = true;
  gap_seen_ = true;
  evidence_.gap();
  next_deadline_ns_ = INT64_MAX;
  const auto forget = [](ExplicitChannel& channel) {
    channel.used = false;
    channel.request.forget();
    channel.response.forget();
    for (PendingRequest& pending : channel.pending) pending.state = PendingRequest::State::kFree;
  };
  for (const auto& entry : nodes_) {
    if (!entry) continue;
    Node& node = *entry;
    node.start = kStartMachine.next(node.start, StartEvent::kGap).to;
    node.start_untold = false;
    forget(node.channel);
    node.exchanged = false;
    node.late_allowance = 0;
    node.responded = false;
    node.last_frames = {};
    node.explicit_connection = Known::kUnknown;
    node.master = kNoMacId;
    PollConnection& poll = node.poll;
    poll.command.forget();
    poll.response.forget();
    node.change_of_state_data.transfer.forget();
    node.multicast_response.transfer.forget();
    poll.awaiting = false;
    poll.has_command = false;
    poll.polled = false;
    poll.last_interval_ns = -1;
    poll.watched = false;
    poll.guess_commands = 0;
    poll.guess_responses = 0;
    // What was lost may have been an allocation or a release: the next poll response says.
    poll.state = PollState::kUnknown;
    if (node.session) node.session->on_gap();
  }
  for (DynamicConnection& connection : dynamic_) {
    forget(connection.channel);
    connection.last_request = connection.last_response = {};
  }
  for (PendingOpen& open : opens_) open.used = false;
}

void Bus::push(const Context& context, const can::Frame& frame) {
  push_any(context, frame);
  const bool plain = devicenet_ && !gap_pending_ && !starts_untold_ && dynamic_.empty() && !settings_.judge_every_block;
  plain_until_ns_ = plain ? next_deadline_ns_ : INT64_MIN;
}

void Bus::push_any(const Context& context, const can::Frame& frame) {
  const TimeNs now = context.frame.time_ns;
  if (!begun_) begin_ns_ = now;
  if (!begun_ || gap_pending_) known_since_ns_ = now;
  begun_ = true;
  gap_pending_ = false;
  last_ns_ = now;
  bits_ += 47 + frame.data.size() * 8;
  served_ = nullptr;
  const Identifier id = identify(frame.identifier);
  if (!devicenet_) {
    const EvidenceKind kind = evidence_.push(id, frame, now);
    if (kind != EvidenceKind::kNone) {
      devicenet_ = true;
      evidence_kind_ = kind;
      evidence_frame_ = context.frame.number;
    }
  }
  if (starts_untold_) tell_starts(context);
  if (now >= next_deadline_ns_) check_deadlines(context);
  if (frame.error) {
    push_error(context, frame);
  } else if (frame.extended) {
    invalid(context, frame, kExtendedFrame);
  } else if (frame.remote) {
    invalid(context, frame, kRemoteFrame);
  } else if (id.kind() == MessageKind::kInvalid) {
    invalid(context, frame, kInvalidIdentifier);
    show_identifier({context, frame, id}, nullptr);
  } else {
    push_data({context, frame, id});
  }
  if (!frame.error) checked(rule("DN101"));
  checked(rule("DN104"));
  if (!devicenet_) return;
  for (Node* entry : sessions_) {
    if (entry->session.get() != served_) entry->session->on_time(context);
  }
}

void Bus::invalid(const Context& context, const can::Frame& frame, std::int64_t kind) {
  const NodeRef ref{.bus = ref_, .protocol = Protocol::kDevicenet};
  if (kind == kExtendedFrame) derive(context.dissection, kMessageField, 0, ref, "Frame with a 29-bit identifier");
  if (kind == kRemoteFrame) derive(context.dissection, kMessageField, 0, ref, "Remote frame");
  if (kind != kInvalidIdentifier) derive(context.dissection, kIdentifierField, frame.identifier, ref);
  raise(context, {.rule = rule("DN101"),
                  .owner = owner_,
                  .arguments = {kind, frame.identifier},
                  .variant = kind << 32U | static_cast<std::int64_t>(frame.identifier)});
}

void Bus::push_error(const Context& context, const can::Frame& frame) {
  if (context.dissection != nullptr) {
    Dissection& dissection = *context.dissection;
    const NodeRef ref{.bus = ref_, .protocol = Protocol::kDevicenet};
    derive(&dissection, kMessageField, 0, ref, "CAN error frame");
    derive(&dissection, kErrorClassField, frame.identifier, ref);
    for (std::size_t bit = 0; bit < std::size(kErrorBits); ++bit) {
      if ((frame.identifier >> bit & 1U) != 0) derive(&dissection, kErrorBits[bit], 1, ref);
    }
    if (fits(kErrorFrame, frame.data)) {
      dissection.add({.layout = &kErrorFrame,
                      .offset = frame.data_offset,
                      .length = kErrorFrame.size,
                      .node = {.bus = ref_, .protocol = Protocol::kDevicenet}});
    }
  }
  std::uint32_t classes = frame.identifier & ~(kClassLostArbitration | kClassRestarted | kClassCounters);
  if ((classes & kClassController) != 0 && fits(kErrorFrame, frame.data)) {
    auto details = static_cast<std::uint32_t>(read(slot(kErrorFrame, "controller"), frame.data));
    if ((details & kControllerReceiveOverflow) != 0) {
      gap();
      gap_pending_ = false;
      known_since_ns_ = context.frame.time_ns;
      raise(context, {.rule = rule("CP103"), .owner = capture_owner_, .arguments = {capture::kLostOverflow, 1}});
    }
    details &= ~(kControllerReceiveOverflow | kControllerActive);
    if (details == 0) classes &= ~kClassController;
  }
  if (classes == 0) return;
  if (error_seen_ && elapsed_ns(error_ns_, context.frame.time_ns) > kErrorPause) findings_.calm(owner_, rule("DN104"));
  error_seen_ = true;
  error_ns_ = context.frame.time_ns;
  const bool bus_off = (classes & kClassBusOff) != 0;
  const std::int64_t code = bus_off ? 91 : (classes & kClassNoAck) != 0 ? 79 : 0;
  if (code != 0)
    derive(context.dissection, kScannerCodeField, code, NodeRef{.bus = ref_, .protocol = Protocol::kDevicenet});
  raise(context, {.rule = rule("DN104"),
                  .owner = owner_,
                  .arguments = {classes, code},
                  .where = {0, 0},
                  .variant = bus_off ? 1 : 0});
}

void Bus::show_identifier(const Arrival& arrival, const Node* node) const {
  Dissection* const dissection = arrival.context.dissection;
  if (dissection == nullptr) return;
  const Identifier& id = arrival.id;
  const NodeRef ref = node == nullptr ? NodeRef{.bus = ref_, .protocol = Protocol::kDevicenet} : node->ref;
  dissection->direction = id.row->direction;
  derive(dissection, kIdentifierField, id.value, ref);
  derive(dissection, kMessageField, 0, ref, name_of_message(id, node));
  if (id.group == 0) return;
  derive(dissection, kGroupField, id.group, ref);
  derive(dissection, kMessageIdField, id.message_id, ref);
  std::int16_t source = id.source();
  std::int16_t destination = id.destination();
  const bool has_header = !arrival.can.data.empty();
  const auto header_mac = [&] { return static_cast<std::int16_t>(read(slot(kHeader, "master"), arrival.can.data)); };
  switch (id.kind()) {
    case MessageKind::kExplicitRequest:
    case MessageKind::kUnconnectedRequest:
      if (has_header) source = header_mac();
      break;
    case MessageKind::kExplicitResponse:
    case MessageKind::kUcmmRequest:
    case MessageKind::kUcmmResponse:
      if (has_header) destination = header_mac();
      break;
    case MessageKind::kPollCommand:
    case MessageKind::kChangeOfStateAck:
      if (node != nullptr) source = node->other_end();
      break;
    case MessageKind::kPollResponse:
    case MessageKind::kChangeOfState:
    case MessageKind::kBitStrobeResponse:
    case MessageKind::kMulticastPollResponse:
      if (node != nullptr) destination = node->other_end();
      break;
    default:
      break;
  }
  if (source >= 0) derive(dissection, kSourceField, source, ref);
  if (destination >= 0) derive(dissection, kDestinationField, destination, ref);
  if (id.row->role == MacRole::kGroup) derive(dissection, kMulticastGroupField, id.mac_id, ref);
  if (id.row->role == MacRole::kChecked) derive(dissection, kCheckedField, id.mac_id, ref);
}

void Bus::show_plain(const Arrival& arrival, const Node& node, const Layout& layout) const {
  if (arrival.context.dissection == nullptr) return;
  const Segment base{.offset = arrival.can.data_offset, .node = node.ref, .direction = arrival.id.row->direction};
  show(*arrival.context.dissection, base, layout, 0, arrival.can.data.size());
}

// A message of the node whose place in the predefined set its identifier names. False where it is none.
bool Bus::push_of_node(const Arrival& arrival, Node& node) {
  const Bytes data = arrival.can.data;
  switch (arrival.id.kind()) {
    case MessageKind::kPollCommand:
      push_poll(arrival, node, true);
      return true;
    case MessageKind::kPollResponse:
      push_poll(arrival, node, false);
      return true;
    case MessageKind::kExplicitRequest:
    case MessageKind::kUnconnectedRequest:
      push_explicit(arrival, node, node.channel, true);
      return true;
    case MessageKind::kExplicitResponse:
      push_explicit(arrival, node, node.channel, false);
      return true;
    case MessageKind::kGroup1:
    case MessageKind::kGroup3:
    case MessageKind::kChangeOfStateAck:
      show_plain(arrival, node, kIoData);
      return true;
    case MessageKind::kChangeOfState:
      push_io(arrival, node, node.change_of_state_data, kChangeOfStateTransfer);
      return true;
    case MessageKind::kMulticastPollResponse:
      push_io(arrival, node, node.multicast_response, kMulticastTransfer);
      return true;
    case MessageKind::kBitStrobeResponse:  // never above 8 bytes
      if (data.empty()) derive(arrival.context.dissection, kIdleField, 1, node.ref);
      show_plain(arrival, node, kIoData);
      return true;
    case MessageKind::kBitStrobeCommand:
      show_plain(arrival, node, fits(kBitStrobe, data) && data.size() == kBitStrobe.size ? kBitStrobe : kIoData);
      return true;
    default:
      return false;
  }
}

void Bus::push_data(const Arrival& arrival) {
  const Identifier& id = arrival.id;
  DynamicConnection* const open = opened_on(id);
  // Whose frame it is: the slave's by its place in the predefined set, else the sender's.
  const bool of_none = id.mac_id == kNoMacId || id.row->role == MacRole::kGroup;
  Node* const entry = open != nullptr ? &node(static_cast<std::int16_t>(open->server))
                      : of_none       ? nullptr
                                      : &node(id.mac_id);
  LastFrame* last = nullptr;
  if (open != nullptr) {
    last = open->channel.request_id == id.value ? &open->last_request : &open->last_response;
  } else if (entry != nullptr && id.kind() != MessageKind::kMacCheck) {
    last = &entry->last_frames[place_of(id)];
  }
  const LastFrame before = last == nullptr ? LastFrame{} : std::exchange(*last, {arrival.number(), arrival.now_ns()});
  if (open != nullptr) {
    push_dynamic(arrival, *open);
  } else {
    push_predefined(arrival, entry);
  }
  if (before.frame != 0 && arrival.context.dissection != nullptr) {
    arrival.context.dissection->links.push_back({.kind = LinkKind::kPreviousOfNode,
                                                 .frame = before.frame,
                                                 .after_ns = elapsed_ns(before.time_ns, arrival.now_ns()),
                                                 .node = entry->ref});
  }
}

void Bus::push_predefined(const Arrival& arrival, Node* entry) {
  const Identifier& id = arrival.id;
  const MessageKind kind = id.kind();
  if (arrival.context.dissection != nullptr) show_identifier(arrival, entry);
  if (entry != nullptr && id.source() >= 0 && kind != MessageKind::kMacCheck) transmitted(arrival, *entry);
  Dissection* const dissection = arrival.context.dissection;
  const Bytes data = arrival.can.data;
  if (kind == MessageKind::kMacCheck) {
    push_mac_check(arrival);
    return;
  }
  if (kind == MessageKind::kUcmmRequest || kind == MessageKind::kUcmmResponse) {
    push_unconnected(arrival, kind == MessageKind::kUcmmRequest);
    return;
  }
  if (entry != nullptr && push_of_node(arrival, *entry)) return;
  if (dissection == nullptr) return;
  const Segment base{.offset = arrival.can.data_offset,
                     .node = {.bus = ref_, .protocol = Protocol::kDevicenet},
                     .direction = id.row->direction};
  const auto show_known = [&](const Layout& layout, const Layout& rest) {
    const std::size_t known = fits(layout, data) ? layout.size : 0;
    show(*dissection, base, layout, 0, known);
    show(*dissection, base, rest, known, data.size() - known);
  };
  if (kind == MessageKind::kOwnershipRequest || kind == MessageKind::kOwnershipResponse) {
    const Layout& cut = fits(kOwnershipVendor, data) ? kOwnershipVendor : kOwnershipHead;
    show_known(fits(kOwnership, data) ? kOwnership : cut, kOwnershipData);
  } else if (kind == MessageKind::kFaultedRequest || kind == MessageKind::kFaultedResponse) {
    show_known(kFaulted, kFaultedData);
  } else {
    show(*dissection, base, kIoData, 0, data.size());
  }
}

void Bus::note_transfer(const Transfer& transfer) {
  note_deadline(transfer.deadline_ns(fragment_limit_ns(), ack_limit_ns()));
}

// What is past its deadline, on the first frame that shows it; and the next deadline of all.
void Bus::check_deadlines(const Context& context) {
  next_deadline_ns_ = INT64_MAX;
  const TimeNs now = context.frame.time_ns;
  const auto expire = [&](OwnerId owner, Transfer& transfer, std::int64_t kind, Actor sender) {
    const FragmentResult result = transfer.expire(now, fragment_limit_ns(), ack_limit_ns());
    report_fragment(context, owner, result, kind, FragmentType::kFirst, 0, {}, sender);
    note_transfer(transfer);
  };
  const auto channel = [&](Node& node, ExplicitChannel& entry) {
    check_requests(context, node, entry);
    expire(node.explicit_owner, entry.request, 2, Actor::kMaster);
    expire(node.explicit_owner, entry.response, 3, Actor::kDrive);
  };
  for (const auto& entry : nodes_) {
    if (!entry) continue;
    if (entry->recognised != Recognised::kGuessed) {  // a guess is no ground for a finding
      if (io_size(*entry, true).fragmented) expire(entry->poll_owner, entry->poll.command, 0, Actor::kMaster);
      if (io_size(*entry, false).fragmented) expire(entry->poll_owner, entry->poll.response, 1, Actor::kDrive);
    }
    if (entry->change_of_state_data.size)
      expire(entry->owner, entry->change_of_state_data.transfer, kChangeOfStateTransfer, Actor::kDrive);
    if (entry->multicast_response.size)
      expire(entry->owner, entry->multicast_response.transfer, kMulticastTransfer, Actor::kDrive);
    channel(*entry, entry->channel);
    check_watchdog(context, *entry);
  }
  for (DynamicConnection& connection : dynamic_) {
    channel(node(static_cast<std::int16_t>(connection.server)), connection.channel);
  }
}

void Bus::report_fragment(const Context& context, OwnerId owner, const FragmentResult& result, std::int64_t transfer,
                          FragmentType type, std::uint8_t count, ByteRange where, Actor sender) {
  const auto fault = static_cast<std::int64_t>(result.fault);
  switch (result.fault) {
    case FragmentFault::kNone:
      return;
    case FragmentFault::kCount:
    case FragmentFault::kType:
      raise(context, {.rule = rule("DN301"),
                      .owner = owner,
                      .arguments = {transfer, static_cast<std::int64_t>(type), count, result.detail},
                      .where = where,
                      .related = {result.related, 0},
                      .variant = transfer * 16 + static_cast<std::int64_t>(type)});
      return;
    case FragmentFault::kNoFirst:
    case FragmentFault::kInterrupted:
    case FragmentFault::kStopped:
      raise(context, {.rule = rule("DN302"),
                      .owner = owner,
                      .arguments = {transfer, fault},
                      .where = where,
                      .related = {result.related, 0},
                      .variant = transfer * 16 + fault});
      return;
    case FragmentFault::kRepeated:
    case FragmentFault::kNotAwaited:
    case FragmentFault::kNoAck:
    case FragmentFault::kAckCount:
    case FragmentFault::kAckStatus: {
      Report report{.rule = rule("DN303"),
                    .owner = owner,
                    .arguments = {transfer, fault, count},
                    .where = where,
                    .related = {result.related, 0},
                    .variant = transfer * 16 + fault};
      if (result.fault == FragmentFault::kAckStatus) report.actor = sender;
      if (result.fault == FragmentFault::kNoAck) report.arguments[2] = result.detail;
      raise(context, report);
      return;
    }
  }
}

// The links from the fragment that completes a message to those before it.
void Bus::show_fragments(const Arrival& arrival, const Transfer& transfer, const NodeRef& ref) const {
  Dissection* const dissection = arrival.context.dissection;
  if (dissection == nullptr) return;
  for (const std::uint64_t frame : transfer.frames()) {
    if (frame == arrival.number()) continue;
    const bool first = frame == transfer.first_frame();
    dissection->links.push_back({.kind = first ? LinkKind::kFirstFragment : LinkKind::kReassembledFrom,
                                 .frame = frame,
                                 .after_ns = first ? elapsed_ns(transfer.first_time_ns(), arrival.now_ns()) : 0,
                                 .node = ref});
  }
}

void Bus::finish(const Context& context) {
  // A deadline is moved on only by frames of this bus: what passed was found on its last frame.
  if (!devicenet_) return;
  for (Node* entry : sessions_) entry->session->on_finish(context);
}

}  // namespace servotrace::devicenet
