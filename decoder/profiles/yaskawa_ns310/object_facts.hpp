// SPDX-License-Identifier: MIT
// What Appendix B and chapter 4 say of an attribute, in one line made by the compiler: the explanation of its field, so
// that `decode --explain`, the reference and Wireshark show type, access, default and effective timing beside unit and
// range.
#pragma once

#include <array>

#include "decoder/core/text.hpp"
#include "decoder/devicenet/object_layouts.hpp"

namespace servotrace::ns310 {

using AttributeFacts = Text<320>;

namespace detail {

constexpr std::string_view type_name(devicenet::DataType type) {
  constexpr std::string_view kNames[] = {"BOOL", "USINT", "UINT",  "UDINT",        "SINT",  "INT", "DINT",
                                         "BYTE", "WORD",  "DWORD", "SHORT_STRING", "EPATH", ""};
  return kNames[static_cast<std::size_t>(type)];
}
constexpr std::string_view access_name(devicenet::Access access) {
  constexpr std::string_view kNames[] = {"Get", "Set", "Get/Set"};
  return kNames[static_cast<std::size_t>(access)];
}
constexpr std::string_view effective_name(devicenet::Effective effective) {
  constexpr std::string_view kNames[] = {"at once", "after a Reset or power-up", "when stopped"};
  return kNames[static_cast<std::size_t>(effective)];
}

constexpr AttributeFacts attribute_facts(const devicenet::Attribute& row) {
  AttributeFacts text;
  text << type_name(row.type);
  if (!type_name(row.type).empty()) text << ", ";
  text << access_name(row.access);
  if (!row.default_text.empty()) text << "; default: " << row.default_text;
  if (row.access != devicenet::Access::kGet) text << "; effective " << effective_name(row.effective);
  if (!row.explanation.empty()) text << "; " << row.explanation;
  return text;
}

}  // namespace detail

// One a row of `attributes`, in their order.
template <std::size_t kCount>
consteval std::array<AttributeFacts, kCount> facts_of(const devicenet::Attribute (&attributes)[kCount]) {
  std::array<AttributeFacts, kCount> facts{};
  for (std::size_t i = 0; i < kCount; ++i) {
    facts[i] = detail::attribute_facts(attributes[i]);
    if (facts[i].is_full()) throw "an attribute's facts do not fit";
  }
  return facts;
}

// `fields` (of attribute_fields()) with `facts` as the explanation of every value; `facts` must live as long.
template <std::size_t kCount>
consteval std::array<Field, 2 * kCount> with_facts(std::array<Field, 2 * kCount> fields,
                                                   const devicenet::Attribute (&attributes)[kCount],
                                                   const std::array<AttributeFacts, kCount>& facts) {
  for (std::size_t i = 0; i < kCount; ++i) {
    const bool text = attributes[i].type == devicenet::DataType::kShortString;
    fields[2 * i + (text ? 1 : 0)].explanation = facts[i].view();
  }
  return fields;
}

}  // namespace servotrace::ns310
