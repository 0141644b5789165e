// SPDX-License-Identifier: MIT
// Timestamps of every resolution pcapng has (if_tsresol, if_tsoffset) in nanoseconds.
#include "replay/capture/ticks.hpp"

#include <gtest/gtest.h>

namespace servotrace::replay {
namespace {

TEST(Ticks, AreMicrosecondsWhereNothingIsSaid) {
  const Ticks ticks;
  EXPECT_EQ(ticks.to_ns(0), 0);
  EXPECT_EQ(ticks.to_ns(1'500'000), 1'500'000'000);
  EXPECT_EQ(ticks.resolution_ns(), 1000U);
}

TEST(Ticks, SaturateAtTheEndOfTime) {
  Ticks ticks;
  const std::uint64_t last = std::uint64_t{INT64_MAX} / 1000;
  EXPECT_EQ(ticks.to_ns(last), static_cast<TimeNs>(last * 1000));
  EXPECT_EQ(ticks.to_ns(last + 1), INT64_MAX);
  ASSERT_TRUE(ticks.set(9));
  EXPECT_EQ(ticks.to_ns(INT64_MAX), INT64_MAX);
  EXPECT_EQ(ticks.to_ns(UINT64_MAX), INT64_MAX);
}

TEST(Ticks, OfDecimalAndBinaryResolutions) {
  Ticks ticks;
  ASSERT_TRUE(ticks.set(3));
  EXPECT_EQ(ticks.to_ns(7), 7'000'000);
  ASSERT_TRUE(ticks.set(12));
  EXPECT_EQ(ticks.to_ns(1'999), 1);
  EXPECT_EQ(ticks.resolution_ns(), 1U);
  ASSERT_TRUE(ticks.set(0x80U | 10U));
  EXPECT_EQ(ticks.to_ns(0), 0);
  EXPECT_EQ(ticks.to_ns(1536), 1'500'000'000);
  EXPECT_FALSE(ticks.set(20));
  EXPECT_FALSE(ticks.set(0x80U | 64U));
  EXPECT_EQ(ticks.to_ns(1024), 1'000'000'000) << "as before";
}

// The two options may stand in either order.
TEST(Ticks, KeepTheirOffset) {
  Ticks offset_first;
  offset_first.set_offset_s(2);
  ASSERT_TRUE(offset_first.set(9));
  Ticks offset_last;
  ASSERT_TRUE(offset_last.set(9));
  offset_last.set_offset_s(2);
  for (const Ticks& ticks : {offset_first, offset_last}) {
    EXPECT_EQ(ticks.to_ns(0), 2'000'000'000);
    EXPECT_EQ(ticks.to_ns(5), 2'000'000'005);
  }
  offset_last.set_offset_s(-3);
  EXPECT_EQ(offset_last.to_ns(1), -2'999'999'999);
  offset_last.set_offset_s(0);
  EXPECT_EQ(offset_last.to_ns(5), 5);
}

}  // namespace
}  // namespace servotrace::replay
