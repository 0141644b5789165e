// SPDX-License-Identifier: MIT
// What a request that succeeded changes: allocation, packet rates, connection sizes, identity, resets.
#include <algorithm>

#include "decoder/devicenet/bus.hpp"
#include "decoder/profiles/profile.hpp"
#include "decoder/profiles/profiles.hpp"

namespace servotrace::devicenet {
namespace {

constexpr std::uint16_t kIdentityClass = 1;
constexpr std::uint16_t kDevicenetClass = 3;
constexpr std::uint16_t kConnectionClass = 5;
constexpr std::uint16_t kPollInstance = 2;
constexpr std::uint16_t kChangeOfStateInstance = 4;  // and cyclic
constexpr std::uint16_t kMulticastInstance = 5;
constexpr std::uint8_t kDeleteService = 0x09;
constexpr std::uint32_t kChoiceExplicit = 0x01;
constexpr std::uint32_t kChoicePoll = 0x02;
constexpr std::uint32_t kChoiceIo = 0x3E;
constexpr DurationNs kMotionAge = kSecondNs;

}  // namespace

void Bus::succeeded(const Arrival& arrival, Node& node, ExplicitChannel& channel, const PendingRequest& pending,
                    const Response& response, Bytes message) {
  const Request& request = pending.request;
  const Bytes data = message.subspan(std::min<std::size_t>(response.data_offset, message.size()));
  if (request.layout == &kAllocate) {
    allocated(arrival, node, channel, pending, response, message);
  } else if (request.layout == &kRelease) {
    released(node, load_le(pending.request_data(), 0, 1));
  } else if (request.service == kResetService && request.class_id == kIdentityClass) {
    was_reset(arrival, node);
  } else if (request.class_id == kConnectionClass) {
    if (request.service == kDeleteService) {
      released(node, request.instance == 1 ? kChoiceExplicit : request.instance == kPollInstance ? kChoicePoll : 0U);
    } else if (request.service == kSetAttribute && request.attribute == 9) {
      packet_rate_set(arrival, node, pending, data);
    } else if (request.service == kSetAttribute) {
      size_told(arrival, node, request, pending.request_data());
    } else if (request.service == kGetAttribute) {
      size_told(arrival, node, request, data);
    }
  } else if (request.service == kGetAttribute && request.class_id == kIdentityClass) {
    identity_read(arrival, node, pending, data);
  } else if (request.service == kGetAttribute && request.class_id == kDevicenetClass) {
    if (request.attribute == 2 && data.size() == 1) node.baud_rate = Learnt{load_le(data, 0, 1), arrival.number()};
    if (request.attribute == 5 && data.size() == 2) {
      node.choice = Learnt{load_le(data, 0, 1), arrival.number()};
      const std::uint32_t master = load_le(data, 1, 1);
      if (master < kMacIds) node.master = static_cast<std::int16_t>(master);
    }
  }
  check_get_of_set_only(arrival, node, pending);
}

void Bus::allocated(const Arrival& arrival, Node& node, ExplicitChannel& channel, const PendingRequest& pending,
                    const Response& response, Bytes message) {
  const std::uint32_t choice = load_le(pending.request_data(), 0, 1);
  const std::uint32_t allocator = load_le(pending.request_data(), 1, 1);
  checked(rule("DN202"));
  findings_.calm(node.unconnected_owner, rule("DN202"));
  findings_.calm(node.explicit_owner, rule("DN202"));
  const std::int64_t before = node.choice ? node.choice->value : 0;
  node.choice = Learnt{before | choice, arrival.number()};
  if (allocator < kMacIds) node.master = static_cast<std::int16_t>(allocator);
  if ((choice & kChoiceExplicit) != 0) {
    node.explicit_connection = Known::kYes;
    channel.body_format = response.layout == &kAllocated
                              ? static_cast<std::uint8_t>(read(slot(kAllocated, "body_format"), message))
                              : std::uint8_t{0};
  }
  if ((choice & kChoicePoll) == 0) return;
  PollConnection& poll = node.poll;
  step(node, PollEvent::kAllocation);
  poll.packet_rate_ms.reset();
  poll.watched = false;
  poll.too_short = false;
  poll.awaiting = false;
  poll.has_command = false;
  findings_.calm(node.poll_owner, rule("DN201"));
}

void Bus::released(Node& node, std::uint32_t choice) {
  if ((choice & kChoiceExplicit) != 0) node.explicit_connection = Known::kNo;
  if ((choice & kChoicePoll) != 0) {
    step(node, PollEvent::kReleased);
    node.poll.packet_rate_ms.reset();
    node.poll.watched = false;
    node.poll.awaiting = false;
    node.poll.has_command = false;
    node.poll.polled = false;
  }
  if (!node.choice) return;
  node.choice->value &= ~static_cast<std::int64_t>(choice);
  if ((node.choice->value & (kChoiceExplicit | kChoiceIo)) == 0) node.master = kNoMacId;
}

void Bus::was_reset(const Arrival& arrival, Node& node) {
  step(node, PollEvent::kReset);
  node.explicit_connection = Known::kUnknown;
  node.master = kNoMacId;
  node.choice.reset();
  node.heard = false;
  node.poll.packet_rate_ms.reset();
  node.poll.watched = false;
  node.poll.awaiting = false;
  node.poll.has_command = false;
  node.poll.polled = false;
  if (node.session && devicenet_) node.session->on_start(arrival.context);
}

void Bus::packet_rate_set(const Arrival& arrival, Node& node, const PendingRequest& pending, Bytes data) {
  // The value in effect is the one in the response where there is one: a device may round it up.
  const Bytes value = data.size() == 2 ? data : pending.request_data();
  if (value.size() != 2) return;
  const Learnt rate{load_le(value, 0, 2), arrival.number()};
  const std::uint16_t instance = pending.request.instance;
  if (instance == 1) {
    node.explicit_rate_ms = rate;
    return;
  }
  PollConnection& poll = node.poll;
  checked(rule("DN210"));
  const bool is_poll = instance == kPollInstance;
  const DurationNs fourfold = milliseconds(rate.value * settings_.limits.epr_factor);
  const bool too_short = is_poll && rate.value != 0 && poll.interval.count() > 0 &&
                         static_cast<double>(fourfold) < poll.interval.mean_ns();
  if ((rate.value == 0 && node.known_drive()) || too_short) {
    raise(arrival.context, {.rule = rule("DN210"),
                            .owner = node.poll_owner,
                            .arguments = {rate.value, too_short ? 1 : 0},
                            .where = arrival.all(),
                            .related = {pending.frame, 0},
                            .basis = {BasisKind::kCapture, arrival.number()}});
  }
  if (!is_poll) return;
  step(node, PollEvent::kPacketRate);
  poll.packet_rate_ms = rate;
  poll.packet_rate_time_ns = arrival.now_ns();
  poll.polled_since_rate = false;
  poll.too_short = too_short;
  poll.watched = rate.value != 0 && !too_short;
  note_deadline(watchdog_deadline_ns(node));
}

// Connection attributes 7 (produced: what the node sends) and 8 (consumed: what it is sent), by connection instance.
void Bus::size_told(const Arrival& arrival, Node& node, const Request& request, Bytes data) {
  if (data.size() != 2 || (request.attribute != 7 && request.attribute != 8)) return;
  const bool produced = request.attribute == 7;
  const Learnt size{load_le(data, 0, 2), arrival.number()};
  switch (request.instance) {
    case kPollInstance:
      (produced ? node.poll.response_size : node.poll.command_size) = size;
      return;
    case kChangeOfStateInstance:
      (produced ? node.change_of_state_data.size : node.change_of_state_size) = size;
      return;
    case kMulticastInstance:
      if (produced) node.multicast_response.size = size;
      return;
    default:
      return;
  }
}

void Bus::identity_read(const Arrival& arrival, Node& node, const PendingRequest& pending, Bytes data) {
  if (pending.request.instance != 1) return;
  switch (pending.request.attribute) {
    case 1:
      if (data.size() == 2) node.identity_vendor = Learnt{load_le(data, 0, 2), arrival.number()};
      break;
    case 3:
      if (data.size() == 1 || data.size() == 2) {
        node.identity_product = Learnt{load_le(data, 0, static_cast<unsigned>(data.size())), arrival.number()};
      }
      break;
    case 7:
      break;
    default:
      return;
  }
  if (node.recognised >= Recognised::kIdentity) return;
  for (const DriveProfile* profile : profiles()) {
    bool matches = false;
    if (node.identity_vendor && node.identity_product && node.identity_product->value == profile->product_code) {
      for (const std::uint16_t vendor : profile->vendor_ids) matches = matches || vendor == node.identity_vendor->value;
    }
    if (pending.request.attribute == 7 && !profile->product_name.empty() &&
        data.size() > profile->product_name.size()) {
      bool same = true;
      for (std::size_t i = 0; i < profile->product_name.size(); ++i) {
        same = same && load_le(data, i + 1, 1) == static_cast<std::uint8_t>(profile->product_name[i]);
      }
      matches = matches || same;
    }
    if (!matches) continue;
    make_session(node, *profile, Recognised::kIdentity, arrival.number());
    return;
  }
}

// Taking the connection from a drive that moves.
void Bus::check_motion(const Arrival& arrival, Node& node, const Request& request, Bytes data) {
  const bool release = request.layout == &kRelease && !data.empty() && (load_le(data, 0, 1) & kChoiceIo) != 0;
  const bool reset =
      request.service == kResetService && (request.class_id == kIdentityClass ||
                                           (request.class_id == kConnectionClass && request.instance >= kPollInstance));
  if (!release && !reset) return;
  checked(rule("DN206"));
  if (!node.session || !node.known_drive() || !node.responded || !node.session->is_moving()) return;
  const DurationNs age = elapsed_ns(node.response_time_ns, arrival.now_ns());
  if (age < 0 || age > kMotionAge) return;
  raise(arrival.context, {.rule = rule("DN206"),
                          .owner = node.owner,
                          .arguments = {release ? 0 : 1, age},
                          .where = arrival.all(),
                          .related = {node.response_frame, 0},
                          .basis = node.drive_basis()});
}

}  // namespace servotrace::devicenet
