// SPDX-License-Identifier: MIT
// The alarms of the NS310 (SIE-C718-7 Table C.1), the SGDH alarms behind each, and what chapter 9 says of causes and
// remedies, in our own words. What chapter 9 does not describe has neither.
#pragma once

#include <array>
#include <utility>

#include "decoder/core/layout.hpp"
#include "decoder/core/text.hpp"

namespace servotrace::ns310 {

inline constexpr std::string_view kAlarmSection = "SIE-C718-7 C.1, 9";

// How an indicator shows the alarm (C.1): MS flashes red where it can be recovered from, is lit red where not.
enum class Indicator : std::uint8_t { kMsFlashesRed, kMsLitRed, kNsLitRed };
inline constexpr std::string_view kIndicatorNames[] = {"MS flashes red", "MS lit red", "NS lit red"};

struct Alarm {
  std::uint8_t code = 0;
  std::string_view name;
  Indicator indicator = Indicator::kMsFlashesRed;
  std::string_view sgdh;  // the SGDH alarms behind it
  std::string_view causes;
  std::string_view remedies;
};

inline constexpr std::string_view kNoSgdhAlarm = "no SGDH alarm";
inline constexpr std::string_view kNotDescribed = "not described in chapter 9";

inline constexpr auto kAlarms = std::to_array<Alarm>({
    {0x01, "Power Element Error", Indicator::kMsFlashesRed,
     "A.03 main circuit encoder error, A.74 overload of the surge current limit resistor",
     "main circuit power switched on and off often, or a defective circuit board",
     "switch the main circuit power less often; else replace the SERVOPACK"},
    {0x02, "Amplifier Overheat", Indicator::kMsFlashesRed, "A.7A heat sink overheated",
     "ambient above 55 degC, poor air flow at the heat sink, a stopped fan or an overload",
     "cool the cabinet, keep the mounting clearances, reduce the load, replace the SERVOPACK where its fan stands"},
    {0x03, "External Overheat", Indicator::kMsFlashesRed, kNoSgdhAlarm, kNotDescribed, kNotDescribed},
    {0x05, "Over Voltage", Indicator::kMsFlashesRed, "A.40 overvoltage, A.41 undervoltage",
     "supply voltage out of specification, more regeneration than the unit takes, a blown fuse or a defective "
     "rectifier",
     "check the supply voltage, the load's inertia and overhanging load; else replace the SERVOPACK"},
    {0x07, "Control Power Error", Indicator::kMsFlashesRed, "A.97 control power off",
     "poor contact of the control supply, or a defective power supply unit",
     "check the connector's wiring and the power supply unit"},
    {0x08, "Sensor Error", Indicator::kMsLitRed,
     "A.81 backup, A.82 checksum, A.83 battery, A.84 data, A.85 overspeed, A.86 overheated, A.C8 clear, A.C9 "
     "communication, A.CA parameter, A.CB echoback, A.CC multi-turn limit mismatch (all of the encoder)",
     "lost encoder supply and battery, a battery below 2.7 V, noise on the encoder cable, power-on above 200 r/min, an "
     "overheated motor, or a multi-turn limit (Pn205) that differs",
     "follow the absolute encoder set-up, renew the battery with the control power on, mend grounding and cable "
     "separation, power on at standstill, correct Pn205; else replace the motor"},
    {0x0A, "Over Load", Indicator::kMsFlashesRed,
     "A.71 overload: high load, A.72 overload: low load, A.73 dynamic brake overload, A.91 overload (warning)",
     "motor wiring wrong or open, a load far above the rated torque, or too much energy for the dynamic brake",
     "check the motor's wiring, reduce torque, inertia or speed, brake dynamically less often, or take a larger motor"},
    {0x0B, "Over Speed", Indicator::kMsFlashesRed, "A.51 overspeed",
     "wrong U, V, W wiring, a reference that is too large, or wrong gain settings",
     "check the motor's wiring, lower the reference, correct the parameters"},
    {0x0C, "Speed Control Error", Indicator::kMsFlashesRed, kNoSgdhAlarm, kNotDescribed, kNotDescribed},
    {0x0D, "Deviation Excess", Indicator::kMsFlashesRed, "A.D0 position error pulse overflow",
     "motor wiring wrong or loose, gains too low, too much load, or acceleration or electronic gear too high",
     "correct the wiring, raise Pn100 and Pn102, reduce the load, the acceleration or the gear ratio"},
    {0x10, "Main Power Error", Indicator::kMsFlashesRed, "A.98 main power off, A.F1 power line open phase",
     "poor contact of the main supply, one phase missing, or a defective power supply unit",
     "check the connector, all phases and the power supply unit"},
    {0x12, "Regeneration Error", Indicator::kMsFlashesRed,
     "A.30 regeneration error, A.32 regenerative overload, A.92 regenerative overload (warning)",
     "a regenerative resistor open or not connected, too small for the energy, or Pn600 not matching it",
     "check the resistor and its wiring, use one that matches the energy, correct Pn600; else replace the SERVOPACK"},
    {0x13, "Servo Processor Error", Indicator::kMsLitRed,
     "A.BF system alarm, A.C1 servo overrun detected, A.EA SGDH system error, A.ED option system error",
     "a defective SERVOPACK, or a motor that ran out of control", "replace the SERVOPACK"},
    {0x14, "EEPROM Error", Indicator::kMsLitRed, "A.02 and A.EE parameter breakdown",
     "power lost while parameters were written, or a defective board or NS310",
     "initialise the parameters (Fn005) and enter the settings anew; else replace SERVOPACK or NS310"},
    {0x15, "Memory Error", Indicator::kMsLitRed, kNoSgdhAlarm, kNotDescribed, kNotDescribed},
    {0x18, "Over Current", Indicator::kMsFlashesRed, "A.10 overcurrent or heat sink overheated",
     "a short between SERVOPACK and motor or in the motor, ambient above 55 degC, bad air flow, or an overload",
     "check the motor's wiring and phases, cool the cabinet, reduce the load; else replace motor or SERVOPACK"},
    {0x20, "Duplicate MAC ID", Indicator::kNsLitRed, "A.E6 DeviceNet duplicate MAC ID error",
     "another node of the network has the same address", "give every node an address of its own (0 to 63)"},
    {0x21, "BUS-OFF Error", Indicator::kNsLitRed, "A.E9 DeviceNet bus-off error",
     "terminators missing, noise on the network wiring, or a wrong baud rate",
     "terminate both ends, keep the network away from power wiring, check the baud rate switch"},
    {0x22, "Dual Port RAM Error", Indicator::kMsLitRed,
     "A.E0 no NS310 unit, A.E1 NS310 unit time-out, A.E2 watchdog counter of the NS310, A.E7 no NS310 detected, A.EB "
     "SERVOPACK initial access, A.EC watchdog counter of the SERVOPACK",
     "an NS310 that is defective or badly mounted, DeviceNet communication interrupted, or a defective SERVOPACK",
     "switch the power off and on, mount the NS310 properly (without one: Fn014); else replace NS310 or SERVOPACK"},
    {0x23, "Wrap Around Error", Indicator::kMsLitRed, kNoSgdhAlarm, kNotDescribed, kNotDescribed},
    {0x24, "Homing Error", Indicator::kMsFlashesRed, kNoSgdhAlarm, kNotDescribed, kNotDescribed},
    {0xF0, "Parameter Setting Error", Indicator::kMsFlashesRed, "A.04 and A.94 parameter setting error",
     "a value outside its range was set, over DeviceNet or before", "set every parameter within its range"},
    {0xF1, "Command Error", Indicator::kMsFlashesRed, "A.95 command error",
     "a command that is not supported, or that the present state does not admit",
     "send supported commands only, and only when their conditions are met"},
    {0xF2, "Combination Error", Indicator::kMsFlashesRed, "A.05 combination error",
     "motor and SERVOPACK capacities that do not match, or encoder parameters not written",
     "use a motor that matches the SERVOPACK"},
    {0xF3, "External Input Error", Indicator::kMsFlashesRed,
     "A.B1 reference speed input read error, A.B2 reference torque input read error",
     "the converter of an analogue reference input is defective", "replace the SERVOPACK"},
    {0xF4, "Switch Setting Error", Indicator::kMsFlashesRed, "A.E8 DeviceNet rotary switch error",
     "the baud rate switch is not at 0 to 2, or the address not 0 to 63", "correct the rotary switches"},
});

constexpr const Alarm* find_alarm(std::int64_t code) {
  for (const Alarm& alarm : kAlarms) {
    if (alarm.code == code) return &alarm;
  }
  return nullptr;
}

// The code of a report that was not read before the report was issued; a code Table C.1 does not have.
inline constexpr std::int64_t kCodeNotRead = -1;
inline constexpr std::int64_t kCodeUnknown = -2;

namespace detail {
// Causes and remedies of one alarm in one text, joined at compile time.
template <std::size_t kIndex>
struct AdviceText {
  static constexpr std::string_view kBetween = "; remedies: ";
  static constexpr const Alarm& kAlarm = kAlarms[kIndex];
  static constexpr std::size_t kSize = kAlarm.causes.size() + kBetween.size() + kAlarm.remedies.size();
  static constexpr std::array<char, kSize> kText = [] {
    std::array<char, kSize> text{};
    std::size_t next = 0;
    for (const std::string_view part : {kAlarm.causes, kBetween, kAlarm.remedies}) {
      for (const char c : part) text[next++] = c;
    }
    return text;
  }();
};
template <std::size_t... kIndices>
consteval auto alarm_advice(std::index_sequence<kIndices...>) {
  return std::array<ValueName, sizeof...(kIndices) + 2>{
      ValueName{kCodeUnknown, "not in Table C.1"}, ValueName{kCodeNotRead, "unknown"},
      ValueName{kAlarms[kIndices].code,
                std::string_view(AdviceText<kIndices>::kText.data(), AdviceText<kIndices>::kSize)}...};
}
// One column of the table as names of the codes, behind rows for what the table cannot say.
template <class Column>
consteval auto alarm_column(std::string_view not_read, std::string_view unknown, Column column) {
  std::array<ValueName, kAlarms.size() + 2> names{};
  names[0] = {kCodeUnknown, unknown};
  names[1] = {kCodeNotRead, not_read};
  for (std::size_t i = 0; i < kAlarms.size(); ++i) names[i + 2] = {kAlarms[i].code, column(kAlarms[i])};
  return names;
}
consteval auto alarm_codes() {
  std::array<ValueName, kAlarms.size() + 1> names{};
  names[0] = {0, "no alarm"};
  for (std::size_t i = 0; i < kAlarms.size(); ++i) names[i + 1] = {kAlarms[i].code, kAlarms[i].name, kAlarms[i].sgdh};
  return names;
}
using AlarmPage = Text<640>;
consteval auto alarm_pages() {
  std::array<AlarmPage, kAlarms.size()> pages{};
  for (std::size_t i = 0; i < pages.size(); ++i) {
    const Alarm& alarm = kAlarms[i];
    pages[i] << kIndicatorNames[static_cast<std::size_t>(alarm.indicator)] << "; SGDH: " << alarm.sgdh
             << "; causes: " << alarm.causes << "; remedies: " << alarm.remedies;
    if (pages[i].is_full()) throw "an alarm's page does not fit";
  }
  return pages;
}
inline constexpr auto kAlarmPages = alarm_pages();
consteval auto alarm_table() {
  std::array<ValueName, kAlarms.size()> rows{};
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = {kAlarms[i].code, kAlarms[i].name, kAlarmPages[i].view()};
  return rows;
}
}  // namespace detail

// Every alarm with indicator, SGDH alarms, causes and remedies, for the rule's page.
inline constexpr auto kAlarmTable = detail::alarm_table();

// The values of the field alarm_code.
inline constexpr auto kAlarmCodes = detail::alarm_codes();
// The same for findings.
inline constexpr auto kAlarmNames = detail::alarm_column("its code was not read (response code 1Eh)", "its code",
                                                         [](const Alarm& alarm) { return alarm.name; });
inline constexpr auto kAlarmSgdh =
    detail::alarm_column("unknown", "not in Table C.1", [](const Alarm& alarm) { return alarm.sgdh; });
// "<causes>; remedies: <remedies>".
inline constexpr auto kAlarmAdvice = detail::alarm_advice(std::make_index_sequence<kAlarms.size()>());

}  // namespace servotrace::ns310
