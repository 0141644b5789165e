// SPDX-License-Identifier: MIT
// From symptom to likely causes, as data: one line says that what a drive or the network reported is commonly explained
// by a violation this program can see, or by something it cannot. Each line cites the section it rests on.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace servotrace::report {

struct Symptom {
  std::string_view rule;      // what was reported
  std::int64_t argument = 0;  // first argument of that finding (alarm, error code); kAny: whatever it is
  std::string_view cause;     // the rule that explains it where it was found before; empty: nothing on the bus shows it
  std::string_view text;      // the explanation, a sentence without a full stop
  std::string_view section;
  std::int64_t sub = -1;  // RX902: the sub number this points at, where the main number is shared; -1: none
};

inline constexpr std::int64_t kAny = -1;

// A parameter that explains a fault where the capture shows it overwritten with another value before.
struct ParameterSymptom {
  std::string_view rule;
  std::int64_t argument = 0;   // as in Symptom
  std::string_view parameter;  // how its name begins; empty: any
  std::string_view text;
  std::string_view section;
};
inline constexpr auto kParameterSymptoms = std::to_array<ParameterSymptom>({
    {"RX902", 24, "Pr0.13 ", "the 1st torque limit was changed: with too little torque the axis cannot follow",
     "SX-DSV02203 7-2-3-4"},
    {"RX902", 24, "Pr5.22 ", "the 2nd torque limit was changed: with too little torque the axis cannot follow",
     "SX-DSV02203 7-2-3-4"},
    {"RX902", 26, "Pr5.13 ", "the over-speed level was changed", "SX-DSV02203 7-1-1"},
    {"RX902", 86, "Pr7.38 ", "the limit of missed updates was changed", "SX-DSV02203 8-1-8"},
    {"RX902", 93, "Pr7.2", "a setting of cycle, updating ratio or operation was changed", "SX-DSV02203 2-5-3"},
    {"RX902", 93, "Pr7.3", "a feedforward or monitor setting was changed", "SX-DSV02203 7-7-4"},
    {"RX902", kAny, "", "a parameter was overwritten with another value", "SX-DSV02203 6-7-1"},
    {"RX901", kAny, "", "a parameter was overwritten with another value", "SX-DSV02203 6-7-1"},
    {"YS901", kAny, "", "an attribute was overwritten with another value", "SIE-C718-7 4.1"},
    {"YS905", kAny, "", "an attribute was overwritten with another value", "SIE-C718-7 4.1"},
    {"NK901", kAny, "", "a parameter was overwritten with another value", "ESB 5.4"},
});

// A row whose cause is the report itself says that the report is its own evidence: nothing lies before it.
// Stronger explanations first: the order is the ranking among causes of equal evidence.
inline constexpr auto kSymptoms = std::to_array<Symptom>({
    // Err86.2: more misses of Update_Counter than Pr7.38. The alarm's main number is shared with Err86.0 and 86.1.
    {"RX902", 86, "RX201", "the master did not update Update_Counter in time, and the drive counts missed updates",
     "SX-DSV02203 8-1-8", 2},
    {"RX902", 86, "RX202", "the master skipped values of Update_Counter, which the drive counts as missed updates",
     "SX-DSV02203 8-1-8", 2},
    {"RX902", 86, "RX203", "the master moved Update_Counter inside an updating cycle", "SX-DSV02203 8-1-8", 2},
    {"RX902", 86, "RX206", "the missed updates went above the limit of Pr7.38", "SX-DSV02203 8-1-8", 2},
    {"RX902", 86, "RX105", "the master sent an undefined cyclic command, cyclic data error 2", "SX-DSV02203 8-1-7", 1},
    {"RX902", 86, "RX102", "the master sent a command block with another MAC-ID, cyclic data error 1",
     "SX-DSV02203 8-1-7", 0},
    {"RX902", 86, "RX103", "the master sent a command block with C/R = 1, cyclic data error 1", "SX-DSV02203 8-1-7", 0},
    {"RX902", 86, "RX107", "the master sent Sub_Chk = 0, cyclic data error 1", "SX-DSV02203 8-1-7", 0},
    {"RX902", 86, "", "the master's cyclic task ran late or stopped: look at its load and at the jitter of the cycle",
     "SX-DSV02203 8-1-8"},
    {"RX902", 83, "RX110", "the drive saw CRC errors cycle after cycle", "SX-DSV02203 8-1-2"},
    {"RX902", 83, "RX101", "the drive saw CRC errors", "SX-DSV02203 8-1-2"},
    {"RX902", 83, "", "cable, connector or noise at this place of the ring, or a drive before it that lost power",
     "SX-DSV02203 8-1-2"},
    {"RX902", 84, "RX112", "the master left the ring without a cycle for longer than the time-out", "SX-DSV02203 8-1-4",
     0},
    {"RX902", 84, "RX111", "the master's cycle jittered more than the drive allows", "SX-DSV02203 8-1-6", 5},
    {"RX902", 84, "RX210", "cycle and updating ratio are no legal pair, so that synchronisation cannot begin",
     "SX-DSV02203 8-1-5"},
    {"RX902", 84, "", "the master's cyclic task stopped, or the ring was broken between two drives",
     "SX-DSV02203 8-1-4"},
    {"RX902", 90, "RX208", "TMG_CNT differed between the axes of one record", "SX-DSV02203 8-1-9"},
    {"RX902", 90, "RX207", "TMG_CNT did not toggle every 2 ms", "SX-DSV02203 8-1-9"},
    {"RX902", 91, "RX404", "the control mode was changed during a profile motion", "SX-DSV02203 8-1-10"},
    {"RX902", 91, "RX402", "the control mode was changed while a non-cyclic command was busy", "SX-DSV02203 8-1-10"},
    {"RX902", 91, "RX403", "the control mode was changed again within 2 ms", "SX-DSV02203 8-1-10"},
    {"RX902", 91, "RX411", "the control mode was changed during homing", "SX-DSV02203 8-1-10"},
    {"RX902", 91, "RX401", "the control mode was changed while a non-cyclic command was held", "SX-DSV02203 8-1-10"},
    {"RX902", 91, "RX502", "homing was commanded in a velocity or torque mode", "SX-DSV02203 8-1-10"},
    {"RX902", 91, "RX507", "homing was commanded during a profile latch or homing", "SX-DSV02203 8-1-10"},
    {"RX902", 91, "RX508", "homing was commanded during a profile motion", "SX-DSV02203 8-1-10"},
    {"RX902", 91, "RX510", "Type_Code of a running profile was changed", "SX-DSV02203 8-1-10"},
    {"RX902", 91, "RX407", "velocity or torque control was commanded in full-closed control", "SX-DSV02203 8-1-10"},
    {"RX902", 91, "RX408", "a control mode was commanded that this cycle does not allow", "SX-DSV02203 8-1-10"},
    {"RX902", 27, "RX703", "the command position moved faster than the motor can", "SX-DSV02203 7-1-4-1"},
    {"RX902", 27, "RX702",
     "the servo was switched on with the command position far from the actual one: the axis jumped",
     "SX-DSV02203 7-1-1"},
    {"RX902", 27, "RX504", "after homing the command position did not start from the new reference",
     "SX-DSV02203 7-2-1"},
    {"RX902", 27, "RX604", "the servo was switched on during an attribute C validation", "SX-DSV02203 6-3-2"},
    {"RX902", 26, "RX702",
     "the servo was switched on with the command position far from the actual one: the axis jumped",
     "SX-DSV02203 7-1-1"},
    {"RX902", 26, "RX703", "the command position moved faster than the motor can", "SX-DSV02203 7-1-4-1"},
    {"RX902", 26, "", "the command asked for more speed than the over-speed level, or the axis overshot",
     "SX-DSV02203 7-1-1"},
    {"RX902", 24, "RX702",
     "the servo was switched on with the command position far from the actual one: the axis jumped",
     "SX-DSV02203 7-1-1"},
    {"RX902", 24, "RX703", "the command position moved faster than the motor can", "SX-DSV02203 7-1-4-1"},
    {"RX902", 24, "RX706", "the command position kept moving while the drive was not active", "SX-DSV02203 7-1-1"},
    {"RX902", 24, "", "the axis was blocked or too heavily loaded, or its torque limited", "SX-DSV02203 8-1"},
    {"RX902", 38, "RX518", "homing on an inhibit input was commanded although the input is an over-travel inhibit",
     "SX-DSV02203 7-2-3"},
    {"RX902", 38, "RX705", "motion was commanded into a limit", "SX-DSV02203 7-6-3"},
    {"RX902", 93, "RX210", "communication cycle and updating ratio are no pair the drive knows", "SX-DSV02203 2-5-1"},
    {"RX902", 93, "RX611", "a parameter was written to a value the drive refuses", "SX-DSV02203 2-5-2"},
    {"RX902", 94, "RX503", "homing was abandoned before it was complete", "SX-DSV02203 7-2-1"},
    {"RX902", kAny, "RX605", "a parameter was written shortly before, and the drive did not take the value as it stood",
     "SX-DSV02203 6-7"},
    {"RX902", kAny, "RX909", "the servo dropped while the master still asked for it", "SX-DSV02203 4-2-3-1"},
    {"RX909", kAny, "RX705", "motion was commanded into a limit", "SX-DSV02203 7-6-3"},
    {"RX909", kAny, "RX907", "the emergency stop input was active", "SX-DSV02203 4-3-4"},
    {"RX909", kAny, "", "main power, a safety input or a dynamic brake took the servo off", "SX-DSV02203 4-3-3"},
    {"RX108", kAny, "RX101", "CRC errors came first: the ring was failing before it was lost", "SX-DSV02203 8-1-2"},
    {"RX108", kAny, "", "a cable between two drives is open, or a drive lost its control power", "SX-DSV02203 8-1-4"},
    {"RX110", kAny, "RX101", "single CRC errors came first: the connection was failing before it failed altogether",
     "SX-DSV02203 8-1-2"},
    {"RX112", kAny, "RX112", "the master left the ring without a cycle: its cyclic task stopped or was delayed",
     "SX-DSV02203 8-1-4"},
    {"RX110", kAny, "", "cable, connector or noise at this place of the ring", "SX-DSV02203 8-1-2"},
    {"RX901", 0x2E, "RX404", "the control mode was changed during a profile motion", "SX-DSV02203 6-10"},
    {"RX901", 0x2E, "RX402", "the control mode was changed while a non-cyclic command was busy", "SX-DSV02203 6-10"},
    {"RX901", 0x2E, "RX403", "the control mode was changed again within 2 ms", "SX-DSV02203 6-10"},
    {"RX901", 0x2E, "RX411", "the control mode was changed during homing", "SX-DSV02203 6-10"},
    {"RX901", 0x22, "RX306", "the non-cyclic command is reserved", "SX-DSV02203 6-10"},
    {"RX901", 0x101, "RX303", "another command was started while the one before was busy", "SX-DSV02203 6-10"},
    // DeviceNet
    {"YS901", kAny, "YS201", "motion was started into an active limit", "SIE-C718-7 5.4"},
    {"YS901", kAny, "YS904", "a limit was reached before the alarm", "SIE-C718-7 5.3.3"},
    {"YS901", kAny, "YS903", "the emergency stop input rose before the alarm", "SIE-C718-7 5.3.3"},
    {"YS901", kAny, "YS203", "Enable fell while the axis moved", "SIE-C718-7 5.3.1"},
    {"YS901", kAny, "DN204", "the poll connection timed out before the alarm", "DeviceNet link layer"},
    {"YS901", kAny, "YS402", "the profile filter settings do not fit each other", "SIE-C718-7 4.3.4"},
    {"YS901", kAny, "YS401", "the electronic gear ratio is outside its range", "SIE-C718-7 4.3.1"},
    {"YS902", kAny, "YS102", "the command code is reserved", "SIE-C718-7 5.3.1"},
    {"YS902", kAny, "YS103", "the response code asked for is reserved", "SIE-C718-7 5.3.1"},
    {"YS902", kAny, "YS101", "the axis instance is not 1", "SIE-C718-7 5.3.1"},
    {"YS902", kAny, "YS108", "the target position is outside its range", "SIE-C718-7 5.3.2"},
    {"YS902", kAny, "YS107", "a speed or acceleration is not positive", "SIE-C718-7 5.3.2"},
    {"YS905", kAny, "YS304", "the chain of blocks has no end or leads to an empty block", "SIE-C718-7 5.5"},
    {"YS905", kAny, "YS303", "a block was started half written", "SIE-C718-7 5.5.2"},
    {"YS905", kAny, "YS305", "a block names an attribute it may not", "SIE-C718-7 5.5.2"},
    {"YS903", kAny, "YS904", "a limit was reached before", "SIE-C718-7 5.3.3"},
    {"NK901", kAny, "NK904", "an over-travel limit was run into before the drive dropped out", "ESB 4.4"},
    {"NK901", kAny, "NK903", "the emergency stop was active before the drive dropped out", "ESB 4.4"},
    {"NK901", kAny, "NK311", "the servo was switched off in motion", "ESB 4.3.2"},
    {"NK901", kAny, "NK309", "motion was started before the home position was known", "ESB 4.4.6"},
    {"NK901", kAny, "NK302", "a start was commanded while the drive was busy", "ESB 4.3.5"},
    {"NK901", kAny, "DN204", "the poll connection timed out before the drive dropped out", "DeviceNet link layer"},
    {"NK901", kAny, "", "an alarm of the drive itself: read TA (800) or the drive's display", "ESB 4.4"},
    {"NK106", kAny, "NK109", "the value written is outside its range", "ESB 5.4"},
    {"NK106", kAny, "NK108", "the number is reserved", "ESB 5.4"},
    {"NK106", kAny, "NK110", "the number cannot be used in this direction", "ESB 5.4"},
    {"NK106", kAny, "NK203", "the optional code is not allowed after this program command", "ESB 5.3.1"},
    {"NK106", kAny, "NK202", "a program was open for editing", "ESB 5.3.1"},
    {"NK106", kAny, "NK303", "a start was commanded while a stop was held", "ESB 4.3.4"},
    {"DN204", kAny, "DN104", "the bus itself was failing: CAN error frames came first", "DeviceNet link layer"},
    {"DN204", kAny, "DN102", "two nodes had the same MAC ID", "DeviceNet link layer"},
    {"DN204", kAny, "DN204", "the master let the connection run out: no poll came within four times the packet rate",
     "DeviceNet link layer"},
    {"DN204", kAny, "", "the scanner stopped polling: it was stopped, lost power, or left the bus",
     "DeviceNet link layer"},
    {"DN205", kAny, "DN104", "the bus itself was failing: CAN error frames came first", "DeviceNet link layer"},
    {"DN205", kAny, "DN102", "two nodes had the same MAC ID", "DeviceNet link layer"},
    {"DN205", kAny, "DN204", "the connection had timed out at the slave", "DeviceNet link layer"},
    {"DN205", kAny, "", "the node lost its power, left the bus or was reset (a scanner shows 72)",
     "DeviceNet link layer"},
    {"DN102", kAny, "DN102", "a second device with this MAC ID came on line", "DeviceNet link layer"},
    {"DN102", kAny, "", "two devices carry the same address switches, or a replaced device kept its old address",
     "DeviceNet link layer"},
    {"DN104", kAny, "DN104", "the bus itself fails: error frames", "DeviceNet link layer"},
    {"DN104", kAny, "", "bus wiring, termination, bit rate or shield; or a node that leaves the bus",
     "DeviceNet link layer"},
});

// Findings that are faults: something failed, rather than was done wrong. In the order of their weight: the first kind
// that occurs in a capture is what failed.
struct FaultRule {
  std::string_view rule;
  int weight;  // 2: a stop or loss; 1: a refusal or a report that need not stop anything
};
inline constexpr auto kFaultRules = std::to_array<FaultRule>({
    {"RX902", 2}, {"YS901", 2}, {"NK901", 2}, {"YS905", 2}, {"RX108", 2}, {"RX112", 2}, {"DN102", 2}, {"DN204", 2},
    {"DN205", 2}, {"DN104", 2}, {"RX110", 2}, {"YS903", 2}, {"NK903", 2}, {"RX907", 2}, {"RX909", 2}, {"RX901", 1},
    {"RX904", 1}, {"YS902", 1}, {"NK106", 1}, {"NK904", 1}, {"YS904", 1}, {"DN401", 1}, {"RX101", 1}, {"NK104", 1},
});

}  // namespace servotrace::report
