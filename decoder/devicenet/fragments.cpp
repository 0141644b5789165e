// SPDX-License-Identifier: MIT
#include "decoder/devicenet/fragments.hpp"

#include <algorithm>

namespace servotrace::devicenet {

void Transfer::store(Bytes payload) {
  const std::size_t taken = std::min(payload.size(), kCapacity - size_);
  std::copy_n(payload.begin(), taken, buffer_.begin() + static_cast<std::ptrdiff_t>(size_));
  size_ += taken;
  if (taken < payload.size()) overflowed_ = true;
}

void Transfer::begin(std::uint8_t key, Bytes payload, std::uint64_t frame, TimeNs time_ns) {
  state_ = State::kActive;
  awaiting_ack_ = acknowledged_;
  faulted_ = false;
  overflowed_ = false;
  key_ = key;
  count_ = 0;
  type_ = FragmentType::kFirst;
  size_ = 0;
  if (acknowledged_) buffer_[size_++] = key;
  store(payload);
  frames_.clear();
  frames_.push_back(frame);
  first_frame_ = frame;
  last_frame_ = frame;
  first_time_ns_ = time_ns;
  last_time_ns_ = time_ns;
}

// One finding a broken transfer: the first.
FragmentResult Transfer::fault(FragmentFault what, std::int64_t detail) {
  FragmentResult result;
  if (faulted_) return result;
  faulted_ = true;
  result.fault = what;
  result.detail = detail;
  result.related = last_frame_;
  return result;
}

bool Transfer::continues(FragmentType type, std::uint8_t count) const {
  return state_ == State::kActive && (type == FragmentType::kMiddle || type == FragmentType::kLast) &&
         count == ((count_ + 1U) & 0x3FU);
}

FragmentResult Transfer::push(FragmentType type, std::uint8_t count, std::uint8_t key, Bytes payload,
                              std::uint64_t frame, TimeNs time_ns, bool mid_stream) {
  FragmentResult result;
  if (type == FragmentType::kAcknowledge) return result;
  if (type == FragmentType::kFirst) {
    if (!acknowledged_ && count == kOnlyFragment) {
      if (state_ == State::kActive) result = fault(FragmentFault::kInterrupted);
      begin(key, payload, frame, time_ns);
      state_ = State::kDone;
      result.begins = true;
      result.complete = !overflowed_;
      return result;
    }
    if (count != 0) {
      if (state_ != State::kActive) {
        faulted_ = false;
        last_frame_ = frame;
      }
      result = fault(FragmentFault::kCount, 0);
      state_ = State::kBroken;
      return result;
    }
    const bool again = acknowledged_ && state_ == State::kActive && !is_other(key) && type_ == FragmentType::kFirst;
    if (again) {  // sent again: it restarts the same message
      const bool silent = !awaiting_ack_;
      const bool was_faulted = faulted_;
      if (!silent) result = fault(FragmentFault::kRepeated, count_);
      const std::uint64_t first = first_frame_;
      const TimeNs first_time = first_time_ns_;
      begin(key, payload, frame, time_ns);
      faulted_ = was_faulted || !silent;
      result.again = true;
      first_frame_ = first;
      first_time_ns_ = first_time;
      return result;
    }
    if (state_ == State::kActive) result = fault(FragmentFault::kInterrupted);
    begin(key, payload, frame, time_ns);
    result.begins = true;
    return result;
  }

  const bool last = type == FragmentType::kLast;
  const bool other = acknowledged_ && is_other(key);  // of another message than the one known
  if (state_ == State::kDone && !other && acknowledged_ && last && count == count_) {  // the last one again
    if (awaiting_ack_) result = fault(FragmentFault::kRepeated, count_);
    result.again = true;
    awaiting_ack_ = true;
    last_time_ns_ = time_ns;
    last_frame_ = frame;
    return result;
  }
  if (state_ == State::kUnknown && mid_stream) {
    state_ = last ? State::kIdle : State::kBroken;
    faulted_ = true;
    key_ = key;
    return result;
  }
  if (state_ == State::kUnknown || state_ == State::kIdle || state_ == State::kDone ||
      (state_ == State::kBroken && other)) {
    faulted_ = false;
    result = fault(FragmentFault::kNoFirst);
    result.related = 0;
    state_ = last ? State::kIdle : State::kBroken;
    key_ = key;
    return result;
  }
  if (state_ == State::kBroken) {
    if (last) state_ = State::kIdle;
    return result;
  }
  if (other) {  // a stray fragment beside the message under way
    result.fault = FragmentFault::kNoFirst;
    return result;
  }
  if (count == count_ && type == type_ && acknowledged_) {  // a retransmission: acknowledged again, not stored
    if (awaiting_ack_) result = fault(FragmentFault::kRepeated, count_);
    result.again = true;
    awaiting_ack_ = true;
    last_time_ns_ = time_ns;
    last_frame_ = frame;
    return result;
  }
  const auto next = static_cast<std::uint8_t>((count_ + 1U) & 0x3FU);
  if (count != next) {
    result = fault(FragmentFault::kCount, next);
    state_ = last ? State::kIdle : State::kBroken;
    return result;
  }
  if (awaiting_ack_) result = fault(FragmentFault::kNotAwaited, count_);
  store(payload);
  frames_.push_back(frame);
  count_ = count;
  type_ = type;
  awaiting_ack_ = acknowledged_;
  last_frame_ = frame;
  last_time_ns_ = time_ns;
  if (last) {
    state_ = State::kDone;
    result.complete = !overflowed_;
  }
  return result;
}

FragmentResult Transfer::acknowledge(std::uint8_t count, std::uint8_t status, std::uint8_t key) {
  FragmentResult result;
  if ((state_ != State::kActive && state_ != State::kDone) || is_other(key)) return result;
  if (status != 0) {  // always a finding of its own
    result.fault = FragmentFault::kAckStatus;
    result.detail = status;
    result.related = last_frame_;
    faulted_ = true;
    awaiting_ack_ = false;
    if (state_ == State::kActive) state_ = State::kBroken;
    return result;
  }
  if (count != count_) {
    if (awaiting_ack_) result = fault(FragmentFault::kAckCount, count_);
    return result;
  }
  awaiting_ack_ = false;
  return result;
}

TimeNs Transfer::deadline_ns(DurationNs limit_ns, DurationNs ack_limit_ns) const {
  TimeNs deadline = INT64_MAX;
  if ((state_ != State::kActive && state_ != State::kDone) || faulted_) return deadline;
  const auto after = [this](DurationNs limit) {
    TimeNs when = 0;
    return __builtin_add_overflow(last_time_ns_, limit, &when) ? INT64_MAX : when;
  };
  if (awaiting_ack_) deadline = after(ack_limit_ns);
  if (state_ == State::kActive) deadline = std::min(deadline, after(limit_ns));
  return deadline;
}

FragmentResult Transfer::expire(TimeNs now_ns, DurationNs limit_ns, DurationNs ack_limit_ns) {
  FragmentResult result;
  if (state_ != State::kActive && state_ != State::kDone) return result;
  const DurationNs age = elapsed_ns(last_time_ns_, now_ns);
  if (awaiting_ack_ && age >= ack_limit_ns) {
    result = fault(FragmentFault::kNoAck, count_);
    if (state_ == State::kDone) state_ = State::kIdle;
  }
  if (state_ == State::kActive && age >= limit_ns) {
    const FragmentResult stopped = fault(FragmentFault::kStopped);
    if (stopped.fault != FragmentFault::kNone) result = stopped;
    state_ = State::kIdle;
  }
  return result;
}

FragmentResult Transfer::abandon() {
  FragmentResult result;
  if (state_ == State::kActive) result = fault(FragmentFault::kInterrupted);
  if (state_ == State::kActive || state_ == State::kBroken) state_ = State::kIdle;
  return result;
}

}  // namespace servotrace::devicenet
