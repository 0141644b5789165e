// SPDX-License-Identifier: MIT
#include "replay/report/series.hpp"

#include <algorithm>

namespace servotrace::report {

void Series::add(TimeNs time_ns, std::int64_t value) {
  ++samples_;
  if (!bins_.empty()) {
    Bin& bin = bins_.back();
    if (elapsed_ns(bin.time_ns, time_ns) < bin_ns_ || time_ns < bin.time_ns) {
      bin.minimum = std::min(bin.minimum, value);
      bin.maximum = std::max(bin.maximum, value);
      bin.last = value;
      ++bin.samples;
      return;
    }
  }
  if (bins_.size() == max_bins_) {
    const DurationNs span = std::max<DurationNs>(elapsed_ns(bins_.front().time_ns, bins_.back().time_ns), 1);
    bin_ns_ = std::max<DurationNs>(bin_ns_ * 2, 2 * (span / static_cast<DurationNs>(max_bins_)) + 1);
    std::size_t kept = 0;
    for (std::size_t i = 1; i < bins_.size(); ++i) {
      Bin& target = bins_[kept];
      const Bin& bin = bins_[i];
      if (elapsed_ns(target.time_ns, bin.time_ns) < bin_ns_) {
        target.minimum = std::min(target.minimum, bin.minimum);
        target.maximum = std::max(target.maximum, bin.maximum);
        target.last = bin.last;
        target.samples += bin.samples;
      } else {
        bins_[++kept] = bin;
      }
    }
    bins_.resize(kept + 1);
    --samples_;
    add(time_ns, value);
    return;
  }
  bins_.push_back({time_ns, value, value, value, 1});
}

void Series::add(std::span<const TimeNs> times, std::int64_t value) {
  while (!times.empty()) {
    add(times.front(), value);
    times = times.subspan(1);
    Bin& bin = bins_.back();  // has the value now: of those that fall into it, too, only the number counts
    const auto end = std::partition_point(times.begin(), times.end(), [&](TimeNs time_ns) {
      return elapsed_ns(bin.time_ns, time_ns) < bin_ns_ || time_ns < bin.time_ns;
    });
    const auto joined = static_cast<std::size_t>(end - times.begin());
    bin.samples += static_cast<std::uint32_t>(joined);
    samples_ += joined;
    times = times.subspan(joined);
  }
}

bool Series::is_constant() const {
  for (const Bin& bin : bins_) {
    if (bin.minimum != bins_.front().minimum || bin.maximum != bins_.front().minimum) return false;
  }
  return true;
}

double scaled(const Field& field, std::int64_t raw) {
  return static_cast<double>(raw) * field.scale.numerator / field.scale.denominator;
}

}  // namespace servotrace::report
