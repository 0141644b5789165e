// SPDX-License-Identifier: MIT
// What the drive's error, alarm and warning numbers mean (SX-DSV02203 6-10-2, 8-1, 8-2). A number that stands in no
// table is shown as its number.
#pragma once

#include <array>

#include "decoder/core/layout.hpp"
#include "decoder/core/text.hpp"

namespace servotrace::rtex {

// 6-10-2; the explanation is the cause
inline constexpr ValueName kCommandErrors[] = {
    {0x0011, "mismatched MAC-ID", "the MAC-ID of the command is not the drive's"},
    {0x0012, "C/R set, or Sub_Chk clear", "C/R = 1 in a command, or Sub_Chk = 0 in 32-byte mode"},
    {0x0021, "cyclic command undefined", "a cyclic command code 5 to 7"},
    {0x0022, "non-cyclic command undefined or not allowed",
     "the code is undefined, or this control mode does not allow it; or an undefined sub-command"},
    {0x002E, "cyclic command refused",
     "cycle, closed loop, data size and control mode do not go together; or the mode was changed within 2 ms, during a "
     "latch positioning or profile homing, or while Busy = 1; or homing 1xh or 2xh in CV or CT"},
    {0x0031, "Type_Code undefined", "the command's list does not have this Type_Code"},
    {0x0032, "argument out of range", "an argument of the non-cyclic command other than Type_Code"},
    {0x0033, "Command_Data1 out of range", "the cyclic data is outside its setup range"},
    {0x0034, "feedforward out of range", "Command_Data3, Sub_Command_Data2 or 3 is outside its setup range"},
    {0x0041, "write to a read-only parameter", "the parameter can only be read"},
    {0x0042, "alarm cannot be cleared", "the alarm is not of the kind that can be cleared, and no warning is present"},
    {0x0043, "no external scale error to clear", "no full-closed control, or no external scale error"},
    {0x0045, "attribute C validation with servo on", "the validation works with servo off only"},
    {0x0046, "command in the drive-inhibit direction",
     "a command toward an active POT or NOT after the stop, or a profile started while decelerating on it"},
    {0x0051, "multi-turn clear in incremental mode", "the encoder is used as incremental"},
    {0x0052, "homing in absolute mode", "homing 1xh or a profile homing in absolute mode"},
    {0x0053, "position set in absolute mode", "homing 21h or 22h in absolute mode"},
    {0x0055, "multi-turn clear in full-closed control", "homing 31h in full-closed control"},
    {0x0056, "multi-turn clear with servo on", "homing 31h works with servo off only"},
    {0x0057, "homing with servo off", "homing 1xh works with servo on only"},
    {0x0058, "trigger not on a latch terminal", "the external input of the trigger is not assigned to SI5, SI6 or SI7"},
    {0x0059, "homing during a profile operation",
     "any homing during profile 12h, 13h, 31h to 33h; or homing 1xh or 31h during profile 10h, 11h or 20h"},
    {0x005A, "Z phase with an absolute external scale", "an absolute scale of the serial type has no Z phase"},
    {0x0061, "EEPROM writing refused", "the control power is too low"},
    {0x0101, "previous command in process", "another non-cyclic command while Busy = 1"},
    {0x0102, "the drive is accessing the encoder", "the command is not accepted at this moment"},
    {0x0103, "the drive is accessing the external scale", "the command is not accepted at this moment"},
    {0x0104, "Type_Code changed during a profile operation", "Type_Code or Latch_Sel1 changed while In_Progress = 1"},
    {0x0140, "Type_Code changed during a profile operation", "as 0104h: 6-8-7 prints this number for it"},
    {0x0201, "writing inhibited", "Pr7.23 bit 0 inhibits parameter and EEPROM writing over RTEX"},
};

enum class Clearable : std::uint8_t { kUnknown, kNo, kYes };

struct AlarmRow {
  std::uint8_t main = 0;
  std::uint8_t sub = 0;
  std::string_view name;
  Clearable clearable = Clearable::kUnknown;
  std::string_view cause;   // empty: the manual names the alarm only
  std::string_view action;  // empty: the manual names none
  std::string_view section;
};

inline constexpr std::string_view kCableAction =
    "check cable length, routing, shielding and connections, and that it is a shielded cable of category 5e; add a "
    "ferrite core; replace the cable, then the drive";
inline constexpr std::string_view kCycleAction =
    "check the connection and the node before it; check that the controller sends at the cycle of Pr7.20; then the "
    "cable: noise, length, shielding";

// Sorted by main and sub number.
inline constexpr AlarmRow kAlarms[] = {
    {11, 0, "control power supply under-voltage", Clearable::kUnknown, "", "", "SX-DSV02203 6-6-1"},
    {24, 0, "position deviation excess", Clearable::kUnknown, "", "", "SX-DSV02203 7-2-3-4"},
    {26, 0, "over-speed", Clearable::kUnknown, "", "", "SX-DSV02203 7-1-1"},
    {27, 1, "motion command error", Clearable::kUnknown, "", "", "SX-DSV02203 7-2-4-2"},
    {27, 4, "command error (position change too large)", Clearable::kUnknown,
     "the command position changed by too much within a cycle",
     "keep the change of the command position below the motor's maximum speed", "SX-DSV02203 7-1-4-1"},
    {27, 5, "command generation error", Clearable::kUnknown,
     "the distance needed to decelerate exceeds 7FFFFFFFh command units", "raise Pr8.04 or lower the initial speed",
     "SX-DSV02203 7-5-10"},
    {27, 7, "position information initialisation error", Clearable::kUnknown,
     "the servo was turned on while attribute C parameters were validated", "keep the servo off while Busy = 1",
     "SX-DSV02203 6-3-2"},
    {33, 0, "I/F input multiple allocation 1", Clearable::kUnknown, "two functions share one status bit", "",
     "SX-DSV02203 4-3-4"},
    {33, 1, "I/F input multiple allocation 2", Clearable::kUnknown, "two functions share one status bit", "",
     "SX-DSV02203 4-3-4"},
    {33, 8, "external latch input allocation", Clearable::kUnknown, "a latch input is not on its terminal",
     "assign HOME, EXT1 to SI5, EXT2 or POT to SI6, EXT3 or NOT to SI7, as normally open contacts",
     "SX-DSV02203 6-5-2"},
    {38, 2, "drive inhibit input 3", Clearable::kUnknown, "homing on POT or NOT with the drive inhibit input enabled",
     "set Pr5.04 to 1", "SX-DSV02203 6-5-1"},
    {41, 0, "absolute encoder counter overflow", Clearable::kUnknown, "", "", "SX-DSV02203 7-2-4-1"},
    {82, 0, "RTEX node address setting", Clearable::kNo, "the rotary switch is outside 0 to 31",
     "set the rotary switch to 0 to 31 and turn the control power on again", "SX-DSV02203 8-1-1"},
    {83, 0, "RTEX continuous communication error 1", Clearable::kYes,
     "CRC errors of the data for this node went on for too long", kCableAction, "SX-DSV02203 8-1-2"},
    {83, 1, "RTEX continuous communication error 2", Clearable::kYes,
     "CRC errors, missing data or cyclic data errors for this node went on for too long", kCableAction,
     "SX-DSV02203 8-1-3"},
    {84, 0, "RTEX time-out", Clearable::kYes, "no communication data came for too long", kCycleAction,
     "SX-DSV02203 8-1-4"},
    {84, 3, "RTEX synchronisation initialisation error", Clearable::kNo,
     "communication and servo could not be synchronised at start", "replace the drive if it comes again",
     "SX-DSV02203 8-1-5"},
    {84, 5, "RTEX communication cycle error", Clearable::kYes, "the data came at an irregular cycle", kCycleAction,
     "SX-DSV02203 8-1-6"},
    {86, 0, "RTEX cyclic data error 1", Clearable::kYes, "MAC-ID, C/R or Sub_Chk was wrong for too long",
     "correct MAC-ID, C/R and Sub_Chk in the controller", "SX-DSV02203 8-1-7"},
    {86, 1, "RTEX cyclic data error 2", Clearable::kYes, "an undefined cyclic command for too long",
     "correct the cyclic command code in the controller", "SX-DSV02203 8-1-7"},
    {86, 2, "RTEX Update_Counter error", Clearable::kNo, "Update_Counter was not renewed more often than Pr7.38 allows",
     "check cycles and updating ratio of controller and drive; with ratio 1 and no counter, disable the alarm",
     "SX-DSV02203 8-1-8"},
    {90, 2, "RTEX inter-axis sync establishment error", Clearable::kUnknown,
     "a communication error or interruption in full-synchronous mode while synchronising",
     "as for 83.0 and 84.0 (the table says it cannot be cleared, 8-1-9 that it can)", "SX-DSV02203 8-1-9"},
    {91, 1, "RTEX command error", Clearable::kYes, "a defined cyclic command was refused",
     "wait 2 ms between mode changes; check which functions the mode allows", "SX-DSV02203 8-1-10"},
    {93, 5, "parameter setting error 4", Clearable::kUnknown,
     "Pr7.20 and Pr7.21 are no pair, or several feedforwards are set in 32-byte mode",
     "set Pr7.20, Pr7.21 and Pr7.35 to Pr7.37 to values that go together", "SX-DSV02203 2-5-3, 7-7-4"},
    {94, 2, "homing error", Clearable::kUnknown, "the home position could not be found",
     "check HOME, POT and NOT and where the homing starts", "SX-DSV02203 7-5-7"},
    {98, 1, "RTEX hardware error 1", Clearable::kNo, "a fault of the RTEX circuit", "replace the drive",
     "SX-DSV02203 8-1-11"},
    {98, 2, "RTEX hardware error 2", Clearable::kNo, "a fault of the RTEX circuit", "replace the drive",
     "SX-DSV02203 8-1-11"},
    {98, 3, "RTEX hardware error 3", Clearable::kNo, "a fault of the RTEX circuit", "replace the drive",
     "SX-DSV02203 8-1-11"},
};

namespace detail {
using AlarmPage = Text<400>;
consteval auto alarm_pages() {
  std::array<AlarmPage, std::size(kAlarms)> pages{};
  for (std::size_t i = 0; i < pages.size(); ++i) {
    const AlarmRow& row = kAlarms[i];
    if (!row.cause.empty()) pages[i] << "cause: " << row.cause << "; ";
    if (!row.action.empty()) pages[i] << "remedy: " << row.action << "; ";
    if (row.clearable == Clearable::kYes) pages[i] << "can be cleared; ";
    if (row.clearable == Clearable::kNo) pages[i] << "cannot be cleared; ";
    pages[i] << row.section;
    if (pages[i].is_full()) throw "an alarm's page does not fit";
  }
  return pages;
}
inline constexpr auto kAlarmPages = alarm_pages();
consteval auto alarm_table() {
  std::array<ValueName, std::size(kAlarms)> rows{};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i] = {std::int64_t{kAlarms[i].main} << 8 | kAlarms[i].sub, kAlarms[i].name, kAlarmPages[i].view()};
  }
  return rows;
}
}  // namespace detail

// Every alarm the manual names with cause and remedy, for the rule's page. The value is main and sub number.
inline constexpr auto kAlarmTable = detail::alarm_table();

// The main number alone (Pr7.23 bit 1 = 0): all that its sub numbers can mean.
inline constexpr ValueName kAlarmMainNames[] = {
    {0, "no alarm"},
    {11, "control power supply under-voltage"},
    {24, "position deviation excess"},
    {26, "over-speed"},
    {27, "motion command error; command error; command generation error; position initialisation error"},
    {33, "I/F input multiple allocation 1 or 2; external latch input allocation"},
    {38, "drive inhibit input 3"},
    {41, "absolute encoder counter overflow"},
    {82, "RTEX node address setting"},
    {83, "RTEX continuous communication error 1 or 2"},
    {84, "RTEX time-out; synchronisation initialisation error; communication cycle error"},
    {86, "RTEX cyclic data error 1 or 2; Update_Counter error"},
    {90, "RTEX inter-axis sync establishment error"},
    {91, "RTEX command error"},
    {93, "parameter setting error 4"},
    {94, "homing error"},
    {98, "RTEX hardware error 1, 2 or 3"},
};

// 8-2
inline constexpr ValueName kWarningNames[] = {
    {0x00, "no warning"},
    {0xC0, "RTEX continuous communication error", "CRC errors in a row reached Pr7.26"},
    {0xC1, "RTEX accumulated communication error", "CRC errors since the start reached Pr7.27"},
    {0xC2, "RTEX Update_Counter error", "fewer updates of Update_Counter than Pr7.28"},
};

// nullptr where the manual does not name the alarm.
constexpr const AlarmRow* find_alarm(std::uint8_t main, std::uint8_t sub) {
  for (const AlarmRow& row : kAlarms) {
    if (row.main == main && row.sub == sub) return &row;
  }
  return nullptr;
}

}  // namespace servotrace::rtex
