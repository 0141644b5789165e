// SPDX-License-Identifier: MIT
#include "captures/simulator/table_reader.hpp"

#include <cmath>

namespace servotrace::simulator {
namespace {

std::string quoted(std::string_view key) { return '"' + std::string(key) + '"'; }

int digit_value(char digit) {
  if (digit >= '0' && digit <= '9') return digit - '0';
  if (digit >= 'a' && digit <= 'f') return digit - 'a' + 10;
  if (digit >= 'A' && digit <= 'F') return digit - 'A' + 10;
  return -1;
}

}  // namespace

void Problems::add(const toml::source_region& where, std::string what) {
  if (error_) return;
  error_ = Error{origin_ + ':' + std::to_string(where.begin.line) + ':' + std::to_string(where.begin.column),
                 std::move(what)};
}

const toml::source_region& TableReader::where(std::string_view key) const {
  const toml::node* node = table_.get(key);
  return node == nullptr ? table_.source() : node->source();
}

const toml::node* TableReader::take(std::string_view key) {
  known_.emplace(key);
  return table_.get(key);
}

const toml::node* TableReader::need(std::string_view key) {
  const toml::node* node = take(key);
  if (node == nullptr) problems_.add(table_.source(), quoted(key) + " is missing");
  return node;
}

bool TableReader::boolean(std::string_view key, bool otherwise) {
  const toml::node* node = take(key);
  if (node == nullptr) return otherwise;
  if (const auto* value = node->as_boolean()) return value->get();
  problems_.add(node->source(), quoted(key) + " must be true or false");
  return otherwise;
}

std::int64_t TableReader::checked(std::string_view key, const toml::node& node, std::int64_t otherwise,
                                  std::int64_t minimum, std::int64_t maximum) {
  const auto* value = node.as_integer();
  if (value == nullptr) {
    problems_.add(node.source(), quoted(key) + " must be a whole number");
    return otherwise;
  }
  if (value->get() < minimum || value->get() > maximum) {
    problems_.add(node.source(),
                  quoted(key) + " must be from " + std::to_string(minimum) + " to " + std::to_string(maximum));
    return otherwise;
  }
  return value->get();
}

std::int64_t TableReader::integer(std::string_view key, std::int64_t otherwise, std::int64_t minimum,
                                  std::int64_t maximum) {
  const toml::node* node = take(key);
  return node == nullptr ? otherwise : checked(key, *node, otherwise, minimum, maximum);
}

std::int64_t TableReader::integer(std::string_view key, std::int64_t minimum, std::int64_t maximum) {
  const toml::node* node = need(key);
  return node == nullptr ? minimum : checked(key, *node, minimum, minimum, maximum);
}

std::optional<std::int64_t> TableReader::optional_integer(std::string_view key, std::int64_t minimum,
                                                          std::int64_t maximum) {
  const toml::node* node = take(key);
  if (node == nullptr) return std::nullopt;
  return checked(key, *node, minimum, minimum, maximum);
}

std::string TableReader::text(std::string_view key, std::string_view otherwise) {
  const toml::node* node = take(key);
  if (node == nullptr) return std::string(otherwise);
  if (const auto* value = node->as_string()) return value->get();
  problems_.add(node->source(), quoted(key) + " must be a text");
  return std::string(otherwise);
}

std::string TableReader::text(std::string_view key) {
  const toml::node* node = need(key);
  return node == nullptr ? std::string() : text(key, "");
}

std::vector<std::uint8_t> TableReader::bytes(std::string_view key) {
  std::vector<std::uint8_t> result;
  const std::string digits = text(key, "");
  int high = -1;
  for (const char letter : digits) {
    if (letter == ' ' && high < 0) continue;
    const int value = digit_value(letter);
    if (value < 0) {
      fail(key, quoted(key) + " must be bytes in hexadecimal, like \"01 2A FF\"");
      return {};
    }
    if (high < 0) {
      high = value;
    } else {
      result.push_back(static_cast<std::uint8_t>(high << 4 | value));
      high = -1;
    }
  }
  if (high >= 0) fail(key, quoted(key) + " ends with half a byte");
  return result;
}

std::vector<std::string> TableReader::texts(std::string_view key) {
  std::vector<std::string> result;
  const toml::array* list = array(key);
  if (list == nullptr) return result;
  for (const toml::node& node : *list) {
    if (const auto* value = node.as_string()) {
      result.push_back(value->get());
    } else {
      problems_.add(node.source(), quoted(key) + " must be a list of texts");
    }
  }
  return result;
}

std::optional<double> TableReader::optional_number(std::string_view key) {
  const toml::node* node = take(key);
  if (node == nullptr) return std::nullopt;
  if (const auto* whole = node->as_integer()) return static_cast<double>(whole->get());
  if (const auto* number = node->as_floating_point()) {
    if (std::isfinite(number->get())) return number->get();
  }
  problems_.add(node->source(), quoted(key) + " must be a number");
  return 0.0;
}

std::optional<DurationNs> TableReader::duration(std::string_view key, double unit_ns) {
  const std::optional<double> number = optional_number(key);
  if (!number) return std::nullopt;
  // A day is more than any scenario lasts, and far from what overflows.
  if (*number < 0 || *number * unit_ns > 86'400e9) {
    fail(key, quoted(key) + " must be a time from 0 to one day");
    return 0;
  }
  return std::llround(*number * unit_ns);
}

DurationNs TableReader::milliseconds(std::string_view key, DurationNs otherwise_ns) {
  return duration(key, 1e6).value_or(otherwise_ns);
}
DurationNs TableReader::microseconds(std::string_view key, DurationNs otherwise_ns) {
  return duration(key, 1e3).value_or(otherwise_ns);
}
std::optional<DurationNs> TableReader::optional_milliseconds(std::string_view key) { return duration(key, 1e6); }

const toml::table* TableReader::table(std::string_view key) {
  const toml::node* node = take(key);
  if (node == nullptr) return nullptr;
  if (!node->is_table()) problems_.add(node->source(), quoted(key) + " must be a table");
  return node->as_table();
}

const toml::array* TableReader::array(std::string_view key) {
  const toml::node* node = take(key);
  if (node == nullptr) return nullptr;
  if (!node->is_array()) problems_.add(node->source(), quoted(key) + " must be a list");
  return node->as_array();
}

std::vector<const toml::table*> TableReader::tables(std::string_view key) {
  std::vector<const toml::table*> result;
  const toml::array* list = array(key);
  if (list == nullptr) return result;
  for (const toml::node& node : *list) {
    if (const toml::table* entry = node.as_table()) {
      result.push_back(entry);
    } else {
      problems_.add(node.source(), quoted(key) + " must be a list of tables");
    }
  }
  return result;
}

void TableReader::done() {
  const toml::key* first = nullptr;
  for (const auto& [key, node] : table_) {
    if (known_.contains(key.str())) continue;
    const bool earlier = first == nullptr || key.source().begin.line < first->source().begin.line ||
                         (key.source().begin.line == first->source().begin.line &&
                          key.source().begin.column < first->source().begin.column);
    if (earlier) first = &key;
  }
  if (first != nullptr) problems_.add(first->source(), "unknown key " + quoted(first->str()));
}

}  // namespace servotrace::simulator
