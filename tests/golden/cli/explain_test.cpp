// SPDX-License-Identifier: MIT
// `servotrace explain`: every rule that a scenario raises is shown broken, with the checker's own words.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "decoder/findings/catalogue.hpp"
#include "replay/examples/rule_examples.hpp"
#include "tests/support/program.hpp"
#include "tests/support/scenarios.hpp"

namespace servotrace::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(Explain, ShowsATraceThatViolatesAndOneThatDoesNot) {
  const Program program;
  const Outcome outcome = program.run({"explain", "RX202"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, StartsWith("RX202 update-counter-skip\n"));
  for (const char* const part : {"Why it matters", "How to fix it", "Manual", "A trace that violates it",
                                 "A trace that does not", "captures/scenarios/", "Leave it out"}) {
    EXPECT_THAT(outcome.out, HasSubstr(part));
  }
  EXPECT_THAT(outcome.out, HasSubstr(": error[RX202] axis 1: Update_Counter went from "));
}

TEST(Explain, HasAnExampleOfEveryRuleThatAScenarioRaises) {
  std::set<std::string, std::less<>> raised;
  for (const std::filesystem::path& path : scenario_files()) {
    const simulator::Scenario scenario = load_scenario(path);
    raised.insert(scenario.rules.begin(), scenario.rules.end());
  }
  std::size_t both = 0;
  for (const Rule& row : kCatalogue) {
    if (!raised.contains(row.id)) continue;
    const replay::RuleExamples* const examples = replay::find_examples(row.id);
    ASSERT_NE(examples, nullptr) << row.id << ": run the target `reference`";
    EXPECT_THAT(std::string(examples->violation.trace), HasSubstr("[" + std::string(row.id) + "]"));
    if (!examples->silent.scenario.empty()) ++both;
  }
  EXPECT_GE(both, raised.size() * 9 / 10);
}

}  // namespace
}  // namespace servotrace::test
