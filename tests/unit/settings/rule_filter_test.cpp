// SPDX-License-Identifier: MIT
// What is ignored, selected, changed and suppressed, and what is said about suppressions that do nothing.
#include "replay/settings/rule_filter.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "replay/settings/suggest.hpp"

namespace servotrace::replay {
namespace {

constexpr Date kDay{2026, 6, 15};

Finding finding(RuleId rule, std::int16_t mac_id = kNoMacId) {
  Finding result;
  result.rule = rule;
  result.severity = rule_row(rule).severity;
  result.node.mac_id = mac_id;
  return result;
}

TEST(RuleFilter, ShowsEverythingByDefault) {
  RuleFilter filter({}, kDay);
  Finding found = finding(rule("CP101"));
  EXPECT_TRUE(filter.apply(found));
  EXPECT_EQ(found.severity, Severity::kWarning);
}

TEST(RuleFilter, IgnoresByPrefix) {
  RuleSettings settings;
  settings.ignore = {"CP10"};
  RuleFilter filter(settings, kDay);
  Finding found = finding(rule("CP101"));
  EXPECT_FALSE(filter.apply(found));
}

TEST(RuleFilter, SelectAndIgnoreOfTheCommandLine) {
  RuleFilter filter({}, kDay);
  EXPECT_TRUE(filter.select(std::vector<std::string>{"CP101", "CP103"}));
  EXPECT_TRUE(filter.ignore(std::vector<std::string>{"CP103"}));
  EXPECT_TRUE(filter.is_shown(rule("CP101")));
  EXPECT_FALSE(filter.is_shown(rule("CP102")));
  EXPECT_FALSE(filter.is_shown(rule("CP103")));
  const Result<void> wrong = filter.select(std::vector<std::string>{"QQ"});
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().what, "no rule 'QQ'");
}

TEST(RuleFilter, LongerPatternDecidesTheSeverity) {
  RuleSettings settings;
  settings.severity = {{"CP101", Severity::kError}, {"CP", Severity::kNote}};
  RuleFilter filter(settings, kDay);
  Finding first = finding(rule("CP101"));
  Finding second = finding(rule("CP102"));
  EXPECT_TRUE(filter.apply(first));
  EXPECT_TRUE(filter.apply(second));
  EXPECT_EQ(first.severity, Severity::kError);
  EXPECT_EQ(second.severity, Severity::kNote);
}

TEST(RuleFilter, SuppressionsHideCountAndExpire) {
  RuleSettings settings;
  settings.suppressions = {{.rule = "CP101", .mac_id = std::int16_t{3}, .reason = "a", .until = kDay, .where = "1"},
                           {.rule = "CP102", .reason = "b", .until = Date{2026, 6, 14}, .where = "2"},
                           {.rule = "CP103", .reason = "c", .until = {}, .where = "3"}};
  RuleFilter filter(settings, kDay);
  Finding of_node = finding(rule("CP101"), 3);
  Finding of_other = finding(rule("CP101"), 4);
  Finding expired = finding(rule("CP102"));
  EXPECT_FALSE(filter.apply(of_node));
  EXPECT_TRUE(filter.apply(of_other));
  EXPECT_TRUE(filter.apply(expired));
  EXPECT_EQ(filter.suppressed(), 1U);
  ASSERT_EQ(filter.uses().size(), 3U);
  EXPECT_EQ(filter.uses()[0].matched, 1U);
  EXPECT_FALSE(filter.uses()[0].expired);
  EXPECT_EQ(filter.uses()[1].matched, 1U);
  EXPECT_TRUE(filter.uses()[1].expired);
  EXPECT_EQ(filter.uses()[2].matched, 0U);
}

TEST(Today, FollowsSourceDateEpoch) {
  ASSERT_EQ(setenv("SOURCE_DATE_EPOCH", "1709164800", 1), 0);  // 2024-02-29 00:00 UTC
  EXPECT_EQ(today(), (Date{2024, 2, 29}));
  EXPECT_EQ(to_string(today()), "2024-02-29");
  ASSERT_EQ(setenv("SOURCE_DATE_EPOCH", "0", 1), 0);
  EXPECT_EQ(today(), (Date{1970, 1, 1}));
  ASSERT_EQ(unsetenv("SOURCE_DATE_EPOCH"), 0);
  EXPECT_GE(today().year, 2024);
}

TEST(Suggest, FindsTheNearWordOnly) {
  EXPECT_EQ(edit_distance("echo", "ehco"), 1U);
  EXPECT_EQ(edit_distance("echo", "ECHO"), 0U);
  EXPECT_EQ(edit_distance("", "abc"), 3U);
  constexpr std::string_view kWords[] = {"check", "decode", "report"};
  EXPECT_EQ(nearest("chekc", kWords), "check");
  EXPECT_EQ(nearest("weather", kWords), "");
  EXPECT_EQ(nearest("", kWords), "");
  EXPECT_EQ(did_you_mean("reprot", kWords), " (did you mean 'report'?)");
}

}  // namespace
}  // namespace servotrace::replay
