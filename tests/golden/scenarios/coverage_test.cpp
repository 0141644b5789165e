// SPDX-License-Identifier: MIT
// Every rule has a scenario that raises it and one that comes close and stays silent.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "decoder/findings/catalogue.hpp"
#include "tests/support/scenarios.hpp"

namespace servotrace::test {
namespace {

// Blocks of the catalogue whose rules all have both.
const std::vector<std::string_view> kComplete = {"CP", "RX", "DN", "YS", "NK"};

TEST(ScenarioCoverage, EveryRuleIsRaisedAndKeptSilent) {
  std::set<std::string, std::less<>> raised;
  std::set<std::string, std::less<>> silent;
  for (const std::filesystem::path& path : scenario_files()) {
    const simulator::Scenario scenario = load_scenario(path);
    raised.insert(scenario.rules.begin(), scenario.rules.end());
    silent.insert(scenario.silent.begin(), scenario.silent.end());
  }
  std::string open;
  for (const Rule& row : kCatalogue) {
    const bool is_covered = raised.contains(row.id) && silent.contains(row.id);
    const bool is_complete =
        std::any_of(kComplete.begin(), kComplete.end(), [&](auto block) { return row.id.starts_with(block); });
    if (is_complete) {
      EXPECT_TRUE(raised.contains(row.id)) << row.id << " has no scenario that raises it";
      EXPECT_TRUE(silent.contains(row.id)) << row.id << " has no scenario in which it stays silent";
    } else if (!is_covered) {
      open += ' ';
      open += row.id;
    }
  }
  RecordProperty("open", open);
  if (!open.empty()) std::printf("rules without both scenarios:%s\n", open.c_str());
}

}  // namespace
}  // namespace servotrace::test
