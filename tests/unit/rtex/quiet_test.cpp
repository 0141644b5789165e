// SPDX-License-Identifier: MIT
// The short cut for blocks that say nothing new changes no finding and no count: everything is judged twice, with the
// short cut and without it.
#include <gtest/gtest.h>

#include "decoder/link/rtex_record.hpp"
#include "tests/support/disturbed.hpp"
#include "tests/support/sanitized.hpp"
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

TEST(QuietBlocks, MovingTrafficSaysTheSame) {
  expect_same(make_traffic(rtex_traffic({.axes = 2, .cycle_us = 83.333, .cycles = 600, .moving = true})));
  expect_same(make_traffic(rtex_traffic({.axes = 2, .cycle_us = 1000, .wide = true, .cycles = 600, .moving = true})));
  expect_same(
      make_traffic(rtex_traffic({.axes = 3, .cycle_us = 500, .cycles = 600, .handshakes = true, .moving = true})));
}

TEST(QuietBlocks, HandshakesInEveryCycleSayTheSame) {
  expect_same(make_traffic(rtex_traffic({.axes = 1, .cycle_us = 83.333, .cycles = 1200, .handshakes = true})));
  expect_same(make_traffic(rtex_traffic({.axes = 5, .cycle_us = 166.667, .cycles = 1200, .handshakes = true})));
  expect_same(
      make_traffic(rtex_traffic({.axes = 3, .cycle_us = 1000, .wide = true, .cycles = 1200, .handshakes = true})));
}

// The rules that read what moves and what is measured have something to say.
Settings talkative() {
  constexpr auto pr = [](int of_class, int number) { return static_cast<std::uint16_t>(of_class << 8 | number); };
  Settings settings;
  settings.rtex.axes.resize(2);
  settings.rtex.axes[0].max_speed = 40'000;
  settings.rtex.axes[0].parameters = {{pr(5, 4), 0}, {pr(7, 23), 0}, {pr(7, 29), 7}, {pr(7, 35), 0}};
  settings.rtex.axes[1].mac_id = 1;
  settings.rtex.axes[1].parameters = {{pr(5, 4), 0}, {pr(7, 23), 0}, {pr(7, 31), 0x21}, {pr(7, 36), 0}};
  return settings;
}

void expect_same_when_disturbed(const RtexTraffic& kind, std::uint32_t seeds, const Settings& settings = {}) {
  const simulator::Simulation whole = make_traffic(rtex_traffic(kind));
  const std::uint32_t wanted = kSanitized ? seeds / 6 : seeds;  // there fuzz_rtex_record looks for more
  for (std::uint32_t seed = 0; seed < wanted; ++seed) {
    SCOPED_TRACE("cycle " + std::to_string(kind.cycle_us) + ", seed " + std::to_string(seed));
    expect_same(disturbed(whole, seed), settings);
    if (testing::Test::HasFailure()) return;
  }
}

TEST(QuietBlocks, DisturbedTrafficSaysTheSame) {
  expect_same_when_disturbed({.axes = 2, .cycle_us = 83.333, .cycles = 500}, 72);
  expect_same_when_disturbed({.axes = 2, .cycle_us = 166.667, .cycles = 500}, 72);
  expect_same_when_disturbed({.axes = 2, .cycle_us = 1000, .wide = true, .cycles = 500}, 72);
}

TEST(QuietBlocks, DisturbedMovingTrafficSaysTheSame) {
  expect_same_when_disturbed({.axes = 2, .cycle_us = 83.333, .cycles = 500, .moving = true}, 72);
  expect_same_when_disturbed({.axes = 2, .cycle_us = 1000, .wide = true, .cycles = 500, .moving = true}, 72);
  expect_same_when_disturbed({.axes = 2, .cycle_us = 500, .cycles = 500, .handshakes = true, .moving = true}, 72);
}

TEST(QuietBlocks, DisturbedMovingTrafficOfKnownDrivesSaysTheSame) {
  expect_same_when_disturbed({.axes = 2, .cycle_us = 1000, .cycles = 500, .moving = true}, 72, talkative());
  expect_same_when_disturbed({.axes = 2, .cycle_us = 1000, .wide = true, .cycles = 500, .moving = true}, 72,
                             talkative());
  expect_same_when_disturbed({.axes = 2, .cycle_us = 83.333, .cycles = 500}, 72, talkative());
}

// Every byte of a block in turn, in three records of a direction.
TEST(QuietBlocks, WhereverABlockChangesItSaysTheSame) {
  const simulator::Simulation whole =
      make_traffic(rtex_traffic({.axes = 2, .cycle_us = 1000, .wide = true, .cycles = 300}));
  const std::size_t first = whole.frames.size() * 3 / 4;
  for (std::size_t at = first; at < first + 2; ++at) {
    constexpr std::size_t kBlocks = 12 + rtex::kRecord.size;  // behind the exported PDU's tags
    for (std::size_t place = kBlocks; place < whole.frames[at].bytes.size(); ++place) {
      SCOPED_TRACE("record " + std::to_string(at) + ", byte " + std::to_string(place - kBlocks));
      simulator::Simulation changed = whole;
      for (std::size_t i = at; i < at + 6; i += 2) {
        std::uint8_t& byte = changed.frames[i].bytes[place];
        byte = static_cast<std::uint8_t>(~byte);
      }
      expect_same(changed, talkative());
      if (HasFailure()) return;
    }
  }
}

TEST(QuietBlocks, DisturbedHandshakesSayTheSame) {
  expect_same_when_disturbed({.axes = 2, .cycle_us = 83.333, .cycles = 800, .handshakes = true}, 72);
  expect_same_when_disturbed({.axes = 2, .cycle_us = 166.667, .cycles = 800, .handshakes = true}, 72);
  expect_same_when_disturbed({.axes = 2, .cycle_us = 1000, .wide = true, .cycles = 800, .handshakes = true}, 72);
}

}  // namespace
}  // namespace servotrace::test
