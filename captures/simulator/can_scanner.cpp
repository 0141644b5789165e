// SPDX-License-Identifier: MIT
#include "captures/simulator/can_scanner.hpp"

#include <algorithm>
#include <utility>

#include "captures/simulator/can_slave.hpp"

namespace servotrace::simulator {
namespace {

constexpr std::uint8_t kFragmentBit = 0x80;
constexpr std::uint8_t kXidBit = 0x40;
constexpr std::uint8_t kMacMask = 0x3F;
constexpr DurationNs kTurnaroundNs = 250 * kMicrosecondNs;
constexpr DurationNs kThinkNs = 2 * kMillisecondNs;  // between an answer and the next request

}  // namespace

Scanner::Scanner(CanBus& bus, std::uint8_t mac_id, DurationNs period_ns)
    : bus_(bus), mac_id_(mac_id), period_ns_(period_ns) {
  bus_.attach(this);
}

void Scanner::receive(const CanFrame& frame) {
  if (frame.extended || frame.remote || frame.error) return;
  if (frame.identifier >= 0x3C0U && frame.identifier < 0x400U) {
    const auto found = nodes_.find(static_cast<std::uint8_t>(frame.identifier & kMacMask));
    if (found == nodes_.end()) return;
    Node& from = found->second;
    if (!from.fragmented) {
      from.response = ByteVector(frame.payload().begin(), frame.payload().end());
      ++from.responses;
    } else if (std::optional<ByteVector> whole = from.io.add(frame.payload())) {
      from.response = std::move(whole);
      ++from.responses;
    }
    return;
  }
  if (frame.identifier < 0x400U || frame.identifier >= 0x600U || (frame.identifier & 7U) != 3) return;
  const auto found = nodes_.find(static_cast<std::uint8_t>(frame.identifier >> 3U & kMacMask));
  if (found != nodes_.end() && frame.length >= 2) receive_explicit(found->second, frame);
}

void Scanner::receive_explicit(Node& from, const CanFrame& frame) {
  const Bytes payload = frame.payload();
  const std::uint32_t identifier = 0x404U + 8U * from.mac_id;
  if ((payload[0] & kFragmentBit) == 0) {
    from.answer.assign(payload.begin(), payload.end());
    from.answered = true;
    return;
  }
  if ((payload[1] & fragment::kTypeMask) == fragment::kAcknowledge) {
    if (from.out_next > from.out.size() || from.out_next == 0) return;
    const ByteVector& sent = from.out[from.out_next - 1];
    const bool same = (payload[1] & fragment::kCountMask) == (sent[1] & fragment::kCountMask);
    if (!same || frame.length < 3 || payload[2] != 0) {
      from.out.clear();
      from.out_next = 0;
      return;
    }
    send_request_fragment(from, identifier, options_);
    return;
  }
  ExplicitAssembler::Step step = from.explicit_in.add(payload);
  if (step.acknowledge) {
    if (acknowledge_count) {
      (*step.acknowledge)[1] =
          static_cast<std::uint8_t>(fragment::kAcknowledge | *std::exchange(acknowledge_count, std::nullopt));
    }
    if (acknowledge_status) (*step.acknowledge)[2] = *std::exchange(acknowledge_status, std::nullopt);
    if (withhold_acknowledges > 0) {
      --withhold_acknowledges;
    } else {
      bus_.send(this, can_frame(identifier, *step.acknowledge), kTurnaroundNs);
    }
  }
  if (step.message) {
    from.answer = *step.message;
    from.answered = true;
  }
}

void Scanner::start_polling() {
  if (polling_) return;
  polling_ = true;
  poll_all(0);
}

void Scanner::poll_all(std::uint64_t turn) {
  for (auto& [mac_id, to] : nodes_) {
    if (!to.polled) continue;
    const std::uint32_t identifier = 0x405U + 8U * mac_id;
    ++to.polls;
    if (to.idle_polls > 0) {
      --to.idle_polls;
      bus_.send(this, can_frame(identifier, {}));
    } else if (to.fragmented) {
      for (const ByteVector& part : split_io(to.command)) bus_.send(this, can_frame(identifier, part));
    } else {
      bus_.send(this, can_frame(identifier, to.command));
    }
  }
  bus_.after(period_ns_, [this, turn] { poll_all(turn + 1); });
}

void Scanner::poll(std::uint8_t node_mac_id, std::uint64_t count) {
  Node& to = nodes_[node_mac_id];
  const std::uint64_t goal = to.polls + count;
  start_polling();
  bus_.run(bus_.now_ns() + static_cast<DurationNs>(count + 1) * period_ns_ + period_ns_,
           [&] { return to.polls >= goal; });
  // Up to shortly before the next poll: what the node answers in time is in.
  bus_.run(bus_.now_ns() + period_ns_ - std::min<DurationNs>(period_ns_ / 8, kMillisecondNs));
}

bool Scanner::request(std::uint8_t node_mac_id, Bytes message, const Options& options) {
  Node& to = nodes_[node_mac_id];
  to.mac_id = node_mac_id;
  options_ = options;
  const std::uint32_t identifier = (options.unconnected ? 0x406U : 0x404U) + 8U * node_mac_id;
  const unsigned xid = options.xid.value_or(to.xid);
  to.xid = xid ^ 1U;
  ByteVector whole{static_cast<std::uint8_t>((xid != 0 ? kXidBit : 0U) | options.master.value_or(mac_id_))};
  whole.insert(whole.end(), message.begin(), message.end());
  to.answered = false;
  std::vector<ByteVector> frames = split_explicit(whole);
  if (frames.size() == 1) {
    to.out.clear();
    to.out_next = 0;
    bus_.send(this, can_frame(identifier, frames[0]));
  } else {
    to.out = std::move(frames);
    to.out_next = 0;
    send_request_fragment(to, identifier, options);
  }
  if (!options.wait) return false;
  const bool came = bus_.run(bus_.now_ns() + options.timeout_ns, [&] { return to.answered; });
  bus_.run(bus_.now_ns() + kThinkNs);
  return came;
}

void Scanner::send_request_fragment(Node& to, std::uint32_t identifier, const Options& options) {
  if (to.out_next >= to.out.size() || to.out_next >= options.stop_after_fragments.value_or(SIZE_MAX)) {
    to.out.clear();
    to.out_next = 0;
    return;
  }
  const DurationNs pause_ns = to.out_next == 0 ? 0 : kTurnaroundNs + options.fragment_pause_ns;
  bus_.send(this, can_frame(identifier, to.out[to.out_next++]), pause_ns);
}

bool Scanner::allocate(std::uint8_t node_mac_id, std::uint8_t choice_bits, std::optional<std::uint8_t> as_master) {
  const std::uint8_t master = as_master.value_or(mac_id_);
  Options options;
  options.unconnected = true;
  options.master = master;
  options.xid = 0;
  const bool came = request(node_mac_id, ByteVector{service::kAllocate, 0x03, 0x01, choice_bits, master}, options);
  const ByteVector& answer = nodes_[node_mac_id].answer;
  return came && answer.size() >= 2 && answer[1] == (service::kAllocate | 0x80);
}

bool Scanner::set_packet_rate(std::uint8_t node_mac_id, std::uint8_t connection, std::uint16_t epr_ms) {
  const ByteVector message{
      service::kSetAttributeSingle,           0x05, connection, 9, static_cast<std::uint8_t>(epr_ms & 0xFFU),
      static_cast<std::uint8_t>(epr_ms >> 8U)};
  return request(node_mac_id, message);
}

}  // namespace servotrace::simulator
