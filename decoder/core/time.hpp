// SPDX-License-Identifier: MIT
// Time is what the capture says: nanoseconds since 1970-01-01 00:00 UTC, in 64 bits (years 1677 to 2262). Never a
// clock.
#pragma once

#include <cstdint>

namespace servotrace {

using TimeNs = std::int64_t;
using DurationNs = std::int64_t;

inline constexpr DurationNs kMicrosecondNs = 1'000;
inline constexpr DurationNs kMillisecondNs = 1'000'000;
inline constexpr DurationNs kSecondNs = 1'000'000'000;

constexpr DurationNs milliseconds(std::int64_t value) { return value * kMillisecondNs; }
constexpr DurationNs seconds(std::int64_t value) { return value * kSecondNs; }

// later - earlier, saturated: hostile timestamps must not overflow.
constexpr DurationNs elapsed_ns(TimeNs earlier, TimeNs later) {
  DurationNs result = 0;
  if (__builtin_sub_overflow(later, earlier, &result)) return later < earlier ? INT64_MIN : INT64_MAX;
  return result;
}

}  // namespace servotrace
