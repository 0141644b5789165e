// SPDX-License-Identifier: MIT
#include "captures/simulator/can_slave.hpp"

#include <algorithm>
#include <utility>

namespace servotrace::simulator {
namespace {

constexpr std::uint8_t kFragmentBit = 0x80;
constexpr std::uint8_t kMacMask = 0x3F;
constexpr std::uint8_t kResponseBit = 0x80;
constexpr DurationNs kMacCheckNs = kSecondNs;
constexpr DurationNs kBootNs = 20 * kMillisecondNs;
constexpr DurationNs kFirstIoNs = 10 * kSecondNs;
constexpr std::int64_t kWatchdogFactor = 4;
constexpr DurationNs kAcknowledgeNs = kSecondNs;
constexpr DurationNs kNextFragmentNs = 300 * kMicrosecondNs;

void put_le(ByteVector& bytes, std::uint32_t value, unsigned byte_count) {
  for (unsigned i = 0; i < byte_count; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8U * i) & 0xFFU));
}

}  // namespace

Slave::Slave(CanBus& bus, Settings settings) : bus_(bus), settings_(std::move(settings)) { bus_.attach(this); }

void Slave::power_off() {
  ++life_;
  state_ = State::kOff;
  allocated_ = 0;
  poll_established_ = false;
  out_.clear();
}

void Slave::power_up(unsigned checks) {
  power_off();
  restart();
  state_ = State::kChecking;
  check_mac_id(checks);
}

void Slave::was_running(int master, std::uint16_t epr_ms) {
  power_off();
  restart();
  state_ = State::kOnLine;
  if (master < 0) return;
  owner_ = static_cast<std::uint8_t>(master);
  allocated_ = choice::kExplicit | choice::kPoll;
  poll_epr_ms_ = epr_ms;
  poll_established_ = true;
  polled_ = true;
  arm_watchdog();
}

void Slave::check_mac_id(unsigned left) {
  if (left == 0) {
    state_ = State::kOnLine;
    return;
  }
  ByteVector payload{0};
  put_le(payload, settings_.identity.vendor_id, 2);
  put_le(payload, settings_.identity.serial_number, 4);
  bus_.send(this, can_frame(0x407U + 8U * settings_.mac_id, payload));
  bus_.after(kMacCheckNs, [this, left, life = life_] {
    if (life == life_ && state_ == State::kChecking) check_mac_id(left - 1);
  });
}

void Slave::receive_mac_check(const CanFrame& frame) {
  if (frame.length < 7) return;
  if ((frame.data[0] & kResponseBit) != 0) {
    if (state_ == State::kChecking || state_ == State::kOnLine) state_ = State::kFault;
    return;
  }
  if (state_ != State::kOnLine) return;
  ByteVector payload{kResponseBit};
  put_le(payload, settings_.identity.vendor_id, 2);
  put_le(payload, settings_.identity.serial_number, 4);
  bus_.send(this, can_frame(frame.identifier, payload), 500 * kMicrosecondNs);
}

void Slave::receive(const CanFrame& frame) {
  if (frame.extended || frame.remote || frame.error) return;
  const std::uint32_t base = 0x400U + 8U * settings_.mac_id;
  if (frame.identifier < base || frame.identifier > base + 7U) return;
  const std::uint32_t message = frame.identifier - base;
  if (message == 7) {
    receive_mac_check(frame);
  } else if (state_ != State::kOnLine) {
    return;
  } else if (message == 6) {
    receive_unconnected(frame);
  } else if (message == 4) {
    receive_explicit(frame);
  } else if (message == 5) {
    receive_poll(frame);
  }
}

void Slave::receive_unconnected(const CanFrame& frame) {
  if (frame.length >= 4 && (frame.data[0] & kFragmentBit) == 0) serve_message(frame.payload(), true);
}

void Slave::receive_explicit(const CanFrame& frame) {
  if (!has(choice::kExplicit) || frame.length < 2 || (frame.data[0] & kMacMask) != owner_) return;
  const Bytes payload = frame.payload();
  if ((payload[0] & kFragmentBit) == 0) {
    serve_message(payload, false);
    return;
  }
  if ((payload[1] & fragment::kTypeMask) == fragment::kAcknowledge) {
    if (out_.empty() || frame.length < 3 ||
        (out_.front()[1] & fragment::kCountMask) != (payload[1] & fragment::kCountMask))
      return;
    out_.pop_front();
    if (payload[2] != 0) out_.clear();
    ++out_turn_;
    out_repeated_ = false;
    if (!out_.empty()) send_fragment();
    return;
  }
  ExplicitAssembler::Step step = requests_.add(payload);
  if (step.acknowledge) {
    if (acknowledge_status) (*step.acknowledge)[2] = *std::exchange(acknowledge_status, std::nullopt);
    if (acknowledge_count) {
      (*step.acknowledge)[1] =
          static_cast<std::uint8_t>(fragment::kAcknowledge | *std::exchange(acknowledge_count, std::nullopt));
    }
    if (withhold_acknowledges > 0) {
      --withhold_acknowledges;
    } else {
      bus_.send(this, can_frame(explicit_response_id(), *step.acknowledge), kNextFragmentNs);
    }
  }
  if (step.message) serve_message(*step.message, false);
}

void Slave::serve_message(Bytes message, bool unconnected) {
  if (message.size() < 4) return;
  const std::uint8_t header = message[0];
  const ExplicitRequest request{message[1], message[2], message[3], message.subspan(4)};
  if (leave_explicit_unanswered > 0) {
    --leave_explicit_unanswered;
    return;
  }
  ExplicitReply answer;
  if (unconnected && request.service == service::kAllocate && next_allocate_reply) {
    answer = *std::exchange(next_allocate_reply, std::nullopt);
  } else if (next_reply && !unconnected) {
    answer = *std::exchange(next_reply, std::nullopt);
  } else {
    answer = serve_any(request, header, unconnected);
  }
  reply(header, request.service, answer);
  if (answer.general == 0 && request.service == service::kReset && request.class_id == 0x01) {
    bus_.after(settings_.explicit_latency_ns + extra_explicit_latency_ns + kBootNs, [this, life = life_] {
      if (life == life_) power_up();
    });
  }
}

void Slave::reply(std::uint8_t header, std::uint8_t service_code, const ExplicitReply& answer) {
  ByteVector message{static_cast<std::uint8_t>(header & ~kFragmentBit)};
  if (answer.general == 0) {
    message.push_back(service_code | kResponseBit);
    message.insert(message.end(), answer.data.begin(), answer.data.end());
  } else {
    message.insert(message.end(), {static_cast<std::uint8_t>(service::kErrorResponse | kResponseBit), answer.general,
                                   answer.additional});
  }
  std::vector<ByteVector> frames = split_explicit(message);
  const DurationNs delay_ns = settings_.explicit_latency_ns + extra_explicit_latency_ns;
  out_.clear();
  ++out_turn_;
  if (frames.size() == 1) {
    bus_.send(this, can_frame(explicit_response_id(), frames[0]), delay_ns);
    return;
  }
  out_.assign(frames.begin(), frames.end());
  out_repeated_ = false;
  bus_.after(delay_ns - kNextFragmentNs, [this, life = life_, turn = out_turn_] {
    if (life == life_ && turn == out_turn_ && !out_.empty()) send_fragment();
  });
}

void Slave::send_fragment() {
  bus_.send(this, can_frame(explicit_response_id(), out_.front()), kNextFragmentNs);
  bus_.after(kAcknowledgeNs, [this, life = life_, turn = out_turn_] {
    if (life != life_ || turn != out_turn_ || out_.empty()) return;
    if (std::exchange(out_repeated_, true)) {
      out_.clear();
    } else {
      send_fragment();
    }
  });
}

void Slave::receive_poll(const CanFrame& frame) {
  if (!has(choice::kPoll) || !poll_established_) return;
  std::optional<ByteVector> command;
  if (settings_.command_size > 8) {
    command = io_.add(frame.payload());
    if (!command) return;
  } else {
    command = ByteVector(frame.payload().begin(), frame.payload().end());
  }
  polled_ = true;
  arm_watchdog();
  if (leave_polls_unanswered > 0) {
    --leave_polls_unanswered;
    return;
  }
  answer_poll();
  // What the drive sends is what it had when the poll came: a command shows in the response to the next one.
  if (command->size() == settings_.command_size) take_command(*command);
}

void Slave::answer_poll() {
  ByteVector data;
  if (answer_idle > 0) {
    --answer_idle;
  } else {
    data = make_response();
  }
  const std::uint32_t identifier = 0x3C0U + settings_.mac_id;
  if (settings_.response_size > 8) {
    for (const ByteVector& part : split_io(data)) {
      bus_.send(this, can_frame(identifier, part), settings_.poll_latency_ns);
    }
  } else {
    bus_.send(this, can_frame(identifier, data), settings_.poll_latency_ns);
  }
}

void Slave::arm_watchdog() {
  const std::uint64_t turn = ++watchdog_;
  if (poll_epr_ms_ == 0) return;
  DurationNs limit_ns = kWatchdogFactor * milliseconds(poll_epr_ms_);
  if (!polled_) limit_ns = std::max(limit_ns, kFirstIoNs);
  bus_.after(limit_ns, [this, turn, life = life_] {
    if (turn != watchdog_ || life != life_ || !poll_established_) return;
    poll_established_ = false;
    lose_master();
  });
}

}  // namespace servotrace::simulator
