// SPDX-License-Identifier: MIT
// The layout of an attribute's value, made from its row by the compiler: an object table is the only place where an
// attribute is described.
//   inline constexpr auto kFields = attribute_fields(kAttributes);
//   inline constexpr auto kLayouts = attribute_layouts("dnet", "identity", kAttributes, kFields);
// and `.layouts = kLayouts` in the ObjectClass row: the DeviceNet stage then shows every value of it by itself.
#pragma once

#include <array>
#include <cstddef>

#include "decoder/core/layout_check.hpp"
#include "decoder/devicenet/objects.hpp"

namespace servotrace::devicenet {

// Two rows an attribute: a SHORT_STRING is its length and its text, everything else uses the first alone.
template <std::size_t kCount>
consteval std::array<Field, 2 * kCount> attribute_fields(const Attribute (&attributes)[kCount]) {
  std::array<Field, 2 * kCount> fields{};
  for (std::size_t i = 0; i < kCount; ++i) {
    const Attribute& row = attributes[i];
    Field& field = fields[2 * i];
    Field& second = fields[2 * i + 1];
    const bool number = size_of(row.type) != 0;
    const bool text = row.type == DataType::kShortString;
    field.key = row.key;
    field.label = row.name;
    field.section = row.section;
    field.explanation = row.explanation;
    if (number) {
      field.width = static_cast<std::uint16_t>(size_of(row.type) * 8U);
      field.kind = is_signed(row.type) ? Kind::kSigned : Kind::kUnsigned;
      field.base = row.type == DataType::kByte || row.type == DataType::kWord || row.type == DataType::kDword
                       ? Base::kHex
                       : Base::kDec;
      field.unit = row.unit;
      field.scale = row.scale;
      field.values = row.values;
      field.range = row.range;
    } else {
      field.kind = text ? Kind::kText : Kind::kBytes;
    }
    if (text) {
      second = field;
      second.first_bit = at(1);
      field = Field{.key = "length",
                    .label = "Length",
                    .first_bit = at(0),
                    .width = 8,
                    .unit = Unit::kByte,
                    .section = row.section};
    }
  }
  return fields;
}

template <std::size_t kCount>
consteval std::array<Layout, kCount> attribute_layouts(std::string_view protocol, std::string_view key,
                                                       const Attribute (&attributes)[kCount],
                                                       const std::array<Field, 2 * kCount>& fields) {
  std::array<Layout, kCount> layouts{};
  for (std::size_t i = 0; i < kCount; ++i) {
    const Attribute& row = attributes[i];
    const bool text = row.type == DataType::kShortString;
    layouts[i] = Layout{.protocol = protocol,
                        .key = key,
                        .title = row.name,
                        .size = text ? std::uint16_t{1} : std::uint16_t{size_of(row.type)},
                        .fields = {&fields[2 * i], text ? std::size_t{2} : std::size_t{1}},
                        .section = row.section};
    if (!well_formed(layouts[i])) throw "an attribute row makes no legal layout";
  }
  return layouts;
}

}  // namespace servotrace::devicenet
