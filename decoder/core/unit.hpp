// SPDX-License-Identifier: MIT
// Units of field values, and the integer ratio that scales a raw value to its unit.
#pragma once

#include <cstdint>
#include <string_view>

namespace servotrace {

enum class Unit : std::uint8_t {
  kNone,
  kCommandUnit,           // RTEX: command units (SX-DSV02203 7-1)
  kCommandUnitPerSecond,  // RTEX: speed where Pr7.25 = 1
  kRevolutionsPerMinute,
  kPercent,
  kStep,                    // NS310: steps (SIE-C718-7 5.3)
  kStepPerSecond,           // NS310: steps/s
  kStepPerSecond2,          // NS310: steps/s^2
  kThousandStepsPerMinute,  // NS310: speeds of class 64h (SIE-C718-7 4.3)
  kPulse,
  kRevolutionsPerSecond,
  kRevolutionsPerSecond2,
  kNanosecond,
  kMicrosecond,
  kMillisecond,
  kSecond,
  kMinute,
  kHertz,
  kPerSecond,  // gains
  kVolt,
  kDegree,
  kDegreeCelsius,
  kByte,
  kAmpere,
  kNewtonMetre,
  kKilogramMetre2,
  kTurn,
  kCount  // not a unit: how many there are
};

// The symbol printed behind a value; empty for kNone.
constexpr std::string_view symbol(Unit unit) {
  switch (unit) {
    case Unit::kNone:
    case Unit::kCount:
      return "";
    case Unit::kCommandUnit:
      return "command units";
    case Unit::kCommandUnitPerSecond:
      return "command units/s";
    case Unit::kRevolutionsPerMinute:
      return "r/min";
    case Unit::kPercent:
      return "%";
    case Unit::kStep:
      return "steps";
    case Unit::kStepPerSecond:
      return "steps/s";
    case Unit::kStepPerSecond2:
      return "steps/s^2";
    case Unit::kThousandStepsPerMinute:
      return "x1000 steps/min";
    case Unit::kPulse:
      return "pulses";
    case Unit::kRevolutionsPerSecond:
      return "s^-1";
    case Unit::kRevolutionsPerSecond2:
      return "s^-2";
    case Unit::kNanosecond:
      return "ns";
    case Unit::kMicrosecond:
      return "us";
    case Unit::kMillisecond:
      return "ms";
    case Unit::kSecond:
      return "s";
    case Unit::kMinute:
      return "min";
    case Unit::kHertz:
      return "Hz";
    case Unit::kPerSecond:
      return "1/s";
    case Unit::kVolt:
      return "V";
    case Unit::kDegree:
      return "deg";
    case Unit::kDegreeCelsius:
      return "degC";
    case Unit::kByte:
      return "bytes";
    case Unit::kAmpere:
      return "A";
    case Unit::kNewtonMetre:
      return "N m";
    case Unit::kKilogramMetre2:
      return "kg m^2";
    case Unit::kTurn:
      return "turns";
  }
  return "";
}

// value in its unit = raw * numerator / denominator. Both above 0.
struct Ratio {
  std::int32_t numerator = 1;
  std::int32_t denominator = 1;
  constexpr bool operator==(const Ratio&) const = default;
};

}  // namespace servotrace
