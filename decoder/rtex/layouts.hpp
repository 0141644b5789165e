// SPDX-License-Identifier: MIT
// Layouts of RTEX data blocks (SX-DSV02203 chapters 4 to 6). A block of 16 bytes is four words: header and control or
// status (0-3), data 1 (4-7), data 2 (8-11), data 3 (12-15); a 32-byte block has a sub-channel of the same shape behind
// it (16-31). Each layout is one word, laid at the offset its comment names; decode.cpp says which.
#pragma once

#include <array>
#include <span>

#include "decoder/rtex/alarms.hpp"
#include "decoder/rtex/codes.hpp"
#include "decoder/rtex/monitors.hpp"
#include "decoder/rtex/parameters.hpp"

namespace servotrace::rtex {

inline constexpr std::size_t kHeaderAt = 0;
inline constexpr std::size_t kData1At = 4;
inline constexpr std::size_t kData2At = 8;
inline constexpr std::size_t kData3At = 12;
inline constexpr std::size_t kSubHeaderAt = 16;
inline constexpr std::size_t kSubData1At = 20;
inline constexpr std::size_t kSubData2At = 24;
inline constexpr std::size_t kSubData3At = 28;
inline constexpr std::size_t kWideBlockSize = 32;  // bytes

// Command, bytes 0-3 (4-2)
inline constexpr Field kCommandFields[] = {
    number("mac_id", "MAC-ID", at(0, 0), 5, "SX-DSV02203 4-2-2"),
    number("update_counter", "Update_Counter", at(0, 5), 2, "SX-DSV02203 4-2-2-1",
           "counts up once each command updating cycle"),
    flag("cr", "C/R", at(0, 7), "SX-DSV02203 4-2-2", "0 in a command"),
    [] {
      Field field = code("non_cyclic_command", "Non-cyclic command", at(1, 0), 4, kNonCyclicNames, "SX-DSV02203 6-1");
      field.role = Role::kState;
      return field;
    }(),
    [] {
      Field field = code("cyclic_command", "Cyclic command", at(1, 4), 3, kCyclicNames, "SX-DSV02203 5-1");
      field.role = Role::kState;
      return field;
    }(),
    flag("tmg_cnt", "TMG_CNT", at(1, 7), "SX-DSV02203 4-2-1-1",
         "toggles every 2 ms in inter-axis full-synchronous mode, else 0"),
    unused("unused_2_0", at(2, 0), 2, "SX-DSV02203 4-2-3"),
    state("homing_ctrl", "Homing_Ctrl", at(2, 2), "SX-DSV02203 4-2-3", "1: the drive looks for the homing trigger"),
    state("tl_sw", "TL_SW", at(2, 3), "SX-DSV02203 4-2-3-3", "torque limit switching"),
    state("gain_sw", "Gain_SW", at(2, 4), "SX-DSV02203 4-2-3-2", "0: first gain, 1: second gain"),
    unused("unused_2_5", at(2, 5), 2, "SX-DSV02203 4-2-3"),
    state("servo_on", "Servo_On", at(2, 7), "SX-DSV02203 4-2-3-1", "1: energise the motor"),
    state("ex_out1", "EX-OUT1", at(3, 0), "SX-DSV02203 4-2-3-5"),
    state("ex_out2", "EX-OUT2", at(3, 1), "SX-DSV02203 4-2-3-5"),
    unused("unused_3_2", at(3, 2), 1, "SX-DSV02203 4-2-3"),
    state("sl_sw", "SL_SW", at(3, 3), "SX-DSV02203 4-2-3-4", "speed limit switching in torque control"),
    unused("unused_3_4", at(3, 4), 1, "SX-DSV02203 4-2-3"),
    state("pause", "Pause", at(3, 5), "SX-DSV02203 6-8-4", "PP: decelerate and wait"),
    state("smooth_stop", "Smooth_Stop", at(3, 6), "SX-DSV02203 6-8-4", "PP: decelerate and end the operation"),
    state("hard_stop", "Hard_Stop", at(3, 7), "SX-DSV02203 6-8-4", "PP: end the operation at once"),
};
inline constexpr Layout kCommand = word("command", "RTEX command", kCommandFields, "SX-DSV02203 4-2");
static_assert(well_formed(kCommand));

// Response, bytes 0-3 (4-3). Pr7.23 decides what bit 1 of byte 2 and bits 0 and 1 of byte 3 say (4-3-3-2, 4-3-4).
constexpr Field status_bit_1(std::string_view label, std::string_view explanation) {
  return state("in_progress", label, at(2, 1), "SX-DSV02203 4-3-3-2", explanation);
}
inline constexpr std::string_view kByInputs =
    "what the input is assigned to (SX-DSV02202 9-1): one of the two, or always 0";
constexpr auto response_fields(const Field& status_bit, std::string_view low, std::string_view low_explanation,
                               std::string_view high, std::string_view high_explanation) {
  return std::to_array<Field>({
      number("mac_id", "Actual MAC-ID", at(0, 0), 5, "SX-DSV02203 4-3-2", "the rotary switch at power-up, no echo"),
      number("update_counter_echo", "Update_Counter_Echo", at(0, 5), 2, "SX-DSV02203 4-3-2"),
      flag("cr", "C/R", at(0, 7), "SX-DSV02203 4-3-2", "1 in a response"),
      code("non_cyclic_command_echo", "Non-cyclic command echo", at(1, 0), 4, kNonCyclicNames, "SX-DSV02203 4-3-1"),
      code("cyclic_command_echo", "Cyclic command echo", at(1, 4), 3, kCyclicNames, "SX-DSV02203 4-3-1"),
      state("cmd_error", "CMD_Error", at(1, 7), "SX-DSV02203 4-3-1", "the command was refused"),
      state("in_position", "In_Position", at(2, 0), "SX-DSV02203 4-3-3"),
      status_bit,
      state("homing_complete", "Homing_Complete", at(2, 2), "SX-DSV02203 4-3-3"),
      state("torque_limited", "Torque_Limited", at(2, 3), "SX-DSV02203 4-3-3"),
      state("warning", "Warning", at(2, 4), "SX-DSV02203 4-3-3"),
      state("alarm", "Alarm", at(2, 5), "SX-DSV02203 4-3-3"),
      state("servo_ready", "Servo_Ready", at(2, 6), "SX-DSV02203 4-3-3-1",
            "main power on, no alarm, communication and servo synchronised"),
      state("servo_active", "Servo_Active", at(2, 7), "SX-DSV02203 4-3-3", "the motor is energised"),
      state("not_pot", low, at(3, 0), "SX-DSV02203 4-3-4", low_explanation),
      state("pot_not", high, at(3, 1), "SX-DSV02203 4-3-4", high_explanation),
      state("home", "HOME", at(3, 2), "SX-DSV02203 4-3-4"),
      state("si_mon1_ext1", "SI-MON1 / EXT1", at(3, 3), "SX-DSV02203 4-3-4", kByInputs),
      state("si_mon2_ext2", "SI-MON2 / EXT2", at(3, 4), "SX-DSV02203 4-3-4", kByInputs),
      state("si_mon3_ext3", "SI-MON3 / EXT3", at(3, 5), "SX-DSV02203 4-3-4", kByInputs),
      state("si_mon4_ex_son", "SI-MON4 / EX-SON", at(3, 6), "SX-DSV02203 4-3-4", kByInputs),
      state("si_mon5_e_stop", "SI-MON5 / E-STOP", at(3, 7), "SX-DSV02203 4-3-4", kByInputs),
  });
}
inline constexpr auto kResponseFields =
    response_fields(status_bit_1("In_Progress / AC_OFF",
                                 "Pr7.23 bit 8 = 0: a position command is being generated; 1: main power off alarm"),
                    "NOT / POT", "POT where Pr7.23 bit 3 = 1", "POT / NOT", "NOT where Pr7.23 bit 3 = 1");
inline constexpr Layout kResponse = word("response", "RTEX response", kResponseFields, "SX-DSV02203 4-3");
static_assert(well_formed(kResponse));

// The same where Pr7.23 is known: bit 3 of it, then bit 8.
constexpr auto known_response_fields(bool swapped, bool ac_off) {
  return response_fields(ac_off
                             ? status_bit_1("AC_OFF", "main power off alarm; Pr7.23 bit 8 = 1")
                             : status_bit_1("In_Progress", "a position command is being generated; Pr7.23 bit 8 = 0"),
                         swapped ? "POT" : "NOT", swapped ? "Pr7.23 bit 3 = 1" : "Pr7.23 bit 3 = 0",
                         swapped ? "NOT" : "POT", swapped ? "Pr7.23 bit 3 = 1" : "Pr7.23 bit 3 = 0");
}
inline constexpr auto kResponseFieldsIn = known_response_fields(false, false);
inline constexpr auto kResponseFieldsSwapped = known_response_fields(true, false);
inline constexpr auto kResponseFieldsOff = known_response_fields(false, true);
inline constexpr auto kResponseFieldsSwappedOff = known_response_fields(true, true);
inline constexpr Layout kResponseForms[] = {
    word("response", "RTEX response (In_Progress; POT above NOT)", kResponseFieldsIn, "SX-DSV02203 4-3"),
    word("response", "RTEX response (In_Progress; NOT above POT)", kResponseFieldsSwapped, "SX-DSV02203 4-3"),
    word("response", "RTEX response (AC_OFF; POT above NOT)", kResponseFieldsOff, "SX-DSV02203 4-3"),
    word("response", "RTEX response (AC_OFF; NOT above POT)", kResponseFieldsSwappedOff, "SX-DSV02203 4-3"),
};
// True for bytes 0-3 of a response, whatever is known of Pr7.23.
constexpr bool is_response_header(const Layout& layout) {
  if (&layout == &kResponse) return true;
  for (const Layout& form : kResponseForms) {
    if (&layout == &form) return true;
  }
  return false;
}

// --- Command_Data1, bytes 4-7 -----------------------------------------------------------------------------------
inline constexpr Field kRawData1Fields[] = {hex("command_data1", "Command_Data1", 0, 32, "SX-DSV02203 4-2")};
inline constexpr Layout kRawData1 = word("command", "Command_Data1", kRawData1Fields, "SX-DSV02203 5-2");  // NOP, 5-7
inline constexpr Field kTargetPositionFields[] = {signal("target_position", "Target position (TPOS)",
                                                         Unit::kCommandUnit, "SX-DSV02203 5-3",
                                                         "a distance for profile 11h and 13h")};
inline constexpr Layout kTargetPosition =
    word("command", "Command_Data1 (PP)", kTargetPositionFields, "SX-DSV02203 5-3");
inline constexpr Field kCommandPositionFields[] = {
    signal("command_position", "Command position (CPOS)", Unit::kCommandUnit, "SX-DSV02203 5-4")};
inline constexpr Layout kCommandPosition =
    word("command", "Command_Data1 (CP)", kCommandPositionFields, "SX-DSV02203 5-4");
inline constexpr Field kCommandSpeedFields[] = {
    signal("command_speed", "Command speed (CSPD)", Unit::kRevolutionsPerMinute, "SX-DSV02203 5-5")};
inline constexpr Layout kCommandSpeed = word("command", "Command_Data1 (CV)", kCommandSpeedFields, "SX-DSV02203 5-5");
inline constexpr Field kCommandSpeedUnitsFields[] = {
    signal("command_speed", "Command speed (CSPD)", Unit::kCommandUnitPerSecond, "SX-DSV02203 5-5", "Pr7.25 = 1")};
inline constexpr Layout kCommandSpeedUnits =
    word("command", "Command_Data1 (CV)", kCommandSpeedUnitsFields, "SX-DSV02203 5-5");
inline constexpr Field kCommandTorqueFields[] = {
    torque_signal("command_torque", "Command torque (CTRQ)", "SX-DSV02203 5-6")};
inline constexpr Layout kCommandTorque = word("command", "Command_Data1 (CT)", kCommandTorqueFields, "SX-DSV02203 5-6");

// --- Command_Data2, bytes 8-11 ----------------------------------------------------------------------------------
inline constexpr Field kRawData2Fields[] = {
    hex("command_data2", "Command_Data2", 0, 32, "SX-DSV02203 6-2", "free in a normal command")};
inline constexpr Layout kRawData2 = word("command", "Command_Data2", kRawData2Fields, "SX-DSV02203 6-2");

inline constexpr Field kResetFields[] = {
    code("type_code", "Type_Code", at(0), 12, kResetTypes, "SX-DSV02203 6-3"),
    unused("unused_9_4", at(1, 4), 4, "SX-DSV02203 6-3"),
    hex("index", "Index", at(2), 16, "SX-DSV02203 6-3", "0"),
};
inline constexpr Layout kReset = word("command", "Reset command", kResetFields, "SX-DSV02203 6-3");
inline constexpr Field kSystemIdFields[] = {
    code("type_code", "Type_Code", at(0), 12, kSystemIdTypes, "SX-DSV02203 6-4-1"),
    unused("unused_9_4", at(1, 4), 4, "SX-DSV02203 6-4"),
    number("index", "Index", at(2), 16, "SX-DSV02203 6-4", "n: characters 4n to 4n + 3"),
};
inline constexpr Layout kSystemId = word("command", "System ID command", kSystemIdFields, "SX-DSV02203 6-4");
inline constexpr Field kHomingFields[] = {
    code("type_code", "Type_Code", at(0), 12, kHomingTypes, "SX-DSV02203 6-5-1"),
    unused("unused_9_4", at(1, 4), 4, "SX-DSV02203 6-5"),
    code("latch_sel1", "Latch_Sel1", at(2, 0), 4, kLatchTriggers, "SX-DSV02203 6-5-4-2"),
    code("latch_sel2", "Latch_Sel2", at(2, 4), 4, kLatchTriggers, "SX-DSV02203 6-5-4-2"),
    code("monitor_sel", "Monitor_Sel", at(3), 8, kShortMonitorTypes, "SX-DSV02203 6-5-4-3"),
};
inline constexpr Layout kHoming = word("command", "Homing command", kHomingFields, "SX-DSV02203 6-5");
inline constexpr Field kAlarmFields[] = {
    code("type_code", "Type_Code", at(0), 12, kAlarmTypes, "SX-DSV02203 6-6-1"),
    unused("unused_9_4", at(1, 4), 4, "SX-DSV02203 6-6"),
    number("index", "Index", at(2), 16, "SX-DSV02203 6-6-1", "0: present, 1 to 14: history"),
};
inline constexpr Layout kAlarm = word("command", "Alarm command", kAlarmFields, "SX-DSV02203 6-6");
inline constexpr Field kAlarmAttributeFields[] = {
    code("type_code", "Type_Code", at(0), 12, kAlarmTypes, "SX-DSV02203 6-6-1"),
    unused("unused_9_4", at(1, 4), 4, "SX-DSV02203 6-6"),
    number("alarm_main", "Index: alarm main number", at(2), 8, "SX-DSV02203 6-6-1", "0: the present alarm"),
    number("alarm_sub", "Index: alarm sub number", at(3), 8, "SX-DSV02203 6-6-1"),
};
inline constexpr Layout kAlarmAttributeCommand =
    word("command", "Alarm command (attribute)", kAlarmAttributeFields, "SX-DSV02203 6-6");
inline constexpr Field kParameterFields[] = {
    code("type_code", "Type_Code", at(0), 12, kParameterTypes, "SX-DSV02203 6-7-1"),
    unused("unused_9_4", at(1, 4), 4, "SX-DSV02203 6-7"),
    code("parameter", "Index: parameter", at(2), 16, kParameterNames, "SX-DSV02203 6-7-2", "class << 8 | number"),
};
inline constexpr Layout kParameter = word("command", "Parameter command", kParameterFields, "SX-DSV02203 6-7");
inline constexpr Field kProfileFields[] = {
    code("type_code", "Type_Code", at(0), 12, kProfileTypes, "SX-DSV02203 6-8-1"),
    unused("unused_9_4", at(1, 4), 4, "SX-DSV02203 6-8"),
    code("latch_sel1", "Latch_Sel1", at(2, 0), 4, kLatchTriggers, "SX-DSV02203 6-8-2"),
    unused("unused_10_4", at(2, 4), 4, "SX-DSV02203 6-8"),
    code("monitor_sel", "Monitor_Sel", at(3), 8, kShortMonitorTypes, "SX-DSV02203 6-8-3"),
};
inline constexpr Layout kProfile = word("command", "Profile command", kProfileFields, "SX-DSV02203 6-8");
inline constexpr Field kMonitorFieldsCommand[] = {
    code("type_code", "Type_Code", at(0), 12, kMonitorTypes, "SX-DSV02203 6-9-1"),
    unused("unused_9_4", at(1, 4), 4, "SX-DSV02203 6-9"),
    number("index", "Index", at(2), 16, "SX-DSV02203 6-9-1"),
};
inline constexpr Layout kMonitor = word("command", "Monitor command", kMonitorFieldsCommand, "SX-DSV02203 6-9");

// --- Command_Data3, bytes 12-15 (7-7-1); "command" and, at 24 and 28, "sub_command" --------------------------------
inline constexpr Field kRawData3Fields[] = {
    hex("command_data3", "Command_Data3", 0, 32, "SX-DSV02203 7-7-1", "0 where Pr7.35 = 0")};
inline constexpr Layout kRawData3 = word("command", "Command_Data3", kRawData3Fields, "SX-DSV02203 7-7-1");
inline constexpr Field kSettingDataFields[] = {setting("setting_data", "Setting_Data", "SX-DSV02203 6-5, 6-7")};
inline constexpr Layout kSettingData = word("command", "Setting_Data", kSettingDataFields, "SX-DSV02203 6-7");
inline constexpr Field kTargetSpeedFields[] = {
    signal("target_speed", "Target speed (TSPD)", Unit::kRevolutionsPerMinute, "SX-DSV02203 6-8")};
inline constexpr Layout kTargetSpeed = word("command", "Target speed", kTargetSpeedFields, "SX-DSV02203 6-8");
inline constexpr Field kTargetSpeedUnitsFields[] = {
    signal("target_speed", "Target speed (TSPD)", Unit::kCommandUnitPerSecond, "SX-DSV02203 6-8", "Pr7.25 = 1")};
inline constexpr Layout kTargetSpeedUnits = word("command", "Target speed", kTargetSpeedUnitsFields, "SX-DSV02203 6-8");
inline constexpr Field kVelocityForwardFields[] = {
    signal("velocity_feedforward", "Velocity feedforward (VFF)", Unit::kRevolutionsPerMinute, "SX-DSV02203 7-7-2")};
inline constexpr Field kVelocityForwardUnitsFields[] = {signal("velocity_feedforward", "Velocity feedforward (VFF)",
                                                               Unit::kCommandUnitPerSecond, "SX-DSV02203 7-7-2",
                                                               "Pr7.25 = 1")};
inline constexpr Field kTorqueForwardFields[] = {
    torque_signal("torque_feedforward", "Torque feedforward (TFF)", "SX-DSV02203 7-7-2")};
// [sub channel]
inline constexpr Layout kVelocityForward[2] = {
    word("command", "Velocity feedforward", kVelocityForwardFields, "SX-DSV02203 7-7-1"),
    word("sub_command", "Velocity feedforward", kVelocityForwardFields, "SX-DSV02203 7-7-1")};
inline constexpr Layout kVelocityForwardUnits[2] = {
    word("command", "Velocity feedforward", kVelocityForwardUnitsFields, "SX-DSV02203 7-7-1"),
    word("sub_command", "Velocity feedforward", kVelocityForwardUnitsFields, "SX-DSV02203 7-7-1")};
inline constexpr Layout kTorqueForward[2] = {
    word("command", "Torque feedforward", kTorqueForwardFields, "SX-DSV02203 7-7-1"),
    word("sub_command", "Torque feedforward", kTorqueForwardFields, "SX-DSV02203 7-7-1")};

// --- Response data without a monitor name ---------------------------------------------------------------------------
inline constexpr Field kRawResponse1Fields[] = {hex("response_data1", "Response_Data1", 0, 32, "SX-DSV02203 4-3-1")};
inline constexpr Layout kRawResponse1 = word("response", "Response_Data1", kRawResponse1Fields, "SX-DSV02203 4-3-1");
inline constexpr Field kRawResponse2Fields[] = {hex("response_data2", "Response_Data2", 0, 32, "SX-DSV02203 4-3-1")};
inline constexpr Layout kRawResponse2 = word("response", "Response_Data2", kRawResponse2Fields, "SX-DSV02203 4-3-1");
inline constexpr Field kRawResponse3Fields[] = {hex("response_data3", "Response_Data3", 0, 32, "SX-DSV02203 4-3-1")};
inline constexpr Layout kRawResponse3 = word("response", "Response_Data3", kRawResponse3Fields, "SX-DSV02203 4-3-1");

// --- Response_Data2 of non-cyclic commands, bytes 8-11 (3-3-2) ------------------------------------------------------
constexpr Field busy() {
  return state("busy", "Busy", at(1, 4), "SX-DSV02203 3-3-2", "the command is being processed");
}
constexpr Field unused_9_5() { return unused("unused_9_5", at(1, 5), 1, "SX-DSV02203 3-3-2"); }
constexpr Field wng() { return flag("wng", "WNG", at(1, 6), "SX-DSV02203 3-3-2", "processed, but with a restriction"); }
constexpr Field err() { return flag("err", "ERR", at(1, 7), "SX-DSV02203 3-3-2", "an error while processing"); }
constexpr Field type_echo(std::uint16_t width, std::span<const ValueName> names, std::string_view section) {
  return code("type_code_echo", "Type_Code_Echo", at(0), width, names, section);
}
// The part every non-cyclic response but homing's and profile's shares.
constexpr Field index_echo(std::string_view section) { return hex("index_echo", "Index_Echo", at(2), 16, section); }

inline constexpr Field kResetEchoFields[] = {
    type_echo(12, kResetTypes, "SX-DSV02203 6-3"), busy(), unused_9_5(), wng(), err(), index_echo("SX-DSV02203 6-3")};
inline constexpr Layout kResetEcho = word("response", "Reset response", kResetEchoFields, "SX-DSV02203 6-3");
inline constexpr Field kSystemIdEchoFields[] = {type_echo(12, kSystemIdTypes, "SX-DSV02203 6-4"),
                                                busy(),
                                                unused_9_5(),
                                                wng(),
                                                err(),
                                                index_echo("SX-DSV02203 6-4")};
inline constexpr Layout kSystemIdEcho = word("response", "System ID response", kSystemIdEchoFields, "SX-DSV02203 6-4");
inline constexpr Field kHomingEchoFields[] = {
    type_echo(8, kHomingTypes, "SX-DSV02203 6-5"),
    state("latch_comp1", "Latch_Comp1", at(1, 0), "SX-DSV02203 6-5-4-3"),
    state("latch_comp2", "Latch_Comp2", at(1, 1), "SX-DSV02203 6-5-4-3"),
    unused("unused_9_2", at(1, 2), 2, "SX-DSV02203 6-5"),
    busy(),
    unused_9_5(),
    wng(),
    err(),
    code("latch_sel1_echo", "Latch_Sel1_Echo", at(2, 0), 4, kLatchTriggers, "SX-DSV02203 6-5-4-2"),
    code("latch_sel2_echo", "Latch_Sel2_Echo", at(2, 4), 4, kLatchTriggers, "SX-DSV02203 6-5-4-2"),
    code("monitor_sel_echo", "Monitor_Sel_Echo", at(3), 8, kShortMonitorTypes, "SX-DSV02203 6-5-4-3"),
};
inline constexpr Layout kHomingEcho = word("response", "Homing response", kHomingEchoFields, "SX-DSV02203 6-5");
inline constexpr Field kAlarmEchoFields[] = {
    type_echo(12, kAlarmTypes, "SX-DSV02203 6-6"), busy(), unused_9_5(), wng(), err(), index_echo("SX-DSV02203 6-6")};
inline constexpr Layout kAlarmEcho = word("response", "Alarm response", kAlarmEchoFields, "SX-DSV02203 6-6");
inline constexpr Field kAlarmAttributeEchoFields[] = {
    type_echo(12, kAlarmTypes, "SX-DSV02203 6-6"),
    busy(),
    unused_9_5(),
    wng(),
    err(),
    number("alarm_main_echo", "Index_Echo: alarm main number", at(2), 8, "SX-DSV02203 6-6-1",
           "asked with 0: the present alarm's"),
    number("alarm_sub_echo", "Index_Echo: alarm sub number", at(3), 8, "SX-DSV02203 6-6-1"),
};
inline constexpr Layout kAlarmAttributeEcho =
    word("response", "Alarm response (attribute)", kAlarmAttributeEchoFields, "SX-DSV02203 6-6");
inline constexpr Field kParameterEchoFields[] = {
    type_echo(12, kParameterTypes, "SX-DSV02203 6-7"),
    busy(),
    unused_9_5(),
    wng(),
    err(),
    code("parameter_echo", "Index_Echo: parameter", at(2), 16, kParameterNames, "SX-DSV02203 6-7-2"),
};
inline constexpr Layout kParameterEcho =
    word("response", "Parameter response", kParameterEchoFields, "SX-DSV02203 6-7");

constexpr Field near_flag() {
  return state("near", "NEAR", at(1, 1), "SX-DSV02203 6-8-5", "the command position is near the target position");
}
constexpr Field psl(std::uint16_t bit) {
  return state("psl", "PSL", bit, "SX-DSV02203 6-8-6", "beyond the positive software limit");
}
constexpr Field nsl(std::uint16_t bit) {
  return state("nsl", "NSL", bit, "SX-DSV02203 6-8-6", "beyond the negative software limit");
}
inline constexpr Field kProfileEchoFields[] = {
    type_echo(8, kProfileTypes, "SX-DSV02203 6-8"),
    state("latch_comp1", "Latch_Comp1", at(1, 0), "SX-DSV02203 6-8-3"),
    near_flag(),
    nsl(at(1, 2)),
    psl(at(1, 3)),
    busy(),
    unused_9_5(),
    wng(),
    err(),
    code("latch_sel1_echo", "Latch_Sel1_Echo", at(2, 0), 4, kLatchTriggers, "SX-DSV02203 6-8-2"),
    unused("unused_10_4", at(2, 4), 4, "SX-DSV02203 6-8"),
    code("monitor_sel_echo", "Monitor_Sel_Echo", at(3), 8, kShortMonitorTypes, "SX-DSV02203 6-8-3"),
};
inline constexpr Layout kProfileEcho = word("response", "Profile response", kProfileEchoFields, "SX-DSV02203 6-8");
// Pr7.23 bit 7 = 1: PSL and NSL change places.
inline constexpr Field kProfileEchoSwappedFields[] = {
    type_echo(8, kProfileTypes, "SX-DSV02203 6-8"),
    state("latch_comp1", "Latch_Comp1", at(1, 0), "SX-DSV02203 6-8-3"),
    near_flag(),
    psl(at(1, 2)),
    nsl(at(1, 3)),
    busy(),
    unused_9_5(),
    wng(),
    err(),
    code("latch_sel1_echo", "Latch_Sel1_Echo", at(2, 0), 4, kLatchTriggers, "SX-DSV02203 6-8-2"),
    unused("unused_10_4", at(2, 4), 4, "SX-DSV02203 6-8"),
    code("monitor_sel_echo", "Monitor_Sel_Echo", at(3), 8, kShortMonitorTypes, "SX-DSV02203 6-8-3"),
};
inline constexpr Layout kProfileEchoSwapped =
    word("response", "Profile response (PSL and NSL swapped)", kProfileEchoSwappedFields, "SX-DSV02203 6-8-6");
inline constexpr Field kMonitorEchoFields[] = {
    type_echo(12, kMonitorTypes, "SX-DSV02203 6-9"), busy(), unused_9_5(), wng(), err(), index_echo("SX-DSV02203 6-9")};
inline constexpr Layout kMonitorEcho = word("response", "Monitor response", kMonitorEchoFields, "SX-DSV02203 6-9");

// Command error, bytes 8-11 and 12-15 (6-10)
inline constexpr Field kErrorFields[] = {
    code("error_code", "Error_Code", at(0), 16, kCommandErrors, "SX-DSV02203 6-10-2"),
    unused("unused_10", at(2), 16, "SX-DSV02203 6-10"),
};
inline constexpr Layout kError = word("response", "Command error", kErrorFields, "SX-DSV02203 6-10");
inline constexpr Field kZero3Fields[] = {unused("unused_12", 0, 32, "SX-DSV02203 6-10")};
inline constexpr Layout kZero3 = word("response", "Response_Data3 (0)", kZero3Fields, "SX-DSV02203 6-10");
// Communication error, bytes 8-11 (6-11)
inline constexpr Field kZero2Fields[] = {unused("unused_8", 0, 32, "SX-DSV02203 6-11")};
inline constexpr Layout kCommunicationError = word("response", "Communication error", kZero2Fields, "SX-DSV02203 6-11");

// --- Monitor_Data of non-cyclic commands, bytes 12-15; system ID and raw also at 20 for the sub channel -------------
inline constexpr Field kCharactersFields[] = {{.key = "characters",
                                               .label = "Characters",
                                               .first_bit = 0,
                                               .width = 32,
                                               .kind = Kind::kText,
                                               .section = "SX-DSV02203 6-4",
                                               .explanation = "ASCII, NUL at the end"}};
inline constexpr Layout kCharacters[2] = {word("response", "System ID", kCharactersFields, "SX-DSV02203 6-4"),
                                          word("sub_response", "System ID", kCharactersFields, "SX-DSV02203 6-4")};
inline constexpr Field kRawMonitorFields[] = {
    hex("monitor_data", "Monitor_Data", 0, 32, "SX-DSV02203 6-9", "a value the manual does not name")};
inline constexpr Layout kRawMonitor[2] = {
    word("response", "Monitor_Data", kRawMonitorFields, "SX-DSV02203 6-9"),
    word("sub_response", "Sub_Monitor_Data", kRawMonitorFields, "SX-DSV02203 6-9")};
inline constexpr Field kPositionEchoFields[] = {
    setting("setting_data_echo", "Setting_Data echo", "SX-DSV02203 6-5", {}, Unit::kCommandUnit)};
inline constexpr Layout kPositionEcho = word("response", "Position set", kPositionEchoFields, "SX-DSV02203 6-5");
inline constexpr Field kAlarmCodeFields[] = {
    [] {
      Field field = number("alarm_main", "Alarm_Code main number", at(0), 8, "SX-DSV02203 6-6-2");
      field.values = kAlarmMainNames;
      return field;
    }(),
    number("alarm_sub", "Alarm_Code sub number", at(1), 8, "SX-DSV02203 6-6-2", "always 0 where Pr7.23 bit 1 = 0"),
    code("warning_code", "Warning_Code", at(2), 16, kWarningNames, "SX-DSV02203 8-2"),
};
inline constexpr Layout kAlarmCode = word("response", "Alarm and warning code", kAlarmCodeFields, "SX-DSV02203 6-6");
inline constexpr Field kAlarmAttributeDataFields[] = {
    hex("attribute_bits_0_4", "Bits 0-4", at(0, 0), 5, "SX-DSV02203 6-6-3"),
    flag("emergency_stop", "EMG-STP", at(0, 5), "SX-DSV02203 6-6-3", "the alarm stops the motor at once"),
    flag("not_clearable", "NOT_ACLR", at(0, 6), "SX-DSV02203 6-6-3", "the alarm cannot be cleared"),
    flag("not_recorded", "NOT_REC", at(0, 7), "SX-DSV02203 6-6-3", "the alarm is not kept in the history"),
    hex("attribute_bits_8_31", "Bits 8-31", at(1, 0), 24, "SX-DSV02203 6-6-3"),
};
inline constexpr Layout kAlarmAttributeData =
    word("response", "Alarm attribute", kAlarmAttributeDataFields, "SX-DSV02203 6-6-3");
inline constexpr Field kParameterValueFields[] = {
    setting("parameter_value", "Parameter value", "SX-DSV02203 6-7", "unstable while Busy = 1")};
inline constexpr Layout kParameterValue = word("response", "Parameter value", kParameterValueFields, "SX-DSV02203 6-7");
inline constexpr Field kParameterCountFields[] = {
    number("parameter_count", "Number of parameters in the class", 0, 32, "SX-DSV02203 6-7-3")};
inline constexpr Layout kParameterCountData =
    word("response", "Number of parameters", kParameterCountFields, "SX-DSV02203 6-7-3");
inline constexpr Field kParameterAttributeFields[] = {
    hex("parameter_attribute_bits_0_2", "Bits 0-2", at(0, 0), 3, "SX-DSV02203 6-7-4"),
    flag("manufacturer_3", "Manufacturer use", at(0, 3), "SX-DSV02203 6-7-4"),
    flag("valid_at_reset", "B_AT_INIT", at(0, 4), "SX-DSV02203 6-7-4", "valid after a reset: attribute C or R"),
    hex("parameter_attribute_bit_5", "Bit 5", at(0, 5), 1, "SX-DSV02203 6-7-4"),
    flag("manufacturer_6", "Manufacturer use", at(0, 6), "SX-DSV02203 6-7-4"),
    flag("not_used", "NOT_USE", at(0, 7), "SX-DSV02203 6-7-4"),
    flag("read_only", "READ_ONLY", at(1, 0), "SX-DSV02203 6-7-4"),
    hex("parameter_attribute_bits_9_11", "Bits 9-11", at(1, 1), 3, "SX-DSV02203 6-7-4"),
    flag("valid_at_validation", "B_PRM_ATB_CFG", at(1, 4), "SX-DSV02203 6-7-4",
         "valid after an attribute C validation: attribute C"),
    hex("parameter_attribute_bits_13_14", "Bits 13-14", at(1, 5), 2, "SX-DSV02203 6-7-4"),
    flag("is_32bit", "PARA_32BIT", at(1, 7), "SX-DSV02203 6-7-4"),
    hex("parameter_attribute_bits_16_31", "Bits 16-31", at(2), 16, "SX-DSV02203 6-7-4"),
};
inline constexpr Layout kParameterAttributeData =
    word("response", "Parameter attribute", kParameterAttributeFields, "SX-DSV02203 6-7-4");

// --- Sub-channel, bytes 16-31 (4-4, 4-5) ----------------------------------------------------------------------------
// `names`: of the Sub_Type_Code, which depends on the sub-command.
constexpr auto sub_command_fields(std::span<const ValueName> names) {
  Field command = code("command", "Sub_Command_Code", at(0, 0), 4, kSubCommandNames, "SX-DSV02203 4-4-1");
  command.role = Role::kState;
  return std::to_array<Field>({
      command,
      unused("unused_16_4", at(0, 4), 3, "SX-DSV02203 4-4"),
      flag("sub_chk", "Sub_Chk", at(0, 7), "SX-DSV02203 4-4-1", "1 in a 32-byte command"),
      code("type_code", "Sub_Type_Code", at(1), 8, names, "SX-DSV02203 4-4-1"),
      number("index", "Sub_Index", at(2), 16, "SX-DSV02203 4-4-1"),
  });
}
inline constexpr auto kSubCommandFields = sub_command_fields({});
inline constexpr auto kSubSystemIdFields = sub_command_fields(kShortSystemIdTypes);
inline constexpr auto kSubMonitorFields = sub_command_fields(kShortMonitorTypes);
inline constexpr Layout kSubCommand = word("sub_command", "RTEX sub-command", kSubCommandFields, "SX-DSV02203 4-4");
inline constexpr Layout kSubSystemId =
    word("sub_command", "RTEX sub-command (System ID)", kSubSystemIdFields, "SX-DSV02203 6-4");
inline constexpr Layout kSubMonitor =
    word("sub_command", "RTEX sub-command (Monitor)", kSubMonitorFields, "SX-DSV02203 6-9");
static_assert(well_formed(kSubCommand));
inline constexpr Field kSubData1Fields[] = {
    hex("sub_command_data1", "Sub_Command_Data1", 0, 32, "SX-DSV02203 4-4-1", "0 for system ID and monitor")};
inline constexpr Layout kSubData1 = word("sub_command", "Sub_Command_Data1", kSubData1Fields, "SX-DSV02203 4-4-1");
inline constexpr Field kSubData2Fields[] = {
    hex("sub_command_data2", "Sub_Command_Data2", 0, 32, "SX-DSV02203 4-4-1", "0 where Pr7.36 = 0")};
inline constexpr Layout kSubData2 = word("sub_command", "Sub_Command_Data2", kSubData2Fields, "SX-DSV02203 4-4-1");
inline constexpr Field kSubData3Fields[] = {
    hex("sub_command_data3", "Sub_Command_Data3", 0, 32, "SX-DSV02203 4-4-1", "0 where Pr7.37 = 0")};
inline constexpr Layout kSubData3 = word("sub_command", "Sub_Command_Data3", kSubData3Fields, "SX-DSV02203 4-4-1");

constexpr auto sub_response_fields(std::span<const ValueName> names) {
  return std::to_array<Field>({
      code("command_echo", "Sub_Command_Code_Echo", at(0, 0), 4, kSubCommandNames, "SX-DSV02203 4-5-1"),
      state("busy", "Sub_Busy", at(0, 4), "SX-DSV02203 4-5-1"),
      flag("wng", "Sub_WNG", at(0, 5), "SX-DSV02203 4-5-1"),
      flag("err", "Sub_ERR", at(0, 6), "SX-DSV02203 4-5-1"),
      state("cmd_err", "Sub_CMD_Err", at(0, 7), "SX-DSV02203 4-5-1"),
      code("type_code_echo", "Sub_Type_Code_Echo", at(1), 8, names, "SX-DSV02203 4-5-1"),
      number("index_echo", "Sub_Index_Echo", at(2), 16, "SX-DSV02203 4-5-1"),
  });
}
inline constexpr auto kSubResponseFields = sub_response_fields({});
inline constexpr auto kSubSystemIdEchoFields = sub_response_fields(kShortSystemIdTypes);
inline constexpr auto kSubMonitorEchoFields = sub_response_fields(kShortMonitorTypes);
inline constexpr Layout kSubResponse = word("sub_response", "RTEX sub-response", kSubResponseFields, "SX-DSV02203 4-5");
inline constexpr Layout kSubSystemIdEcho =
    word("sub_response", "RTEX sub-response (System ID)", kSubSystemIdEchoFields, "SX-DSV02203 6-4");
inline constexpr Layout kSubMonitorEcho =
    word("sub_response", "RTEX sub-response (Monitor)", kSubMonitorEchoFields, "SX-DSV02203 6-9");
static_assert(well_formed(kSubResponse));
// Sub_CMD_Err = 1 (6-10)
inline constexpr Field kSubErrorFields[] = {
    code("command_echo", "Sub_Command_Code_Echo", at(0, 0), 4, kSubCommandNames, "SX-DSV02203 6-10"),
    state("busy", "Sub_Busy", at(0, 4), "SX-DSV02203 6-10"),
    flag("wng", "Sub_WNG", at(0, 5), "SX-DSV02203 6-10"),
    flag("err", "Sub_ERR", at(0, 6), "SX-DSV02203 6-10"),
    state("cmd_err", "Sub_CMD_Err", at(0, 7), "SX-DSV02203 6-10"),
    unused("unused_17", at(1), 8, "SX-DSV02203 6-10"),
    code("error_code", "Sub_Error_Code", at(2), 16, kCommandErrors, "SX-DSV02203 6-10-2"),
};
inline constexpr Layout kSubError = word("sub_response", "RTEX sub-command error", kSubErrorFields, "SX-DSV02203 6-10");
static_assert(well_formed(kSubError));
inline constexpr Field kSubZero1Fields[] = {unused("unused_20", 0, 32, "SX-DSV02203 4-5-1")};
inline constexpr Layout kSubZero1 =
    word("sub_response", "Sub_Response_Data1 (0)", kSubZero1Fields, "SX-DSV02203 4-5-1");
inline constexpr Field kSubZero2Fields[] = {
    hex("sub_response_data2", "Sub_Response_Data2", 0, 32, "SX-DSV02203 4-5-1", "0 where Pr7.33 = 0")};
inline constexpr Layout kSubRaw2 = word("sub_response", "Sub_Response_Data2", kSubZero2Fields, "SX-DSV02203 4-5-1");
inline constexpr Field kSubZero3Fields[] = {
    hex("sub_response_data3", "Sub_Response_Data3", 0, 32, "SX-DSV02203 4-5-1", "0 where Pr7.34 = 0")};
inline constexpr Layout kSubRaw3 = word("sub_response", "Sub_Response_Data3", kSubZero3Fields, "SX-DSV02203 4-5-1");
inline constexpr Field kSubRaw1Fields[] = {
    hex("sub_response_data1", "Sub_Response_Data1", 0, 32, "SX-DSV02203 4-5-1", "0 where Pr7.32 = 0")};
inline constexpr Layout kSubRaw1 = word("sub_response", "Sub_Response_Data1", kSubRaw1Fields, "SX-DSV02203 4-5-1");

// Every layout of this protocol, the record header's included.
std::span<const Layout* const> layouts();
// Fields no single frame holds.
std::span<const Field* const> derived();

}  // namespace servotrace::rtex
