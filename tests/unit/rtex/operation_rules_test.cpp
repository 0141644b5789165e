// SPDX-License-Identifier: MIT
// Homing, latch, profile operations, parameters and the emergency stop: each rule raised by one fault, and silent on
// the nearest healthy traffic.
#include <gtest/gtest.h>

#include "tests/unit/rtex/bench.hpp"

namespace servotrace::rtex::test {
namespace {

Settings with(std::map<std::uint16_t, std::int32_t> parameters) {
  Settings settings;
  settings.rtex.axes.push_back({.mac_id = 0, .parameters = std::move(parameters)});
  return settings;
}

void exchange(Bench& bench, std::uint8_t code, std::uint16_t type, std::uint16_t index = 0, std::int32_t data3 = 0,
              unsigned held = 6) {
  bench.non_cyclic(0, code, type, index, data3);
  bench.cycles(held);
  bench.normal();
  bench.cycles(4);
}
// A drive that answers a parameter command with the value written, or with `data`.
void write_parameter(Bench& bench, std::uint16_t index, std::int32_t value) {
  bench.at(0).data = static_cast<std::uint32_t>(value);
  exchange(bench, 6, 0x011, index, value);
}
void read_parameter(Bench& bench, std::uint16_t index, std::int32_t value) {
  bench.at(0).data = static_cast<std::uint32_t>(value);
  exchange(bench, 6, 0x010, index);
}

// In profile position mode, servo on, homed.
void in_pp(Bench& bench) {
  bench.at(0).homing_complete = true;
  bench.set(0, "cyclic_command", 1);
  bench.set(0, "servo_on", 1);
  bench.cycles(10);
}

TEST(OperationRules, ProfileUpdateIgnored) {
  for (const int extend : {0, 1}) {
    Bench bench(1, with({{0x0717, extend << 5}}));
    in_pp(bench);
    bench.non_cyclic(0, 7, 0x10, 0, 100);
    bench.cycles(6);
    bench.non_cyclic(0, 7, 0x10, 0, 200);
    bench.cycles(6);
    EXPECT_EQ(bench.rules(), extend == 1 ? "" : "RX511");
  }
  Bench assumed;
  in_pp(assumed);
  assumed.non_cyclic(0, 7, 0x10, 0, 100);
  assumed.cycles(6);
  assumed.non_cyclic(0, 7, 0x10, 0x0900, 100);
  assumed.cycles(6);
  ASSERT_EQ(assumed.rules(), "RX511");
  EXPECT_EQ(assumed.found("RX511").at(0).severity, Severity::kNote);
}

TEST(OperationRules, ProfileRelativeChanged) {
  for (const bool running : {false, true}) {
    Bench bench(1, with({{0x0717, 0x20}}));
    in_pp(bench);
    bench.position(0, 500);
    bench.non_cyclic(0, 7, 0x11, 0, 100);
    bench.cycles(6);
    bench.at(0).in_progress = running;
    bench.cycles(3);
    bench.position(0, 600);
    bench.cycles(6);
    EXPECT_EQ(bench.rules(), running ? "RX512" : "");
  }
}

TEST(OperationRules, SoftwareLimit) {
  Bench bench(1, with({{0x0717, 0}}));
  in_pp(bench);
  bench.non_cyclic(0, 7, 0x10, 0, 100);
  bench.cycles(6);
  EXPECT_EQ(bench.rules(), "");
  bench.on_response = [](std::size_t, MutableBytes block) {
    if (block[1] == 0x17) block[9] |= 8;
  };
  bench.cycles(20);
  ASSERT_EQ(bench.rules(), "RX516");
  EXPECT_EQ(bench.found("RX516").size(), 1U);
  EXPECT_EQ(bench.found("RX516").at(0).arguments[0], 1);
  Bench swapped(1, with({{0x0717, 0x80}}));
  in_pp(swapped);
  swapped.on_response = bench.on_response;
  swapped.non_cyclic(0, 7, 0x10, 0, 100);
  swapped.cycles(6);
  ASSERT_EQ(swapped.found("RX516").size(), 1U);
  EXPECT_EQ(swapped.found("RX516").at(0).arguments[0], 2);
}

TEST(OperationRules, HomingOnInhibitInput) {
  for (const int setup : {0, 1}) {
    Bench bench(1, with({{0x0504, setup}}));
    bench.set(0, "servo_on", 1);
    bench.cycles(5);
    bench.non_cyclic(0, 4, 0x15);
    bench.cycles(3);
    EXPECT_EQ(bench.rules(), setup == 1 ? "" : "RX518");
  }
}

TEST(OperationRules, PositionSetInMotion) {
  for (const std::int32_t speed : {30, 31}) {
    Bench bench;
    bench.set(0, "servo_on", 1);
    bench.at(0).speed = speed;
    bench.cycles(10);
    bench.non_cyclic(0, 4, 0x21);
    bench.cycles(3);
    EXPECT_EQ(bench.rules(), speed == 30 ? "" : "RX519");
  }
}

TEST(OperationRules, MultiTurnNeedsANewStart) {
  for (const bool restart : {false, true}) {
    Bench bench;
    bench.mac(0, 3);
    bench.at(0).homing_complete = true;
    bench.cycles(10);
    exchange(bench, 4, 0x31, 0, 0, 40);
    if (restart) {
      bench.extra_ns = seconds(5);
      bench.sequence += 10'000;
      bench.set(0, "cyclic_command", 0);
      bench.cycles(5);
      bench.set(0, "cyclic_command", 2);
      bench.cycles(5);
    }
    bench.set(0, "servo_on", 1);
    bench.cycles(5);
    EXPECT_EQ(bench.found("RX520").size(), restart ? 0U : 1U);
  }
}

TEST(OperationRules, MultiTurnAndASoftwareReset) {
  Bench bench;
  bench.mac(0, 3);
  bench.at(0).homing_complete = true;
  bench.cycles(10);
  exchange(bench, 4, 0x31, 0, 0, 40);
  exchange(bench, 1, 0x001);
  bench.set(0, "cyclic_command", 0);
  bench.cycles(20);
  bench.set(0, "cyclic_command", 2);
  bench.cycles(5);
  bench.set(0, "servo_on", 1);
  bench.cycles(5);
  EXPECT_EQ(bench.rules(), "RX520");
}

TEST(OperationRules, ProfileNotResumed) {
  for (const std::string_view bit : {"smooth_stop", "hard_stop", "pause"}) {
    Bench bench;
    in_pp(bench);
    bench.non_cyclic(0, 7, 0x10, 0, 100);
    bench.cycles(6);
    bench.at(0).in_progress = true;
    bench.cycles(3);
    bench.set(0, bit, 1);
    bench.cycles(5);
    bench.set(0, bit, 0);
    bench.cycles(5);
    EXPECT_EQ(bench.rules(), bit == "pause" ? "" : "RX521") << bit;
  }
}

TEST(OperationRules, HomingNotForEncoder) {
  const struct {
    bool absolute, full_closed;
    std::uint8_t code;
    std::uint16_t type, index;
    std::int64_t error;
  } rows[] = {
      {true, false, 4, 0x18, 0, 0x0052},  {false, false, 4, 0x18, 0, 0}, {true, false, 4, 0x21, 0, 0x0053},
      {false, false, 4, 0x31, 0, 0x0051}, {true, false, 4, 0x31, 0, 0},  {true, true, 4, 0x31, 0, 0x0055},
      {true, true, 4, 0x51, 0, 0x005A},   {true, true, 4, 0x51, 1, 0},   {true, true, 4, 0x53, 0x01, 0x005A},
      {false, true, 4, 0x51, 0, 0},       {true, false, 4, 0x51, 0, 0},
  };
  for (const auto& row : rows) {
    Settings settings;
    settings.rtex.axes.push_back({.mac_id = 0, .full_closed = row.full_closed, .absolute = row.absolute});
    Bench bench(1, settings);
    bench.set(0, "servo_on", row.type != 0x31);
    bench.at(0).homing_complete = true;
    bench.cycles(5);
    bench.non_cyclic(0, row.code, row.type, row.index);
    bench.cycles(3);
    EXPECT_EQ(bench.rules(), row.error != 0 ? "RX522" : "") << row.type << " " << row.absolute << row.full_closed;
    if (row.error != 0) {
      EXPECT_EQ(bench.found("RX522").at(0).arguments[2], row.error);
    }
  }
}

TEST(OperationRules, LatchReadEarly) {
  for (const bool complete : {false, true}) {
    Bench bench;
    bench.cycles(5);
    bench.on_response = [complete](std::size_t, MutableBytes block) {
      if (block[1] == 0x24 && complete) block[9] |= 1;
    };
    exchange(bench, 4, 0x51, 0x0001);
    exchange(bench, 10, 0x09);
    EXPECT_EQ(bench.rules(), complete ? "" : "RX523");
  }
  Bench unknown;
  unknown.cycles(5);
  exchange(unknown, 10, 0x09);
  EXPECT_EQ(unknown.rules(), "");
}

TEST(OperationRules, LatchCancelled) {
  for (const bool cancel : {false, true}) {
    Bench bench;
    bench.at(0).homing_complete = true;
    bench.cycles(5);
    exchange(bench, 4, 0x52, 0x0010);
    if (cancel) exchange(bench, 4, 0x58, 0x0010);
    exchange(bench, 4, 0x21);
    EXPECT_EQ(bench.rules(), cancel ? "" : "RX524");
  }
}

TEST(OperationRules, ProfileNeverEnds) {
  for (const std::int32_t speed : {0, 1}) {
    Bench bench;
    in_pp(bench);
    bench.non_cyclic(0, 7, 0x10, 0, speed);
    bench.cycles(4);
    bench.at(0).in_progress = true;
    bench.cycles(1990);
    EXPECT_EQ(bench.rules(), "");
    bench.cycles(20);
    EXPECT_EQ(bench.rules(), speed == 0 ? "RX525" : "");
  }
}

TEST(OperationRules, ProfileNotStarted) {
  for (const std::int32_t way : {1000, 1001}) {
    Bench bench;
    in_pp(bench);
    bench.position(0, 0);
    Bench known(1, with({{0x071D, 0}}));
    in_pp(known);
    known.position(0, way);
    known.non_cyclic(0, 7, 0x10, 0, 100);
    known.cycles(200);
    EXPECT_EQ(known.rules(), "");
    known.cycles(10);
    EXPECT_EQ(known.rules(), way == 1000 ? "" : "RX527");
  }
  Bench moves(1, with({{0x071D, 0}}));
  in_pp(moves);
  moves.position(0, 5000);
  moves.non_cyclic(0, 7, 0x10, 0, 100);
  moves.cycles(4);
  moves.at(0).in_progress = true;
  moves.cycles(50);
  moves.at(0).in_progress = false;
  moves.cycles(300);
  EXPECT_EQ(moves.rules(), "");
}

TEST(OperationRules, EepromWear) {
  Bench bench;
  bench.cycles(5);
  for (int n = 0; n < 10; ++n) exchange(bench, 6, 0x081);
  EXPECT_EQ(bench.rules(), "");
  exchange(bench, 6, 0x081);
  EXPECT_EQ(bench.rules(), "RX608");
}

TEST(OperationRules, ParameterNeedsReset) {
  for (const bool validated : {false, true}) {
    Bench bench;
    bench.cycles(5);
    write_parameter(bench, 0x0008, 10'000);  // attribute C
    write_parameter(bench, 0x070B, 5);       // attribute A
    if (validated) exchange(bench, 1, 0x011);
    EXPECT_EQ(bench.rules(), "");
    bench.pipeline().finish();
    ASSERT_EQ(bench.rules(), validated ? "" : "RX609");
    if (!validated) {
      EXPECT_EQ(bench.found("RX609").at(0).arguments[0], 0x0008);
      EXPECT_EQ(bench.found("RX609").at(0).frame, bench.frame());
    }
  }
}

// A read of the attribute (040h) counts above what the manual prints.
TEST(OperationRules, ParameterAttributeIsLearnt) {
  Bench bench;
  bench.cycles(5);
  bench.at(0).data = 0x00009010;
  exchange(bench, 6, 0x040, 0x0004);
  write_parameter(bench, 0x0004, 250);
  bench.pipeline().finish();
  ASSERT_EQ(bench.rules(), "RX609");
  EXPECT_EQ(bench.found("RX609").at(0).arguments[0], 0x0004);
}

TEST(OperationRules, ParameterWhileMoving) {
  for (const std::int32_t speed : {0, 200}) {
    Bench bench;
    bench.set(0, "servo_on", 1);
    bench.at(0).speed = speed;
    bench.cycles(10);
    write_parameter(bench, 0x0801, 100);
    write_parameter(bench, 0x0004, 100);
    EXPECT_EQ(bench.rules(), speed == 0 ? "" : "RX610");
    EXPECT_EQ(bench.found("RX610").size(), speed == 0 ? 0U : 1U);
  }
}

TEST(OperationRules, ParameterValueForbidden) {
  const struct {
    std::uint16_t index;
    std::int32_t value;
    bool raised;
  } rows[] = {{0x0001, 6, false}, {0x0001, 1, true},     {0x0714, 3, false}, {0x0714, 2, true},   {0x0715, 2, false},
              {0x0715, 0, true},  {0x0716, 0x13, false}, {0x0716, 4, true},  {0x070B, 11, false}, {0x070B, 10, true}};
  for (const auto& row : rows) {
    Bench bench(1, with({{0x070C, 10}}));
    bench.cycles(5);
    write_parameter(bench, row.index, row.value);
    EXPECT_EQ(bench.rules(), row.raised ? "RX611" : "") << row.index << " " << row.value;
  }
}

TEST(OperationRules, OneFeedforwardOnce) {
  for (const bool wide : {false, true}) {
    Bench bench(1, with({{0x0724, 1}}));
    bench.at(0).wide = wide;
    bench.sub(0, 0, 0);
    bench.cycles(5);
    write_parameter(bench, 0x0723, 1);
    EXPECT_EQ(bench.rules(), wide ? "RX611" : "");
  }
}

TEST(OperationRules, ResetWithoutEeprom) {
  for (const bool saved : {false, true}) {
    Bench bench;
    bench.mac(0, 3);
    bench.cycles(5);
    write_parameter(bench, 0x0714, 3);
    write_parameter(bench, 0x0715, 1);
    if (saved) exchange(bench, 6, 0x081);
    exchange(bench, 1, 0x001);
    ASSERT_EQ(bench.rules(), saved ? "" : "RX612");
    if (!saved) {
      EXPECT_EQ(bench.found("RX612").at(0).arguments[0], 0x0714);
      EXPECT_EQ(bench.found("RX612").at(0).arguments[1], 2);
    }
  }
}

TEST(OperationRules, ParameterDiffersFromRing) {
  const struct {
    std::uint16_t index;
    std::int32_t value;
    bool raised;
  } rows[] = {{0x0714, 3, false},    {0x0714, 6, true}, {0x0715, 1, false}, {0x0715, 2, true},
              {0x0716, 0x10, false}, {0x0716, 1, true}, {0x0717, 1, false}};
  for (const auto& row : rows) {
    Bench bench;
    bench.cycles(60);
    read_parameter(bench, row.index, row.value);
    EXPECT_EQ(bench.rules(), row.raised ? "RX613" : "") << row.index << " " << row.value;
  }
  Bench pending;  // written and not in force yet
  pending.cycles(60);
  write_parameter(pending, 0x0714, 6);
  read_parameter(pending, 0x0714, 6);
  EXPECT_EQ(pending.rules(), "");
}

TEST(OperationRules, EmergencyStop) {
  for (const bool is_e_stop : {false, true}) {
    Settings settings;
    settings.rtex.axes.push_back({.mac_id = 0});
    if (is_e_stop) settings.rtex.axes[0].input_second_meaning[7] = true;
    Bench bench(1, settings);
    bench.cycles(5);
    bench.on_response = [](std::size_t, MutableBytes block) { block[3] |= 0x80; };
    bench.cycles(5);
    EXPECT_EQ(bench.rules(), is_e_stop ? "RX907" : "");
  }
  Bench monitor;
  monitor.cycles(5);
  monitor.at(0).data = 0;
  monitor.non_cyclic(0, 10, 0x21);
  monitor.cycles(6);
  monitor.at(0).data = 0x80;
  monitor.cycles(6);
  EXPECT_EQ(monitor.rules(), "RX907");
  EXPECT_EQ(monitor.found("RX907").size(), 1U);
}

}  // namespace
}  // namespace servotrace::rtex::test
