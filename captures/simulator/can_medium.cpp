// SPDX-License-Identifier: MIT
#include "captures/simulator/can_medium.hpp"

#include <algorithm>

namespace servotrace::simulator {
namespace {

// Arbitration: the value of the bits from the identifier on; lower wins.
std::uint64_t priority(const CanFrame& frame) {
  if (frame.error) return 0;
  const std::uint64_t base = frame.extended ? frame.identifier >> 18U : frame.identifier;
  const std::uint64_t rest = frame.extended ? frame.identifier & 0x3FFFFU : 0;
  return base << 21U | (frame.extended ? std::uint64_t{3} << 19U | rest << 1U : 0) | (frame.remote ? 1U : 0U);
}

constexpr unsigned kIntermissionBits = 3;

}  // namespace

void CanBus::detach(const Station* station) {
  stations_.erase(std::remove(stations_.begin(), stations_.end(), station), stations_.end());
}

void CanBus::send(const Station* sender, const CanFrame& frame, DurationNs delay_ns) {
  waiting_.push_back({now_ns_ + delay_ns, sender, frame});
}

void CanBus::at(TimeNs time_ns, std::function<void()> action) {
  timers_.emplace(std::max(time_ns, now_ns_), std::move(action));
}

std::size_t CanBus::winner(TimeNs at_ns) const {
  std::size_t best = waiting_.size();
  for (std::size_t i = 0; i < waiting_.size(); ++i) {
    if (waiting_[i].ready_ns > at_ns) continue;
    if (best == waiting_.size() || priority(waiting_[i].frame) < priority(waiting_[best].frame)) best = i;
  }
  return best;
}

void CanBus::transmit(std::size_t index, TimeNs start_ns) {
  Waiting entry = waiting_[index];
  waiting_.erase(waiting_.begin() + static_cast<std::ptrdiff_t>(index));
  const Fate fate = tamper ? tamper(entry.frame) : Fate::kSent;
  if (fate == Fate::kLost) return;
  const TimeNs bits = wire_bits(entry.frame);
  const TimeNs end_ns = start_ns + (bits - kIntermissionBits) * kSecondNs / bit_rate_;
  free_ns_ = start_ns + bits * kSecondNs / bit_rate_;
  at(end_ns, [this, entry, fate] {
    if (recording && fate != Fate::kUnrecorded) recorded_.push_back({now_ns_, entry.frame});
    if (fate == Fate::kUnheard || entry.frame.error) return;
    const std::vector<Station*> hearers = stations_;  // a station may leave while it hears
    for (Station* station : hearers) {
      if (station != entry.sender) station->receive(entry.frame);
    }
  });
}

bool CanBus::step(TimeNs until_ns) {
  TimeNs start_ns = INT64_MAX;
  for (const Waiting& entry : waiting_) start_ns = std::min(start_ns, std::max(entry.ready_ns, free_ns_));
  const TimeNs timer_ns = timers_.empty() ? INT64_MAX : timers_.begin()->first;
  const TimeNs next_ns = std::min(start_ns, timer_ns);
  if (next_ns > until_ns) {
    now_ns_ = std::max(now_ns_, until_ns);
    return false;
  }
  now_ns_ = std::max(now_ns_, next_ns);
  if (timer_ns <= start_ns) {
    const std::function<void()> action = std::move(timers_.begin()->second);
    timers_.erase(timers_.begin());
    action();
  } else {
    transmit(winner(next_ns), next_ns);
  }
  return true;
}

bool CanBus::run(TimeNs until_ns, const std::function<bool()>& done) {
  while (!done()) {
    if (!step(until_ns)) return done();
  }
  return true;
}

}  // namespace servotrace::simulator
