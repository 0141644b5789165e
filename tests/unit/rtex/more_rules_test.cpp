// SPDX-License-Identifier: MIT
// Arguments, motion, parameters and reports: each rule raised by one fault, and silent on the nearest healthy traffic.
#include <gtest/gtest.h>

#include "tests/unit/rtex/bench.hpp"

namespace servotrace::rtex::test {
namespace {

Settings with(std::map<std::uint16_t, std::int32_t> parameters) {
  Settings settings;
  settings.rtex.axes.push_back({.mac_id = 0, .parameters = std::move(parameters)});
  return settings;
}

// Sends one main-channel command, holds it, goes back.
void exchange(Bench& bench, std::uint8_t code, std::uint16_t type, std::uint16_t index = 0, std::int32_t data3 = 0,
              unsigned held = 6) {
  bench.non_cyclic(0, code, type, index, data3);
  bench.cycles(held);
  bench.normal();
  bench.cycles(4);
}

TEST(MoreRules, UpdateCounterAccumulatedOnceAThreshold) {
  Bench bench(1, with({{0x0726, 3}}));
  bench.cycles(60);
  for (int n = 0; n < 6; ++n) {
    bench.count = false;
    bench.cycle();
    bench.count = true;
    bench.cycles(3);
  }
  ASSERT_EQ(bench.rules(), "RX201 RX206");
  EXPECT_EQ(bench.found("RX206").size(), 1U);
  EXPECT_EQ(bench.found("RX206").at(0).arguments[0], 4);
}

TEST(MoreRules, PositionBetweenUpdates) {
  for (const bool late : {false, true}) {
    Bench bench;
    bench.ratio = 2;
    bench.set(0, "servo_on", 1);
    bench.cycles(60);
    if (!late) bench.cycles(1);  // the counter moved in this one
    bench.position(0, 50);
    bench.cycles(4);
    EXPECT_EQ(bench.rules(), late ? "" : "RX212");
  }
}

TEST(MoreRules, ProfileOnlyInPp) {
  Bench bench;
  bench.cycles(5);
  bench.non_cyclic(0, 7, 0x20);
  bench.cycles(1);
  EXPECT_EQ(bench.found("RX307").size(), 1U);
}

TEST(MoreRules, TypeCodes) {
  Bench bench;
  bench.cycles(5);
  exchange(bench, 6, 0x012, 0x0008);
  EXPECT_EQ(bench.found("RX308").size(), 1U);
  exchange(bench, 6, 0x001, 0x0008);
  EXPECT_EQ(bench.rules(), "RX308 RX606");
  exchange(bench, 10, 0x107);
  exchange(bench, 10, 0x401);
  EXPECT_EQ(bench.found("RX308").size(), 1U);
  exchange(bench, 10, 0x77);
  EXPECT_EQ(bench.found("RX308").back().severity, Severity::kNote);
}

TEST(MoreRules, ArgumentsOutOfRange) {
  const struct {
    std::uint8_t code;
    std::uint16_t type, index;
    bool wrong;
  } rows[] = {{5, 0x000, 14, false},     {5, 0x000, 15, true},     {5, 0x001, 1, true},     {5, 0x002, 0x0156, false},
              {6, 0x030, 0x0800, false}, {6, 0x030, 0x0801, true}, {6, 0x081, 1, true},     {10, 0x01, 2, false},
              {10, 0x05, 1, true},       {10, 0x61, 9, false},     {4, 0x51, 0x0904, true}, {4, 0x51, 0x0943, false},
              {4, 0x52, 0x0943, true}};
  for (const auto& row : rows) {
    Bench bench;
    bench.cycles(5);
    exchange(bench, row.code, row.type, row.index);
    EXPECT_EQ(bench.rules(), row.wrong ? "RX309" : "") << int{row.code} << " " << row.type << " " << row.index;
  }
}

TEST(MoreRules, CommandData3) {
  Bench known(1, with({{0x0723, 0}}));
  known.cycles(5);
  known.non_cyclic(0, 0, 0, 0, 7);
  known.cycles(3);
  EXPECT_EQ(known.rules(), "RX310");
  Bench assumed;
  assumed.cycles(5);
  assumed.non_cyclic(0, 0, 0, 0, 7);
  assumed.cycles(3);
  EXPECT_EQ(assumed.rules(), "");
  assumed.at(0).error_code = 0x0034;
  assumed.cycles(3);
  EXPECT_EQ(assumed.rules(), "RX310 RX901");
  EXPECT_EQ(assumed.found("RX310").at(0).severity, Severity::kWarning);
  Bench forward(1, with({{0x0723, 1}}));
  forward.cycles(5);
  forward.non_cyclic(0, 0, 0, 0, 7);
  forward.cycles(3);
  EXPECT_EQ(forward.rules(), "");
}

TEST(MoreRules, EchoMissing) {
  Bench bench;
  bench.cycles(5);
  bench.on_response = [](std::size_t, MutableBytes block) { block[1] = 0x20; };
  bench.non_cyclic(0, 10, 0x05);
  bench.cycles(190);
  EXPECT_EQ(bench.rules(), "");
  bench.cycles(20);
  EXPECT_EQ(bench.rules(), "RX311");
}

TEST(MoreRules, BusyLong) {
  Bench bench;
  bench.at(0).busy = true;
  bench.cycles(5);
  bench.non_cyclic(0, 6, 0x010, 0x0008);
  bench.cycles(1990);
  EXPECT_EQ(bench.rules(), "");
  bench.cycles(30);
  EXPECT_EQ(bench.rules(), "RX312");
}

TEST(MoreRules, ResultNotRead) {
  Bench bench;
  bench.cycles(5);
  exchange(bench, 10, 0x05);
  EXPECT_EQ(bench.rules(), "");
  bench.on_response = [](std::size_t, MutableBytes block) {
    if (block[1] == 0x2A) block[8] = 0x01;
  };
  exchange(bench, 10, 0x05);
  EXPECT_EQ(bench.rules(), "RX313");
}

// Left while Busy: one act, one finding.
TEST(MoreRules, ResultNotReadWhileBusy) {
  Bench bench;
  bench.cycles(5);
  bench.at(0).busy = true;
  exchange(bench, 6, 0x010);
  EXPECT_EQ(bench.rules(), "RX304");
}

// 7-7-4: one finding as long as the word is not 0; the responses between do not end it.
TEST(MoreRules, SubDataNotZeroIsOneEpisode) {
  Settings settings;
  settings.rtex.axes.push_back({.mac_id = 0, .parameters = {{0x0724, 0}, {0x0725, 0}}});
  Bench bench(1, settings);
  bench.at(0).wide = true;
  bench.sub(0, 0, 0);
  bench.cycles(5);
  bench.command(0)[24] = 7;
  bench.cycles(5);
  ASSERT_EQ(bench.rules(), "RX314");
  EXPECT_EQ(bench.found("RX314").size(), 1U);
  EXPECT_EQ(bench.found("RX314").at(0).count, 5U);
}

TEST(MoreRules, EchoArguments) {
  Bench bench;
  bench.cycles(5);
  bench.on_response = [](std::size_t, MutableBytes block) {
    if (block[1] == 0x2A) block[8] = 0x01;
  };
  bench.non_cyclic(0, 10, 0x05);
  bench.cycles(190);
  EXPECT_EQ(bench.rules(), "");
  bench.cycles(30);
  EXPECT_EQ(bench.rules(), "RX315");
}

TEST(MoreRules, ModeChangesInMotion) {
  Bench bench;
  bench.set(0, "cyclic_command", 3);
  bench.set(0, "servo_on", 1);
  bench.cycles(10);
  bench.at(0).speed = 500;
  bench.cycles(3);
  bench.set(0, "cyclic_command", 2);
  bench.cycles(8);
  EXPECT_EQ(bench.rules(), "RX405");
  bench.set(0, "cyclic_command", 1);
  bench.cycles(8);
  EXPECT_EQ(bench.rules(), "RX405 RX406");
}

TEST(MoreRules, ModeChangeAtRestIsSilent) {
  Bench bench;
  bench.set(0, "cyclic_command", 3);
  bench.set(0, "servo_on", 1);
  bench.cycles(10);
  bench.at(0).speed = 30;
  bench.set(0, "cyclic_command", 2);
  bench.cycles(8);
  EXPECT_EQ(bench.rules(), "");
}

TEST(MoreRules, ModeInCycleAndLoop) {
  Bench pp(1, {}, 166'667);
  pp.set(0, "cyclic_command", 1);
  pp.cycles(5);
  EXPECT_EQ(pp.rules(), "RX408");
  Settings settings;
  settings.rtex.axes.push_back({.mac_id = 0, .full_closed = true});
  Bench cv(1, settings);
  cv.set(0, "cyclic_command", 3);
  cv.cycles(5);
  EXPECT_EQ(cv.rules(), "RX407");
}

TEST(MoreRules, ModeChangeInHoming) {
  Bench bench;
  bench.set(0, "servo_on", 1);
  bench.cycles(5);
  bench.non_cyclic(0, 4, 0x11);
  bench.cycles(5);
  bench.normal();
  bench.set(0, "cyclic_command", 3);
  bench.cycles(5);
  EXPECT_EQ(bench.rules(), "RX411");
}

TEST(MoreRules, HomingStarts) {
  Bench off;
  off.cycles(5);
  off.non_cyclic(0, 4, 0x18);
  off.cycles(5);
  EXPECT_EQ(off.rules(), "RX501");
  Bench cv;
  cv.set(0, "cyclic_command", 3);
  cv.cycles(5);
  cv.non_cyclic(0, 4, 0x21);
  cv.cycles(5);
  EXPECT_EQ(cv.rules(), "RX502");
  Bench pp;
  pp.set(0, "cyclic_command", 1);
  pp.set(0, "servo_on", 1);
  pp.cycles(5);
  pp.non_cyclic(0, 4, 0x18);
  pp.cycles(5);
  EXPECT_EQ(pp.rules(), "RX517");
}

TEST(MoreRules, HomingAbandoned) {
  Bench bench;
  bench.set(0, "servo_on", 1);
  bench.cycles(5);
  exchange(bench, 4, 0x18);
  ASSERT_EQ(bench.rules(), "RX503");
  EXPECT_EQ(bench.found("RX503").at(0).severity, Severity::kWarning);
  bench.at(0).homing_complete = true;
  exchange(bench, 4, 0x21);
  EXPECT_EQ(bench.found("RX503").size(), 1U);
}

TEST(MoreRules, MultiTurnClear) {
  Bench on;
  on.set(0, "servo_on", 1);
  on.at(0).homing_complete = true;
  on.cycles(5);
  exchange(on, 4, 0x31, 0, 0, 40);
  EXPECT_EQ(on.rules(), "RX505");
  Bench brief;
  brief.at(0).homing_complete = true;
  brief.cycles(5);
  exchange(brief, 4, 0x31, 0, 0, 15);
  EXPECT_EQ(brief.rules(), "RX506");
}

TEST(MoreRules, Profiles) {
  Bench bench;
  bench.set(0, "cyclic_command", 1);
  bench.set(0, "servo_on", 1);
  bench.cycles(5);
  exchange(bench, 7, 0x11, 0, -5);
  EXPECT_EQ(bench.rules(), "RX514");
  exchange(bench, 7, 0x10, 0, 5);
  EXPECT_EQ(bench.rules(), "RX513 RX514");
  exchange(bench, 7, 0x31, 0, 5);
  EXPECT_EQ(bench.rules(), "RX513 RX514 RX515");
  bench.set(0, "pause", 1);
  exchange(bench, 7, 0x11, 0, 5);
  EXPECT_EQ(bench.rules(), "RX513 RX514 RX515 RX526");
}

TEST(MoreRules, ProfileTypeChangedInProgress) {
  Bench bench;
  bench.set(0, "cyclic_command", 1);
  bench.set(0, "servo_on", 1);
  bench.cycles(5);
  bench.non_cyclic(0, 7, 0x11, 0, 5);
  bench.cycles(5);
  bench.at(0).in_progress = true;
  bench.cycles(5);
  bench.non_cyclic(0, 7, 0x13, 0, 5);
  bench.cycles(5);
  EXPECT_EQ(bench.rules(), "RX510");
}

TEST(MoreRules, LatchPositioningAllowsNeitherHomingNorModeChange) {
  for (const bool homing : {false, true}) {
    Bench bench;
    bench.set(0, "cyclic_command", 1);
    bench.set(0, "servo_on", 1);
    bench.cycles(5);
    bench.non_cyclic(0, 7, 0x13, 0, 5);
    bench.cycles(5);
    bench.at(0).in_progress = true;
    bench.normal();
    bench.cycles(5);
    if (homing) {
      bench.non_cyclic(0, 4, 0x50);
    } else {
      bench.set(0, "cyclic_command", 3);
    }
    bench.cycles(1);
    EXPECT_EQ(bench.rules(), homing ? "RX507" : "RX404");
  }
}

TEST(MoreRules, ResetOfAllDrives) {
  for (const bool second : {false, true}) {
    Bench bench(2);
    bench.cycles(5);
    bench.non_cyclic(0, 1, 0x001);
    if (second) bench.non_cyclic(1, 1, 0x001);
    bench.cycles(5);
    bench.normal(0);
    bench.normal(1);
    bench.cycles(1);
    EXPECT_EQ(bench.rules(), second ? "" : "RX601");
    if (!second) {
      EXPECT_EQ(bench.found("RX601").at(0).arguments[0], 2);
    }
  }
}

// The echo of the second drive was in records that the capture lost.
TEST(MoreRules, ResetWithItsEchoLost) {
  Bench bench(2);
  bench.cycles(5);
  bench.non_cyclic(0, 1, 0x001);
  bench.cycles(3);
  bench.non_cyclic(1, 1, 0x001);
  bench.cycles(1);
  bench.drop_cycles(3);
  bench.normal(0);
  bench.normal(1);
  bench.cycles(1);
  EXPECT_EQ(bench.rules(), "CP103");
}

TEST(MoreRules, ResetAndValidationWithServoOn) {
  Bench reset;
  reset.set(0, "servo_on", 1);
  reset.cycles(5);
  reset.non_cyclic(0, 1, 0x001);
  reset.cycles(3);
  EXPECT_EQ(reset.rules(), "RX602");
  Bench validation;
  validation.set(0, "servo_on", 1);
  validation.cycles(5);
  validation.non_cyclic(0, 1, 0x011);
  validation.cycles(2);
  EXPECT_EQ(validation.rules(), "RX603");
}

TEST(MoreRules, ServoOnInValidation) {
  Bench bench;
  bench.at(0).busy = true;
  bench.cycles(5);
  bench.non_cyclic(0, 1, 0x011);
  bench.cycles(5);
  bench.set(0, "servo_on", 1);
  bench.cycles(1);
  EXPECT_EQ(bench.found("RX604").size(), 1U);
}

TEST(MoreRules, ParameterWrites) {
  Bench bench;
  bench.cycles(5);
  bench.at(0).data = 5;
  exchange(bench, 6, 0x011, 0x0004, 5);
  EXPECT_EQ(bench.rules(), "");
  exchange(bench, 6, 0x011, 0x0004, 9);
  EXPECT_EQ(bench.rules(), "RX605");
  Bench inhibited(1, with({{0x0717, 1}}));
  inhibited.cycles(5);
  inhibited.non_cyclic(0, 6, 0x081);
  inhibited.cycles(5);
  EXPECT_EQ(inhibited.rules(), "RX607");
}

TEST(MoreRules, ServoOn) {
  Bench bench;
  bench.at(0).ready = false;
  bench.cycles(5);
  bench.set(0, "servo_on", 1);
  bench.cycles(1);
  EXPECT_EQ(bench.rules(), "RX701");
  Bench turning;
  turning.at(0).speed = -30;
  turning.cycles(5);
  turning.set(0, "servo_on", 1);
  turning.cycles(1);
  EXPECT_EQ(turning.rules(), "RX707");
  Bench slow;
  slow.at(0).speed = 29;
  slow.cycles(5);
  slow.set(0, "servo_on", 1);
  slow.cycles(5);
  EXPECT_EQ(slow.rules(), "");
}

TEST(MoreRules, Reports) {
  Bench bench;
  bench.cycles(5);
  bench.at(0).warning = true;
  bench.cycles(5);
  EXPECT_EQ(bench.rules(), "RX903");
  bench.at(0).err = true;
  exchange(bench, 6, 0x081);
  bench.at(0).err = false;
  bench.at(0).wng = true;
  exchange(bench, 10, 0x05);
  EXPECT_EQ(bench.rules(), "RX903 RX904 RX905");
}

TEST(MoreRules, HomeLostAndServoDropped) {
  Bench bench;
  bench.at(0).homing_complete = true;
  bench.set(0, "servo_on", 1);
  bench.cycles(20);
  bench.at(0).homing_complete = false;
  bench.cycles(2);
  EXPECT_EQ(bench.rules(), "RX908");
  bench.on_response = [](std::size_t, MutableBytes block) { block[2] &= 0x7F; };
  bench.cycles(2);
  EXPECT_EQ(bench.rules(), "RX908 RX909");
  Bench ordinary;
  ordinary.set(0, "servo_on", 1);
  ordinary.cycles(20);
  ordinary.set(0, "servo_on", 0);
  ordinary.cycles(20);
  EXPECT_EQ(ordinary.rules(), "");
}

}  // namespace
}  // namespace servotrace::rtex::test
