// SPDX-License-Identifier: MIT
// The monitor values of SX-DSV02203 6-9-1: one layout of 4 bytes a Type_Code. The same values fill Monitor_Data and,
// chosen by Pr7.29 to Pr7.34, the response data.
#pragma once

#include <array>

#include "decoder/rtex/row.hpp"

namespace servotrace::rtex {

inline constexpr std::string_view kMonitorSection = "SX-DSV02203 6-9-1";

constexpr Field counter(std::string_view key, std::string_view label, Unit unit = Unit::kNone, Ratio scale = {},
                        std::string_view explanation = {}) {
  Field field = number(key, label, 0, 32, kMonitorSection, explanation);
  field.unit = unit;
  field.scale = scale;
  return field;
}

inline constexpr ValueName kNoRevolutionCauses[] = {
    {0, "no cause", "none can be detected, the motor rotates normally"},
    {1, "not in servo ready state", "main power off, an alarm, not synchronised, or a validation is running"},
    {2, "no servo-on command", "Servo_On is 0, or EX-SON is assigned and off"},
    {3, "over-travel inhibit input active", "POT or NOT is on and the command goes in its direction"},
    {4, "torque limit too small", "the valid torque limit is 5 % of the rated torque or less"},
    {7, "position command too slow", "the position command in a control period is one command unit or less"},
    {10, "velocity command too low", "the command velocity is 30 r/min or less"},
    {11, "manufacturer use"},
    {12, "torque command too low", "the command torque is 5 % of the rated torque or less"},
    {13, "speed limit too low", "the speed limit value is 30 r/min or less"},
    {14, "other causes", "below 30 r/min for none of the causes 1 to 13"},
};
inline constexpr ValueName kRecognition[] = {{0, "invalid"}, {1, "valid"}};

constexpr Field named_counter(std::string_view key, std::string_view label, std::span<const ValueName> values,
                              std::string_view section) {
  Field field = number(key, label, 0, 32, section);
  field.values = values;
  return field;
}

// 6-9-5 and 6-9-3: bit maps. Unlisted bits have no meaning in the manual; they are not reserved, for it does not fix
// them at 0.
inline constexpr std::string_view kSignalSection = "SX-DSV02203 6-9-5";
inline constexpr Field kLogicalInputFields[] = {
    state("input_servo_on_command", "Servo on command", at(0, 0), kSignalSection,
          "the command of the control process, not the external input alone"),
    hex("input_bit_1", "Bit 1", at(0, 1), 1, kSignalSection),
    state("input_not", "Negative direction drive inhibit input (NOT)", at(0, 2), kSignalSection),
    state("input_pot", "Positive direction drive inhibit input (POT)", at(0, 3), kSignalSection),
    hex("input_bits_4_6", "Bits 4-6", at(0, 4), 3, kSignalSection),
    state("input_e_stop", "Emergency stop input (E-STOP)", at(0, 7), kSignalSection),
    hex("input_bits_8_31", "Bits 8-31", at(1, 0), 24, kSignalSection),
};
inline constexpr Field kExtendedInputFields[] = {
    state("input_ext1", "External latch input 1 (EXT1)", at(0, 0), kSignalSection),
    state("input_ext2", "External latch input 2 (EXT2)", at(0, 1), kSignalSection),
    state("input_ext3", "External latch input 3 (EXT3)", at(0, 2), kSignalSection),
    hex("input_extended_bit_3", "Bit 3", at(0, 3), 1, kSignalSection),
    state("input_home", "Near home input (HOME)", at(0, 4), kSignalSection),
    hex("input_extended_bits_5_17", "Bits 5-17", at(0, 5), 13, kSignalSection),
    state("input_si_mon1", "General purpose monitor input 1 (SI-MON1)", at(2, 2), kSignalSection),
    state("input_si_mon2", "General purpose monitor input 2 (SI-MON2)", at(2, 3), kSignalSection),
    state("input_si_mon3", "General purpose monitor input 3 (SI-MON3)", at(2, 4), kSignalSection),
    state("input_si_mon4", "General purpose monitor input 4 (SI-MON4)", at(2, 5), kSignalSection),
    state("input_si_mon5", "General purpose monitor input 5 (SI-MON5)", at(2, 6), kSignalSection),
    hex("input_extended_bits_23_31", "Bits 23-31", at(2, 7), 9, kSignalSection),
};
inline constexpr Field kLogicalOutputFields[] = {
    state("output_servo_ready", "Servo ready output (S-RDY)", at(0, 0), kSignalSection),
    state("output_servo_alarm", "Servo alarm output (ALM)", at(0, 1), kSignalSection),
    state("output_positioning_complete", "Positioning complete output (INP)", at(0, 2), kSignalSection),
    state("output_brake_release", "Brake release output (BRK-OFF)", at(0, 3), kSignalSection),
    state("output_zero_speed", "Zero speed detect output (ZSP)", at(0, 4), kSignalSection),
    state("output_torque_limiting", "Torque limiting output (TLC)", at(0, 5), kSignalSection),
    state("output_velocity_coincidence", "Velocity coincidence output (V-COIN)", at(0, 6), kSignalSection),
    hex("output_bits_7_8", "Bits 7-8", at(0, 7), 2, kSignalSection),
    state("output_at_speed", "At-speed output (AT-SPEED)", at(1, 1), kSignalSection),
    hex("output_bits_10_15", "Bits 10-15", at(1, 2), 6, kSignalSection),
    state("output_warning_1", "Warning output 1 (WARN1)", at(2, 0), kSignalSection),
    state("output_warning_2", "Warning output 2 (WARN2)", at(2, 1), kSignalSection),
    state("output_position_command", "Position command on/off output (P-CMD)", at(2, 2), kSignalSection),
    state("output_positioning_complete_2", "Positioning complete output 2 (INP2)", at(2, 3), kSignalSection),
    state("output_velocity_limiting", "Velocity limiting output (V-LIMIT)", at(2, 4), kSignalSection),
    state("output_alarm_clear_attribute", "Alarm clear attribute output (ALM-ATB)", at(2, 5), kSignalSection),
    state("output_velocity_command", "Velocity command on/off output (V-CMD)", at(2, 6), kSignalSection),
    hex("output_bit_23", "Bit 23", at(2, 7), 1, kSignalSection),
    state("output_ex_out1", "RTEX operation output 1 (EX-OUT1)", at(3, 0), kSignalSection),
    state("output_ex_out2", "RTEX operation output 2 (EX-OUT2)", at(3, 1), kSignalSection),
    hex("output_bits_26_31", "Bits 26-31", at(3, 2), 6, kSignalSection),
};
inline constexpr Field kExtendedOutputFields[] = {
    hex("output_extended_bits_0_8", "Bits 0-8", at(0, 0), 9, kSignalSection),
    state("output_sync_complete", "Communication sync complete output (SYNC_CMP)", at(1, 1), kSignalSection),
    hex("output_extended_bits_10_31", "Bits 10-31", at(1, 2), 22, kSignalSection),
};
inline constexpr Field kPhysicalInputFields[] = {
    flag("input_si1", "SI1 input", at(0, 0), kSignalSection, "1: connected to COM-"),
    flag("input_si2", "SI2 input", at(0, 1), kSignalSection),
    flag("input_si3", "SI3 input", at(0, 2), kSignalSection),
    flag("input_si4", "SI4 input", at(0, 3), kSignalSection),
    flag("input_si5", "SI5 input", at(0, 4), kSignalSection),
    flag("input_si6", "SI6 input", at(0, 5), kSignalSection),
    flag("input_si7", "SI7 input", at(0, 6), kSignalSection),
    flag("input_si8", "SI8 input", at(0, 7), kSignalSection),
    hex("input_physical_bits_8_31", "Bits 8-31", at(1, 0), 24, kSignalSection),
};
inline constexpr Field kPhysicalOutputFields[] = {
    flag("output_so1", "SO1 output", at(0, 0), kSignalSection, "1: transistor on"),
    flag("output_so2", "SO2 output", at(0, 1), kSignalSection),
    flag("output_so3", "SO3 output", at(0, 2), kSignalSection),
    hex("output_physical_bits_3_31", "Bits 3-31", at(0, 3), 29, kSignalSection),
};
// Bytes 12 and 13 hold more warnings than their places can be read from the manual: those stay one number.
inline constexpr Field kWarningFlagFields[] = {
    state("warning_battery", "Battery", at(0, 0), "SX-DSV02203 6-9-3"),
    hex("warning_bits_1_4", "Bits 1-4", at(0, 1), 4, "SX-DSV02203 6-9-3"),
    hex("warning_overload_fan", "Overload, regenerative overload, fan lock", at(0, 5), 3, "SX-DSV02203 6-9-3",
        "one bit each"),
    state("warning_scale", "Scale error", at(1, 0), "SX-DSV02203 6-9-3"),
    state("warning_continuous_communication", "Continuous communication error", at(1, 1), "SX-DSV02203 6-9-3"),
    state("warning_accumulated_communication", "Cumulative communication error", at(1, 2), "SX-DSV02203 6-9-3"),
    hex("warning_counter_power", "Update counter, main power source off", at(1, 3), 5, "SX-DSV02203 6-9-3",
        "one bit each"),
    state("warning_lifetime", "Lifetime detection", at(2, 0), "SX-DSV02203 6-9-3"),
    state("warning_encoder_overheating", "Encoder overheating", at(2, 1), "SX-DSV02203 6-9-3"),
    state("warning_encoder_communication", "Encoder communication", at(2, 2), "SX-DSV02203 6-9-3"),
    state("warning_oscillation", "Oscillation detection", at(2, 3), "SX-DSV02203 6-9-3"),
    state("warning_scale_communication", "Scale communication", at(2, 4), "SX-DSV02203 6-9-3"),
    hex("warning_bits_21_31", "Bits 21-31", at(2, 5), 11, "SX-DSV02203 6-9-3"),
};

// A monitor of one number. Its Index is 0 (6-9-1) unless `any_index`: the column shows a dash.
struct MonitorRow {
  std::uint8_t code = 0;           // new Type_Code
  std::uint16_t conventional = 0;  // the MINAS-A4N Type_Code, main channel only; 0: none
  Field field;
  bool any_index = false;
  bool speed = false;  // its unit is chosen by Pr7.25
};

inline constexpr MonitorRow kMonitors[] = {
    {0x01, 0x101,
     signal("position_deviation", "Position deviation (PERR)", Unit::kCommandUnit, kMonitorSection,
            "after filtering; undefined in CV and CT")},
    {0x02, 0x102, counter("encoder_resolution", "Encoder resolution", Unit::kPulse)},
    {0x04, 0x104,
     signal("internal_position_filtered", "Internal command position after filtering (MPOS)", Unit::kCommandUnit,
            kMonitorSection)},
    {0x05, 0x105, signal("actual_speed", "Actual speed (ASPD)", Unit::kRevolutionsPerMinute, kMonitorSection), false,
     true},
    {0x06, 0x106, torque_signal("torque", "Torque (TRQ)", kMonitorSection, "command torque to the motor")},
    {0x07, 0, signal("actual_position", "Actual position (APOS)", Unit::kCommandUnit, kMonitorSection)},
    {0x08, 0,
     signal("internal_position", "Internal command position before filtering (IPOS)", Unit::kCommandUnit,
            kMonitorSection)},
    {0x09, 0,
     setting("latch_position_1", "Latch position 1 (LPOS1)", kMonitorSection,
             "undefined until Latch_Comp1 is 1 (6-5-4-3)", Unit::kCommandUnit)},
    {0x0A, 0,
     setting("latch_position_2", "Latch position 2 (LPOS2)", kMonitorSection,
             "undefined until Latch_Comp2 is 1 (6-5-4-3)", Unit::kCommandUnit)},
    {0x0C, 0,
     signal("command_velocity", "Command velocity after filtering (MSPD)", Unit::kRevolutionsPerMinute, kMonitorSection,
            "undefined in CT"),
     false, true},
    {0x0D, 0, signal("external_scale_position", "External scale position (EXPOS)", Unit::kPulse, kMonitorSection)},
    {0x11, 0x111, counter("regenerative_load", "Regenerative load ratio", Unit::kPercent, kTenth)},
    {0x12, 0x112, counter("overload", "Overload ratio", Unit::kPercent, kTenth)},
    {0x31, 0x131, counter("inertia_ratio", "Inertia ratio", Unit::kPercent)},
    {0x32, 0x132, named_counter("motor_recognition", "Automatic motor recognition", kRecognition, kMonitorSection)},
    {0x33, 0x133,
     named_counter("no_revolution_cause", "Cause of no revolution", kNoRevolutionCauses, "SX-DSV02203 6-9-2")},
    {0x41, 0x201,
     counter("mechanical_angle", "Mechanical angle (single-turn data)", Unit::kPulse, {},
             "FFFFFFFFh with an incremental encoder until its Z phase was seen")},
    {0x42, 0x202, counter("electrical_angle", "Electrical angle", Unit::kNone, {}, "0 to 1FFh")},
    {0x43, 0, setting("multi_turn", "Multi-turn data", kMonitorSection, {}, Unit::kTurn), true},
    {0x61, 0, counter("power_on_time", "Power on cumulative time", Unit::kMinute, {30, 1}), true},
    {0x62, 0, setting("driver_temperature", "Servo driver temperature", kMonitorSection, {}, Unit::kDegreeCelsius),
     true},
    {0x63, 0,
     setting("encoder_temperature", "Encoder temperature", kMonitorSection, "20-bit encoder only, else 0",
             Unit::kDegreeCelsius),
     true},
    {0x64, 0, counter("inrush_relay_operations", "Number of inrush resistance relay operations"), true},
    {0x65, 0, counter("dynamic_brake_operations", "Number of dynamic brake operations"), true},
    {0x66, 0, counter("fan_time", "Fan operating time", Unit::kMinute, {30, 1}), true},
    {0x67, 0, counter("fan_life", "Fan life expectancy", Unit::kPercent, kTenth), true},
    {0x68, 0, counter("capacitor_life", "Capacitor life expectancy", Unit::kPercent, kTenth), true},
    {0x69, 0, counter("pn_voltage", "Voltage across PN", Unit::kVolt), true},
    {0x71, 0x401, counter("rtex_communication_errors", "RTEX cumulative communication errors")},
    {0x81, 0x411, counter("encoder_communication_errors", "Encoder cumulative communication errors")},
    {0x82, 0x412, counter("encoder_data_errors", "Encoder cumulative communication data errors")},
    {0x83, 0, counter("scale_communication_errors", "External scale cumulative communication errors")},
    {0x84, 0, counter("scale_data_errors", "External scale cumulative communication data errors")},
};
inline constexpr std::size_t kMonitorCount = std::size(kMonitors);

// The main channel's layouts have the key "response", the sub channel's "sub_response".
struct MonitorTables {
  std::array<Field, kMonitorCount> fields;           // as printed; speeds in r/min
  std::array<Field, kMonitorCount> fields_in_units;  // speeds in command units a second (Pr7.25 = 1)
};
consteval MonitorTables make_monitor_fields() {
  MonitorTables tables{};
  for (std::size_t i = 0; i < kMonitorCount; ++i) {
    tables.fields[i] = tables.fields_in_units[i] = kMonitors[i].field;
    if (kMonitors[i].speed) tables.fields_in_units[i].unit = Unit::kCommandUnitPerSecond;
  }
  return tables;
}
inline constexpr MonitorTables kMonitorFields = make_monitor_fields();

using MonitorLayouts = std::array<Layout, kMonitorCount>;
consteval MonitorLayouts make_monitor_layouts(std::string_view key, bool in_units) {
  MonitorLayouts layouts{};
  for (std::size_t i = 0; i < kMonitorCount; ++i) {
    const Field& field = in_units ? kMonitorFields.fields_in_units[i] : kMonitorFields.fields[i];
    layouts[i] = word(key, kMonitors[i].field.label, std::span(&field, 1), kMonitors[i].field.section);
  }
  return layouts;
}
// [sub channel][Pr7.25 = 1]
inline constexpr MonitorLayouts kMonitorLayouts[2][2] = {
    {make_monitor_layouts("response", false), make_monitor_layouts("response", true)},
    {make_monitor_layouts("sub_response", false), make_monitor_layouts("sub_response", true)},
};

// Bit maps: [sub channel].
struct BitMapRow {
  std::uint8_t code = 0;
  std::uint16_t conventional = 0;
  std::string_view title;
  Layout layouts[2];
};
constexpr BitMapRow bit_map(std::uint8_t type_code, std::uint16_t conventional, std::string_view title,
                            std::span<const Field> fields, std::string_view section) {
  return {type_code,
          conventional,
          title,
          {word("response", title, fields, section), word("sub_response", title, fields, section)}};
}
inline constexpr std::uint8_t kLogicalInputs = 0x21;
inline constexpr BitMapRow kBitMaps[] = {
    bit_map(kLogicalInputs, 0, "Logical input signal", kLogicalInputFields, kSignalSection),
    bit_map(0x22, 0, "Logical output signal", kLogicalOutputFields, kSignalSection),
    bit_map(0x23, 0, "Logical input signal (expansion portion)", kExtendedInputFields, kSignalSection),
    bit_map(0x24, 0, "Logical output signal (expansion portion)", kExtendedOutputFields, kSignalSection),
    bit_map(0x25, 0, "Physical input signal", kPhysicalInputFields, kSignalSection),
    bit_map(0x26, 0, "Physical output signal", kPhysicalOutputFields, kSignalSection),
    bit_map(0x34, 0x134, "Warning flags", kWarningFlagFields, "SX-DSV02203 6-9-3"),
};

// Names of all Type_Codes, sorted: for Type_Code and Monitor_Sel fields.
inline constexpr std::size_t kMonitorNameCount = [] {
  std::size_t count = kMonitorCount + std::size(kBitMaps);
  for (const MonitorRow& row : kMonitors) count += row.conventional != 0;
  for (const BitMapRow& row : kBitMaps) count += row.conventional != 0;
  return count;
}();
inline constexpr auto kMonitorTypes = [] {
  std::array<ValueName, kMonitorNameCount> names{};
  std::size_t next = 0;
  const auto add = [&](std::int64_t value, std::string_view name) {
    std::size_t place = next++;
    for (; place > 0 && names[place - 1].value > value; --place) names[place] = names[place - 1];
    names[place] = {value, name, {}};
  };
  for (const MonitorRow& row : kMonitors) {
    add(row.code, row.field.label);
    if (row.conventional != 0) add(row.conventional, row.field.label);
  }
  for (const BitMapRow& row : kBitMaps) {
    add(row.code, row.title);
    if (row.conventional != 0) add(row.conventional, row.title);
  }
  return names;
}();
// The codes of one byte: Monitor_Sel, Sub_Type_Code, Pr7.29 to Pr7.34.
inline constexpr std::size_t kShortMonitorCount = kMonitorCount + std::size(kBitMaps);
inline constexpr std::span<const ValueName> kShortMonitorTypes{kMonitorTypes.data(), kShortMonitorCount};
static_assert(kShortMonitorTypes.back().value == 0x84);

// The new one-byte code of a Type_Code, 0 where the list does not have it.
constexpr std::uint8_t monitor_code(std::uint16_t type_code) {
  for (const MonitorRow& row : kMonitors) {
    if (row.code == type_code || (row.conventional == type_code && type_code != 0)) return row.code;
  }
  for (const BitMapRow& row : kBitMaps) {
    if (row.code == type_code || (row.conventional == type_code && type_code != 0)) return row.code;
  }
  return 0;
}

// The layout of a monitor value, or nullptr where the list does not have the code.
constexpr const Layout* monitor_layout(std::uint16_t type_code, bool sub, bool speed_in_units) {
  const std::uint8_t short_code = monitor_code(type_code);
  if (short_code == 0) return nullptr;
  for (std::size_t i = 0; i < kMonitorCount; ++i) {
    if (kMonitors[i].code == short_code)
      return &kMonitorLayouts[sub ? 1 : 0][kMonitors[i].speed && speed_in_units ? 1 : 0][i];
  }
  for (const BitMapRow& row : kBitMaps) {
    if (row.code == short_code) return &row.layouts[sub ? 1 : 0];
  }
  return nullptr;
}

// True where 6-9-1 prints an Index of 0 for the monitor (PERR takes 1 and 2 as well).
constexpr bool monitor_index_ok(std::uint16_t type_code, std::uint16_t index) {
  const std::uint8_t short_code = monitor_code(type_code);
  for (const MonitorRow& row : kMonitors) {
    if (row.code == short_code) return row.any_index || index == 0 || (short_code == 0x01 && index <= 2);
  }
  return short_code == 0 || index == 0;
}

}  // namespace servotrace::rtex
