// SPDX-License-Identifier: MIT
// SX-DSV02203 6-9: every monitor of the list with its unit and sign, and every bit of the signal maps, typed by hand.
#include <gtest/gtest.h>

#include "decoder/render/value.hpp"
#include "tests/oracle/rtex/fields.hpp"

namespace servotrace::rtex::oracle {
namespace {

Block monitor(std::string_view type, std::string_view data, const BlockFormat& format = {}) {
  return Block::response("A3 2A C1 00 00 00 00 00 " + std::string(type) + " 00 00 " + std::string(data), format);
}

struct Row {
  std::string_view type;          // byte 8 and the low bits of byte 9, new code
  std::string_view conventional;  // "" where the list has none
  std::string_view key;
  Unit unit;
  bool is_signed;
};
// 32 bits, signed where the value is a position, speed, torque, temperature or a turn.
const Row kRows[] = {
    {"01 00", "01 01", "position_deviation", Unit::kCommandUnit, true},
    {"02 00", "02 01", "encoder_resolution", Unit::kPulse, false},
    {"04 00", "04 01", "internal_position_filtered", Unit::kCommandUnit, true},
    {"05 00", "05 01", "actual_speed", Unit::kRevolutionsPerMinute, true},
    {"06 00", "06 01", "torque", Unit::kPercent, true},
    {"07 00", "", "actual_position", Unit::kCommandUnit, true},
    {"08 00", "", "internal_position", Unit::kCommandUnit, true},
    {"09 00", "", "latch_position_1", Unit::kCommandUnit, true},
    {"0A 00", "", "latch_position_2", Unit::kCommandUnit, true},
    {"0C 00", "", "command_velocity", Unit::kRevolutionsPerMinute, true},
    {"0D 00", "", "external_scale_position", Unit::kPulse, true},
    {"11 00", "11 01", "regenerative_load", Unit::kPercent, false},
    {"12 00", "12 01", "overload", Unit::kPercent, false},
    {"31 00", "31 01", "inertia_ratio", Unit::kPercent, false},
    {"32 00", "32 01", "motor_recognition", Unit::kNone, false},
    {"33 00", "33 01", "no_revolution_cause", Unit::kNone, false},
    {"41 00", "01 02", "mechanical_angle", Unit::kPulse, false},
    {"42 00", "02 02", "electrical_angle", Unit::kNone, false},
    {"43 00", "", "multi_turn", Unit::kTurn, true},
    {"61 00", "", "power_on_time", Unit::kMinute, false},
    {"62 00", "", "driver_temperature", Unit::kDegreeCelsius, true},
    {"63 00", "", "encoder_temperature", Unit::kDegreeCelsius, true},
    {"64 00", "", "inrush_relay_operations", Unit::kNone, false},
    {"65 00", "", "dynamic_brake_operations", Unit::kNone, false},
    {"66 00", "", "fan_time", Unit::kMinute, false},
    {"67 00", "", "fan_life", Unit::kPercent, false},
    {"68 00", "", "capacitor_life", Unit::kPercent, false},
    {"69 00", "", "pn_voltage", Unit::kVolt, false},
    {"71 00", "01 04", "rtex_communication_errors", Unit::kNone, false},
    {"81 00", "11 04", "encoder_communication_errors", Unit::kNone, false},
    {"82 00", "12 04", "encoder_data_errors", Unit::kNone, false},
    {"83 00", "", "scale_communication_errors", Unit::kNone, false},
    {"84 00", "", "scale_data_errors", Unit::kNone, false},
};

TEST(Monitor, Section6_9_1List) {
  for (const Row& row : kRows) {
    const std::string name = "response." + std::string(row.key);
    if (row.type == "07 00") continue;  // Response_Data1 has the name already: the next test
    const std::int64_t expected = row.is_signed ? std::int64_t{-2} : std::int64_t{0xFFFFFFFE};
    for (const std::string_view type : {row.type, row.conventional}) {
      if (type.empty()) continue;
      const auto block = monitor(type, "FE FF FF FF");
      EXPECT_EQ(block[name], expected) << name << " as " << type;
      ASSERT_NE(block.field(name), nullptr) << name << " as " << type;
      EXPECT_EQ(block.field(name)->unit, row.unit) << name;
    }
  }
}

// The position stands in Response_Data1 and Response_Data2 both; the second is the monitor's.
TEST(Monitor, Section6_9_1ActualPosition) {
  const auto block = monitor("07 00", "FE FF FF FF");
  EXPECT_EQ(block["response.actual_position"], 0);
  EXPECT_EQ(block.last("response.actual_position"), -2);
}

TEST(Monitor, Section6_9_1SubChannel) {
  for (const Row& row : kRows) {
    const auto block =
        Block::response("A3 20 C1 00 00 00 00 00 00 00 00 00 00 00 00 00 0A " + std::string(row.type.substr(0, 2)) +
                        " 00 00 FE FF FF FF 00 00 00 00 00 00 00 00");
    EXPECT_EQ(block["sub_response." + std::string(row.key)],
              row.is_signed ? std::int64_t{-2} : std::int64_t{0xFFFFFFFE})
        << row.key;
  }
}

TEST(Monitor, Section6_9_1Scales) {
  EXPECT_EQ(monitor("11 00", "F4 01 00 00").field("response.regenerative_load")->scale.denominator, 10);
  EXPECT_EQ(monitor("12 00", "F4 01 00 00").field("response.overload")->scale.denominator, 10);
  EXPECT_EQ(monitor("61 00", "02 00 00 00").field("response.power_on_time")->scale.numerator, 30);
  // As people read them: 30h is 4.8 %, -2 is -0.2 %, 2 half-hours are 60 min.
  const struct {
    std::string_view type, data, key, text;
  } rows[] = {
      {"06 00", "30 00 00 00", "torque", "4.8 %"},
      {"06 00", "FE FF FF FF", "torque", "-0.2 %"},
      {"11 00", "F4 01 00 00", "regenerative_load", "50.0 %"},
      {"12 00", "01 00 00 00", "overload", "0.1 %"},
      {"67 00", "E8 03 00 00", "fan_life", "100.0 %"},
      {"68 00", "05 00 00 00", "capacitor_life", "0.5 %"},
      {"61 00", "02 00 00 00", "power_on_time", "60 min"},
  };
  for (const auto& row : rows) {
    const auto block = monitor(row.type, row.data);
    const std::string name = "response." + std::string(row.key);
    EXPECT_EQ(value_text(*block.field(name), *block.last(name)), row.text) << row.key;
  }
}

TEST(Monitor, Section6_9_1SpeedUnitByPr7_25) {
  for (const std::string_view type : {"05 00", "0C 00"}) {
    const std::string key = type == "05 00" ? "response.actual_speed" : "response.command_velocity";
    EXPECT_EQ(monitor(type, "01 00 00 00", {.speed_in_units = true}).field(key)->unit, Unit::kCommandUnitPerSecond);
  }
}

TEST(Monitor, Section6_9_2CauseOfNoRevolution) {
  EXPECT_EQ(monitor("33 00", "07 00 00 00").name("response.no_revolution_cause"), "position command too slow");
  EXPECT_EQ(monitor("33 00", "0E 00 00 00").name("response.no_revolution_cause"), "other causes");
  EXPECT_EQ(monitor("33 00", "05 00 00 00").name("response.no_revolution_cause"), "");
}

TEST(Monitor, UnnamedTypeCodeIsANumber) {
  EXPECT_EQ(monitor("0B 00", "78 56 34 12")["response.monitor_data"], 0x12345678);
}

// One bit at a time: exactly the named one of the map is 1.
void expect_bits(std::string_view type, std::initializer_list<std::pair<unsigned, std::string_view>> bits) {
  for (const auto& [bit, key] : bits) {
    std::string data;
    for (unsigned byte = 0; byte < 4; ++byte) {
      const unsigned value = bit / 8 == byte ? 1U << bit % 8 : 0;
      data += "0123456789ABCDEF"[value >> 4];
      data += "0123456789ABCDEF"[value & 15];
      data += ' ';
    }
    const auto block = monitor(type, data);
    for (const auto& [other, name] : bits)
      EXPECT_EQ(block["response." + std::string(name)], other == bit ? 1 : 0) << type << " bit " << bit << " " << name;
  }
}

TEST(Monitor, Section6_9_3WarningFlags) {
  expect_bits("34 00", {{0, "warning_battery"},
                        {8, "warning_scale"},
                        {9, "warning_continuous_communication"},
                        {10, "warning_accumulated_communication"},
                        {16, "warning_lifetime"},
                        {17, "warning_encoder_overheating"},
                        {18, "warning_encoder_communication"},
                        {19, "warning_oscillation"},
                        {20, "warning_scale_communication"}});
}

TEST(Monitor, Section6_9_5Signals) {
  expect_bits("21 00", {{0, "input_servo_on_command"}, {2, "input_not"}, {3, "input_pot"}, {7, "input_e_stop"}});
  expect_bits("23 00", {{0, "input_ext1"},
                        {1, "input_ext2"},
                        {2, "input_ext3"},
                        {4, "input_home"},
                        {18, "input_si_mon1"},
                        {19, "input_si_mon2"},
                        {20, "input_si_mon3"},
                        {21, "input_si_mon4"},
                        {22, "input_si_mon5"}});
  expect_bits("22 00", {{0, "output_servo_ready"},
                        {1, "output_servo_alarm"},
                        {2, "output_positioning_complete"},
                        {3, "output_brake_release"},
                        {4, "output_zero_speed"},
                        {5, "output_torque_limiting"},
                        {6, "output_velocity_coincidence"},
                        {9, "output_at_speed"},
                        {16, "output_warning_1"},
                        {17, "output_warning_2"},
                        {18, "output_position_command"},
                        {19, "output_positioning_complete_2"},
                        {20, "output_velocity_limiting"},
                        {21, "output_alarm_clear_attribute"},
                        {22, "output_velocity_command"},
                        {24, "output_ex_out1"},
                        {25, "output_ex_out2"}});
  expect_bits("24 00", {{9, "output_sync_complete"}});
  expect_bits("25 00", {{0, "input_si1"}, {3, "input_si4"}, {7, "input_si8"}});
  expect_bits("26 00", {{0, "output_so1"}, {1, "output_so2"}, {2, "output_so3"}});
}

// Response_Data by Pr7.29 to Pr7.34 (4-3-1, 4-5): every monitor of one byte, in each of the six places.
TEST(Monitor, Section4_3_1ChosenByPr7_29ToPr7_34) {
  for (const Row& row : kRows) {
    const auto code = static_cast<std::uint8_t>(std::stoul(std::string(row.type.substr(0, 2)), nullptr, 16));
    for (std::size_t place = 0; place < 6; ++place) {
      BlockFormat format;
      format.monitor[place] = code;
      // FFFFFFFEh in the chosen place, 0 in the others.
      const std::string_view offsets[] = {"FE FF FF FF", "00 00 00 00"};
      std::string bytes = "A3 20 C1 00";
      for (std::size_t i = 0; i < 3; ++i) bytes += " " + std::string(offsets[i == place ? 0 : 1]);
      bytes += " 00 00 00 00";
      for (std::size_t i = 3; i < 6; ++i) bytes += " " + std::string(offsets[i == place ? 0 : 1]);
      const auto block = Block::response(bytes, format);
      const std::string name = (place < 3 ? "response." : "sub_response.") + std::string(row.key);
      const bool is_default_elsewhere =
          row.key == "actual_position" || row.key == "actual_speed" || row.key == "torque";
      if (is_default_elsewhere && place < 3) continue;  // two places show the same monitor
      EXPECT_EQ(block[name], row.is_signed ? std::int64_t{-2} : std::int64_t{0xFFFFFFFE})
          << name << " in place " << place;
    }
  }
}

}  // namespace
}  // namespace servotrace::rtex::oracle
