// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "decoder/core/durations.hpp"

namespace servotrace {
namespace {

TEST(Durations, CountsBoundsAndMean) {
  Durations durations;
  EXPECT_EQ(durations.percentile_ns(99), 0);
  durations.add(100);
  durations.add(300);
  durations.add(-1);
  EXPECT_EQ(durations.count(), 2U);
  EXPECT_EQ(durations.minimum_ns(), 100);
  EXPECT_EQ(durations.maximum_ns(), 300);
  EXPECT_DOUBLE_EQ(durations.mean_ns(), 200.0);
}

TEST(Durations, PercentileIsRightToAnEighth) {
  Durations durations;
  for (int i = 1; i <= 1000; ++i) durations.add(i * 1000);
  EXPECT_GE(durations.percentile_ns(50), 500'000);
  EXPECT_LE(durations.percentile_ns(50), 562'500);
  EXPECT_GE(durations.percentile_ns(99), 990'000);
  EXPECT_LE(durations.percentile_ns(99), 1'000'000);
}

TEST(Durations, TakesTheLargestAndSmallest) {
  Durations durations;
  for (const DurationNs value : {DurationNs{0}, DurationNs{7}, DurationNs{8}, INT64_MAX}) durations.add(value);
  EXPECT_EQ(durations.minimum_ns(), 0);
  EXPECT_EQ(durations.percentile_ns(50), 7);
  EXPECT_EQ(durations.percentile_ns(100), INT64_MAX);
}

}  // namespace
}  // namespace servotrace
