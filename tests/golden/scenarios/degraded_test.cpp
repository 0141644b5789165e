// SPDX-License-Identifier: MIT
// A recording that begins late, loses records or keeps only a part of each says less; it never blames the bus for
// something the whole recording does not show.
#include <gtest/gtest.h>

#include <set>

#include "tests/support/scenarios.hpp"

namespace servotrace::test {
namespace {

using Key = std::pair<std::string, int>;

std::set<Key> keys_of(const std::vector<CheckedFinding>& findings) {
  std::set<Key> keys;
  for (const CheckedFinding& found : findings) keys.emplace(found.rule, found.finding.node.mac_id);
  return keys;
}

class DegradedScenarios : public ::testing::TestWithParam<std::filesystem::path> {
 protected:
  void SetUp() override {
    scenario_ = load_scenario(GetParam());
    whole_ = simulate_scenario(scenario_);
    settings_ = settings_of(scenario_);
  }

  void expect_nothing_new(const simulator::Simulation& degraded) {
    const std::set<Key> known = keys_of(check(whole_, settings_));
    for (const CheckedFinding& found : check(degraded, settings_)) {
      const bool of_capture = found.rule.starts_with("CP");
      // The catalogue wants a note where the capture does not show the program that runs.
      const bool unknown_program =
          found.finding.severity == Severity::kNote && (found.rule == "NK302" || found.rule == "NK309");
      EXPECT_TRUE(of_capture || unknown_program || known.contains({found.rule, found.finding.node.mac_id}))
          << "new: " << found.text;
    }
  }

  simulator::Scenario scenario_;
  simulator::Simulation whole_;
  Settings settings_;
};

TEST_P(DegradedScenarios, BeginningLate) {
  simulator::Simulation late = whole_;
  late.frames.erase(late.frames.begin(), late.frames.begin() + static_cast<std::ptrdiff_t>(late.frames.size() / 3));
  expect_nothing_new(late);
}

// What a CAN adapter writes in the place of frames it had no room for: without it, a loss on CAN shows nowhere.
constexpr std::uint8_t kReceiveOverflow[] = {0x20, 0, 0, 0x04, 8, 0, 0, 0, 0, 0x01, 0, 0, 0, 0, 0, 0};

TEST_P(DegradedScenarios, LosingEverySeventhRecord) {
  simulator::Simulation lossy = whole_;
  lossy.frames.clear();
  for (std::size_t i = 0; i < whole_.frames.size(); ++i) {
    simulator::SimulatedFrame frame = whole_.frames[i];
    if (i % 7 == 6) {
      if (whole_.interfaces[frame.interface_id].link_type != LinkType::kCanSocketcan) continue;
      frame.bytes.assign(std::begin(kReceiveOverflow), std::end(kReceiveOverflow));
      frame.original_length = sizeof kReceiveOverflow;
    }
    lossy.frames.push_back(frame);
  }
  expect_nothing_new(lossy);
}

TEST_P(DegradedScenarios, KeepingPartsOfTheRecordsOnly) {
  simulator::Simulation cut = whole_;
  for (std::size_t i = cut.frames.size() * 2 / 3; i < cut.frames.size(); ++i)
    cut.frames[i].bytes.resize(cut.frames[i].bytes.size() * 3 / 4);
  expect_nothing_new(cut);
}

std::string name_of(const ::testing::TestParamInfo<std::filesystem::path>& info) { return info.param.stem().string(); }

INSTANTIATE_TEST_SUITE_P(All, DegradedScenarios, ::testing::ValuesIn(scenario_files()), name_of);

}  // namespace
}  // namespace servotrace::test
