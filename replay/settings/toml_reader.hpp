// SPDX-License-Identifier: MIT
// Typed access to TOML tables: a wrong key, type or value is kept as an error with its place, reading goes on with
// nothing in its stead, and the caller looks once at the end.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "decoder/core/result.hpp"
#include "replay/settings/rule_filter.hpp"

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wold-style-cast"
#endif
#include <toml++/toml.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace servotrace::replay {

// Keeps the error that stands first in the file.
class TomlErrors {
 public:
  explicit TomlErrors(std::string origin) : origin_(std::move(origin)) {}
  void add(const toml::source_region& place, std::string what);
  std::string place(const toml::source_region& region) const;
  const std::optional<Error>& first() const { return first_; }

 private:
  std::string origin_;
  std::optional<Error> first_;
  toml::source_position position_;
};

class TomlTable {
 public:
  // `title` names the table in messages ("[limits]"); every key not in `keys` is an error.
  TomlTable(const toml::table& table, std::string title, std::vector<std::string_view> keys, TomlErrors& errors);

  bool has(std::string_view key) const { return table_.contains(key); }
  std::optional<std::int64_t> integer(std::string_view key, std::int64_t minimum, std::int64_t maximum) const;
  // Integers are taken for numbers too. Never a NaN or infinity.
  std::optional<double> number(std::string_view key) const;
  std::optional<bool> boolean(std::string_view key) const;
  // Never empty.
  std::optional<std::string> text(std::string_view key) const;
  // The index in `choices` of a string value.
  std::optional<std::size_t> choice(std::string_view key, std::span<const std::string_view> choices) const;
  std::optional<std::size_t> choice(std::string_view key, std::initializer_list<std::string_view> choices) const {
    return choice(key, std::span(choices.begin(), choices.size()));
  }
  std::optional<Date> date(std::string_view key) const;
  const toml::table* table(std::string_view key) const;
  const toml::array* array(std::string_view key) const;
  // An array of tables, [[key]].
  template <class Function>
  void each_table(std::string_view key, Function function) const {
    const toml::array* const list = array(key);
    if (list == nullptr) return;
    for (const toml::node& element : *list) {
      if (const toml::table* const entry = element.as_table()) {
        function(*entry);
      } else {
        errors_.add(element.source(), fmt::format("'{}' must be written as tables: [[{}]]", key, key));
      }
    }
  }
  // False, and an error, where the key is missing.
  bool require(std::string_view key) const;
  void fail(std::string_view key, std::string what) const;

 private:
  void wrong_type(const toml::node& node, std::string_view key, std::string_view wanted) const;

  const toml::table& table_;
  std::string title_;
  TomlErrors& errors_;
};

// "a string", "an integer" ...: for messages.
std::string_view type_name(const toml::node& node);

// An integer of any node, with the checks of TomlTable::integer. `what` names it in messages.
std::optional<std::int64_t> integer_of(const toml::node& node, std::string_view what, std::int64_t minimum,
                                       std::int64_t maximum, TomlErrors& errors);

}  // namespace servotrace::replay
