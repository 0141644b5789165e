// SPDX-License-Identifier: MIT
// How often something happens: whether it happened more than `limit` times within an hour. Space for the last limit + 1
// times is taken once; a limit beyond kMaximum is never exceeded.
#pragma once

#include <cstdint>
#include <vector>

#include "decoder/core/time.hpp"

namespace servotrace {

class Hourly {
 public:
  static constexpr std::int64_t kMaximum = 100'000;

  explicit Hourly(std::int64_t limit) {
    if (limit >= 0 && limit < kMaximum) times_.resize(static_cast<std::size_t>(limit) + 1);
  }
  // True where this occurrence is one too many.
  bool add(TimeNs now) {
    if (times_.empty()) return false;
    times_[next_] = now;
    next_ = (next_ + 1) % times_.size();
    if (count_ < times_.size()) ++count_;
    return count_ == times_.size() && elapsed_ns(times_[next_], now) < 3600 * kSecondNs;
  }
  void clear() { count_ = 0; }

 private:
  std::vector<TimeNs> times_;
  std::size_t next_ = 0;
  std::size_t count_ = 0;
};

}  // namespace servotrace
