// SPDX-License-Identifier: MIT
// Short forms for the rows of the RTEX tables.
#pragma once

#include "decoder/core/layout_check.hpp"

namespace servotrace::rtex {

constexpr Field flag(std::string_view key, std::string_view label, std::uint16_t bit, std::string_view section,
                     std::string_view explanation = {}, Role role = Role::kPlain) {
  return {.key = key,
          .label = label,
          .first_bit = bit,
          .width = 1,
          .kind = Kind::kBool,
          .role = role,
          .section = section,
          .explanation = explanation};
}

// A flag whose changes are events of the timeline.
constexpr Field state(std::string_view key, std::string_view label, std::uint16_t bit, std::string_view section,
                      std::string_view explanation = {}) {
  return flag(key, label, bit, section, explanation, Role::kState);
}

// Bits the manual fixes at 0.
constexpr Field unused(std::string_view key, std::uint16_t bit, std::uint16_t width, std::string_view section) {
  return {.key = key,
          .label = "Unused",
          .first_bit = bit,
          .width = width,
          .kind = width == 1 ? Kind::kBool : Kind::kUnsigned,
          .base = Base::kHex,
          .reserved = true,
          .section = section,
          .explanation = "the manual fixes it at 0"};
}

constexpr Field number(std::string_view key, std::string_view label, std::uint16_t bit, std::uint16_t width,
                       std::string_view section, std::string_view explanation = {}) {
  return {.key = key, .label = label, .first_bit = bit, .width = width, .section = section, .explanation = explanation};
}

constexpr Field hex(std::string_view key, std::string_view label, std::uint16_t bit, std::uint16_t width,
                    std::string_view section, std::string_view explanation = {}) {
  Field field = number(key, label, bit, width, section, explanation);
  field.base = Base::kHex;
  return field;
}

// A code with names. Not closed: a code outside the list is shown as its number, and judged by a rule.
constexpr Field code(std::string_view key, std::string_view label, std::uint16_t bit, std::uint16_t width,
                     std::span<const ValueName> values, std::string_view section, std::string_view explanation = {}) {
  Field field = hex(key, label, bit, width, section, explanation);
  field.values = values;
  return field;
}

// A signed 32-bit process value that fills a layout of 4 bytes.
constexpr Field signal(std::string_view key, std::string_view label, Unit unit, std::string_view section,
                       std::string_view explanation = {}) {
  return {.key = key,
          .label = label,
          .first_bit = 0,
          .width = 32,
          .kind = Kind::kSigned,
          .role = Role::kSignal,
          .unit = unit,
          .section = section,
          .explanation = explanation};
}

inline constexpr Ratio kTenth{1, 10};

// A torque: the drives send it in 0.1 % of the rated torque.
constexpr Field torque_signal(std::string_view key, std::string_view label, std::string_view section,
                              std::string_view explanation = {}) {
  Field field = signal(key, label, Unit::kPercent, section, explanation);
  field.scale = kTenth;
  return field;
}

// A signed 32-bit number that is no time series.
constexpr Field setting(std::string_view key, std::string_view label, std::string_view section,
                        std::string_view explanation = {}, Unit unit = Unit::kNone) {
  Field field = signal(key, label, unit, section, explanation);
  field.role = Role::kPlain;
  return field;
}

// A layout of 4 bytes: the data words of a block.
constexpr Layout word(std::string_view key, std::string_view title, std::span<const Field> fields,
                      std::string_view section) {
  return {.protocol = "rtex", .key = key, .title = title, .size = 4, .fields = fields, .section = section};
}

}  // namespace servotrace::rtex
