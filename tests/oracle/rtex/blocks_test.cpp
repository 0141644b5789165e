// SPDX-License-Identifier: MIT
// SX-DSV02203 chapters 4 and 5: every bit of the command and response blocks, typed by hand.
#include <gtest/gtest.h>

#include "decoder/render/value.hpp"
#include "tests/oracle/rtex/fields.hpp"

namespace servotrace::rtex::oracle {
namespace {

// One bit of a command word at a time: exactly the named field is not 0.
void expect_only(const Block& block, std::string_view layout, std::span<const Field> fields, std::string_view key,
                 std::int64_t value) {
  for (const Field& field : fields) {
    const std::string name = std::string(layout) + "." + std::string(field.key);
    EXPECT_EQ(block[name], field.key == key ? value : 0) << name << " where only " << key << " is set";
  }
}

TEST(Command, Section4_2EveryBit) {
  const struct {
    std::string_view bytes, key;
    std::int64_t value;
  } rows[] = {
      {"1F 00 00 00", "mac_id", 31},
      {"60 00 00 00", "update_counter", 3},
      {"80 00 00 00", "cr", 1},
      {"00 0A 00 00", "non_cyclic_command", 10},
      {"00 40 00 00", "cyclic_command", 4},
      {"00 80 00 00", "tmg_cnt", 1},
      {"00 00 03 00", "unused_2_0", 3},
      {"00 00 04 00", "homing_ctrl", 1},
      {"00 00 08 00", "tl_sw", 1},
      {"00 00 10 00", "gain_sw", 1},
      {"00 00 60 00", "unused_2_5", 3},
      {"00 00 80 00", "servo_on", 1},
      {"00 00 00 01", "ex_out1", 1},
      {"00 00 00 02", "ex_out2", 1},
      {"00 00 00 04", "unused_3_2", 1},
      {"00 00 00 08", "sl_sw", 1},
      {"00 00 00 10", "unused_3_4", 1},
      {"00 00 00 20", "pause", 1},
      {"00 00 00 40", "smooth_stop", 1},
      {"00 00 00 80", "hard_stop", 1},
  };
  for (const auto& row : rows) {
    const auto block = Block::command(std::string(row.bytes) + " 00 00 00 00 00 00 00 00 00 00 00 00");
    expect_only(block, "command", kCommandFields, row.key, row.value);
  }
}

TEST(Response, Section4_3EveryBit) {
  const struct {
    std::string_view bytes, key;
    std::int64_t value;
  } rows[] = {
      {"1F 00 00 00", "mac_id", 31},
      {"60 00 00 00", "update_counter_echo", 3},
      {"80 00 00 00", "cr", 1},
      {"00 0A 00 00", "non_cyclic_command_echo", 10},
      {"00 40 00 00", "cyclic_command_echo", 4},
      {"00 80 00 00", "cmd_error", 1},
      {"00 00 01 00", "in_position", 1},
      {"00 00 02 00", "in_progress", 1},
      {"00 00 04 00", "homing_complete", 1},
      {"00 00 08 00", "torque_limited", 1},
      {"00 00 10 00", "warning", 1},
      {"00 00 20 00", "alarm", 1},
      {"00 00 40 00", "servo_ready", 1},
      {"00 00 80 00", "servo_active", 1},
      {"00 00 00 01", "not_pot", 1},
      {"00 00 00 02", "pot_not", 1},
      {"00 00 00 04", "home", 1},
      {"00 00 00 08", "si_mon1_ext1", 1},
      {"00 00 00 10", "si_mon2_ext2", 1},
      {"00 00 00 20", "si_mon3_ext3", 1},
      {"00 00 00 40", "si_mon4_ex_son", 1},
      {"00 00 00 80", "si_mon5_e_stop", 1},
  };
  for (const auto& row : rows) {
    const auto block = Block::response(std::string(row.bytes) + " 00 00 00 00 00 00 00 00 00 00 00 00");
    expect_only(block, "response", kResponseFields, row.key, row.value);
  }
}

TEST(Command, Section5CyclicData) {
  EXPECT_EQ(Block::command("23 10 80 00 18 FC FF FF 00 00 00 00 00 00 00 00")["command.target_position"], -1000);
  EXPECT_EQ(Block::command("23 20 80 00 18 FC FF FF 00 00 00 00 00 00 00 00")["command.command_position"], -1000);
  EXPECT_EQ(Block::command("23 30 80 00 18 FC FF FF 00 00 00 00 00 00 00 00")["command.command_speed"], -1000);
  EXPECT_EQ(Block::command("23 40 80 00 18 FC FF FF 00 00 00 00 00 00 00 00")["command.command_torque"], -1000);
  EXPECT_EQ(Block::command("23 00 80 00 18 FC FF FF 00 00 00 00 00 00 00 00")["command.command_data1"], 0xFFFFFC18);
  EXPECT_EQ(Block::command("23 30 80 00 18 FC FF FF 00 00 00 00 00 00 00 00").field("command.command_speed")->unit,
            Unit::kRevolutionsPerMinute);
  EXPECT_EQ(Block::command("23 30 80 00 18 FC FF FF 00 00 00 00 00 00 00 00", {.speed_in_units = true})
                .field("command.command_speed")
                ->unit,
            Unit::kCommandUnitPerSecond);
}

TEST(Response, Section4_3_1DefaultData) {
  const auto block = Block::response("A3 20 C1 00 18 FC FF FF B8 0B 00 00 F4 01 00 00");
  EXPECT_EQ(block["response.actual_position"], -1000);
  EXPECT_EQ(block["response.actual_speed"], 3000);
  EXPECT_EQ(block["response.torque"], 500);
  EXPECT_EQ(value_text(*block.field("response.torque"), *block["response.torque"]), "50.0 %");
}

// 4-3-3-2, 4-3-4: Pr7.23 bit 8 chooses what status bit 1 is, bit 3 where POT and NOT are.
TEST(Response, Sections4_3_3_2And4_3_4NamedByPr7_23) {
  const struct {
    BlockFormat format;
    std::string_view bit_1, low, high;
  } rows[] = {
      {{}, "In_Progress / AC_OFF", "NOT / POT", "POT / NOT"},
      {{.status_known = true}, "In_Progress", "NOT", "POT"},
      {{.status_known = true, .inhibit_swapped = true}, "In_Progress", "POT", "NOT"},
      {{.status_known = true, .ac_off = true}, "AC_OFF", "NOT", "POT"},
      {{.status_known = true, .inhibit_swapped = true, .ac_off = true}, "AC_OFF", "POT", "NOT"},
  };
  for (const auto& row : rows) {
    const auto block = Block::response("A3 20 C3 01 00 00 00 00 00 00 00 00 00 00 00 00", row.format);
    EXPECT_EQ(block.field("response.in_progress")->label, row.bit_1);
    EXPECT_EQ(block.field("response.not_pot")->label, row.low);
    EXPECT_EQ(block.field("response.pot_not")->label, row.high);
    EXPECT_EQ(block["response.in_progress"], 1);
    EXPECT_EQ(block["response.not_pot"], 1);
    EXPECT_EQ(block["response.pot_not"], 0);
    EXPECT_EQ(block["response.servo_active"], 1);
  }
}

TEST(Response, Section4_3_1DataChosenByPr7_29ToPr7_31) {
  const auto block =
      Block::response("A3 20 C1 00 01 00 00 00 02 00 00 00 03 00 00 00", {.monitor = {0x01, 0x08, 0x62, 0, 0, 0}});
  EXPECT_EQ(block["response.position_deviation"], 1);
  EXPECT_EQ(block["response.internal_position"], 2);
  EXPECT_EQ(block["response.driver_temperature"], 3);
  EXPECT_EQ(block["response.actual_position"], std::nullopt);
}

TEST(SubCommand, Section4_4) {
  const auto block =
      Block::command("23 20 80 00 00 00 00 00 00 00 00 00 00 00 00 00 8A 05 34 12 01 00 00 00 02 00 00 00 03 00 00 00");
  EXPECT_EQ(block.words(), 8U);
  EXPECT_EQ(block["sub_command.sub_chk"], 1);
  EXPECT_EQ(block["sub_command.unused_16_4"], 0);
  EXPECT_EQ(block.name("sub_command.command"), "Monitor");
  EXPECT_EQ(block.name("sub_command.type_code"), "Actual speed (ASPD)");
  EXPECT_EQ(block["sub_command.index"], 0x1234);
  EXPECT_EQ(block["sub_command.sub_command_data1"], 1);
  EXPECT_EQ(block["sub_command.sub_command_data2"], 2);
  EXPECT_EQ(block["sub_command.sub_command_data3"], 3);
  const auto forward =
      Block::command("23 20 80 00 00 00 00 00 00 00 00 00 00 00 00 00 F0 05 34 12 01 00 00 00 FE FF FF FF FD FF FF FF",
                     {.feedforward = {0, 1, 2}});
  EXPECT_EQ(forward["sub_command.unused_16_4"], 7);
  EXPECT_EQ(forward["sub_command.velocity_feedforward"], -2);
  EXPECT_EQ(forward["sub_command.torque_feedforward"], -3);
}

TEST(SubResponse, Section4_5) {
  const auto block = Block::response(
      "A3 20 C1 00 00 00 00 00 00 00 00 00 00 00 00 00 1A 05 34 12 FF FF FF FF 02 00 00 00 03 00 00 00");
  EXPECT_EQ(block["sub_response.busy"], 1);
  EXPECT_EQ(block["sub_response.wng"], 0);
  EXPECT_EQ(block["sub_response.err"], 0);
  EXPECT_EQ(block["sub_response.cmd_err"], 0);
  EXPECT_EQ(block["sub_response.actual_speed"], -1);
  EXPECT_EQ(block["sub_response.index_echo"], 0x1234);
  EXPECT_EQ(block["sub_response.sub_response_data2"], 2);
  EXPECT_EQ(block["sub_response.sub_response_data3"], 3);
  EXPECT_EQ(Block::response("A3 20 C1 00 00 00 00 00 00 00 00 00 00 00 00 00 20 00 00 00 07 00 00 00 00 00 00 00 00 "
                            "00 00 00")["sub_response.wng"],
            1);
  EXPECT_EQ(Block::response("A3 20 C1 00 00 00 00 00 00 00 00 00 00 00 00 00 40 00 00 00 07 00 00 00 00 00 00 00 00 "
                            "00 00 00")["sub_response.err"],
            1);
  const auto chosen =
      Block::response("A3 20 C1 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 07 00 00 00 08 00 00 00 09 00 00 00",
                      {.monitor = {0, 0, 0, 0x07, 0x05, 0x06}});
  EXPECT_EQ(chosen["sub_response.actual_position"], 7);
  EXPECT_EQ(chosen["sub_response.actual_speed"], 8);
  EXPECT_EQ(chosen["sub_response.torque"], 9);
}

TEST(Response, Section6_10CommandError) {
  const auto block = Block::response(
      "A3 A6 C1 00 00 00 00 00 2E 00 00 00 00 00 00 00 8A 00 32 00 00 00 00 00 00 00 00 00 00 00 00 00");
  EXPECT_EQ(block["response.cmd_error"], 1);
  EXPECT_EQ(block["response.error_code"], 0x2E);
  EXPECT_EQ(block.name("response.error_code"), "cyclic command refused");
  EXPECT_EQ(block["sub_response.cmd_err"], 1);
  EXPECT_EQ(block["sub_response.error_code"], 0x32);
  EXPECT_EQ(block.name("sub_response.error_code"), "argument out of range");
}

TEST(Response, Section6_11CommunicationError) {
  const auto block = Block::response(
      "A3 FF C1 00 00 00 00 00 00 00 00 00 00 00 00 00 8F 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00");
  EXPECT_EQ(block["response.unused_8"], 0);
  EXPECT_EQ(block["response.error_code"], std::nullopt);
  EXPECT_EQ(block["sub_response.error_code"], std::nullopt);
  // FFh with an error code is the error echo of an undefined command 7Fh.
  EXPECT_EQ(Block::response("A3 FF C1 00 00 00 00 00 21 00 00 00 00 00 00 00")["response.error_code"], 0x21);
}

}  // namespace
}  // namespace servotrace::rtex::oracle
