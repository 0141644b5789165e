// SPDX-License-Identifier: MIT
#include "replay/settings/toml_reader.hpp"

#include <cmath>

#include "replay/settings/suggest.hpp"

namespace servotrace::replay {

void TomlErrors::add(const toml::source_region& place_in_file, std::string what) {
  if (first_ && !(place_in_file.begin < position_)) return;
  position_ = place_in_file.begin;
  first_ = Error{place(place_in_file), std::move(what)};
}

std::string TomlErrors::place(const toml::source_region& region) const {
  if (!region.begin) return origin_;
  return fmt::format("{}:{}:{}", origin_, region.begin.line, region.begin.column);
}

std::string_view type_name(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "an array";
    case toml::node_type::string:
      return "a string";
    case toml::node_type::integer:
      return "an integer";
    case toml::node_type::floating_point:
      return "a number with a fraction";
    case toml::node_type::boolean:
      return "a boolean";
    case toml::node_type::date:
      return "a date";
    case toml::node_type::time:
      return "a time";
    case toml::node_type::date_time:
      return "a date with a time";
    case toml::node_type::none:
      break;
  }
  return "nothing";
}

std::optional<std::int64_t> integer_of(const toml::node& node, std::string_view what, std::int64_t minimum,
                                       std::int64_t maximum, TomlErrors& errors) {
  const toml::value<std::int64_t>* const value = node.as_integer();
  if (value == nullptr) {
    errors.add(node.source(), fmt::format("'{}' must be an integer, not {}", what, type_name(node)));
    return {};
  }
  if (value->get() >= minimum && value->get() <= maximum) return value->get();
  if (maximum == std::numeric_limits<std::int64_t>::max()) {
    errors.add(node.source(), fmt::format("'{}' = {}: must be at least {}", what, value->get(), minimum));
  } else {
    errors.add(node.source(), fmt::format("'{}' = {}: must be {} to {}", what, value->get(), minimum, maximum));
  }
  return {};
}

TomlTable::TomlTable(const toml::table& table, std::string title, std::vector<std::string_view> known,
                     TomlErrors& errors)
    : table_(table), title_(std::move(title)), errors_(errors) {
  for (auto&& [key, node] : table) {
    bool found = false;
    for (const std::string_view candidate : known) found = found || candidate == key.str();
    if (found) continue;
    const std::string place = title_.empty() ? std::string() : " in " + title_;
    errors_.add(key.source(), fmt::format("unknown key '{}'{}{}", key.str(), place, did_you_mean(key.str(), known)));
  }
}

void TomlTable::wrong_type(const toml::node& node, std::string_view key, std::string_view wanted) const {
  errors_.add(node.source(), fmt::format("'{}' must be {}, not {}", key, wanted, type_name(node)));
}

std::optional<std::int64_t> TomlTable::integer(std::string_view key, std::int64_t minimum, std::int64_t maximum) const {
  const toml::node* const node = table_.get(key);
  if (node == nullptr) return {};
  return integer_of(*node, key, minimum, maximum, errors_);
}

std::optional<double> TomlTable::number(std::string_view key) const {
  const toml::node* const node = table_.get(key);
  if (node == nullptr) return {};
  if (!node->is_number()) {
    wrong_type(*node, key, "a number");
    return {};
  }
  const double value = node->value_or(std::numeric_limits<double>::quiet_NaN());
  if (std::isfinite(value)) return value;
  errors_.add(node->source(), fmt::format("'{}' must be a finite number", key));
  return {};
}

std::optional<bool> TomlTable::boolean(std::string_view key) const {
  const toml::node* const node = table_.get(key);
  if (node == nullptr) return {};
  if (const toml::value<bool>* const value = node->as_boolean()) return value->get();
  wrong_type(*node, key, "true or false");
  return {};
}

std::optional<std::string> TomlTable::text(std::string_view key) const {
  const toml::node* const node = table_.get(key);
  if (node == nullptr) return {};
  const toml::value<std::string>* const value = node->as_string();
  if (value == nullptr) {
    wrong_type(*node, key, "a string");
    return {};
  }
  if (!value->get().empty()) return value->get();
  errors_.add(node->source(), fmt::format("'{}' must not be empty", key));
  return {};
}

std::optional<std::size_t> TomlTable::choice(std::string_view key, std::span<const std::string_view> choices) const {
  const std::optional<std::string> value = text(key);
  if (!value) return {};
  std::string wanted;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    if (choices[i] == *value) return i;
    if (i > 0) wanted += i + 1 == choices.size() ? " or " : ", ";
    wanted += fmt::format("\"{}\"", choices[i]);
  }
  fail(key, fmt::format("'{}' = \"{}\": must be {}", key, *value, wanted));
  return {};
}

std::optional<Date> TomlTable::date(std::string_view key) const {
  const toml::node* const node = table_.get(key);
  if (node == nullptr) return {};
  const toml::value<toml::date>* const value = node->as_date();
  if (value == nullptr) {
    wrong_type(*node, key, "a date such as 2027-01-31 (no quotes)");
    return {};
  }
  return Date{value->get().year, value->get().month, value->get().day};
}

const toml::table* TomlTable::table(std::string_view key) const {
  const toml::node* const node = table_.get(key);
  if (node == nullptr) return nullptr;
  if (!node->is_table()) wrong_type(*node, key, "a table");
  return node->as_table();
}

const toml::array* TomlTable::array(std::string_view key) const {
  const toml::node* const node = table_.get(key);
  if (node == nullptr) return nullptr;
  if (node->is_table()) {
    errors_.add(node->source(), fmt::format("'{}' must be written as [[{}]], not [{}]", key, key, key));
    return nullptr;
  }
  if (!node->is_array()) wrong_type(*node, key, "an array");
  return node->as_array();
}

bool TomlTable::require(std::string_view key) const {
  if (has(key)) return true;
  errors_.add(table_.source(), fmt::format("{} needs '{}'", title_, key));
  return false;
}

void TomlTable::fail(std::string_view key, std::string what) const {
  const toml::node* const node = table_.get(key);
  errors_.add(node == nullptr ? table_.source() : node->source(), std::move(what));
}

}  // namespace servotrace::replay
