// SPDX-License-Identifier: MIT
// The command, response and homing codes of the NS310 (SIE-C718-7 5.3, 5.4.3).
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

// Block commands (5.5.1, 5.5.2; Table 5.15 misprints 09h as 08h).
inline constexpr ValueName kBlockCommands[] = {
    {0x01, "modify attribute"},    {0x02, "wait equals"},  {0x03, "link if greater"},
    {0x04, "link if less"},        {0x06, "delay"},        {0x07, "trajectory"},
    {0x08, "trajectory and wait"}, {0x09, "speed change"}, {0x10, "home position travel"},
};

}  // namespace servotrace::ns310
