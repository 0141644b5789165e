// SPDX-License-Identifier: MIT
// The command position against the actual one, TMG_CNT and changes of the mode in motion: each rule raised by one
// fault, and silent on the nearest healthy traffic.
#include <gtest/gtest.h>

#include "tests/unit/rtex/bench.hpp"

namespace servotrace::rtex::test {
namespace {

Settings with(std::map<std::uint16_t, std::int32_t> parameters, std::optional<std::int64_t> max_speed = {}) {
  Settings settings;
  settings.rtex.axes.push_back({.mac_id = 0, .parameters = std::move(parameters), .max_speed = max_speed});
  return settings;
}
Settings full_sync(bool on) {
  Settings settings;
  settings.rtex.full_sync = on;
  return settings;
}

// TMG_CNT of every axis toggles each `period` cycles.
void toggling(Bench& bench, unsigned cycles, unsigned period, std::size_t nodes = 2) {
  static unsigned tick;
  for (unsigned n = 0; n < cycles; ++n) {
    for (std::size_t i = 0; i < nodes; ++i) bench.set(i, "tmg_cnt", tick / period % 2);
    ++tick;
    bench.cycle();
  }
}

TEST(PositionRules, TimingCountPeriod) {
  for (const unsigned period : {4U, 3U, 5U}) {  // 2 ms are 4 cycles of 0.5 ms
    Bench bench(2, full_sync(true));
    toggling(bench, 60, period);
    EXPECT_EQ(bench.rules(), period == 4 ? "" : "RX207") << period;
  }
  Bench never(2, full_sync(true));
  never.cycles(20);
  ASSERT_EQ(never.rules(), "RX207");
  EXPECT_EQ(never.found("RX207").at(0).node.mac_id, kNoMacId);
  EXPECT_EQ(never.found("RX207").size(), 1U);
}

TEST(PositionRules, TimingCountRestartsAfterAGap) {
  Bench bench(2, full_sync(true));
  toggling(bench, 22, 4);
  bench.drop_cycles(3);
  toggling(bench, 40, 4);
  EXPECT_EQ(bench.rules(), "CP103");
}

TEST(PositionRules, TimingCountOfTheAxes) {
  Bench bench(3, full_sync(true));
  toggling(bench, 20, 4, 2);
  ASSERT_EQ(bench.rules(), "RX208");
  EXPECT_EQ(bench.found("RX208").at(0).arguments[0], 4);
}

TEST(PositionRules, TimingCountInSemiSynchronousMode) {
  Bench known(2, full_sync(false));
  toggling(known, 40, 4);
  ASSERT_EQ(known.rules(), "RX209");
  EXPECT_EQ(known.found("RX209").size(), 1U);
  EXPECT_EQ(known.found("RX209").at(0).severity, Severity::kWarning);
  Bench left_over(2);
  left_over.set(0, "tmg_cnt", 1);
  left_over.set(1, "tmg_cnt", 1);
  left_over.cycles(30);
  ASSERT_EQ(left_over.rules(), "RX209");
  EXPECT_EQ(left_over.found("RX209").at(0).severity, Severity::kNote);  // the mode is only assumed
  Bench right(2);
  toggling(right, 60, 4);
  EXPECT_EQ(right.rules(), "");
  right.set(0, "tmg_cnt", 0);  // learnt by now
  right.set(1, "tmg_cnt", 0);
  right.cycles(12);
  EXPECT_EQ(right.rules(), "RX207");
}

TEST(PositionRules, ModeChangeVelocity) {
  const struct {
    std::int32_t actual, commanded;
    bool raised;
  } rows[] = {{500, 550, false},   {500, 610, true}, {500, -500, true},
              {-500, -520, false}, {60, 90, false},  {60, 91, true}};
  for (const auto& row : rows) {
    Bench bench(1, with({{0x0719, 0}}));
    bench.set(0, "cyclic_command", 4);
    bench.set(0, "servo_on", 1);
    bench.cycles(10);
    bench.at(0).speed = row.actual;
    bench.cycles(3);
    bench.set(0, "cyclic_command", 3);
    bench.position(0, row.commanded);  // Command_Data1
    bench.cycles(4);
    EXPECT_EQ(bench.rules(), row.raised ? "RX409" : "") << row.actual << " " << row.commanded;
  }
}

TEST(PositionRules, ModeChangeVelocityIntoPp) {
  for (const std::int32_t speed : {580, 700}) {
    Bench bench(1, with({{0x0719, 0}}));
    bench.at(0).homing_complete = true;
    bench.set(0, "cyclic_command", 3);
    bench.set(0, "servo_on", 1);
    bench.cycles(10);
    bench.at(0).speed = -500;
    bench.cycles(3);
    bench.set(0, "cyclic_command", 1);
    bench.non_cyclic(0, 7, 0x10, 0, speed);
    bench.cycles(4);
    EXPECT_EQ(bench.rules(), speed == 580 ? "" : "RX409");
  }
}

TEST(PositionRules, ServoOnPositionJump) {
  for (const std::int32_t command : {1000, 1001, -1001}) {
    Bench bench(1, with({{0x071D, 0}}));
    bench.at(0).follow = false;
    bench.position(0, command);
    bench.cycles(5);
    bench.set(0, "servo_on", 1);
    bench.cycles(3);
    EXPECT_EQ(bench.rules(), command == 1000 ? "" : "RX702");
  }
  Bench wraps(1, with({{0x071D, 0}}));
  wraps.at(0).follow = false;
  wraps.at(0).position = 2'147'483'647;
  wraps.position(0, -2'147'483'647 - 1);
  wraps.cycles(5);
  wraps.set(0, "servo_on", 1);
  wraps.cycles(3);
  EXPECT_EQ(wraps.rules(), "");
}

// Without Pr7.29 Response_Data1 counts as the actual position once it has followed the command.
TEST(PositionRules, ActualPositionHasToBeShown) {
  for (const bool shown : {false, true}) {
    Bench bench;
    bench.set(0, "servo_on", 1);
    bench.cycles(10);
    for (std::int32_t n = 1; shown && n <= 20; ++n) {
      bench.position(0, 100 * n);
      bench.cycle();
    }
    bench.set(0, "servo_on", 0);
    bench.cycles(10);
    bench.at(0).follow = false;
    bench.position(0, 50'000);
    bench.cycles(3);
    bench.set(0, "servo_on", 1);
    bench.cycles(3);
    EXPECT_EQ(bench.rules(), shown ? "RX702" : "");
    if (shown) {
      EXPECT_EQ(bench.found("RX702").at(0).basis.kind, BasisKind::kCapture);
    }
  }
}

TEST(PositionRules, PositionStep) {
  for (const std::int32_t step : {100, 102}) {  // 200000 units a second: 100 in 0.5 ms
    Bench bench(1, with({}, 200'000));
    bench.set(0, "servo_on", 1);
    bench.cycles(60);
    for (std::int32_t n = 1; n <= 5; ++n) {
      bench.position(0, step * n);
      bench.cycle();
    }
    EXPECT_EQ(bench.rules(), step == 100 ? "" : "RX703");
  }
}

TEST(PositionRules, PositionStepIsSilentAfterHomingAndOnAModeChange) {
  Bench bench(1, with({}, 200'000));
  bench.at(0).homing_complete = true;
  bench.set(0, "servo_on", 1);
  bench.position(0, 70'000);
  bench.cycles(60);
  bench.non_cyclic(0, 4, 0x21);
  bench.cycles(6);
  bench.position(0, 0);
  bench.cycles(4);
  bench.normal();
  bench.cycles(8);
  bench.set(0, "cyclic_command", 3);
  bench.cycles(8);
  bench.set(0, "cyclic_command", 2);
  bench.position(0, 9'000);
  bench.cycles(8);
  EXPECT_EQ(bench.rules(), "");
}

TEST(PositionRules, HomingPositionNotSet) {
  const struct {
    std::int32_t homed, normal;
    bool raised;
  } rows[] = {{0, 0, false}, {0, 900, false}, {0, 1001, true}, {5000, 0, false}, {5000, 900, true}, {5000, 5000, true}};
  for (const auto& row : rows) {
    Bench bench;
    bench.at(0).homing_complete = true;
    bench.set(0, "servo_on", 1);
    bench.position(0, 5000);
    bench.cycles(10);
    bench.non_cyclic(0, 4, 0x18);
    bench.cycles(6);
    bench.position(0, row.homed);
    bench.cycles(3);
    bench.normal();
    bench.position(0, row.normal);
    bench.cycles(4);
    EXPECT_EQ(bench.rules(), row.raised ? "RX504" : "") << row.homed << " " << row.normal;
  }
}

TEST(PositionRules, HomingPositionAfterAPositionSet) {
  for (const std::int32_t normal : {700, 0}) {
    Bench bench(1, with({}, 200'000));
    bench.at(0).homing_complete = true;
    bench.set(0, "servo_on", 1);
    bench.cycles(60);
    bench.non_cyclic(0, 4, 0x21, 0, 700);
    bench.cycles(8);
    bench.normal();
    bench.position(0, normal);
    bench.cycles(4);
    EXPECT_EQ(bench.rules(), normal == 700 ? "" : "RX504");
  }
}

TEST(PositionRules, PositionSetMoving) {
  for (const bool complete : {false, true}) {
    Bench bench;
    bench.set(0, "servo_on", 1);
    bench.cycles(10);
    bench.non_cyclic(0, 4, 0x22, 0, 50);
    bench.cycles(6);
    bench.at(0).homing_complete = complete;
    bench.cycles(2);
    bench.position(0, 50);
    bench.cycles(2);
    EXPECT_EQ(bench.rules(), complete ? "" : "RX509");
  }
}

TEST(PositionRules, DriveInhibit) {
  const auto pot = [](std::size_t, MutableBytes block) { block[3] |= 2; };
  Bench bench(1, with({{0x0504, 0}, {0x0717, 0}}));
  bench.set(0, "servo_on", 1);
  bench.cycles(10);
  std::int32_t position = 0;
  const auto move = [&](std::int32_t step, int cycles) {
    for (int n = 0; n < cycles; ++n) bench.position(0, position += step), bench.cycle();
  };
  move(100, 10);
  bench.on_response = pot;
  move(100, 20);  // on the way: the drive decelerates
  bench.cycles(60);
  move(-100, 20);
  move(100, 20);  // back to where it stood
  EXPECT_EQ(bench.rules(), "RX705");
  EXPECT_EQ(bench.found("RX705").at(0).severity, Severity::kWarning);
  EXPECT_EQ(bench.found("RX705").at(0).arguments[0], 1);
}

TEST(PositionRules, DriveInhibitLeavesTheOtherDirection) {
  Bench bench(1, with({{0x0504, 0}}));
  bench.set(0, "servo_on", 1);
  bench.set(0, "cyclic_command", 3);
  bench.on_response = [](std::size_t, MutableBytes block) { block[3] |= 1; };  // NOT
  bench.cycles(10);
  bench.position(0, 30);
  bench.cycles(10);
  EXPECT_EQ(bench.rules(), "");
  bench.position(0, -1);
  bench.cycles(10);
  ASSERT_EQ(bench.rules(), "RX705");
  EXPECT_EQ(bench.found("RX705").at(0).severity, Severity::kNote);  // Pr7.23 is assumed
  Bench disabled(1, with({{0x0504, 1}}));
  disabled.set(0, "servo_on", 1);
  disabled.set(0, "cyclic_command", 3);
  disabled.on_response = bench.on_response;
  disabled.cycles(10);
  disabled.position(0, -30);
  disabled.cycles(10);
  EXPECT_EQ(disabled.rules(), "");
}

TEST(PositionRules, ProfileTowardTheInhibit) {
  for (const std::int32_t target : {500, -500}) {
    Bench bench(1, with({{0x0504, 0}, {0x0717, 0}}));
    bench.set(0, "cyclic_command", 1);
    bench.set(0, "servo_on", 1);
    bench.on_response = [](std::size_t, MutableBytes block) { block[3] |= 2; };
    bench.cycles(10);
    bench.position(0, target);
    bench.non_cyclic(0, 7, 0x11, 0, 100);
    bench.cycles(6);
    EXPECT_EQ(bench.rules(), target > 0 ? "RX705" : "");
  }
}

TEST(PositionRules, CommandWhileOff) {
  for (const int moving : {0, 1, 2}) {
    Bench bench(1, with({{0x071D, 0}}));
    bench.at(0).follow = false;
    bench.cycles(300);
    for (std::int32_t n = 1; n <= 20; ++n) {
      if (moving == 1) bench.position(0, 100 * n);
      if (moving == 2) bench.at(0).position = 100 * n;  // the axis is moved by hand
      bench.cycle();
    }
    EXPECT_EQ(bench.rules(), moving == 1 ? "RX706" : "") << moving;
  }
  Bench follows(1, with({{0x071D, 0}}));
  follows.cycles(300);
  for (std::int32_t n = 1; n <= 40; ++n) follows.position(0, 100 * n), follows.cycle();
  EXPECT_EQ(follows.rules(), "");
}

}  // namespace
}  // namespace servotrace::rtex::test
