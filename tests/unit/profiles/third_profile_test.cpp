// SPDX-License-Identifier: MIT
// A third drive takes one folder (invented_spindle) and one line: this program is built with profiles.hpp and that line
// (tests/CMakeLists.txt), everything else is the decoder's own code. One with rules: invented_gripper.
#include <gtest/gtest.h>

#include <algorithm>

#include "decoder/pipeline/registry.hpp"
#include "decoder/profiles/profiles.hpp"
#include "tests/support/can_decoder.hpp"
#include "tests/unit/profiles/invented_spindle/profile.hpp"

namespace servotrace {
namespace {

TEST(ThirdProfile, IsInTheList) {
  EXPECT_EQ(profiles().size(), 3U);
  const std::vector<std::string_view> keys = profile_keys();
  EXPECT_EQ(keys, (std::vector<std::string_view>{"yaskawa-ns310", "nsk-esb", "invented-spindle", "generic"}));
  const std::vector<const Layout*> layouts = all_layouts();
  EXPECT_NE(std::find(layouts.begin(), layouts.end(), &spindle::kStatus), layouts.end());
}

TEST(ThirdProfile, IsDecodedWhereItIsConfigured) {
  test::CanDecoder bus(7, "invented-spindle");
  bus.frame(0x43D, "01");  // a poll command to node 7
  const std::string text = bus.frame(0x3C7, "E8 03 01");
  EXPECT_NE(text.find("Status\n    Speed: 1000 r/min\n    Runs: 1\n"), std::string::npos) << text;
}

// Vendor and product code of the Identity object, read as 5.6.2 of the NS310 manual draws it.
TEST(ThirdProfile, IsRecognisedByItsIdentity) {
  test::CanDecoder bus(7, "");
  bus.frame(0x43C, "00 0E 01 01 01");
  bus.frame(0x43B, "00 8E EE 0E");
  bus.frame(0x43C, "40 0E 01 01 03");
  bus.frame(0x43B, "40 8E 07 00");
  bus.frame(0x43D, "01");
  const std::string text = bus.frame(0x3C7, "E8 03 00");
  EXPECT_NE(text.find("Speed: 1000 r/min\n"), std::string::npos) << text;
}

}  // namespace
}  // namespace servotrace
