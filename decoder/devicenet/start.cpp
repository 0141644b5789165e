// SPDX-License-Identifier: MIT
// The start of a node: its Duplicate MAC ID check, and challengers of its MAC ID.
#include "decoder/devicenet/bus.hpp"
#include "decoder/devicenet/derived.hpp"

namespace servotrace::devicenet {
namespace {

constexpr DurationNs kActivity = 5 * kSecondNs;       // an older pair is that of a replaced drive
constexpr DurationNs kCaptureBefore = 1'500'000'000;  // of DN103: the first request may have been missed

std::int64_t pair_variant(std::uint16_t vendor, std::uint32_t serial) {
  return static_cast<std::int64_t>(std::uint64_t{vendor} << 32U | serial);
}

}  // namespace

void Bus::push_mac_check(const Arrival& arrival) {
  Node& entry = node(arrival.id.mac_id);
  const Bytes data = arrival.can.data;
  if (data.size() != kMacCheck.size) {
    show_plain(arrival, entry, kIoData);
    return;
  }
  show_plain(arrival, entry, kMacCheck);
  checked(rule("DN102"));
  const auto vendor = static_cast<std::uint16_t>(read(slot(kMacCheck, "vendor_id"), data));
  const auto serial = static_cast<std::uint32_t>(read(slot(kMacCheck, "serial_number"), data));
  const bool answer = read(slot(kMacCheck, "response"), data) != 0;
  const bool own = entry.has_pair && entry.vendor_id == vendor && entry.serial_number == serial;
  const bool recent = entry.active && elapsed_ns(entry.active_time_ns, arrival.now_ns()) <= kActivity;
  const auto duplicate = [&](std::int64_t kind, std::uint16_t other_vendor, std::uint32_t other_serial) {
    raise(arrival.context, {.rule = rule("DN102"),
                            .owner = entry.owner,
                            .arguments = {kind, other_vendor, other_serial},
                            .where = arrival.all(),
                            .related = {entry.check_frame, 0},
                            .variant = pair_variant(other_vendor, other_serial)});
    derive(arrival.context.dissection, kScannerCodeField, 70, entry.ref);
  };
  const auto take_pair = [&](bool certain) {
    entry.has_pair = true;
    entry.pair_certain = certain;
    entry.vendor_id = vendor;
    entry.serial_number = serial;
  };
  if (!answer) {
    if (own) {
      // Of a node heard on line whose pair came up just now, the second request proves as little as the first.
      started(arrival, entry, entry.pair_certain);
    } else if (entry.has_pair && recent) {
      entry.has_challenger = true;
      entry.challenger_vendor = vendor;
      entry.challenger_serial = serial;
      duplicate(1, vendor, serial);
    } else {  // a node not seen before, or a replaced drive
      const bool certain = !recent;
      take_pair(certain);
      entry.has_challenger = false;
      started(arrival, entry, certain);
    }
    return;
  }
  if (own && entry.pair_certain) {
    if (entry.has_challenger) {
      duplicate(0, entry.challenger_vendor, entry.challenger_serial);
    } else {
      duplicate(0, vendor, serial);
    }
  } else if (!entry.has_pair) {
    take_pair(true);
    duplicate(0, vendor, serial);
  } else if (entry.start == StartState::kOnLine && entry.pair_certain) {
    duplicate(0, vendor, serial);  // somebody else than the node answers for it
  } else {
    // The one that asked is the challenger; the node is the one that answers, and it goes on as before.
    duplicate(0, entry.vendor_id, entry.serial_number);
    entry.has_challenger = true;
    entry.challenger_vendor = entry.vendor_id;
    entry.challenger_serial = entry.serial_number;
    take_pair(true);
    entry.poll.state = PollState::kUnknown;
    entry.explicit_connection = Known::kUnknown;
  }
  entry.start = kStartMachine.next(entry.start, StartEvent::kAnswered).to;
}

void Bus::started(const Arrival& arrival, Node& node, bool certain) {
  node.heard = false;
  node.choice.reset();
  node.master = kNoMacId;
  node.poll.packet_rate_ms.reset();
  node.poll.watched = false;
  node.poll.awaiting = false;
  node.poll.has_command = false;
  node.explicit_rate_ms.reset();
  node.channel.body_format = 0;
  node.channel.used = false;
  if (!certain) {
    node.poll.state = PollState::kUnknown;
    node.explicit_connection = Known::kUnknown;
    return;
  }
  node.active = true;
  node.active_time_ns = arrival.now_ns();
  node.start = kStartMachine.next(node.start, StartEvent::kOwnCheck).to;
  step(node, PollEvent::kStart);
  node.explicit_connection = Known::kNo;
  for (PendingRequest& pending : node.channel.pending) pending.state = PendingRequest::State::kFree;
  node.late_allowance = 0;
  for (Transfer* transfer : {&node.channel.request, &node.channel.response, &node.poll.command, &node.poll.response,
                             &node.change_of_state_data.transfer, &node.multicast_response.transfer}) {
    transfer->forget();
  }
  std::erase_if(dynamic_, [&](const DynamicConnection& connection) { return connection.server == node.ref.mac_id; });
  if (node.start != StartState::kFirstCheck) return;
  node.check_time_ns = arrival.now_ns();
  node.check_frame = arrival.number();
  node.start_untold = true;
  starts_untold_ = true;
  tell_starts(arrival.context);
}

// A start may be seen before the bus is known to be DeviceNet, or the node to be a drive: its session hears of it as
// soon as there is one.
void Bus::tell_starts(const Context& context) {
  if (!devicenet_) return;
  starts_untold_ = false;
  for (Node* node : sessions_) {
    if (!node->start_untold) continue;
    node->start_untold = false;
    node->session->on_start(context);
    if (node->check_frame == context.frame.number) served_ = node->session.get();
  }
}

// It sends something else than its check, for the first time or where it was not known to be on line.
void Bus::step_start(const Arrival& arrival, Node& node) {
  const auto& row = kStartMachine.next(node.start, StartEvent::kTransmit);
  if (row.action == StartAction::kShortCheck) {
    checked(rule("DN103"));
    if (elapsed_ns(known_since_ns_, node.check_time_ns) >= kCaptureBefore) {
      raise(arrival.context, {.rule = rule("DN103"),
                              .owner = node.owner,
                              .arguments = {elapsed_ns(node.check_time_ns, arrival.now_ns())},
                              .related = {node.check_frame, 0}});
    }
  } else if (node.start == StartState::kChecked) {
    checked(rule("DN103"));
  }
  node.start = row.to;
}

}  // namespace servotrace::devicenet
