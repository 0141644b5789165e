// SPDX-License-Identifier: MIT
// What no single RTEX frame holds: how far a non-cyclic command is and how long it took (SX-DSV02203 3-3-4), and the
// strings of the system ID, four characters an answer (6-4).
#pragma once

#include "decoder/rtex/row.hpp"

namespace servotrace::rtex {

inline constexpr Field kEchoTimeField{.key = "echo_time_ns",
                                      .label = "Time until accepted",
                                      .width = 64,
                                      .kind = Kind::kSigned,
                                      .role = Role::kSignal,
                                      .unit = Unit::kNanosecond,
                                      .section = "SX-DSV02203 3-3-4",
                                      .explanation = "from the first command of this code to its first echo"};
inline constexpr Field kCompletionTimeField{
    .key = "completion_time_ns",
    .label = "Time until completed",
    .width = 64,
    .kind = Kind::kSigned,
    .role = Role::kSignal,
    .unit = Unit::kNanosecond,
    .section = "SX-DSV02203 3-3-4",
    .explanation = "from the first command of this code to the answer with its arguments and Busy = 0"};

// Of a command record that follows the one before without a gap.
inline constexpr Field kCycleTimeField{.key = "cycle_time_ns",
                                       .label = "Time since the command record before",
                                       .width = 64,
                                       .kind = Kind::kSigned,
                                       .unit = Unit::kNanosecond,
                                       .section = "SX-DSV02203 3-1",
                                       .explanation = "the communication cycle as it was recorded"};

// Of a response with the actual position, in CP.
inline constexpr Field kDeviationField{
    .key = "deviation",
    .label = "Command minus actual position",
    .width = 32,
    .kind = Kind::kSigned,
    .role = Role::kSignal,
    .unit = Unit::kCommandUnit,
    .section = "SX-DSV02203 7-1",
    .explanation = "the last command position less this actual position; the drive's own deviation is PERR (6-9-1)"};

// Of a command block that holds a non-cyclic command.
inline constexpr ValueName kHandshakeNames[] = {{1, "waiting for echo"}, {2, "in process"}};
inline constexpr Field kHandshakeField{.key = "handshake",
                                       .label = "Handshake",
                                       .width = 8,
                                       .values = kHandshakeNames,
                                       .section = "SX-DSV02203 3-3-4",
                                       .explanation = "how far the drive is with the non-cyclic command held"};

// A string of the system ID: its new Type_Code and the name of what it says.
struct SystemIdRow {
  std::uint8_t type_code = 0;
  Field field;
};
constexpr SystemIdRow system_id_row(std::uint8_t type_code, std::string_view key, std::string_view label,
                                    std::string_view explanation = {}) {
  return {
      type_code,
      {.key = key, .label = label, .kind = Kind::kText, .section = "SX-DSV02203 6-4-1", .explanation = explanation}};
}
// Sorted by Type_Code (6-4-1); the conventional codes are these times 16.
inline constexpr SystemIdRow kSystemIds[] = {
    system_id_row(0x01, "vendor_name", "Vendor name"),
    system_id_row(0x05, "device_type", "Device type", "1: servo"),
    system_id_row(0x06, "manufacturer_id", "System ID for manufacturer use"),
    system_id_row(0x12, "driver_model", "Driver model No."),
    system_id_row(0x13, "driver_serial", "Driver serial No."),
    system_id_row(0x14, "software_version", "Servo driver software version"),
    system_id_row(0x15, "driver_type", "Driver type",
                  "A4N 0 or A5N 1, rotary 0 or linear 1, then CP, CV, CT and PP: 1 where supported"),
    system_id_row(0x22, "motor_model", "Motor model No."),
    system_id_row(0x23, "motor_serial", "Motor serial No."),
    system_id_row(0x31, "scale_vendor", "Vendor ID of the external scale"),
    system_id_row(0x32, "scale_model", "Model ID of the external scale"),
    system_id_row(0x34, "manufacturer_scale", "External scale ID for manufacturer use"),
};
inline constexpr std::size_t kSystemIdCount = std::size(kSystemIds);

// The place of a new or conventional Type_Code in kSystemIds; kSystemIdCount where it is none.
constexpr std::size_t system_id_place(std::uint16_t type_code) {
  for (std::size_t i = 0; i < kSystemIdCount; ++i) {
    if (kSystemIds[i].type_code == type_code || kSystemIds[i].type_code << 4U == type_code) return i;
  }
  return kSystemIdCount;
}
static_assert(system_id_place(0x010) == 0 && system_id_place(0x120) == system_id_place(0x12));

}  // namespace servotrace::rtex
