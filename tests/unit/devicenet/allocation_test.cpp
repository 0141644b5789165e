// SPDX-License-Identifier: MIT
// In the steady state no frame allocates: polls, their fragments, explicit requests and responses.
#include <gtest/gtest.h>

#include "tests/support/counting_new.hpp"
#include "tests/unit/devicenet/bench.hpp"

namespace servotrace::devicenet {
namespace {

TEST(SteadyState, NoAllocation) {
  Pipeline pipeline{test::Bench::assumed()};
  Dissection dissection;
  const struct {
    std::uint32_t id;
    const char* data;
  } kCycle[] = {{0x42D, ""},
                {0x3C5, "01 02 03"},
                {0x435, "00 01 02 03 04 05 06 07"},
                {0x435, "81 08 09 0A"},
                {0x3C6, "00 01 02 03 04 05 06 07"},
                {0x3C6, "81 08 09 0A"},
                {0x42C, "01 0E 01 01 07"},
                {0x42B, "81 00 8E 03 41 42"},
                {0x42C, "81 C0 00"},
                {0x42B, "81 81 43"},
                {0x42C, "81 C1 00"}};
  std::vector<std::vector<std::uint8_t>> records;
  for (const auto& frame : kCycle) records.push_back(test::can_record(frame.id, servotrace::test::hex(frame.data)));
  std::uint64_t number = 0;
  std::uint64_t before = 0;
  for (int cycle = 0; cycle < 200; ++cycle) {
    if (cycle == 100) before = servotrace::test::allocation_count;
    for (const auto& record : records) {
      ++number;
      pipeline.push({.number = number,
                     .time_ns = static_cast<TimeNs>(number) * kMillisecondNs,
                     .link_type = LinkType::kCanSocketcan,
                     .bytes = record,
                     .original_length = static_cast<std::uint32_t>(record.size())},
                    &dissection);
    }
  }
  EXPECT_EQ(servotrace::test::allocation_count - before, 0U);
}

}  // namespace
}  // namespace servotrace::devicenet
