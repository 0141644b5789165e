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

struct ObjectClass {
  std::uint16_t id = 0;
  std::string_view key;  // lower_snake
  std::string_view name;
  std::uint16_t first_instance = 1;
  std::uint16_t last_instance = 1;
  std::span<const ServiceName> services;
  std::span<const Attribute> attributes;
  std::string_view section;
};

}  // namespace servotrace::devicenet
