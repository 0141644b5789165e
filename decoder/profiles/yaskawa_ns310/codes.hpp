// SPDX-License-Identifier: MIT
// The command, response, homing and alarm codes of the NS310 (SIE-C718-7 5.3, 5.4.3, C.1).
#pragma once

#include "decoder/core/layout.hpp"

namespace servotrace::ns310 {

// Command code, byte 2 bits 4-0 (5.3.1): says what bytes 4-7 hold.
enum class CommandCode : std::uint8_t {
  kNop = 0x00,
  kTargetPosition = 0x01,
  kTargetSpeed = 0x02,
  kAcceleration = 0x03,
  kDeceleration = 0x04,
  kContinuousSpeed = 0x11,
  kHoming = 0x12,
  kAlarmClear = 0x1E,
};
inline constexpr ValueName kCommandCodes[] = {
    {0x00, "NOP", "No meaning."},
    {0x01, "Target position", "Positioning: starts with Start Trajectory."},
    {0x02, "Target speed", "Speed of a positioning; starts nothing."},
    {0x03, "Acceleration", "Of positioning, continuous rotation and homing; starts nothing."},
    {0x04, "Deceleration", "Of positioning, continuous rotation and homing; starts nothing."},
    {0x11, "Continuous rotor speed", "Rotation at a fixed speed in the Direction given: starts with Start Trajectory."},
    {0x12, "Homing type", "Homing: starts with Start Trajectory."},
    {0x1E, "Alarm clear", "Clears the alarms of NS310 and SGDH on the rising edge of Start Trajectory."},
};

// Response code, byte 3 bits 4-0 (5.3.1, 5.3.3): asks for, and names, what bytes 4-7 of the response hold.
enum class ResponseCode : std::uint8_t {
  kNop = 0x00,
  kCurrentPosition = 0x01,
  kCommandPosition = 0x02,
  kCurrentSpeed = 0x03,
  kAlarmCode = 0x1E,
};
inline constexpr ValueName kResponseCodes[] = {
    {0x00, "NOP"},           {0x01, "Current position"}, {0x02, "Command position"},
    {0x03, "Current speed"}, {0x1E, "Alarm code"},
};

// Homing types (5.4.3).
inline constexpr ValueName kHomingTypes[] = {
    {0, "Type 0", "Home position signal, then phase C of the encoder."},
    {1, "Type 1", "Home position signal only."},
    {3, "Type 3", "Phase C of the encoder only."},
};

// Alarm codes a response of code 1Eh carries (Table C.1), with the SGDH alarms behind each.
inline constexpr ValueName kAlarmCodes[] = {
    {0x00, "no alarm"},
    {0x01, "Power Element Error",
     "SGDH A.03 main circuit encoder error, A.74 overload of surge current limit resistor."},
    {0x02, "Amplifier Overheat", "SGDH A.7A heat sink overheated."},
    {0x03, "External Overheat", "No SGDH alarm behind it."},
    {0x05, "Over Voltage", "SGDH A.40 overvoltage, A.41 undervoltage."},
    {0x07, "Control Power Error", "SGDH A.97 control power off."},
    {0x08, "Sensor Error",
     "SGDH A.81 absolute encoder backup, A.82 encoder checksum, A.83 absolute encoder battery, A.84 absolute encoder "
     "data, A.85 absolute encoder overspeed, A.86 encoder overheated, A.C8 absolute encoder clear, A.C9 encoder "
     "communication, A.CA encoder parameter, A.CB encoder echoback, A.CC multi-turn limit mismatch."},
    {0x0A, "Over Load",
     "SGDH A.71 overload: high load, A.72 overload: low load, A.73 dynamic brake overload, A.91 overload (warning)."},
    {0x0B, "Over Speed", "SGDH A.51 overspeed."},
    {0x0C, "Speed Control Error", "No SGDH alarm behind it."},
    {0x0D, "Deviation Excess", "SGDH A.D0 position error pulse overflow."},
    {0x10, "Main Power Error", "SGDH A.98 main power off, A.F1 power line open phase."},
    {0x12, "Regeneration Error",
     "SGDH A.30 regeneration error, A.32 regenerative overload, A.92 regenerative overload (warning)."},
    {0x13, "Servo Processor Error",
     "SGDH A.BF system alarm, A.C1 servo overrun detected, A.EA SGDH system error, A.ED option system error."},
    {0x14, "EEPROM Error", "SGDH A.02 parameter breakdown, A.EE parameter breakdown."},
    {0x15, "Memory Error", "No SGDH alarm behind it."},
    {0x18, "Over Current", "SGDH A.10 overcurrent or heat sink overheated."},
    {0x20, "Duplicate MAC ID", "SGDH A.E6 DeviceNet duplicate MAC ID error."},
    {0x21, "BUS-OFF Error", "SGDH A.E9 DeviceNet bus-off error."},
    {0x22, "Dual Port RAM Error",
     "SGDH A.E0 no NS310 unit, A.E1 NS310 unit time-out, A.E2 watchdog counter error of NS310 unit, A.E7 no NS310 unit "
     "detected, A.EB SERVOPACK initial access error, A.EC watchdog counter error of NS310 unit."},
    {0x23, "Wrap Around Error", "No SGDH alarm behind it."},
    {0x24, "Homing Error", "No SGDH alarm behind it."},
    {0xF0, "Parameter Setting Error", "SGDH A.04 parameter setting error, A.94 parameter setting error."},
    {0xF1, "Command Error", "SGDH A.95 command error."},
    {0xF2, "Combination Error", "SGDH A.05 combination error."},
    {0xF3, "External Input Error",
     "SGDH A.B1 reference speed input read error, A.B2 reference torque input read error."},
    {0xF4, "Switch Setting Error", "SGDH A.E8 DeviceNet rotary switch error."},
};

}  // namespace servotrace::ns310
