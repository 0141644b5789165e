// SPDX-License-Identifier: MIT
// Timestamps of capture files in units of an interface to nanoseconds.
#pragma once

#include <algorithm>
#include <cstdint>

#include "decoder/core/time.hpp"

namespace servotrace::replay {

// A resolution as pcapng's if_tsresol gives it: 10^-v, or 2^-v with the top bit set.
class Ticks {
 public:
  // Microseconds, pcapng's default.
  Ticks() = default;
  // False, and nothing changed, for a resolution finer than 64 bits can hold.
  bool set(std::uint8_t resolution) {
    const unsigned exponent = resolution & 0x7FU;
    const bool binary = (resolution & 0x80U) != 0;
    if (exponent > (binary ? 63U : 19U)) return false;
    binary_ = binary;
    shift_ = exponent;
    multiply_ = divide_ = 1;
    for (unsigned i = exponent; i < 9; ++i) multiply_ *= 10;
    for (unsigned i = 9; i < exponent; ++i) divide_ *= 10;
    settle();
    return true;
  }
  void set_offset_s(std::int64_t offset_s) {
    offset_s_ = offset_s;
    settle();
  }

  // Saturates at the ends of TimeNs.
  TimeNs to_ns(std::uint64_t ticks) const {
    if (ticks < plain_below_) [[likely]]
      return static_cast<TimeNs>(ticks * multiply_);
    return slow(ticks);
  }
  // Nanoseconds between two ticks, at least 1.
  std::uint32_t resolution_ns() const {
    if (binary_) return static_cast<std::uint32_t>(std::max<std::uint64_t>(1, 1'000'000'000U >> std::min(shift_, 31U)));
    return static_cast<std::uint32_t>(multiply_);
  }

 private:
  __extension__ using Wide = __int128;

  static constexpr std::uint64_t last_plain(std::uint64_t multiply) { return std::uint64_t{INT64_MAX} / multiply; }
  void settle() { plain_below_ = binary_ || divide_ != 1 || offset_s_ != 0 ? 0 : last_plain(multiply_) + 1; }

  TimeNs slow(std::uint64_t ticks) const {
    Wide value = ticks;
    if (binary_) {
      const std::uint64_t whole = ticks >> shift_;
      const std::uint64_t part = shift_ == 0 ? 0 : ticks & ((std::uint64_t{1} << shift_) - 1);
      value = Wide{whole} * kSecondNs + (Wide{part} * kSecondNs >> shift_);
    } else {
      value = value * static_cast<Wide>(multiply_) / static_cast<Wide>(divide_);
    }
    value += Wide{offset_s_} * kSecondNs;
    if (value > INT64_MAX) return INT64_MAX;
    if (value < INT64_MIN) return INT64_MIN;
    return static_cast<TimeNs>(value);
  }

  std::uint64_t multiply_ = 1000;  // of a binary resolution these two mean nothing
  std::uint64_t divide_ = 1;
  std::uint64_t plain_below_ = last_plain(1000) + 1;  // of fewer ticks the product is the time
  std::int64_t offset_s_ = 0;
  unsigned shift_ = 0;
  bool binary_ = false;
};

}  // namespace servotrace::replay
