// SPDX-License-Identifier: MIT
// Fragmented messages: explicit ones (every fragment acknowledged) and I/O ones (none is). One Transfer follows the
// fragments of one direction of one connection.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "decoder/core/bytes.hpp"
#include "decoder/core/small_vector.hpp"
#include "decoder/core/time.hpp"

namespace servotrace::devicenet {

enum class FragmentType : std::uint8_t { kFirst, kMiddle, kLast, kAcknowledge };
inline constexpr std::uint8_t kOnlyFragment = 0x3F;  // count of a first fragment that is the only one (I/O)

// What is wrong with a fragment. The numbers are argument 0 of DN301-DN303.
enum class FragmentFault : std::uint8_t {
  kNone,
  kCount,        // DN301: not the next count
  kType,         // DN301: the type does not fit
  kNoFirst,      // DN302: a middle or last fragment without a first
  kInterrupted,  // DN302: another message begun before the end
  kStopped,      // DN302: no further fragment in time
  kRepeated,     // DN303: sent again without its acknowledgement
  kNotAwaited,   // DN303: followed by the next without its acknowledgement
  kNoAck,        // DN303: not acknowledged in time
  kAckCount,     // DN303: an acknowledgement of another count
  kAckStatus,    // DN303: an acknowledgement with a status other than 0
};

struct FragmentResult {
  FragmentFault fault = FragmentFault::kNone;
  bool complete = false;      // message() is whole now
  bool begins = false;        // a first fragment of a message not seen before
  bool again = false;         // the last fragment once more
  std::int64_t detail = 0;    // the count expected
  std::uint64_t related = 0;  // frame the fault refers to, 0: none
};

class Transfer {
 public:
  // `key_mask`: the bits of a key that tell messages apart.
  explicit Transfer(bool acknowledged, std::uint8_t key_mask = 0xFF)
      : acknowledged_(acknowledged), key_mask_(key_mask) {}

  // A fragment of `payload`. `key` tells messages of one identifier apart (the explicit header; 0 for I/O) and is kept
  // as the message's first byte where the transfer is acknowledged. `mid_stream`: a fragment without its first is no
  // wonder, for the capture (or what follows a gap) began just now.
  FragmentResult push(FragmentType type, std::uint8_t count, std::uint8_t key, Bytes payload, std::uint64_t frame,
                      TimeNs time_ns, bool mid_stream);
  // The same for a fragment of an unacknowledged transfer that is the next one, of a message that begins where the one
  // before has ended; most are. False, and nothing was done, for any other.
  bool push_next(FragmentType type, std::uint8_t count, Bytes payload, std::uint64_t frame, TimeNs time_ns) {
    if (acknowledged_ || payload.size() > kPayload) return false;
    if (type == FragmentType::kFirst) {
      if (count != 0 || state_ != State::kDone) return false;
      state_ = State::kActive;
      faulted_ = overflowed_ = awaiting_ack_ = false;
      key_ = 0;
      size_ = 0;
      frames_.clear();
      first_frame_ = frame;
      first_time_ns_ = time_ns;
    } else {
      if (!continues(type, count) || faulted_ || overflowed_ || size_ + kPayload > kCapacity) return false;
      if (type == FragmentType::kLast) state_ = State::kDone;
    }
    count_ = count;
    type_ = type;
    std::uint8_t* const to = buffer_.data() + size_;
    if (payload.size() == kPayload) {
      std::copy_n(payload.data(), kPayload, to);  // of a size the compiler knows
    } else {
      std::copy_n(payload.data(), payload.size(), to);
    }
    size_ += payload.size();
    frames_.push_back(frame);
    last_frame_ = frame;
    last_time_ns_ = time_ns;
    return true;
  }
  // An acknowledgement of this transfer's fragments.
  FragmentResult acknowledge(std::uint8_t count, std::uint8_t status, std::uint8_t key);
  // What time alone shows. Limits in nanoseconds.
  FragmentResult expire(TimeNs now_ns, DurationNs limit_ns, DurationNs ack_limit_ns);
  // The earliest time at which expire() may find something; INT64_MAX: never.
  TimeNs deadline_ns(DurationNs limit_ns, DurationNs ack_limit_ns) const;

  // Another message of the same connection begins (a plain one, or a new request): what is unfinished never ends.
  FragmentResult abandon();
  // Nothing is known any more (gap, restart of the node).
  void forget() { state_ = State::kUnknown; }

  // True where (type, count) continues the message under way.
  bool continues(FragmentType type, std::uint8_t count) const;
  // All of the message is in.
  bool complete() const { return state_ == State::kDone && !overflowed_; }
  bool active() const { return state_ == State::kActive; }
  bool idle() const { return state_ == State::kUnknown || state_ == State::kIdle || state_ == State::kDone; }
  // The bytes so far. Valid until the next call of a member that changes the transfer.
  Bytes message() const { return Bytes(buffer_).first(size_); }
  std::uint64_t first_frame() const { return first_frame_; }
  std::uint64_t last_frame() const { return last_frame_; }
  // The frames of the fragments stored, in order; of a long message the first ones.
  const SmallVector<std::uint64_t, 48>& frames() const { return frames_; }
  TimeNs first_time_ns() const { return first_time_ns_; }
  // The message was longer than kCapacity: its end is missing.
  bool overflowed() const { return overflowed_; }

  static constexpr std::size_t kCapacity = 1024;
  static constexpr std::size_t kPayload = 7;  // bytes of an I/O fragment

 private:
  enum class State : std::uint8_t { kUnknown, kIdle, kActive, kDone, kBroken };

  void begin(std::uint8_t key, Bytes payload, std::uint64_t frame, TimeNs time_ns);
  void store(Bytes payload);
  FragmentResult fault(FragmentFault what, std::int64_t detail = 0);
  bool is_other(std::uint8_t key) const { return ((key ^ key_) & key_mask_) != 0; }

  bool acknowledged_;
  std::uint8_t key_mask_;
  State state_ = State::kUnknown;
  bool awaiting_ack_ = false;
  bool faulted_ = false;  // one finding a broken transfer
  bool overflowed_ = false;
  std::uint8_t key_ = 0;
  std::uint8_t count_ = 0;  // of the last fragment stored
  FragmentType type_ = FragmentType::kFirst;
  std::size_t size_ = 0;
  std::uint64_t first_frame_ = 0;
  std::uint64_t last_frame_ = 0;
  TimeNs first_time_ns_ = 0;
  TimeNs last_time_ns_ = 0;
  SmallVector<std::uint64_t, 48> frames_;
  std::array<std::uint8_t, kCapacity> buffer_ = {};
};

}  // namespace servotrace::devicenet
