// SPDX-License-Identifier: MIT
// Every scenario raises exactly what it says, and nothing else.
#include <gtest/gtest.h>

#include <algorithm>

#include "decoder/findings/catalogue.hpp"
#include "decoder/render/value.hpp"
#include "tests/support/scenarios.hpp"

namespace servotrace::test {
namespace {

bool matches(const simulator::ExpectedFinding& expected, const CheckedFinding& found) {
  const Finding& finding = found.finding;
  if (expected.rule != found.rule) return false;
  if (!expected.any_node && expected.mac_id != finding.node.mac_id) return false;
  if (!expected.channel.empty() && expected.channel != name_of(finding.node.channel)) return false;
  if (!expected.severity.empty() && expected.severity != name_of(finding.severity)) return false;
  if (expected.cause.empty()) return true;
  return finding.cause.frame != 0 && expected.cause == rule_row(finding.cause.rule).id;
}

std::string describe(const simulator::ExpectedFinding& expected) {
  std::string text = expected.rule;
  if (!expected.any_node) text += " mac_id " + std::to_string(expected.mac_id);
  if (!expected.channel.empty()) text += ' ' + expected.channel;
  if (!expected.severity.empty()) text += ' ' + expected.severity;
  if (!expected.cause.empty()) text += " caused by " + expected.cause;
  return text;
}

class Scenarios : public ::testing::TestWithParam<std::filesystem::path> {};

// Each finding is claimed by the first row that fits it and is not full yet.
TEST_P(Scenarios, RaiseExactlyWhatTheyExpect) {
  const simulator::Scenario scenario = load_scenario(GetParam());
  const std::vector<CheckedFinding> findings = check(simulate_scenario(scenario), settings_of(scenario));
  std::vector<std::uint32_t> claimed(scenario.expect.size(), 0);
  for (const CheckedFinding& found : findings) {
    std::size_t row = 0;
    while (row < scenario.expect.size() &&
           (!matches(scenario.expect[row], found) || claimed[row] == scenario.expect[row].findings))
      ++row;
    if (row < scenario.expect.size()) {
      ++claimed[row];
    } else {
      ADD_FAILURE() << "not expected: " << found.text;
    }
  }
  for (std::size_t row = 0; row < scenario.expect.size(); ++row) {
    const simulator::ExpectedFinding& expected = scenario.expect[row];
    EXPECT_EQ(claimed[row], expected.findings) << describe(expected);
  }
}

std::string name_of(const ::testing::TestParamInfo<std::filesystem::path>& info) { return info.param.stem().string(); }

INSTANTIATE_TEST_SUITE_P(All, Scenarios, ::testing::ValuesIn(scenario_files()), name_of);

}  // namespace
}  // namespace servotrace::test
