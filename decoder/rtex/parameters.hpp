// SPDX-License-Identifier: MIT
// The parameters SX-DSV02203 names, the bits of Pr7.22 to Pr7.24 and the choices of Pr7.29 to Pr7.37. An index is class
// << 8 | number: Pr7.23 is 0717h.
#pragma once

#include <array>

#include "decoder/rtex/monitors.hpp"

namespace servotrace::rtex {

// 6-7-4. kUnknown: the manual does not print it.
enum class Attribute : std::uint8_t { kUnknown, kA, kB, kC, kR, kReadOnly };

constexpr std::uint16_t pr(unsigned parameter_class, unsigned parameter_number) {
  return static_cast<std::uint16_t>(parameter_class << 8U | parameter_number);
}

struct ParameterRow {
  std::uint16_t index = 0;
  Attribute attribute = Attribute::kUnknown;
  std::string_view section;
};

// Sorted by index.
inline constexpr ValueName kParameterNames[] = {
    {pr(0, 0), "Pr0.00 rotational direction setup"},
    {pr(0, 1), "Pr0.01 control mode setup"},
    {pr(0, 2), "Pr0.02 real-time auto-gain tuning setup"},
    {pr(0, 4), "Pr0.04 inertia ratio"},
    {pr(0, 8), "Pr0.08 number of command pulses per motor revolution"},
    {pr(0, 13), "Pr0.13 1st torque limit"},
    {pr(0, 15), "Pr0.15 absolute encoder setup"},
    {pr(1, 14), "Pr1.14 2nd gain setup"},
    {pr(1, 15), "Pr1.15 mode of position control switching"},
    {pr(1, 20), "Pr1.20 mode of velocity control switching"},
    {pr(1, 24), "Pr1.24 mode of torque control switching"},
    {pr(3, 12), "Pr3.12 acceleration time setting"},
    {pr(3, 13), "Pr3.13 deceleration time setting"},
    {pr(3, 14), "Pr3.14 S-curve acceleration/deceleration"},
    {pr(3, 17), "Pr3.17 selection of speed limit"},
    {pr(3, 21), "Pr3.21 speed limit value"},
    {pr(3, 22), "Pr3.22 speed limit value 2"},
    {pr(4, 31), "Pr4.31 positioning complete range"},
    {pr(4, 32), "Pr4.32 positioning complete output setup"},
    {pr(4, 33), "Pr4.33 INP hold time"},
    {pr(4, 35), "Pr4.35 speed coincidence range"},
    {pr(5, 4), "Pr5.04 over-travel inhibit input setup"},
    {pr(5, 5), "Pr5.05 sequence at over-travel inhibit"},
    {pr(5, 13), "Pr5.13 over-speed level setup"},
    {pr(5, 20), "Pr5.20 position setup unit select"},
    {pr(5, 21), "Pr5.21 selection of torque limit"},
    {pr(5, 22), "Pr5.22 2nd torque limit"},
    {pr(5, 25), "Pr5.25 external input positive direction torque limit"},
    {pr(5, 26), "Pr5.26 external input negative direction torque limit"},
    {pr(6, 27), "Pr6.27 warning latch state setup"},
    {pr(6, 38), "Pr6.38 warning mask setup"},
    {pr(7, 0), "Pr7.00 display on LED"},
    {pr(7, 3), "Pr7.03 output setup during torque limit"},
    {pr(7, 10), "Pr7.10 profile software limit function"},
    {pr(7, 11), "Pr7.11 profile positive side software limit value"},
    {pr(7, 12), "Pr7.12 profile negative side software limit value"},
    {pr(7, 13), "Pr7.13 absolute home position offset"},
    {pr(7, 15), "Pr7.15 profile positioning neighborhood range"},
    {pr(7, 20), "Pr7.20 RTEX communication cycle setup"},
    {pr(7, 21), "Pr7.21 RTEX command updating cycle ratio setup"},
    {pr(7, 22), "Pr7.22 RTEX function expansion setup 1"},
    {pr(7, 23), "Pr7.23 RTEX function expansion setup 2"},
    {pr(7, 24), "Pr7.24 RTEX function expansion setup 3"},
    {pr(7, 25), "Pr7.25 RTEX speed unit setup"},
    {pr(7, 26), "Pr7.26 RTEX continuous communication error warning setup"},
    {pr(7, 27), "Pr7.27 RTEX accumulated communication error warning setup"},
    {pr(7, 28), "Pr7.28 RTEX Update_Counter error warning setup"},
    {pr(7, 29), "Pr7.29 RTEX monitor select 1"},
    {pr(7, 30), "Pr7.30 RTEX monitor select 2"},
    {pr(7, 31), "Pr7.31 RTEX monitor select 3"},
    {pr(7, 32), "Pr7.32 RTEX monitor select 4"},
    {pr(7, 33), "Pr7.33 RTEX monitor select 5"},
    {pr(7, 34), "Pr7.34 RTEX monitor select 6"},
    {pr(7, 35), "Pr7.35 RTEX command setup 1"},
    {pr(7, 36), "Pr7.36 RTEX command setup 2"},
    {pr(7, 37), "Pr7.37 RTEX command setup 3"},
    {pr(7, 38), "Pr7.38 RTEX Update_Counter error protection setup"},
    {pr(8, 1), "Pr8.01 profile linear acceleration constant"},
    {pr(8, 4), "Pr8.04 profile linear deceleration constant"},
    {pr(8, 10), "Pr8.10 amount of travel after profile position latch detection"},
    {pr(8, 12), "Pr8.12 profile return to home position mode setup"},
    {pr(8, 13), "Pr8.13 profile home position return velocity 1"},
    {pr(8, 14), "Pr8.14 profile home position return velocity 2"},
};

// The attributes the manual prints, sorted by index.
inline constexpr ParameterRow kParameters[] = {
    {pr(0, 1), Attribute::kR, "SX-DSV02203 2-5-2"},    {pr(0, 8), Attribute::kC, "SX-DSV02203 6-7-4"},
    {pr(1, 14), Attribute::kB, "SX-DSV02203 4-2-3-2"}, {pr(3, 17), Attribute::kB, "SX-DSV02203 4-2-3-4"},
    {pr(3, 21), Attribute::kB, "SX-DSV02203 4-2-3-4"}, {pr(3, 22), Attribute::kB, "SX-DSV02203 4-2-3-4"},
    {pr(5, 21), Attribute::kB, "SX-DSV02203 4-2-3-3"}, {pr(6, 38), Attribute::kC, "SX-DSV02203 8-2-1"},
    {pr(7, 11), Attribute::kA, "SX-DSV02203 6-8-6"},   {pr(7, 12), Attribute::kA, "SX-DSV02203 6-8-6"},
    {pr(7, 15), Attribute::kA, "SX-DSV02203 6-8-5"},   {pr(7, 20), Attribute::kR, "SX-DSV02203 2-5-2"},
    {pr(7, 21), Attribute::kR, "SX-DSV02203 2-5-2"},   {pr(7, 22), Attribute::kR, "SX-DSV02203 2-5-2"},
    {pr(7, 23), Attribute::kB, "SX-DSV02203 3-3-3"},   {pr(7, 24), Attribute::kC, "SX-DSV02203 4-2-3-5"},
    {pr(7, 35), Attribute::kC, "SX-DSV02203 7-7-1"},   {pr(7, 36), Attribute::kC, "SX-DSV02203 7-7-1"},
    {pr(7, 37), Attribute::kC, "SX-DSV02203 7-7-1"},   {pr(8, 1), Attribute::kB, "SX-DSV02203 7-5-1"},
    {pr(8, 4), Attribute::kB, "SX-DSV02203 7-5-1"},    {pr(8, 10), Attribute::kB, "SX-DSV02203 7-5-1"},
    {pr(8, 12), Attribute::kB, "SX-DSV02203 7-5-1"},   {pr(8, 13), Attribute::kB, "SX-DSV02203 7-5-1"},
    {pr(8, 14), Attribute::kB, "SX-DSV02203 7-5-1"},
};

constexpr Attribute attribute_of(std::uint16_t index) {
  for (const ParameterRow& row : kParameters) {
    if (row.index == index) return row.attribute;
  }
  return Attribute::kUnknown;
}

inline constexpr ValueName kSyncModes[] = {{0, "inter-axis semi-synchronous"}, {1, "inter-axis full-synchronous"}};
inline constexpr ValueName kDataSizes[] = {{0, "16-byte mode"}, {1, "32-byte mode"}};
inline constexpr Field kPr722Fields[] = {
    code("data_size", "Data size", at(0, 0), 1, kDataSizes, "SX-DSV02203 2-5-2"),
    code("sync_mode", "Inter-axis synchronous mode", at(0, 1), 1, kSyncModes, "SX-DSV02203 4-2-1-1"),
    unused("unused_2", at(0, 2), 2, "SX-DSV02203 2-5-2"),
    flag("scale_monitor", "External scale monitoring at semi-closed control", at(0, 4), "SX-DSV02203 2-5-2"),
    hex("other", "Other bits", at(0, 5), 27, "SX-DSV02203 2-5-2"),
};
inline constexpr Layout kPr722 =
    word("pr7_22", "Pr7.22 RTEX function expansion setup 1", kPr722Fields, "SX-DSV02203 2-5-2");
static_assert(well_formed(kPr722));

inline constexpr ValueName kStartModes[] = {{0, "MINAS-A4N compatible mode", "from the standard command only"},
                                            {1, "extend mode", "on a change of the code or its arguments, too"}};
inline constexpr ValueName kAlarmCodeModes[] = {{0, "main number only"}, {1, "main and sub number"}};
inline constexpr ValueName kPotNotPlaces[] = {{0, "POT bit 1, NOT bit 0"}, {1, "NOT bit 1, POT bit 0"}};
inline constexpr ValueName kLimitPlaces[] = {{0, "PSL bit 3, NSL bit 2"}, {1, "NSL bit 3, PSL bit 2"}};
inline constexpr ValueName kStatusChoices[] = {{0, "In_Progress"}, {1, "AC_OFF"}};
inline constexpr Field kPr723Fields[] = {
    flag("write_inhibited", "Parameter and EEPROM writing inhibited", at(0, 0), "SX-DSV02203 6-7-5"),
    code("alarm_code_mode", "Alarm code", at(0, 1), 1, kAlarmCodeModes, "SX-DSV02203 6-6-2"),
    flag("pot_not_silent", "POT and NOT always 0 while disabled", at(0, 2), "SX-DSV02203 4-3-4", "where Pr5.04 = 1"),
    code("pot_not_place", "POT and NOT bits", at(0, 3), 1, kPotNotPlaces, "SX-DSV02203 4-3-4"),
    flag("com_led", "COM LED lighting condition", at(0, 4), "SX-DSV02203 2-6"),
    code("start_mode", "Non-cyclic start mode", at(0, 5), 1, kStartModes, "SX-DSV02203 3-3-3"),
    flag("pot_not_inverted", "POT and NOT logic inverted", at(0, 6), "SX-DSV02203 4-3-4"),
    code("limit_place", "PSL and NSL bits", at(0, 7), 1, kLimitPlaces, "SX-DSV02203 6-8-6"),
    code("status_bit_1", "Status flag bit 1", at(1, 0), 1, kStatusChoices, "SX-DSV02203 4-3-3-2"),
    hex("other", "Other bits", at(1, 1), 23, "SX-DSV02203 3-3-3"),
};
inline constexpr Layout kPr723 =
    word("pr7_23", "Pr7.23 RTEX function expansion setup 2", kPr723Fields, "SX-DSV02203 3-3-3");
static_assert(well_formed(kPr723));

inline constexpr ValueName kOutputChoices[] = {{0, "hold"}, {1, "initialise"}};
inline constexpr Field kPr724Fields[] = {
    code("ex_out1_on_loss", "EX-OUT1 at communication cutoff", at(0, 0), 1, kOutputChoices, "SX-DSV02203 4-2-3-5"),
    code("ex_out2_on_loss", "EX-OUT2 at communication cutoff", at(0, 1), 1, kOutputChoices, "SX-DSV02203 4-2-3-5"),
    hex("other", "Other bits", at(0, 2), 30, "SX-DSV02203 4-2-3-5"),
};
inline constexpr Layout kPr724 =
    word("pr7_24", "Pr7.24 RTEX function expansion setup 3", kPr724Fields, "SX-DSV02203 4-2-3-5");
static_assert(well_formed(kPr724));

// Pr7.29 to Pr7.34: the monitor that fills a word of the response, by its new Type_Code. 0 is what MINAS-A4N has there,
// in the sub-channel nothing (4-3-1, 4-5-1).
using MonitorSelectNames = std::array<ValueName, kShortMonitorCount + 1>;
consteval MonitorSelectNames monitor_select_names(std::string_view by_default, std::string_view explanation) {
  MonitorSelectNames names{};
  names[0] = {0, by_default, explanation};
  for (std::size_t i = 0; i < kShortMonitorCount; ++i) names[i + 1] = kShortMonitorTypes[i];
  return names;
}
inline constexpr auto kSelect1Names = monitor_select_names("Actual position (APOS)", "0, as MINAS-A4N");
inline constexpr auto kSelect2Names = monitor_select_names("Actual speed (ASPD)", "0, as MINAS-A4N");
inline constexpr auto kSelect3Names = monitor_select_names("Torque (TRQ)", "0, as MINAS-A4N");
inline constexpr auto kSubSelectNames = monitor_select_names("none", "0 is returned");

constexpr Field choice(std::string_view key, std::string_view label, std::span<const ValueName> values,
                       std::string_view section, std::string_view explanation) {
  Field field = setting(key, label, section, explanation);
  field.values = values;
  return field;
}
inline constexpr Field kMonitorSelectFields[] = {
    choice("monitor_select", "Pr7.29 RTEX monitor select 1", kSelect1Names, "SX-DSV02203 4-3-1", "Response_Data1"),
    choice("monitor_select", "Pr7.30 RTEX monitor select 2", kSelect2Names, "SX-DSV02203 4-3-1", "Response_Data2"),
    choice("monitor_select", "Pr7.31 RTEX monitor select 3", kSelect3Names, "SX-DSV02203 4-3-1", "Response_Data3"),
    choice("monitor_select", "Pr7.32 RTEX monitor select 4", kSubSelectNames, "SX-DSV02203 4-5-1",
           "Sub_Response_Data1"),
    choice("monitor_select", "Pr7.33 RTEX monitor select 5", kSubSelectNames, "SX-DSV02203 4-5-1",
           "Sub_Response_Data2"),
    choice("monitor_select", "Pr7.34 RTEX monitor select 6", kSubSelectNames, "SX-DSV02203 4-5-1",
           "Sub_Response_Data3"),
};
// Pr7.35 to Pr7.37: the feedforward a word of the command holds.
inline constexpr ValueName kFeedforwards[] = {{0, "disabled"}, {1, "velocity feedforward"}, {2, "torque feedforward"}};
inline constexpr Field kForwardChoiceFields[] = {
    choice("feedforward", "Pr7.35 RTEX command setup 1", kFeedforwards, "SX-DSV02203 7-7-1", "Command_Data3"),
    choice("feedforward", "Pr7.36 RTEX command setup 2", kFeedforwards, "SX-DSV02203 7-7-1", "Sub_Command_Data2"),
    choice("feedforward", "Pr7.37 RTEX command setup 3", kFeedforwards, "SX-DSV02203 7-7-1", "Sub_Command_Data3"),
};

constexpr Layout choice_layout(std::string_view key, const Field& field) {
  return word(key, field.label, std::span(&field, 1), field.section);
}
// Pr7.29 to Pr7.37, one after the other.
inline constexpr Layout kChoices[] = {
    choice_layout("pr7_29", kMonitorSelectFields[0]), choice_layout("pr7_30", kMonitorSelectFields[1]),
    choice_layout("pr7_31", kMonitorSelectFields[2]), choice_layout("pr7_32", kMonitorSelectFields[3]),
    choice_layout("pr7_33", kMonitorSelectFields[4]), choice_layout("pr7_34", kMonitorSelectFields[5]),
    choice_layout("pr7_35", kForwardChoiceFields[0]), choice_layout("pr7_36", kForwardChoiceFields[1]),
    choice_layout("pr7_37", kForwardChoiceFields[2]),
};

}  // namespace servotrace::rtex
