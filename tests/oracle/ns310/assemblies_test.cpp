// SPDX-License-Identifier: MIT
// The command and response assemblies of SIE-C718-7 5.3 to 5.5: bytes typed from the manual's tables and examples.
#include <gtest/gtest.h>

#include "decoder/core/slot.hpp"
#include "decoder/profiles/yaskawa_ns310/layouts.hpp"
#include "tests/support/bytes.hpp"

namespace servotrace::ns310 {
namespace {

using test::hex;

// Bytes 4-7.
Bytes data_of(Bytes message) { return message.subspan(kDataOffset); }

// Table 5.2, one bit at a time.
TEST(Ns310Oracle, Section531CommandFormat) {
  struct Row {
    const char* key;
    const char* bytes;
    std::int64_t value;
  };
  const Row rows[] = {
      {"start_trajectory", "01 00 00 00", 1}, {"start_block", "02 00 00 00", 1},
      {"incremental", "04 00 00 00", 1},      {"direction", "08 00 00 00", 1},
      {"smooth_stop", "10 00 00 00", 1},      {"hard_stop", "20 00 00 00", 1},
      {"valid_data", "40 00 00 00", 1},       {"enable", "80 00 00 00", 1},
      {"block_number", "00 FF 00 00", 255},   {"command_code", "00 00 1F 00", 0x1F},
      {"command_axis", "00 00 E0 00", 7},     {"response_code", "00 00 00 1F", 0x1F},
      {"response_axis", "00 00 00 E0", 7},
  };
  EXPECT_EQ(std::size(rows), kCommand.fields.size());
  for (const Row& row : rows) {
    const auto bytes = hex(row.bytes);
    for (const Field& field : kCommand.fields) {
      EXPECT_EQ(read(slot_of(field), bytes), field.key == row.key ? row.value : 0) << row.key << " in " << field.key;
    }
  }
}

// Table 5.3, one bit at a time.
TEST(Ns310Oracle, Section533ResponseFormat) {
  struct Row {
    const char* key;
    const char* bytes;
    std::int64_t value;
  };
  const Row rows[] = {
      {"trajectory_in_progress", "01 00 00 00", 1},
      {"block_in_execution", "02 00 00 00", 1},
      {"on_target_position", "04 00 00 00", 1},
      {"alarm", "08 00 00 00", 1},
      {"emergency_stop_input", "10 00 00 00", 1},
      {"home_flag", "20 00 00 00", 1},
      {"valid_data", "40 00 00 00", 1},
      {"enable_state", "80 00 00 00", 1},
      {"executing_block_number", "00 FF 00 00", 255},
      {"servo_ready", "00 00 01 00", 1},
      {"cw_hardware_limit", "00 00 02 00", 1},
      {"ccw_hardware_limit", "00 00 04 00", 1},
      {"positive_software_limit", "00 00 08 00", 1},
      {"negative_software_limit", "00 00 10 00", 1},
      {"trajectory_start_echo", "00 00 20 00", 1},
      {"block_fault", "00 00 40 00", 1},
      {"command_error", "00 00 80 00", 1},
      {"response_code", "00 00 00 1F", 0x1F},
      {"response_axis", "00 00 00 E0", 7},
  };
  EXPECT_EQ(std::size(rows), kResponse.fields.size());
  for (const Row& row : rows) {
    const auto bytes = hex(row.bytes);
    for (const Field& field : kResponse.fields) {
      EXPECT_EQ(read(slot_of(field), bytes), field.key == row.key ? row.value : 0) << row.key << " in " << field.key;
    }
  }
}

TEST(Ns310Oracle, Section541PositioningTo128000) {
  const auto bytes = hex("C1 00 21 23 00 F4 01 00");
  EXPECT_EQ(read(slot(kCommand, "enable"), bytes), 1);
  EXPECT_EQ(read(slot(kCommand, "valid_data"), bytes), 1);
  EXPECT_EQ(read(slot(kCommand, "hard_stop"), bytes), 0);
  EXPECT_EQ(read(slot(kCommand, "smooth_stop"), bytes), 0);
  EXPECT_EQ(read(slot(kCommand, "incremental"), bytes), 0);
  EXPECT_EQ(read(slot(kCommand, "start_block"), bytes), 0);
  EXPECT_EQ(read(slot(kCommand, "start_trajectory"), bytes), 1);
  EXPECT_EQ(read(slot(kCommand, "command_axis"), bytes), 1);
  EXPECT_EQ(read(slot(kCommand, "command_code"), bytes), 0x01);
  EXPECT_EQ(read(slot(kCommand, "response_axis"), bytes), 1);
  EXPECT_EQ(read(slot(kCommand, "response_code"), bytes), 0x03);
  ASSERT_EQ(&command_data(read(slot(kCommand, "command_code"), bytes)), &kTargetPosition);
  EXPECT_EQ(read(slot(kTargetPosition, "target_position"), data_of(bytes)), 128'000);
}

TEST(Ns310Oracle, Section542ContinuousRotation8000) {
  const auto bytes = hex("C9 00 31 23 40 1F 00 00");
  EXPECT_EQ(read(slot(kCommand, "direction"), bytes), 1);
  EXPECT_EQ(find_value(kDirectionNames, 1)->name, "forward (positive, clockwise)");
  EXPECT_EQ(read(slot(kCommand, "start_trajectory"), bytes), 1);
  EXPECT_EQ(read(slot(kCommand, "command_code"), bytes), 0x11);
  ASSERT_EQ(&command_data(0x11), &kContinuousSpeed);
  EXPECT_EQ(read(slot(kContinuousSpeed, "continuous_speed"), data_of(bytes)), 8'000);
}

TEST(Ns310Oracle, Section543HomingType0) {
  const auto bytes = hex("C1 00 32 21 00 00 00 00");
  EXPECT_EQ(read(slot(kCommand, "command_code"), bytes), 0x12);
  EXPECT_EQ(read(slot(kCommand, "response_code"), bytes), 0x01);
  ASSERT_EQ(&command_data(0x12), &kHoming);
  EXPECT_EQ(read(slot(kHoming, "homing_type"), data_of(bytes)), 0);
  EXPECT_EQ(read(slot(kHoming, "homing_reserved"), data_of(bytes)), 0);
  for (const int type : {0, 1, 3}) EXPECT_NE(find_value(kHomingTypes, type), nullptr);
  EXPECT_EQ(find_value(kHomingTypes, 2), nullptr);
}

TEST(Ns310Oracle, Section551StartOfBlock1) {
  const auto bytes = hex("C2 01 20 21 00 00 00 00");
  EXPECT_EQ(read(slot(kCommand, "start_block"), bytes), 1);
  EXPECT_EQ(read(slot(kCommand, "start_trajectory"), bytes), 0);
  EXPECT_EQ(read(slot(kCommand, "block_number"), bytes), 1);
  EXPECT_EQ(read(slot(kCommand, "command_code"), bytes), 0x00);
  EXPECT_EQ(&command_data(0x00), &kCommandData);
}

TEST(Ns310Oracle, Section532DataOfEveryCommandCode) {
  EXPECT_EQ(read(slot(kTargetPosition, "target_position"), hex("FF FF FF FF")), -1);
  EXPECT_EQ(read(slot(kTargetSpeed, "target_speed"), hex("40 1F 00 00")), 8'000);
  EXPECT_EQ(read(slot(kAcceleration, "acceleration"), hex("34 12 00 00")), 0x1234);
  EXPECT_EQ(read(slot(kDeceleration, "deceleration"), hex("00 00 00 40")), 0x40000000);
  EXPECT_EQ(read(slot(kAlarmClear, "alarm_clear"), hex("01 00 00 00")), 1);
  EXPECT_EQ(read(slot(kAlarmClear, "alarm_clear_reserved"), hex("01 00 00 00")), 0);
  EXPECT_NE(read(slot(kAlarmClear, "alarm_clear_reserved"), hex("80 00 00 00")), 0);
  EXPECT_NE(read(slot(kHoming, "homing_reserved"), hex("00 01 00 00")), 0);
  EXPECT_EQ(&command_data(0x02), &kTargetSpeed);
  EXPECT_EQ(&command_data(0x03), &kAcceleration);
  EXPECT_EQ(&command_data(0x04), &kDeceleration);
  EXPECT_EQ(&command_data(0x1E), &kAlarmClear);
  for (int code = 0; code < 32; ++code) {  // 05h-10h, 13h-1Dh and 1Fh are reserved
    const bool known = code <= 0x04 || code == 0x11 || code == 0x12 || code == 0x1E;
    EXPECT_EQ(find_value(kCommandCodes, code) != nullptr, known) << code;
  }
}

TEST(Ns310Oracle, Section533DataOfEveryResponseCode) {
  EXPECT_EQ(&response_data(0x00), &kResponseData);
  EXPECT_EQ(&response_data(0x01), &kCurrentPosition);
  EXPECT_EQ(&response_data(0x02), &kCommandPosition);
  EXPECT_EQ(&response_data(0x03), &kCurrentSpeed);
  EXPECT_EQ(&response_data(0x1E), &kAlarmCode);
  EXPECT_EQ(read(slot(kCurrentPosition, "current_position"), hex("00 F4 01 00")), 128'000);
  EXPECT_EQ(read(slot(kCommandPosition, "command_position"), hex("00 0C FE FF")), -128'000);
  EXPECT_EQ(read(slot(kCurrentSpeed, "current_speed"), hex("40 1F 00 00")), 8'000);
  EXPECT_EQ(read(slot(kAlarmCode, "alarm_code"), hex("F1 00 00 00")), 0xF1);
  for (int code = 0; code < 32; ++code) {  // 04h-1Dh and 1Fh are reserved
    EXPECT_EQ(find_value(kResponseCodes, code) != nullptr, code <= 0x03 || code == 0x1E) << code;
  }
}

TEST(Ns310Oracle, TableC1AlarmCodes) {
  EXPECT_EQ(find_value(kAlarmCodes, 0x0D)->name, "Deviation Excess");
  EXPECT_EQ(find_value(kAlarmCodes, 0x20)->name, "Duplicate MAC ID");
  EXPECT_EQ(find_value(kAlarmCodes, 0xF4)->name, "Switch Setting Error");
  EXPECT_EQ(find_value(kAlarmCodes, 0x04), nullptr);
  EXPECT_EQ(std::size(kAlarmCodes), 27U);  // the 26 of the table and "no alarm"
}

}  // namespace
}  // namespace servotrace::ns310
