// SPDX-License-Identifier: MIT
// The poll connection: commands and responses, their fragments, their watchdog, and the drive they belong to.
#include <algorithm>
#include <cstdlib>

#include "decoder/devicenet/bus.hpp"
#include "decoder/devicenet/derived.hpp"
#include "decoder/profiles/profile.hpp"
#include "decoder/profiles/profiles.hpp"

namespace servotrace::devicenet {
namespace {

constexpr std::size_t kFrameData = 8;       // bytes of a CAN frame: above this a connection is fragmented
constexpr std::uint8_t kMisfitLimit = 8;    // frames without one whole message, before the profile is doubted
constexpr std::uint8_t kGuessMessages = 3;  // of the guessed size, each way

constexpr std::int64_t kCommandTransfer = 0;  // argument 0 of DN301 and DN302
constexpr std::int64_t kResponseTransfer = 1;

}  // namespace

// Configured, told by the device (connection attributes 7 and 8), by its profile.
Bus::Size Bus::io_size(const Node& node, bool command) const {
  const auto sized = [](std::int64_t bytes) {
    return Size{true, bytes > static_cast<std::int64_t>(kFrameData), static_cast<std::uint32_t>(bytes)};
  };
  if (node.change_of_state_only()) {  // its acknowledges are no fragments
    if (!command) return sized(kFrameData);
    return node.change_of_state_size ? sized(node.change_of_state_size->value) : Size{};
  }
  const std::uint8_t profile = node.profile == nullptr ? std::uint8_t{0}
                               : command               ? node.profile->command_size
                                                       : node.profile->response_size;
  if (profile != 0 && node.recognised == Recognised::kConfigured) return sized(profile);
  const std::optional<Learnt>& learnt = command ? node.poll.command_size : node.poll.response_size;
  if (learnt) return sized(learnt->value);
  if (profile != 0) return sized(profile);
  return {};
}

void Bus::step(Node& node, PollEvent event) { node.poll.state = kPollMachine.next(node.poll.state, event).to; }

// A message whose last fragment has come in order.
void Bus::deliver_whole(const Arrival& arrival, Node& node, bool command, const Transfer& transfer) {
  findings_.calm(node.poll_owner, rule("DN301"));
  findings_.calm(node.poll_owner, rule("DN302"));
  deliver(arrival, node, command,
          {.bytes = transfer.message(),
           .buffer = Buffer::kReassembled,
           .offset = 0,
           .first_frame = transfer.first_frame(),
           .in_frame = arrival.bytes(1, arrival.can.data.size() - 1)});
}

// The fragment that is due: nothing to find. False, and nothing was done, for any other.
[[gnu::always_inline]] inline bool Bus::push_next_fragment(const Arrival& arrival, Node& node, bool command) {
  Transfer& transfer = command ? node.poll.command : node.poll.response;
  const Bytes data = arrival.can.data;
  const auto type = static_cast<FragmentType>(read(slot(kFragment, "type"), data));
  const auto count = static_cast<std::uint8_t>(read(slot(kFragment, "count"), data));
  if (arrival.context.dissection != nullptr || settings_.judge_every_block ||
      !transfer.push_next(type, count, data.subspan(1), arrival.number(), arrival.now_ns())) {
    return false;
  }
  checked(rule("DN301"));
  checked(rule("DN302"));
  if (!transfer.complete()) {
    note_deadline(after_ns(arrival.now_ns(), fragment_limit_ns()));
    if (type != FragmentType::kFirst) return true;
    if (command) {
      poll_begins(arrival, node);
    } else {
      poll_answered(arrival, node);
    }
    return true;
  }
  deliver_whole(arrival, node, command, transfer);
  return true;
}

void Bus::push_poll(const Arrival& arrival, Node& node, bool command) {
  const Size size = io_size(node, command);
  const Bytes data = arrival.can.data;
  if (data.empty()) {
    derive(arrival.context.dissection, kIdleField, 1, node.ref);
  } else if (size.known && size.fragmented) {
    if (!push_next_fragment(arrival, node, command)) push_fragmented_poll(arrival, node, command);
    return;
  } else if (!size.known) {
    push_ambiguous_poll(arrival, node, command);
    return;
  }
  if (command) {
    poll_begins(arrival, node);
  } else {
    poll_answered(arrival, node);
  }
  deliver(arrival, node, command,
          {.bytes = data,
           .buffer = Buffer::kFrame,
           .offset = arrival.can.data_offset,
           .first_frame = arrival.number(),
           .in_frame = arrival.all()});
}

// Of what most frames are, a poll command or response of a known node before any deadline, only the connection is
// looked at. Any other frame is taken as push() takes it.
// What it calls in this file is made part of it: half of the time would go into the calls.
[[gnu::flatten]] void Bus::push_plain(const Context& context, const can::Frame& frame) {
  const Identifier id = identify(frame.identifier);
  const bool command = id.kind() == MessageKind::kPollCommand;
  if (!command && id.kind() != MessageKind::kPollResponse) {
    push(context, frame);
    return;
  }
  Node* const node = nodes_[static_cast<std::size_t>(id.mac_id)].get();
  const TimeNs now = context.frame.time_ns;
  if (node == nullptr || now >= plain_until_ns_) {
    push(context, frame);
    return;
  }
  last_ns_ = now;
  bits_ += 47 + frame.data.size() * 8;
  served_ = nullptr;
  const Arrival arrival{context, frame, id};
  node->last_frames[place_of(id)] = {context.frame.number, now};
  if (!command) transmitted(arrival, *node);
  push_poll(arrival, *node, command);
  findings_.checked(rule("DN101"));
  findings_.checked(rule("DN104"));
  for (Node* entry : sessions_) {
    if (entry->session.get() != served_ && entry->session->waits()) entry->session->on_time(context);
  }
}

void Bus::push_fragmented_poll(const Arrival& arrival, Node& node, bool command) {
  Transfer& transfer = command ? node.poll.command : node.poll.response;
  const Bytes data = arrival.can.data;
  const auto type = static_cast<FragmentType>(read(slot(kFragment, "type"), data));
  const auto count = static_cast<std::uint8_t>(read(slot(kFragment, "count"), data));
  if (arrival.context.dissection != nullptr) {
    const Segment base{.offset = arrival.can.data_offset,
                       .node = node.ref,
                       .direction = arrival.id.row->direction,
                       .guessed = node.recognised == Recognised::kGuessed};
    show(*arrival.context.dissection, base, kFragment, 0, kFragment.size);
    show(*arrival.context.dissection, base, kFragmentData, kFragment.size, data.size() - kFragment.size);
  }
  const bool begins_again = transfer.active() && type == FragmentType::kFirst;
  FragmentResult result =
      transfer.push(type, count, 0, data.subspan(1), arrival.number(), arrival.now_ns(), mid_stream(arrival.now_ns()));
  checked(rule("DN301"));
  checked(rule("DN302"));
  if (type == FragmentType::kAcknowledge) {  // I/O fragments have none
    result.fault = FragmentFault::kType;
    result.detail = 0;
  }
  if (node.recognised == Recognised::kGuessed) {
    if (result.fault != FragmentFault::kNone && ++node.poll.misfits == kMisfitLimit) {
      forget_guess(node);
      return;
    }
  } else if (result.fault != FragmentFault::kNone && !node.poll.size_seen && node.known_drive()) {
    // As long as no message fitted the profile, the profile is in doubt and not the fragments.
    if (node.poll.misfits < kMisfitLimit && ++node.poll.misfits == kMisfitLimit) {
      const Size size = io_size(node, command);
      raise(arrival.context, {.rule = rule("DN203"),
                              .owner = node.poll_owner,
                              .arguments = {command ? 0 : 1, static_cast<std::int64_t>(data.size()), size.bytes, 1},
                              .where = arrival.all(),
                              .basis = node.drive_basis(),
                              .variant = 1});
      derive(arrival.context.dissection, kScannerCodeField, 77, node.ref);
    }
  } else {
    report_fragment(arrival.context, node.poll_owner, result, command ? kCommandTransfer : kResponseTransfer, type,
                    count, arrival.bytes(0, 1), command ? Actor::kMaster : Actor::kDrive);
  }
  note_transfer(transfer);
  if (command ? result.begins : result.begins || begins_again) {
    if (command) {
      poll_begins(arrival, node);
    } else {
      poll_answered(arrival, node);
    }
  }
  if (!result.complete) return;
  show_fragments(arrival, transfer, node.ref);
  if (arrival.context.dissection != nullptr) arrival.context.dissection->reassembled = transfer.message();
  deliver_whole(arrival, node, command, transfer);
}

// The connection size is not known: the first byte is data, or the header of a fragment.
void Bus::push_ambiguous_poll(const Arrival& arrival, Node& node, bool command) {
  Transfer& transfer = command ? node.poll.command : node.poll.response;
  const Bytes data = arrival.can.data;
  const auto type = static_cast<FragmentType>(read(slot(kFragment, "type"), data));
  const auto count = static_cast<std::uint8_t>(read(slot(kFragment, "count"), data));
  const bool follows = transfer.continues(type, count);
  const bool begins = type == FragmentType::kFirst && count == 0 && data.size() == kFrameData;
  const bool only = type == FragmentType::kFirst && count == kOnlyFragment;
  bool complete = false;
  if (follows || begins) {
    complete = transfer.push(type, count, 0, data.subspan(1), arrival.number(), arrival.now_ns(), true).complete;
  } else {
    transfer.forget();
  }
  if (complete) {
    guess(arrival, node, command, transfer);
  } else if (!follows && !begins) {
    (command ? node.poll.guess_commands : node.poll.guess_responses) = 0;
  }
  if (follows || begins || only) derive(arrival.context.dissection, kAmbiguousField, 1, node.ref);
  if (command) {
    if (!follows) poll_begins(arrival, node);
  } else {
    poll_answered(arrival, node);
  }
  show_plain(arrival, node, kIoData);
  if (command) {
    node.poll.awaiting = node.poll.state == PollState::kEstablished;
    node.poll.has_command = true;
    node.poll.command_bytes = static_cast<std::uint32_t>(data.size());
    node.poll.command_frame = arrival.number();
    node.poll.command_time_ns = arrival.now_ns();
  }
}

// A drive whose messages only fit as fragments of its own size, both ways, is guessed: decoded, no rule.
void Bus::guess(const Arrival& arrival, Node& node, bool command, const Transfer& transfer) {
  if (node.recognised != Recognised::kNone) return;
  const auto total = transfer.message().size();
  for (const DriveProfile* profile : profiles()) {
    if (profile->command_size <= kFrameData || profile->response_size <= kFrameData) continue;
    std::uint8_t& seen = command ? node.poll.guess_commands : node.poll.guess_responses;
    if (total != (command ? profile->command_size : profile->response_size)) {
      seen = 0;
      continue;
    }
    if (seen < kGuessMessages) ++seen;
    if (node.poll.guess_commands < kGuessMessages || node.poll.guess_responses < kGuessMessages) return;
    make_session(node, *profile, Recognised::kGuessed, arrival.number());
    return;
  }
}

void Bus::forget_guess(Node& node) {
  node.profile = nullptr;
  node.recognised = Recognised::kNone;
  node.session.reset();
  std::erase(sessions_, &node);
  node.poll.misfits = 0;
  node.poll.guess_commands = 0;
  node.poll.guess_responses = 0;
}

// A new poll command begins on this frame (whole, or its first fragment).
void Bus::poll_begins(const Arrival& arrival, Node& node) {
  PollConnection& poll = node.poll;
  Dissection* const dissection = arrival.context.dissection;
  if (poll.polled) {
    const DurationNs interval = elapsed_ns(poll.polled_time_ns, arrival.now_ns());
    poll.interval.add(interval);
    if (poll.last_interval_ns >= 0 && interval >= 0) {
      poll.interval_change.add(std::abs(interval - poll.last_interval_ns));
    }
    poll.last_interval_ns = interval;
    derive(dissection, kPollIntervalField, interval, node.ref);
  }
  if (poll.state == PollState::kEstablished && poll.has_command && !node.change_of_state()) {
    checked(rule("DN205"));
    if (poll.awaiting) {
      raise(arrival.context, {.rule = rule("DN205"),
                              .owner = node.poll_owner,
                              .arguments = {elapsed_ns(poll.command_time_ns, arrival.now_ns())},
                              .where = arrival.all(),
                              .related = {poll.command_frame, 0}});
      derive(dissection, kScannerCodeField, 72, node.ref);
    }
  }
  poll.awaiting = false;
  const PollState before = poll.state;
  const auto& row = kPollMachine.next(before, PollEvent::kCommand);
  checked(rule("DN201"));
  if (row.action == PollAction::kNotAllocated && !node.change_of_state()) {  // such a connection shares the identifier
    raise(arrival.context, {.rule = rule("DN201"),
                            .owner = node.poll_owner,
                            .arguments = {static_cast<std::int64_t>(before)},
                            .where = arrival.all(),
                            .related = {node.check_frame, 0},
                            .variant = static_cast<std::int64_t>(before)});
  }
  poll.state = row.to;
  poll.polled = true;
  poll.polled_time_ns = arrival.now_ns();
  poll.polled_frame = arrival.number();
  if (poll.packet_rate_ms) poll.polled_since_rate = true;
  watch(node);
  derive(dissection, kPollStateField, static_cast<std::int64_t>(poll.state), node.ref);
}

// A poll response (whole, or its first fragment) arrived.
void Bus::poll_answered(const Arrival& arrival, Node& node) {
  PollConnection& poll = node.poll;
  if (poll.has_command && poll.awaiting) {
    const DurationNs answer = elapsed_ns(poll.command_time_ns, arrival.now_ns());
    poll.answer.add(answer);
    derive(arrival.context.dissection, kResponseTimeField, answer, node.ref);
    if (arrival.context.dissection != nullptr) {
      arrival.context.dissection->links.push_back(
          {.kind = LinkKind::kRequestIn, .frame = poll.command_frame, .after_ns = answer, .node = node.ref});
    }
  }
  poll.awaiting = false;
  findings_.calm(node.poll_owner, rule("DN205"));
  findings_.calm(node.poll_owner, rule("DN201"));
  step(node, PollEvent::kResponse);
  if (poll.watched) note_deadline(watchdog_deadline_ns(node));  // established by this response, not by a command
  derive(arrival.context.dissection, kPollStateField, static_cast<std::int64_t>(poll.state), node.ref);
  const Bytes data = arrival.can.data;
  if (!data.empty()) {
    poll.data_seen = true;
    findings_.calm(node.poll_owner, rule("DN212"));
    return;
  }
  // An empty change-of-state acknowledge looks the same: only of a connection known to be polled.
  const bool polled = poll.data_seen || (node.choice && (node.choice->value & 0x02) != 0);
  checked(rule("DN212"));
  if (poll.has_command && poll.command_bytes > 0 && polled && !node.change_of_state()) {
    raise(arrival.context, {.rule = rule("DN212"),
                            .owner = node.poll_owner,
                            .arguments = {0},
                            .where = arrival.all(),
                            .related = {poll.command_frame, 0}});
    derive(arrival.context.dissection, kScannerCodeField, 86, node.ref);
  }
}

// A whole message, idle ones too.
void Bus::deliver(const Arrival& arrival, Node& node, bool command, const Message& message) {
  PollConnection& poll = node.poll;
  if (command) {
    poll.awaiting = poll.state == PollState::kEstablished;
    poll.has_command = true;
    poll.command_bytes = static_cast<std::uint32_t>(message.bytes.size());
    poll.command_frame = arrival.number();
    poll.command_time_ns = arrival.now_ns();
  }
  const std::uint8_t wanted = node.profile == nullptr ? std::uint8_t{0}
                              : command               ? node.profile->command_size
                                                      : node.profile->response_size;
  const std::size_t size = message.bytes.size();
  const bool sized = wanted == 0 || size == wanted;
  if (size != 0 && node.known_drive() && wanted != 0) {
    checked(rule("DN203"));
    if (sized) {
      poll.size_seen = true;
      findings_.calm(node.poll_owner, rule("DN203"));
    } else {
      raise(arrival.context,
            {.rule = rule("DN203"),
             .owner = node.poll_owner,
             .arguments = {command ? 0 : 1, static_cast<std::int64_t>(size), wanted, poll.size_seen ? 0 : 1},
             .where = message.in_frame,
             .basis = node.drive_basis(),
             .variant = poll.size_seen ? 0 : 1});
      derive(arrival.context.dissection, kScannerCodeField, 77, node.ref);
    }
  }
  if (size == 0) return;
  if (!node.session || !sized || !devicenet_) {
    if (arrival.context.dissection != nullptr) {
      show(*arrival.context.dissection,
           {.offset = message.offset,
            .buffer = message.buffer,
            .node = node.ref,
            .direction = arrival.id.row->direction},
           kIoData, 0, size);
    }
    return;
  }
  served_ = node.session.get();
  if (command) {
    node.session->on_command(arrival.context, message);
  } else {
    node.response_time_ns = arrival.now_ns();
    node.response_frame = arrival.number();
    node.responded = true;
    node.session->on_response(arrival.context, message);
  }
}

TimeNs Bus::watchdog_deadline_ns(const Node& node) const {
  const PollConnection& poll = node.poll;
  if (!poll.watched || !poll.packet_rate_ms || poll.packet_rate_ms->value == 0) return INT64_MAX;
  if (poll.state != PollState::kEstablished && poll.state != PollState::kConfiguring) return INT64_MAX;
  DurationNs limit = milliseconds(poll.packet_rate_ms->value * settings_.limits.epr_factor);
  if (!poll.polled_since_rate) limit = std::max(limit, milliseconds(settings_.limits.first_io_ms));
  return after_ns(poll.polled_since_rate ? poll.polled_time_ns : poll.packet_rate_time_ns, limit);
}

void Bus::watch(Node& node) {
  PollConnection& poll = node.poll;
  // After a gap the watchdog is watched again from the first poll command on.
  if (poll.packet_rate_ms && poll.polled_since_rate) poll.watched = poll.packet_rate_ms->value != 0 && !poll.too_short;
  if (!poll.watched) return;
  checked(rule("DN204"));
  note_deadline(watchdog_deadline_ns(node));
}

void Bus::check_watchdog(const Context& context, Node& node) {
  const TimeNs deadline = watchdog_deadline_ns(node);
  if (deadline == INT64_MAX) return;
  PollConnection& poll = node.poll;
  const TimeNs from = poll.polled_since_rate ? poll.polled_time_ns : poll.packet_rate_time_ns;
  if (context.frame.time_ns <= deadline) {
    note_deadline(deadline);
    return;
  }
  const auto& row = kPollMachine.next(poll.state, PollEvent::kTimeout);
  poll.state = row.to;
  if (row.action != PollAction::kTimedOut) return;
  raise(context, {.rule = rule("DN204"),
                  .owner = node.poll_owner,
                  .arguments = {elapsed_ns(from, context.frame.time_ns), elapsed_ns(from, deadline)},
                  .related = {poll.polled_since_rate ? poll.polled_frame : poll.packet_rate_ms->frame, 0},
                  .basis = {BasisKind::kCapture, poll.packet_rate_ms->frame}});
  poll.awaiting = false;
}

}  // namespace servotrace::devicenet
