// SPDX-License-Identifier: MIT
// Durations: count, bounds, mean and percentiles of an interval measured again and again, in fixed space. Percentiles
// are read from buckets an eighth of a power of two wide, so they are right to 12.5 % (rounded up, never below).
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "decoder/core/time.hpp"

namespace servotrace {

class Durations {
 public:
  // A negative duration (a clock set back) is not counted.
  void add(DurationNs duration_ns) {
    if (duration_ns < 0) return;
    minimum_ns_ = count_ == 0 ? duration_ns : std::min(minimum_ns_, duration_ns);
    maximum_ns_ = std::max(maximum_ns_, duration_ns);
    ++count_;
    sum_ns_ += static_cast<double>(duration_ns);
    ++buckets_[bucket(static_cast<std::uint64_t>(duration_ns))];
  }
  // As if each of the other's had been added here.
  void merge(const Durations& other) {
    if (other.count_ == 0) return;
    minimum_ns_ = count_ == 0 ? other.minimum_ns_ : std::min(minimum_ns_, other.minimum_ns_);
    maximum_ns_ = std::max(maximum_ns_, other.maximum_ns_);
    count_ += other.count_;
    sum_ns_ += other.sum_ns_;  // whole numbers far below 2^53
    for (std::size_t i = 0; i < buckets_.size(); ++i) buckets_[i] += other.buckets_[i];
  }
  std::uint64_t count() const { return count_; }
  DurationNs minimum_ns() const { return minimum_ns_; }
  DurationNs maximum_ns() const { return maximum_ns_; }
  double mean_ns() const { return count_ == 0 ? 0 : sum_ns_ / static_cast<double>(count_); }
  // The duration that `percent` of them do not exceed.
  DurationNs percentile_ns(unsigned percent) const {
    if (count_ == 0) return 0;
    const std::uint64_t wanted = (count_ * percent + 99) / 100;
    std::uint64_t seen = 0;
    for (std::size_t i = 0; i < buckets_.size(); ++i) {
      seen += buckets_[i];
      if (seen >= wanted) return std::clamp(upper_end(i), minimum_ns_, maximum_ns_);
    }
    return maximum_ns_;
  }

 private:
  static constexpr unsigned kSteps = 8;  // buckets a power of two
  static std::size_t bucket(std::uint64_t value) {
    if (value < kSteps) return static_cast<std::size_t>(value);
    const auto power = static_cast<unsigned>(std::bit_width(value)) - 1U;  // at least 3
    return (power - 2U) * kSteps + static_cast<std::size_t>(value >> (power - 3U) & (kSteps - 1U));
  }
  static DurationNs upper_end(std::size_t index) {
    if (index < kSteps) return static_cast<DurationNs>(index);
    const auto power = static_cast<unsigned>(index / kSteps) + 2U;
    const std::uint64_t step = std::uint64_t{1} << (power - 3U);
    return static_cast<DurationNs>((std::uint64_t{1} << power) + (index % kSteps + 1) * step - 1);
  }

  std::array<std::uint32_t, 62 * kSteps> buckets_{};
  std::uint64_t count_ = 0;
  DurationNs minimum_ns_ = 0;
  DurationNs maximum_ns_ = 0;
  double sum_ns_ = 0;
};

}  // namespace servotrace
