// SPDX-License-Identifier: MIT
// The codes of commands and their Type_Codes (SX-DSV02203 chapters 4 to 6).
#pragma once

#include "decoder/core/layout.hpp"

namespace servotrace::rtex {

enum class Cyclic : std::uint8_t { kNop = 0, kPp = 1, kCp = 2, kCv = 3, kCt = 4 };  // 5..7 are undefined
enum class NonCyclic : std::uint8_t {
  kNormal = 0,
  kReset = 1,
  kSystemId = 2,
  kHoming = 4,
  kAlarm = 5,
  kParameter = 6,
  kProfile = 7,
  kMonitor = 10
};

// 4-2-1
inline constexpr ValueName kCyclicNames[] = {
    {0, "NOP", "invalid data: the drive keeps its last command"},
    {1, "PP", "profile position mode: the drive generates the positions"},
    {2, "CP", "cyclic position mode: the controller sends a position each updating cycle"},
    {3, "CV", "cyclic velocity mode: the controller sends a speed each communication cycle"},
    {4, "CT", "cyclic torque mode: the controller sends a torque each communication cycle"},
};
// 4-2-1, 6-1
inline constexpr ValueName kNonCyclicNames[] = {
    {0, "Normal", "the standard command: the reference of the non-cyclic handshake"},
    {1, "Reset", "restarts the drive, or validates attribute C parameters"},
    {2, "System ID", "reads names, serial numbers and versions"},
    {4, "Homing", "return to home, position set, latch"},
    {5, "Alarm", "reads or clears alarms"},
    {6, "Parameter", "reads or writes parameters, writes the EEPROM"},
    {7, "Profile", "starts an operation of the profile position mode"},
    {10, "Monitor", "reads one monitor value"},
};
// 4-4-1
inline constexpr ValueName kSubCommandNames[] = {{0, "Normal"}, {2, "System ID"}, {10, "Monitor"}};

// 6-3
inline constexpr std::uint16_t kSoftwareReset = 0x001;
inline constexpr std::uint16_t kValidation = 0x011;
inline constexpr ValueName kResetTypes[] = {
    {kSoftwareReset, "software reset", "the drive restarts when the command goes back to normal"},
    {kValidation, "attribute C parameter validation", "makes changed attribute C parameters valid, servo off"},
};

// 6-4-1; conventional three-digit codes on the main channel only
inline constexpr ValueName kSystemIdTypes[] = {
    {0x01, "vendor name"},
    {0x05, "device type"},
    {0x06, "manufacturer use"},
    {0x010, "vendor name (conventional)"},
    {0x12, "driver model No."},
    {0x13, "driver serial No."},
    {0x14, "servo driver software version"},
    {0x15, "driver type"},
    {0x22, "motor model No."},
    {0x23, "motor serial No."},
    {0x31, "vendor ID of the external scale"},
    {0x32, "model ID of the external scale"},
    {0x34, "manufacturer use"},
    {0x050, "device type (conventional)"},
    {0x060, "manufacturer use (conventional)"},
    {0x120, "driver model No. (conventional)"},
    {0x130, "driver serial No. (conventional)"},
    {0x140, "servo driver software version (conventional)"},
    {0x150, "driver type (conventional)"},
    {0x220, "motor model No. (conventional)"},
    {0x230, "motor serial No. (conventional)"},
    {0x310, "vendor ID of the external scale (conventional)"},
    {0x320, "model ID of the external scale (conventional)"},
    {0x340, "manufacturer use (conventional)"},
};

// The codes of one byte, which the sub channel takes as well
inline constexpr ValueName kShortSystemIdTypes[] = {
    {0x01, "vendor name"},
    {0x05, "device type"},
    {0x06, "manufacturer use"},
    {0x12, "driver model No."},
    {0x13, "driver serial No."},
    {0x14, "servo driver software version"},
    {0x15, "driver type"},
    {0x22, "motor model No."},
    {0x23, "motor serial No."},
    {0x31, "vendor ID of the external scale"},
    {0x32, "model ID of the external scale"},
    {0x34, "manufacturer use"},
};

// 6-5-1
inline constexpr ValueName kHomingTypes[] = {
    {0x11, "homing on Z phase"},
    {0x12, "homing on HOME rising"},
    {0x13, "homing on HOME falling"},
    {0x14, "homing on POT rising"},
    {0x15, "homing on POT falling"},
    {0x16, "homing on NOT rising"},
    {0x17, "homing on NOT falling"},
    {0x18, "homing on EXT1 rising"},
    {0x19, "homing on EXT1 falling"},
    {0x1A, "homing on EXT2 rising"},
    {0x1B, "homing on EXT2 falling"},
    {0x1C, "homing on EXT3 rising"},
    {0x1D, "homing on EXT3 falling"},
    {0x21, "actual position set"},
    {0x22, "command position set"},
    {0x31, "clear multi-turn data of the absolute encoder"},
    {0x50, "latch status monitor"},
    {0x51, "start position latch 1"},
    {0x52, "start position latch 2"},
    {0x53, "start position latch 1 and 2"},
    {0x54, "cancel position latch 1"},
    {0x58, "cancel position latch 2"},
    {0x5C, "cancel position latch 1 and 2"},
};
// 6-5-4-2, 6-8-2
inline constexpr ValueName kLatchTriggers[] = {
    {0, "Z phase"},      {1, "EXT1 rising"},   {2, "EXT2 rising"},   {3, "EXT3 rising"},
    {9, "EXT1 falling"}, {10, "EXT2 falling"}, {11, "EXT3 falling"},
};

// 6-6-1
inline constexpr std::uint16_t kAlarmRead = 0x000;
inline constexpr std::uint16_t kAlarmClear = 0x001;
inline constexpr std::uint16_t kAlarmAttribute = 0x002;
inline constexpr std::uint16_t kAlarmClearHistory = 0x011;
inline constexpr std::uint16_t kAlarmClearScale = 0x021;
inline constexpr ValueName kAlarmTypes[] = {
    {kAlarmRead, "read present alarm or alarm history"}, {kAlarmClear, "clear alarm"},
    {kAlarmAttribute, "read alarm attribute"},           {kAlarmClearHistory, "clear alarm history"},
    {kAlarmClearScale, "clear error on external scale"},
};

// 6-7-1
inline constexpr std::uint16_t kParameterRead = 0x010;
inline constexpr std::uint16_t kParameterWrite = 0x011;
inline constexpr std::uint16_t kParameterCount = 0x030;
inline constexpr std::uint16_t kParameterAttribute = 0x040;
inline constexpr std::uint16_t kEepromWrite = 0x081;
inline constexpr std::uint16_t kEepromWriteConventional = 0x101;
inline constexpr ValueName kParameterTypes[] = {
    {kParameterRead, "parameter reading"},
    {kParameterWrite, "parameter writing"},
    {kParameterCount, "number of parameters in a class"},
    {kParameterAttribute, "parameter attribute read-out"},
    {kEepromWrite, "EEPROM writing"},
    {kEepromWriteConventional, "EEPROM writing (conventional)"},
};

// 6-8-1
inline constexpr ValueName kProfileTypes[] = {
    {0x10, "absolute positioning"},
    {0x11, "relative positioning"},
    {0x12, "position latch absolute positioning"},
    {0x13, "position latch relative positioning"},
    {0x20, "continuous revolution (JOG)"},
    {0x31, "homing 1 (HOME and Z phase)"},
    {0x32, "homing 2 (HOME)"},
    {0x33, "homing 3 (Z phase)"},
};

}  // namespace servotrace::rtex
