// SPDX-License-Identifier: MIT
// Field and Layout: the rows that say what the bytes of a message mean. Everything that reads, writes, shows or
// documents a message is a visitor over these rows (see layout_check.hpp for what makes a row legal).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "decoder/core/bytes.hpp"
#include "decoder/core/unit.hpp"

namespace servotrace {

enum class Kind : std::uint8_t { kUnsigned, kSigned, kBool, kBytes, kText };
enum class Base : std::uint8_t { kDec, kHex };

// What a field is good for beside being shown.
enum class Role : std::uint8_t {
  kPlain,
  kSignal,  // a process value: a numeric series a axis for graphs and export (position, speed, torque)
  kState    // a state: every change of it is an event of the timeline (servo on, alarm, control mode)
};

// One named value of a field. `explanation` may be empty.
struct ValueName {
  std::int64_t value = 0;
  std::string_view name;
  std::string_view explanation = {};
};

struct Range {
  std::int64_t minimum = 0;
  std::int64_t maximum = 0;
};

// One field. Bits count from 0, the least significant bit of byte 0; byte n starts at bit 8n. A field wider than what
// is left of its byte goes on in the next one, least significant byte first, unless `order` is kBig (whole bytes only).
struct Field {
  std::string_view key;    // lower_snake, unique in its layout; the last part of the filter name
  std::string_view label;  // for people, in the manual's words
  std::uint16_t first_bit = 0;
  std::uint16_t width =
      0;  // bits; numbers up to 64. 0: all bytes up to the end of the message (bytes and text, last row)
  Kind kind = Kind::kUnsigned;
  Base base = Base::kDec;
  ByteOrder order = ByteOrder::kLittle;
  Role role = Role::kPlain;
  Unit unit = Unit::kNone;
  Ratio scale = {};
  std::span<const ValueName> values = {};  // sorted by value, unique
  bool closed = false;                     // a value outside `values` is a violation
  Range range = {};                        // legal raw values; minimum == maximum == 0: no range
  bool reserved = false;                   // the manual fixes it at 0
  std::string_view section;                // manual and section, "SX-DSV02203 4-2-2-1"
  std::string_view explanation = {};

  constexpr bool has_range() const { return range.minimum != 0 || range.maximum != 0; }
  constexpr std::size_t first_byte() const { return first_bit / 8U; }
  // Bytes that hold the field (at least 1); for a field of width 0 the ones from first_byte() on.
  constexpr std::size_t byte_count() const { return width == 0 ? 0 : (first_bit % 8U + width + 7U) / 8U; }
};

// A message or a fixed part of one. Filter name of a field: `<protocol>.<key>.<field key>`; where `key` is empty
// `<protocol>.<field key>`. Several layouts may share a key (variants of one place): fields of equal filter names must
// then be of equal type.
struct Layout {
  std::string_view protocol;  // "rtex", "dnet", "ns310", "esb"
  std::string_view key;
  std::string_view title;
  std::uint16_t size = 0;  // bytes; a message with a field of width 0 may be longer
  std::span<const Field> fields;
  std::string_view section;

  constexpr const Field* find(std::string_view field_key) const {
    for (const Field& field : fields) {
      if (field.key == field_key) return &field;
    }
    return nullptr;
  }
};

// The first bit of `bit` (0 = least significant) of byte `byte`.
constexpr std::uint16_t at(unsigned byte, unsigned bit = 0) { return static_cast<std::uint16_t>(byte * 8U + bit); }

// The row of `values` that names `value`, or nullptr.
constexpr const ValueName* find_value(std::span<const ValueName> values, std::int64_t value) {
  for (const ValueName& row : values) {
    if (row.value == value) return &row;
  }
  return nullptr;
}

// True where `value` breaks what the row says: not in a closed list, outside the range, or not 0 where reserved.
constexpr bool is_violation(const Field& field, std::int64_t value) {
  if (field.reserved && value != 0) return true;
  if (field.closed && find_value(field.values, value) == nullptr) return true;
  return field.has_range() && (value < field.range.minimum || value > field.range.maximum);
}

}  // namespace servotrace
