// SPDX-License-Identifier: MIT
#include "replay/report/frame_times.hpp"

#include <gtest/gtest.h>

namespace servotrace::test {
namespace {

TEST(FrameTimes, KnowsEveryFrameOfAShortCapture) {
  report::FrameTimes times(8);
  EXPECT_EQ(times.at(1, -1), -1);
  for (std::uint64_t frame = 1; frame <= 8; ++frame) times.add(frame, static_cast<TimeNs>(1000 + 10 * frame));
  for (std::uint64_t frame = 1; frame <= 8; ++frame)
    EXPECT_EQ(times.at(frame, -1), static_cast<TimeNs>(1000 + 10 * frame));
  EXPECT_EQ(times.at(0, -1), -1);
  EXPECT_EQ(times.at(9, -1), -1);
}

TEST(FrameTimes, KnowsOneCloseBeforeEveryFrameOfALongCapture) {
  report::FrameTimes times(8);
  constexpr std::uint64_t kFrames = 1000;
  for (std::uint64_t frame = 1; frame <= kFrames; ++frame) times.add(frame, static_cast<TimeNs>(frame));
  for (std::uint64_t frame = 1; frame <= kFrames; ++frame) {
    const TimeNs known = times.at(frame, -1);
    EXPECT_LE(known, static_cast<TimeNs>(frame));
    EXPECT_GT(known + 256, static_cast<TimeNs>(frame)) << "a stride of at most a quarter of the capture";
    EXPECT_GE(known, 1);
  }
}

}  // namespace
}  // namespace servotrace::test
