// SPDX-License-Identifier: MIT
// Objects, attributes and services of explicit messages, as tables: of DeviceNet itself (objects.cpp) and of each drive
// profile (its own folder).
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "decoder/core/layout.hpp"

namespace servotrace::devicenet {

enum class DataType : std::uint8_t {
  kBool,
  kUsint,
  kUint,
  kUdint,
  kSint,
  kInt,
  kDint,
  kByte,
  kWord,
  kDword,
  kShortString,
  kEpath,
  kBytes
};
enum class Access : std::uint8_t { kGet, kSet, kGetSet };
enum class Effective : std::uint8_t { kAtOnce, kAfterReset, kWhenStopped };

// The bytes of a value of this type; 0: variable.
constexpr std::uint8_t size_of(DataType type) {
  switch (type) {
    case DataType::kBool:
    case DataType::kUsint:
    case DataType::kSint:
    case DataType::kByte:
      return 1;
    case DataType::kUint:
    case DataType::kInt:
    case DataType::kWord:
      return 2;
    case DataType::kUdint:
    case DataType::kDint:
    case DataType::kDword:
      return 4;
    case DataType::kShortString:
    case DataType::kEpath:
    case DataType::kBytes:
      return 0;
  }
  return 0;
}
constexpr bool is_signed(DataType type) {
  return type == DataType::kSint || type == DataType::kInt || type == DataType::kDint;
}

struct Attribute {
  std::uint16_t number = 0;
  std::string_view key;   // lower_snake
  std::string_view name;  // in the manual's words
  DataType type = DataType::kUsint;
  Access access = Access::kGet;
  Range range = {};  // raw; minimum == maximum == 0: none
  Unit unit = Unit::kNone;
  Ratio scale = {};
  std::span<const ValueName> values = {};
  std::string_view default_text = {};
  Effective effective = Effective::kAtOnce;
  std::string_view section;
  std::string_view explanation = {};
};

struct ServiceName {
  std::uint8_t code = 0;
  std::string_view name;
};

// A number may have a second row where the manual leaves open which of two data types it has.
struct ObjectClass {
  std::uint16_t id = 0;
  std::string_view key;  // lower_snake
  std::string_view name;
  std::uint16_t first_instance = 1;
  std::uint16_t last_instance = 1;
  std::span<const ServiceName> services;
  std::span<const Attribute> attributes;
  std::string_view section;
  // One a row of `attributes`, in their order (object_layouts.hpp); empty: values are shown as bytes.
  std::span<const Layout> layouts = {};

  constexpr const Attribute* find(std::uint32_t number) const {
    for (const Attribute& row : attributes) {
      if (row.number == number) return &row;
    }
    return nullptr;
  }
  // Of an attribute that has a row a data type: the one a value of `size` bytes is of, else the first.
  constexpr const Attribute* find(std::uint32_t number, std::size_t size) const {
    for (const Attribute& row : attributes) {
      if (row.number == number && size_of(row.type) == size) return &row;
    }
    return find(number);
  }
  constexpr const Layout* layout_of(const Attribute& row) const {
    const auto index = static_cast<std::size_t>(&row - attributes.data());
    return index < layouts.size() ? &layouts[index] : nullptr;
  }
  constexpr bool has_service(std::uint8_t code) const {
    for (const ServiceName& row : services) {
      if (row.code == code) return true;
    }
    return false;
  }
};

// The class of this id, or nullptr.
constexpr const ObjectClass* find_class(std::span<const ObjectClass> classes, std::uint32_t id) {
  for (const ObjectClass& row : classes) {
    if (row.id == id) return &row;
  }
  return nullptr;
}

// The class attributes (instance 0) every class may have.
const ObjectClass& class_attributes();

// The objects every DeviceNet device has (1 to 5) with their attributes, and the position controller classes 24h-27h
// by name.
std::span<const ObjectClass> standard_objects();
// True for the value of a connection path attribute: a CIP path, shown segment by segment.
bool is_path(const Layout& value);

}  // namespace servotrace::devicenet
