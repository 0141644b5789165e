// SPDX-License-Identifier: MIT
// The examples of SIE-C718-7 chapter 5 as frames of node 5, and what is printed of them.
#include <gtest/gtest.h>

#include "tests/support/can_decoder.hpp"

namespace servotrace::ns310 {
namespace {

constexpr std::uint32_t kPollCommand = 0x42D;   // 405h + 8 x 5
constexpr std::uint32_t kPollResponse = 0x3C5;  // 3C0h + 5
constexpr std::uint32_t kRequest = 0x42C;       // 404h + 8 x 5
constexpr std::uint32_t kAnswer = 0x42B;        // 403h + 8 x 5

void expect_lines(const std::string& text, std::initializer_list<std::string_view> lines) {
  for (const std::string_view line : lines) EXPECT_NE(text.find(line), std::string::npos) << line << " in\n" << text;
}

test::CanDecoder decoder() { return {5, "yaskawa-ns310"}; }

TEST(Ns310Messages, Section541PositioningTo128000) {
  expect_lines(decoder().frame(kPollCommand, "C1 00 21 23 00 F4 01 00"),
               {"Start Trajectory: 1\n", "Command Code: 01h (Target position)\n",
                "Absolute/Incremental: 0 (absolute position)\n", "Target Position: 128000 steps\n"});
}

TEST(Ns310Messages, Section542ContinuousRotation8000) {
  expect_lines(decoder().frame(kPollCommand, "C9 00 31 23 40 1F 00 00"),
               {"Direction (V mode): 1 (forward (positive, clockwise))\n",
                "Command Code: 11h (Continuous rotor speed)\n", ": 8000 steps/s\n"});
}

TEST(Ns310Messages, Section543HomingType0) {
  expect_lines(decoder().frame(kPollCommand, "C1 00 32 21 00 00 00 00"),
               {"Command Code: 12h (Homing type)\n", "Homing Type: 0 (Type 0)\n"});
}

TEST(Ns310Messages, Section551StartOfBlock1) {
  test::CanDecoder bus = decoder();
  bus.frame(kPollCommand, "C0 01 20 21 00 00 00 00");
  bus.frame(kPollResponse, "C4 00 01 21 00 00 00 00");
  expect_lines(bus.frame(kPollCommand, "C2 01 20 21 00 00 00 00"),
               {"Start Block: 1\n", "Block Number: 1\n", "[node 5: Command blocks: block 1: (unknown)]\n"});
}

TEST(Ns310Messages, Section562ReadingAcceleration1234h) {
  test::CanDecoder bus = decoder();
  expect_lines(bus.frame(kRequest, "00 0E 25 01 08"),
               {"Service: 0Eh (Get_Attribute_Single)\n", "[node 5: Attribute: Acceleration]\n"});
  expect_lines(bus.frame(kAnswer, "00 8E 34 12 00 00"), {"Acceleration: 4660 steps/s^2\n"});
}

// 5.6.3: attribute by attribute. What attribute 3 means is the block command's to say.
TEST(Ns310Messages, Section563BlockAttributeByAttribute) {
  test::CanDecoder bus = decoder();
  bus.frame(kRequest, "00 10 27 01 01 08");
  expect_lines(bus.frame(kAnswer, "00 90"), {"block 1: trajectory and wait, target_position 0"});
  // Nine bytes travel as two fragments.
  bus.frame(kRequest, "80 00 10 27 01 03 00 F4");
  bus.frame(kAnswer, "80 C0 00");
  expect_lines(bus.frame(kRequest, "80 81 01 00"), {"Command block attribute: Target Position 128000 steps]\n"});
  bus.frame(kAnswer, "80 C1 00");
  expect_lines(bus.frame(kAnswer, "00 90"), {"block 1: trajectory and wait, target_position 128000"});
}

TEST(Ns310Messages, TableC1AndChapter9OfAnAlarm) {
  const std::string text = decoder().frame(kPollResponse, "48 00 00 3E 0D 00 00 00");
  expect_lines(
      text, {"Alarm Code: 0000000Dh (Deviation Excess)\n", "SGDH alarms behind it: A.D0 position error pulse overflow]",
             "Indicator: MS flashes red]", "Causes: motor wiring wrong or loose", "Remedies: correct the wiring"});
}

}  // namespace
}  // namespace servotrace::ns310
