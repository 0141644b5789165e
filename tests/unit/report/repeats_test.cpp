// SPDX-License-Identifier: MIT
// Records that say nothing new are not taken apart: the report is the same as that of one where every record was.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "decoder/pipeline/pipeline.hpp"
#include "replay/report/pages.hpp"
#include "replay/report/series.hpp"
#include "tests/support/disturbed.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/scenarios.hpp"
#include "tests/support/traffic.hpp"

namespace servotrace::test {
namespace {

std::string report_of(const std::filesystem::path& path, bool every_block) {
  Settings settings;
  settings.judge_every_block = every_block;
  const Result<report::Built> built =
      report::build_model({.path = path, .name = "capture"}, settings, replay::RuleFilter());
  if (!built) return built.error().text();
  return report::json(std::span(&*built, 1), settings) + report::html(std::span(&*built, 1), settings);
}

void expect_same_report(const simulator::Simulation& simulation) {
  const std::filesystem::path path =
      std::filesystem::path(testing::TempDir()) / ("repeats-" + std::to_string(getpid()) + ".pcapng");
  write_capture(simulation, path);
  const std::string whole = report_of(path, true);
  const std::string quick = report_of(path, false);
  std::filesystem::remove(path);
  EXPECT_GT(whole.size(), 10'000U);
  const auto parted = std::mismatch(whole.begin(), whole.end(), quick.begin(), quick.end()).first;
  const auto at = static_cast<std::size_t>(parted - whole.begin());
  EXPECT_TRUE(whole == quick) << whole.substr(at, 200) << "\n--- is ---\n"
                              << quick.substr(std::min(at, quick.size()), 200);
}

TEST(Repeats, QuietTrafficGivesTheSameReport) {
  expect_same_report(make_traffic(rtex_traffic({.axes = 3, .cycle_us = 83.333, .cycles = 4000})));
  expect_same_report(make_traffic(rtex_traffic({.axes = 2, .cycle_us = 1000, .wide = true, .cycles = 2500})));
  expect_same_report(make_traffic(rtex_traffic({.axes = 2, .cycle_us = 500, .cycles = 1000, .handshakes = true})));
}

TEST(Repeats, DisturbedTrafficGivesTheSameReport) {
  const RtexTraffic kinds[] = {
      {.axes = 2, .cycle_us = 83.333, .cycles = 1500},
      {.axes = 2, .cycle_us = 166.667, .cycles = 1500},
      {.axes = 2, .cycle_us = 1000, .wide = true, .cycles = 1500},
  };
  for (const RtexTraffic& kind : kinds) {
    const simulator::Simulation whole = make_traffic(rtex_traffic(kind));
    for (std::uint32_t seed = 0; seed < (kSanitized ? 4U : 24U); ++seed) {
      SCOPED_TRACE("cycle " + std::to_string(kind.cycle_us) + ", seed " + std::to_string(seed));
      expect_same_report(disturbed(whole, seed));
      if (HasFailure()) return;
    }
  }
}

// The window of a fault is 30 s long: what lies before it is not looked at closely.
TEST(Repeats, AFaultAfterALongQuietTimeGivesTheSameReport) {
  simulator::Simulation simulation = make_traffic(rtex_traffic({.axes = 1, .cycle_us = 1000, .cycles = 42'000}));
  constexpr std::size_t kAlarmAt = 12 + 24 + 2;  // behind the tags and the record's header
  for (std::size_t i = 82'001; i < 82'201; i += 2) simulation.frames[i].bytes.at(kAlarmAt) ^= 0x20U;
  expect_same_report(simulation);
}

// Two nodes that give the same MAC-ID share their series: no record may be left out.
TEST(Repeats, SharedSeriesGiveTheSameReport) {
  simulator::Simulation simulation = make_traffic(rtex_traffic({.axes = 2, .cycle_us = 500, .cycles = 2000}));
  constexpr std::size_t kSecondBlock = 12 + 24 + 16;
  for (simulator::SimulatedFrame& frame : simulation.frames) {
    if (frame.bytes.size() > kSecondBlock) frame.bytes[kSecondBlock] &= 0xE0U;
  }
  expect_same_report(simulation);
}

// The short cut is taken where it may be, and only there.
TEST(Repeats, MostOfAQuietRingIsNotTakenApart) {
  const simulator::Simulation simulation = make_traffic(rtex_traffic({.axes = 2, .cycle_us = 500, .cycles = 1000}));
  for (const bool only_news : {true, false}) {
    Pipeline pipeline{Settings{}};
    const auto dissection = std::make_unique<Dissection>();
    dissection->only_news = only_news;
    std::size_t repeated = 0;
    for (std::size_t i = 0; i < simulation.frames.size(); ++i) {
      pipeline.push(raw_frame(simulation, i), dissection.get());
      repeated += dissection->repeats ? 1 : 0;
      EXPECT_EQ(dissection->segments.size() == 1, dissection->repeats) << i;  // the record's header
    }
    EXPECT_EQ(repeated > simulation.frames.size() / 2, only_news) << repeated;
    EXPECT_TRUE(only_news || repeated == 0) << repeated;
  }
}

TEST(Series, ManyAtOnceAreTheSameAsOneByOne) {
  for (const std::size_t bins : {2U, 8U, 64U}) {
    report::Series one_by_one(bins);
    report::Series at_once(bins);
    TimeNs now = 0;
    for (int stretch = 0; stretch < 40; ++stretch) {
      std::vector<TimeNs> times;
      for (int i = 0; i < stretch * stretch % 97; ++i) times.push_back(now += (i * 7919 + stretch * 104'729) % 1000);
      for (const TimeNs time_ns : times) one_by_one.add(time_ns, stretch % 5);
      at_once.add(times, stretch % 5);
      one_by_one.add(now - 3, -1);
      at_once.add(now - 3, -1);
    }
    ASSERT_EQ(at_once.samples(), one_by_one.samples());
    ASSERT_EQ(at_once.bins().size(), one_by_one.bins().size());
    for (std::size_t i = 0; i < at_once.bins().size(); ++i) {
      const report::Series::Bin& bin = at_once.bins()[i];
      const report::Series::Bin& expected = one_by_one.bins()[i];
      EXPECT_EQ(bin.time_ns, expected.time_ns);
      EXPECT_EQ(bin.minimum, expected.minimum);
      EXPECT_EQ(bin.maximum, expected.maximum);
      EXPECT_EQ(bin.last, expected.last);
      EXPECT_EQ(bin.samples, expected.samples);
    }
  }
}

}  // namespace
}  // namespace servotrace::test
