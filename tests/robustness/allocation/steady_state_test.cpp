// SPDX-License-Identifier: MIT
// No allocation a frame in the steady state: the first half of the traffic may allocate, the second may not, neither in
// the reader nor in the pipeline, looked at or not.
#include <gtest/gtest.h>

#include "decoder/findings/catalogue.hpp"
#include "decoder/pipeline/pipeline.hpp"
#include "replay/capture/source.hpp"
#include "tests/support/counting_new.hpp"
#include "tests/support/scenarios.hpp"
#include "tests/support/traffic.hpp"

namespace servotrace::test {
namespace {

void expect_no_allocation(const std::string& scenario, std::size_t at_least, const char* name) {
  const simulator::Simulation simulation = make_traffic(scenario);
  ASSERT_GT(simulation.frames.size(), at_least) << name;
  for (const bool looked_at : {false, true}) {
    Pipeline pipeline{Settings{}};
    Dissection dissection;
    std::uint64_t before = 0;
    for (std::size_t i = 0; i < simulation.frames.size(); ++i) {
      if (i == simulation.frames.size() / 2) before = allocation_count;
      pipeline.push(raw_frame(simulation, i), looked_at ? &dissection : nullptr);
    }
    EXPECT_EQ(allocation_count - before, 0U) << name << (looked_at ? ", with a dissection" : "");
    for (const Finding& finding : pipeline.findings().all())
      EXPECT_EQ(finding.severity, Severity::kNote)
          << name << ": " << rule_row(finding.rule).id << " at " << finding.frame;
    EXPECT_GT(pipeline.checked_frames(), at_least) << name;
  }
}

TEST(Allocation, NoneAFrameInQuietRings) {
  expect_no_allocation(rtex_traffic({.axes = 1, .cycle_us = 83.333, .cycles = 2000}), 4000, "1 axis");
  expect_no_allocation(rtex_traffic({.axes = 5, .cycle_us = 83.333, .cycles = 1500}), 3000, "5 axes");
  expect_no_allocation(rtex_traffic({.axes = 32, .cycle_us = 500, .cycles = 800}), 1600, "32 axes");
  expect_no_allocation(rtex_traffic({.axes = 16, .cycle_us = 1000, .wide = true, .cycles = 800}), 1600, "16 wide axes");
}

TEST(Allocation, NoneAFrameInRingsFullOfHandshakes) {
  expect_no_allocation(rtex_traffic({.axes = 2, .cycle_us = 500, .cycles = 1500, .handshakes = true}), 2000, "2 axes");
}

TEST(Allocation, NoneAFrameInRingsThatMove) {
  expect_no_allocation(rtex_traffic({.axes = 3, .cycle_us = 500, .cycles = 1500, .handshakes = true, .moving = true}),
                       2000, "3 axes");
}

TEST(Allocation, NoneAFrameInTheReader) {
  const simulator::Simulation simulation = make_traffic(rtex_traffic({.axes = 2, .cycles = 1000}));
  const std::filesystem::path path = std::filesystem::temp_directory_path() / "servotrace-allocation-test.pcapng";
  write_capture(simulation, path);
  {
    auto source = replay::open_capture(path);
    ASSERT_TRUE(source);
    RawFrame frame;
    ASSERT_EQ((*source)->next(frame), replay::Source::Step::kFrame);
    const std::uint64_t before = allocation_count;
    std::size_t frames = 1;
    while ((*source)->next(frame) == replay::Source::Step::kFrame) ++frames;
    EXPECT_EQ(allocation_count - before, 0U);
    EXPECT_EQ(frames, simulation.frames.size());
  }
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace servotrace::test
