// SPDX-License-Identifier: MIT
// The alarms of the ESB by the pattern of DRDY, OVER and BRK (ESB Table 4-12), and the bits of the alarm word (5.4.6).
// C4 and E7 are never reported over DeviceNet and are left out.
#pragma once

#include <array>
#include <utility>

#include "decoder/core/layout.hpp"
#include "decoder/core/text.hpp"

namespace servotrace::esb {

inline constexpr std::string_view kAlarmSection = "ESB 4.4.1 (Table 4-12)";

enum class MotorState : std::uint8_t { kNormal, kServoLock, kServoOff };

// A pattern of the outputs: DRDY in bit 0, OVER in bit 1, BRK in bit 2.
constexpr std::uint8_t pattern(bool drdy, bool over, bool brk) {
  return static_cast<std::uint8_t>((drdy ? 1U : 0U) | (over ? 2U : 0U) | (brk ? 4U : 0U));
}

inline constexpr std::int8_t kNoBit = -1;  // the alarm word has none for it

struct Alarm {
  std::string_view code;  // as the seven-segment display shows it
  std::string_view name;
  std::int8_t word_bit = kNoBit;  // of the alarm word
};

// In the order of the table; the index is the bit of a set of alarms.
inline constexpr auto kAlarms = std::to_array<Alarm>({
    {"E0", "Memory error", kNoBit},
    {"E2", "EEPROM error", kNoBit},
    {"E8", "Interface error", kNoBit},
    {"F0", "Brake-on position error", 0},
    {"F1", "Excess position error", 1},
    {"F2", "Software over travel limit", 2},
    {"F3", "Hardware over travel limit", 3},
    {"F4", "Emergency stop", 4},
    {"F5", "Program error", 5},
    {"F8", "Automatic tuning error", kNoBit},
    {"C2", "RS-232C error", 10},
    {"C3", "CPU error", 11},
    {"A0", "Resolver circuit error", 16},
    {"A1", "Absolute position error", 17},
    {"A3", "Software thermal sensor", 19},
    {"A4", "Velocity error over", 20},
    {"A5", "Home position undefined", 21},
    {"A8", "Brake error", kNoBit},
    {"P0", "Heat sink overheat", 24},
    {"P1", "Abnormal main AC line voltage", 25},
    {"P2", "Over current", 26},
    {"P3", "Control AC line under voltage", 27},
});

// One row of the table: an alarm under a setting of its alarm type.
struct AlarmPattern {
  std::uint8_t alarm = 0;  // index into kAlarms
  bool drdy = false;
  bool over = false;
  bool brk = false;
  MotorState motor = MotorState::kServoOff;
  std::uint16_t setting = 0;       // number of the parameter that chooses the row; 0: none
  std::int32_t setting_value = 0;  // its value for this row
};

inline constexpr auto kAlarmPatterns = std::to_array<AlarmPattern>({
    {0, false, false, false, MotorState::kServoOff, 0, 0},   {1, false, false, false, MotorState::kServoOff, 0, 0},
    {2, false, false, false, MotorState::kServoOff, 0, 0},   {3, false, false, false, MotorState::kServoLock, 0, 0},
    {4, false, false, true, MotorState::kServoLock, 281, 1}, {4, true, true, true, MotorState::kServoLock, 281, 2},
    {4, false, true, true, MotorState::kServoLock, 281, 3},  {5, false, false, true, MotorState::kServoLock, 282, 1},
    {5, true, true, true, MotorState::kServoLock, 282, 2},   {6, true, false, true, MotorState::kServoLock, 283, 0},
    {6, false, false, true, MotorState::kServoLock, 283, 1}, {6, true, true, true, MotorState::kServoLock, 283, 2},
    {7, true, false, false, MotorState::kServoLock, 0, 0},   {8, true, false, true, MotorState::kServoLock, 284, 0},
    {8, true, true, true, MotorState::kServoLock, 284, 2},   {9, true, false, true, MotorState::kNormal, 285, 0},
    {9, true, true, true, MotorState::kNormal, 285, 2},      {10, true, false, true, MotorState::kNormal, 0, 0},
    {10, false, false, true, MotorState::kServoLock, 0, 0},  {10, true, true, true, MotorState::kNormal, 0, 0},
    {11, false, false, false, MotorState::kServoOff, 0, 0},  {12, false, false, false, MotorState::kServoOff, 0, 0},
    {13, false, false, false, MotorState::kServoOff, 0, 0},  {14, false, false, false, MotorState::kServoOff, 0, 0},
    {15, false, true, false, MotorState::kServoOff, 0, 0},   {15, true, true, true, MotorState::kServoLock, 0, 0},
    {16, true, false, true, MotorState::kNormal, 280, 0},    {16, true, true, true, MotorState::kNormal, 280, 2},
    {17, true, true, false, MotorState::kServoLock, 0, 0},   {18, false, false, false, MotorState::kServoOff, 0, 0},
    {19, false, false, false, MotorState::kServoOff, 0, 0},  {20, false, false, false, MotorState::kServoOff, 0, 0},
    {21, false, false, false, MotorState::kServoOff, 0, 0},
});

// The alarms whose row fits, as a set (bit n: kAlarms[n]). `known(number)` returns a pointer to a parameter's known
// value or nullptr; a row whose setting is known to be another does not fit. Without `brake_counts` BRK is not compared
// (the servo is off or the emergency stop holds the brake: BRK is 0 whatever the alarm).
template <class Known>
constexpr std::uint64_t alarms_that_fit(bool drdy, bool over, bool brk, bool brake_counts, Known known) {
  std::uint64_t set = 0;
  for (const AlarmPattern& row : kAlarmPatterns) {
    if (row.drdy != drdy || row.over != over || (brake_counts && row.brk != brk)) continue;
    if (row.setting != 0) {
      const std::int32_t* value = known(row.setting);
      if (value != nullptr && *value != row.setting_value) continue;
    }
    set |= std::uint64_t{1} << row.alarm;
  }
  return set;
}

// `set` narrowed by the alarm word: those whose bit is set; where none is, those the word has no bit for.
constexpr std::uint64_t narrowed(std::uint64_t set, std::uint32_t word) {
  std::uint64_t shown = 0;
  std::uint64_t without_bit = 0;
  for (std::size_t i = 0; i < kAlarms.size(); ++i) {
    const std::uint64_t bit = std::uint64_t{1} << i;
    if (kAlarms[i].word_bit == kNoBit) {
      without_bit |= bit;
    } else if ((word >> kAlarms[i].word_bit & 1U) != 0) {
      shown |= bit;
    }
  }
  // The word is the drive's own word: what it shows stands, whatever the pattern.
  return shown != 0 ? shown : set & without_bit;
}

namespace detail {
// "F1 excess position error" needs code and name in one text: joined at compile time.
template <std::size_t kIndex>
struct AlarmText {
  static constexpr std::size_t kSize = kAlarms[kIndex].code.size() + 1 + kAlarms[kIndex].name.size();
  static constexpr std::array<char, kSize> kText = [] {
    std::array<char, kSize> text{};
    std::size_t next = 0;
    for (const char c : kAlarms[kIndex].code) text[next++] = c;
    text[next++] = ' ';
    for (const char c : kAlarms[kIndex].name) text[next++] = c;
    return text;
  }();
};
template <std::size_t... kIndices>
consteval auto alarm_names(std::index_sequence<kIndices...>) {
  return std::array<ValueName, sizeof...(kIndices)>{
      ValueName{static_cast<std::int64_t>(kIndices),
                std::string_view(AlarmText<kIndices>::kText.data(), AlarmText<kIndices>::kSize)}...};
}
}  // namespace detail
// Names of the bits of a set of alarms: "F1 Excess position error".
inline constexpr auto kAlarmNames = detail::alarm_names(std::make_index_sequence<kAlarms.size()>());

namespace detail {
// "DRDY = 0, or OVER = 1 where EP (281) = 2": the outputs of an alarm by Table 4-12.
using AlarmPage = Text<320>;
consteval auto alarm_pages() {
  std::array<AlarmPage, kAlarms.size()> pages{};
  for (const AlarmPattern& row : kAlarmPatterns) {
    AlarmPage& page = pages[row.alarm];
    if (!page.view().empty()) page << "; ";
    page << "DRDY = " << std::int64_t{row.drdy} << ", OVER = " << std::int64_t{row.over}
         << ", BRK = " << std::int64_t{row.brk};
    if (row.setting != 0) page << " where " << std::int64_t{row.setting} << " = " << std::int64_t{row.setting_value};
  }
  for (std::size_t i = 0; i < pages.size(); ++i) {
    pages[i] << "; ";
    if (kAlarms[i].word_bit == kNoBit) {
      pages[i] << "no bit of the alarm word";
    } else {
      pages[i] << "bit " << std::int64_t{kAlarms[i].word_bit} << " of the alarm word";
    }
    if (pages[i].is_full()) throw "an alarm's page does not fit";
  }
  return pages;
}
inline constexpr auto kAlarmPages = alarm_pages();
consteval auto alarm_table() {
  auto rows = kAlarmNames;
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].explanation = kAlarmPages[i].view();
  return rows;
}
}  // namespace detail
// Every alarm with its outputs, for the rules' pages.
inline constexpr auto kAlarmTable = detail::alarm_table();

}  // namespace servotrace::esb
