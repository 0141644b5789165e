// SPDX-License-Identifier: MIT
// When a frame was recorded, in bounded memory: the time of every frame of a short capture, of every second, fourth,
// ... one of a longer one.
#pragma once

#include <cstdint>
#include <vector>

#include "decoder/core/time.hpp"

namespace servotrace::report {

class FrameTimes {
 public:
  explicit FrameTimes(std::size_t most = 65'536) : most_(most < 2 ? 2 : most) {}

  // Frames come in the order of their numbers, which begin at 1, and none is left out.
  void add(std::uint64_t frame, TimeNs time_ns) {
    if (((frame - 1) & (stride_ - 1)) != 0) return;
    if (times_.size() == most_) thin();
    if (((frame - 1) & (stride_ - 1)) == 0) times_.push_back(time_ns);
  }
  // The time of the frame, or of one close before it. `other` where nothing is known.
  TimeNs at(std::uint64_t frame, TimeNs other) const {
    if (frame == 0 || times_.empty() || (frame - 1) / stride_ >= times_.size()) return other;
    return times_[(frame - 1) / stride_];
  }

 private:
  void thin() {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < times_.size(); i += 2) times_[kept++] = times_[i];
    times_.resize(kept);
    stride_ *= 2;
  }

  std::size_t most_;
  std::uint64_t stride_ = 1;  // a power of two
  std::vector<TimeNs> times_;
};

}  // namespace servotrace::report
