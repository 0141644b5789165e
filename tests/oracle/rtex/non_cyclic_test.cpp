// SPDX-License-Identifier: MIT
// SX-DSV02203 6-3 to 6-8: the data words of the non-cyclic commands and their answers, typed by hand, with the examples
// the manual prints.
#include <gtest/gtest.h>

#include "tests/oracle/rtex/fields.hpp"

namespace servotrace::rtex::oracle {
namespace {

// Header and Command_Data1 or Response_Data1 of node 3 in CP: what stands before the words of the command.
std::string command(std::string_view code, std::string_view words) {
  return "23 " + std::string(code) + " 80 00 00 00 00 00 " + std::string(words);
}
std::string response(std::string_view echo, std::string_view words) {
  return "A3 " + std::string(echo) + " C1 00 00 00 00 00 " + std::string(words);
}

// Busy, WNG and ERR stand at the same place in every answer (3-3-2).
void expect_process_bits(std::string_view echo, std::string_view type) {
  const struct {
    std::string_view byte9, key;
  } rows[] = {{"10", "response.busy"}, {"40", "response.wng"}, {"80", "response.err"}, {"20", "response.unused_9_5"}};
  for (const auto& row : rows) {
    const auto block =
        Block::response(response(echo, std::string(type) + " " + std::string(row.byte9) + " 00 00 00 00 00 00"));
    for (const auto& other : rows) EXPECT_EQ(block[other.key], other.key == row.key ? 1 : 0) << echo << row.key;
  }
}

TEST(NonCyclic, Section3_3_2ProcessBits) {
  for (const std::string_view echo : {"21", "22", "24", "25", "26", "2A"}) expect_process_bits(echo, "11");
  expect_process_bits("17", "10");
}

TEST(Reset, Section6_3) {
  const auto reset = Block::command(command("21", "01 00 00 00 00 00 00 00"));
  EXPECT_EQ(reset["command.type_code"], 0x001);
  EXPECT_EQ(reset.name("command.type_code"), "software reset");
  const auto validation = Block::command(command("21", "11 F0 34 12 00 00 00 00"));
  EXPECT_EQ(validation.name("command.type_code"), "attribute C parameter validation");
  EXPECT_EQ(validation["command.unused_9_4"], 15);
  EXPECT_EQ(validation["command.index"], 0x1234);
  const auto answer = Block::response(response("21", "11 00 34 12 00 00 00 00"));
  EXPECT_EQ(answer["response.type_code_echo"], 0x011);
  EXPECT_EQ(answer["response.index_echo"], 0x1234);
}

// 6-4-2: the vendor name "Panasonic" over three values of Index.
TEST(SystemId, Section6_4_2VendorName) {
  const struct {
    std::string_view words;
    std::int64_t index;
    std::string text;
  } rows[] = {{"01 00 00 00 50 61 6E 61", 0, "Pana"},
              {"01 00 01 00 73 6F 6E 69", 1, "soni"},
              {"01 00 02 00 63 00 00 00", 2, std::string("c\0\0\0", 4)}};
  for (const auto& row : rows) {
    const auto block = Block::response(response("22", row.words));
    EXPECT_EQ(block.name("response.type_code_echo"), "vendor name");
    EXPECT_EQ(block["response.index_echo"], row.index);
    EXPECT_EQ(block.text("response.characters"), row.text);
  }
  EXPECT_EQ(Block::command(command("22", "10 00 02 00 00 00 00 00")).name("command.type_code"),
            "vendor name (conventional)");
}

// 6-4-4: a rotary A5N answers "1011", then "11".
TEST(SystemId, Section6_4_4DriverType) {
  EXPECT_EQ(Block::response(response("22", "15 00 00 00 31 30 31 31")).text("response.characters"), "1011");
  EXPECT_EQ(Block::response(response("22", "15 00 01 00 31 31 00 00")).text("response.characters"),
            std::string("11\0\0", 4));
  EXPECT_EQ(Block::response(response("22", "15 00 00 00 31 30 31 31")).name("response.type_code_echo"), "driver type");
}

TEST(SystemId, Section4_5SubChannel) {
  const auto block =
      Block::response(response("20", "00 00 00 00 00 00 00 00 02 05 00 00 31 00 00 00 00 00 00 00 00 00 00 00"));
  EXPECT_EQ(block.name("sub_response.type_code_echo"), "device type");
  EXPECT_EQ(block.text("sub_response.characters"), std::string("1\0\0\0", 4));
}

TEST(Homing, Section6_5) {
  const auto block = Block::command(command("24", "53 F0 92 0A 18 FC FF FF"));
  EXPECT_EQ(block["command.type_code"], 0x53);
  EXPECT_EQ(block["command.unused_9_4"], 15);
  EXPECT_EQ(block["command.latch_sel1"], 2);  // EXT2 rising
  EXPECT_EQ(block["command.latch_sel2"], 9);  // EXT1 falling
  EXPECT_EQ(block.name("command.monitor_sel"), "Latch position 2 (LPOS2)");
  EXPECT_EQ(Block::command(command("24", "21 00 00 00 18 FC FF FF"))["command.setting_data"], -1000);
  EXPECT_EQ(Block::command(command("24", "22 00 00 00 18 FC FF FF"))["command.setting_data"], -1000);
  EXPECT_EQ(Block::command(command("24", "11 00 00 00 18 FC FF FF"))["command.command_data3"], 0xFFFFFC18);
}

TEST(Homing, Section6_5_4Latch) {
  const auto first = Block::response(response("24", "53 01 92 09 18 FC FF FF"));
  EXPECT_EQ(first["response.latch_comp1"], 1);
  EXPECT_EQ(first["response.latch_comp2"], 0);
  EXPECT_EQ(first["response.latch_sel1_echo"], 2);
  EXPECT_EQ(first["response.latch_sel2_echo"], 9);
  EXPECT_EQ(first["response.latch_position_1"], -1000);
  const auto second = Block::response(response("24", "50 02 00 0A 18 FC FF FF"));
  EXPECT_EQ(second["response.latch_comp1"], 0);
  EXPECT_EQ(second["response.latch_comp2"], 1);
  EXPECT_EQ(second["response.latch_position_2"], -1000);
  EXPECT_EQ(Block::response(response("24", "50 0C 00 00 00 00 00 00"))["response.unused_9_2"], 3);
  EXPECT_EQ(Block::response(response("24", "21 00 00 00 18 FC FF FF"))["response.setting_data_echo"], -1000);
}

TEST(Alarm, Section6_6) {
  const auto history = Block::command(command("25", "00 00 0E 00 00 00 00 00"));
  EXPECT_EQ(history["command.index"], 14);
  const auto attribute = Block::command(command("25", "02 00 56 02 00 00 00 00"));
  EXPECT_EQ(attribute["command.alarm_main"], 86);
  EXPECT_EQ(attribute["command.alarm_sub"], 2);
  const auto code = Block::response(response("25", "00 00 00 00 56 02 C2 00"));
  EXPECT_EQ(code["response.alarm_main"], 86);
  EXPECT_EQ(code["response.alarm_sub"], 2);
  EXPECT_EQ(code["response.warning_code"], 0xC2);
  EXPECT_EQ(code.name("response.warning_code"), "RTEX Update_Counter error");
  EXPECT_EQ(Block::response(response("25", "00 00 00 00 10 00 00 00")).name("response.alarm_main"), "");
}

TEST(Alarm, Section6_6_3Attribute) {
  const struct {
    std::string_view byte12, key;
  } rows[] = {{"80", "response.not_recorded"}, {"40", "response.not_clearable"}, {"20", "response.emergency_stop"}};
  for (const auto& row : rows) {
    const auto block = Block::response(response("25", "02 00 56 02 " + std::string(row.byte12) + " 00 00 00"));
    EXPECT_EQ(block["response.alarm_main_echo"], 86);
    EXPECT_EQ(block["response.alarm_sub_echo"], 2);
    for (const auto& other : rows) EXPECT_EQ(block[other.key], other.key == row.key ? 1 : 0);
  }
}

// 6-7-2: Pr7.23 is byte 10 = 17h, byte 11 = 07h. 6-7: -1000 is FFFFFC18h.
TEST(Parameter, Section6_7_2IndexAndSettingData) {
  const auto write = Block::command(command("26", "11 00 17 07 18 FC FF FF"));
  EXPECT_EQ(write["command.parameter"], 0x0717);
  EXPECT_EQ(write.name("command.parameter"), "Pr7.23 RTEX function expansion setup 2");
  EXPECT_EQ(write["command.type_code"], 0x011);
  const auto other = Block::command(command("26", "11 00 0B 07 18 FC FF FF"));
  EXPECT_EQ(other["command.setting_data"], -1000);
  EXPECT_EQ(Block::response(response("26", "10 00 0B 07 18 FC FF FF"))["response.parameter_value"], -1000);
}

// 6-7-3: class 8 has 20 parameters.
TEST(Parameter, Section6_7_3Count) {
  EXPECT_EQ(Block::response(response("26", "30 00 00 08 14 00 00 00"))["response.parameter_count"], 20);
}

// 6-7-4: Pr0.08 answers 00009010h.
TEST(Parameter, Section6_7_4Attribute) {
  const auto block = Block::response(response("26", "40 00 08 00 10 90 00 00"));
  EXPECT_EQ(block["response.parameter_echo"], 0x0008);
  EXPECT_EQ(block["response.valid_at_reset"], 1);
  EXPECT_EQ(block["response.valid_at_validation"], 1);
  EXPECT_EQ(block["response.is_32bit"], 1);
  EXPECT_EQ(block["response.read_only"], 0);
  EXPECT_EQ(block["response.not_used"], 0);
  const auto bits = Block::response(response("26", "40 00 08 00 C8 01 00 00"));
  EXPECT_EQ(bits["response.not_used"], 1);
  EXPECT_EQ(bits["response.manufacturer_6"], 1);
  EXPECT_EQ(bits["response.manufacturer_3"], 1);
  EXPECT_EQ(bits["response.read_only"], 1);
  EXPECT_EQ(bits["response.valid_at_reset"], 0);
}

// The bits of Pr7.22 to Pr7.24: 2-5-2, 3-3-3, 4-2-3-5, 4-3-4, 6-7-5, 6-8-6.
TEST(Parameter, Sections2_5_2To6_8_6BitFields) {
  const struct {
    std::string_view index, value, key;
  } rows[] = {
      {"16 07", "01 00 00 00", "data_size"},       {"16 07", "02 00 00 00", "sync_mode"},
      {"16 07", "10 00 00 00", "scale_monitor"},   {"17 07", "01 00 00 00", "write_inhibited"},
      {"17 07", "02 00 00 00", "alarm_code_mode"}, {"17 07", "04 00 00 00", "pot_not_silent"},
      {"17 07", "08 00 00 00", "pot_not_place"},   {"17 07", "10 00 00 00", "com_led"},
      {"17 07", "20 00 00 00", "start_mode"},      {"17 07", "40 00 00 00", "pot_not_inverted"},
      {"17 07", "80 00 00 00", "limit_place"},     {"17 07", "00 01 00 00", "status_bit_1"},
      {"18 07", "01 00 00 00", "ex_out1_on_loss"}, {"18 07", "02 00 00 00", "ex_out2_on_loss"},
  };
  for (const auto& row : rows) {
    const std::string layout = row.index == "16 07" ? "pr7_22." : row.index == "17 07" ? "pr7_23." : "pr7_24.";
    const auto read = Block::response(response("26", "10 00 " + std::string(row.index) + " " + std::string(row.value)));
    const auto written =
        Block::command(command("26", "11 00 " + std::string(row.index) + " " + std::string(row.value)));
    for (const auto& other : rows) {
      if (other.index != row.index) continue;
      EXPECT_EQ(read[layout + std::string(other.key)], other.key == row.key ? 1 : 0) << row.key << " " << other.key;
      EXPECT_EQ(written[layout + std::string(other.key)], other.key == row.key ? 1 : 0) << row.key;
    }
  }
}

// 4-3-1, 4-5-1, 6-7: what Pr7.29 (071Dh) to Pr7.34 (0722h) choose, by its Type_Code of 6-9-1.
TEST(Parameter, Sections4_3_1And4_5_1MonitorSelects) {
  const struct {
    std::string_view index, layout, value, name;
  } rows[] = {
      {"1D 07", "pr7_29", "01 00 00 00", "Position deviation (PERR)"},
      {"1D 07", "pr7_29", "00 00 00 00", "Actual position (APOS)"},
      {"1E 07", "pr7_30", "0C 00 00 00", "Command velocity after filtering (MSPD)"},
      {"1E 07", "pr7_30", "00 00 00 00", "Actual speed (ASPD)"},
      {"1F 07", "pr7_31", "12 00 00 00", "Overload ratio"},
      {"1F 07", "pr7_31", "00 00 00 00", "Torque (TRQ)"},
      {"20 07", "pr7_32", "21 00 00 00", "Logical input signal"},
      {"21 07", "pr7_33", "62 00 00 00", "Servo driver temperature"},
      {"22 07", "pr7_34", "84 00 00 00", "External scale cumulative communication data errors"},
      {"22 07", "pr7_34", "00 00 00 00", "none"},
      {"22 07", "pr7_34", "03 00 00 00", ""},  // the list has no 03h
  };
  for (const auto& row : rows) {
    const std::string key = std::string(row.layout) + ".monitor_select";
    const std::string arguments = " 00 " + std::string(row.index) + " " + std::string(row.value);
    EXPECT_EQ(Block::response(response("26", "10" + arguments)).name(key), row.name) << row.index;
    EXPECT_EQ(Block::command(command("26", "11" + arguments)).name(key), row.name) << row.index;
  }
}

// 7-7-1: Pr7.35 (0723h) to Pr7.37 (0725h).
TEST(Parameter, Section7_7_1FeedforwardChoices) {
  for (const std::string_view index : {"23", "24", "25"}) {
    const std::string key = index == "23"   ? "pr7_35.feedforward"
                            : index == "24" ? "pr7_36.feedforward"
                                            : "pr7_37.feedforward";
    const auto named = [&](std::string_view value) {
      return std::string(
          Block::command(command("26", "11 00 " + std::string(index) + " 07 " + std::string(value) + " 00 00 00"))
              .name(key));
    };
    EXPECT_EQ(named("00"), "disabled");
    EXPECT_EQ(named("01"), "velocity feedforward");
    EXPECT_EQ(named("02"), "torque feedforward");
  }
}

TEST(Profile, Section6_8) {
  const auto block = Block::command("23 17 80 00 18 FC FF FF 12 F0 F1 09 D0 07 00 00");
  EXPECT_EQ(block["command.target_position"], -1000);
  EXPECT_EQ(block["command.type_code"], 0x12);
  EXPECT_EQ(block["command.unused_9_4"], 15);
  EXPECT_EQ(block["command.latch_sel1"], 1);
  EXPECT_EQ(block["command.unused_10_4"], 15);
  EXPECT_EQ(block.name("command.monitor_sel"), "Latch position 1 (LPOS1)");
  EXPECT_EQ(block["command.target_speed"], 2000);
  EXPECT_EQ(block.field("command.target_speed")->unit, Unit::kRevolutionsPerMinute);
}

TEST(Profile, Sections6_8_3To6_8_6Status) {
  const struct {
    std::string_view byte9, key, swapped;
  } rows[] = {{"01", "latch_comp1", "latch_comp1"}, {"02", "near", "near"}, {"04", "nsl", "psl"}, {"08", "psl", "nsl"}};
  for (const auto& row : rows) {
    const std::string bytes = "A3 17 C3 00 00 00 00 00 12 " + std::string(row.byte9) + " 01 09 18 FC FF FF";
    const auto block = Block::response(bytes);
    const auto swapped = Block::response(bytes, {.limits_swapped = true});
    for (const auto& other : rows) {
      const std::string name = "response." + std::string(other.key);
      EXPECT_EQ(block[name], other.key == row.key ? 1 : 0) << row.key << " " << other.key;
      EXPECT_EQ(swapped[name], other.key == row.swapped ? 1 : 0) << row.key << " " << other.key;
    }
    EXPECT_EQ(block["response.latch_sel1_echo"], 1);
    EXPECT_EQ(block["response.latch_position_1"], -1000);
  }
}

// 7-7-1: Command_Data3 is feedforward by Pr7.35 but where it is Setting_Data.
TEST(Feedforward, Section7_7_1) {
  const std::string normal = command("20", "00 00 00 00 18 FC FF FF");
  EXPECT_EQ(Block::command(normal)["command.command_data3"], 0xFFFFFC18);
  EXPECT_EQ(Block::command(normal, {.feedforward = {1, 0, 0}})["command.velocity_feedforward"], -1000);
  EXPECT_EQ(Block::command(normal, {.feedforward = {2, 0, 0}})["command.torque_feedforward"], -1000);
  EXPECT_EQ(Block::command(normal, {.feedforward = {1, 0, 0}, .speed_in_units = true})
                .field("command.velocity_feedforward")
                ->unit,
            Unit::kCommandUnitPerSecond);
  const std::string read = command("26", "10 00 08 00 18 FC FF FF");
  EXPECT_EQ(Block::command(read, {.feedforward = {2, 0, 0}})["command.torque_feedforward"], -1000);
  const std::string write = command("26", "11 00 08 00 18 FC FF FF");
  EXPECT_EQ(Block::command(write, {.feedforward = {2, 0, 0}})["command.setting_data"], -1000);
}

}  // namespace
}  // namespace servotrace::rtex::oracle
