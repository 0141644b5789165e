// SPDX-License-Identifier: MIT
// A signal over time in bounded memory: minimum and maximum a bin, so that a spike never disappears.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "decoder/core/layout.hpp"
#include "decoder/core/time.hpp"
#include "decoder/findings/finding.hpp"

namespace servotrace::report {

class Series {
 public:
  struct Bin {
    TimeNs time_ns = 0;  // of its first sample
    std::int64_t minimum = 0;
    std::int64_t maximum = 0;
    std::int64_t last = 0;
    std::uint32_t samples = 0;
  };

  // max_bins: at least 2. When they are full, neighbours are joined and bins become twice as long.
  explicit Series(std::size_t max_bins = 1024) : max_bins_(max_bins < 2 ? 2 : max_bins) { bins_.reserve(max_bins_); }

  // Samples come in the order of time; one that is earlier than its bin joins the last bin.
  void add(TimeNs time_ns, std::int64_t value);
  // One sample of this value at each of these times, which ascend: the same as adding them one by one.
  void add(std::span<const TimeNs> times, std::int64_t value);
  const std::vector<Bin>& bins() const { return bins_; }
  std::uint64_t samples() const { return samples_; }
  bool is_constant() const;

 private:
  std::size_t max_bins_;
  DurationNs bin_ns_ = 0;  // 0: one sample a bin
  std::vector<Bin> bins_;
  std::uint64_t samples_ = 0;
};

// What a signal is: a field of a node.
struct Signal {
  NodeRef node;
  std::string filter;  // "rtex.response.actual_position"
  std::string label;
  const Field* field = nullptr;
  Series series;
};

// Raw value to its unit.
double scaled(const Field& field, std::int64_t raw);

}  // namespace servotrace::report
