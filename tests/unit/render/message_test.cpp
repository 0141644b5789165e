// SPDX-License-Identifier: MIT
// Messages of findings: counted nouns, and what is no message.
#include "decoder/render/message.hpp"

#include <gtest/gtest.h>

#include "decoder/findings/catalogue.hpp"

namespace servotrace {
namespace {

std::string stuck_for(std::int64_t cycles) {
  Finding finding;
  finding.rule = rule("RX201");
  finding.arguments = {2, cycles};
  return message(finding);
}

TEST(Message, ANounFollowsItsNumber) {
  EXPECT_EQ(stuck_for(1), "Update_Counter stuck at 2 for 1 updating cycle");
  EXPECT_EQ(stuck_for(3), "Update_Counter stuck at 2 for 3 updating cycles");
}

bool is_message(std::string_view text) {
  Rule row = rule_row(rule("RX201"));
  row.message = text;
  return well_formed(row);
}

TEST(Message, WhatIsMalformedDoesNotPass) {
  EXPECT_TRUE(is_message("text"));
  EXPECT_TRUE(is_message("{3}"));
  EXPECT_TRUE(is_message("{0|cycle} and {1}, then {2|poll}"));
  for (const char* const text : {"", "{4}", "{}", "{0", "{", "}", "a}b", "{0|}", "{0cycle}", "{x}", "{|cycle}"})
    EXPECT_FALSE(is_message(text)) << text;
}

}  // namespace
}  // namespace servotrace
