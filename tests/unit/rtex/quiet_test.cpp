// SPDX-License-Identifier: MIT
// The short cut for blocks that say nothing new changes no finding and no count: everything is judged twice, with the
// short cut and without it.
#include <gtest/gtest.h>

#include "tests/support/disturbed.hpp"
#include "tests/support/scenarios.hpp"
#include "tests/support/short_cut.hpp"
#include "tests/support/traffic.hpp"

namespace servotrace::test {
namespace {

TEST(QuietBlocks, EveryScenarioSaysTheSame) {
  for (const std::filesystem::path& path : scenario_files()) {
    SCOPED_TRACE(path.stem().string());
    const simulator::Scenario scenario = load_scenario(path);
    expect_same(simulate_scenario(scenario), settings_of(scenario));
  }
}

TEST(QuietBlocks, QuietTrafficSaysTheSame) {
  expect_same(make_traffic(rtex_traffic({.axes = 1, .cycle_us = 83.333, .cycles = 600})));
  expect_same(make_traffic(rtex_traffic({.axes = 5, .cycle_us = 166.667, .cycles = 600})));
  expect_same(make_traffic(rtex_traffic({.axes = 3, .cycle_us = 1000, .wide = true, .cycles = 600})));
  expect_same(make_traffic(rtex_traffic({.axes = 2, .cycle_us = 500, .cycles = 600, .handshakes = true})));
}

TEST(QuietBlocks, DisturbedTrafficSaysTheSame) {
  const RtexTraffic kinds[] = {
      {.axes = 2, .cycle_us = 83.333, .cycles = 500},
      {.axes = 2, .cycle_us = 166.667, .cycles = 500},
      {.axes = 2, .cycle_us = 1000, .wide = true, .cycles = 500},
  };
  for (const RtexTraffic& kind : kinds) {
    const simulator::Simulation whole = make_traffic(rtex_traffic(kind));
    for (std::uint32_t seed = 0; seed < 64; ++seed) {
      SCOPED_TRACE("cycle " + std::to_string(kind.cycle_us) + ", seed " + std::to_string(seed));
      expect_same(disturbed(whole, seed));
      if (HasFailure()) return;
    }
  }
}

}  // namespace
}  // namespace servotrace::test
