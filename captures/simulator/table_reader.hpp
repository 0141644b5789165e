// SPDX-License-Identifier: MIT
// Reads a TOML table of a scenario key by key: a wrong type, a value out of range, a missing or an unknown key is an
// error with line and column. The first error of a scenario is kept; after it every getter hands out its default, so
// that a reader needs no checks of its own between two keys.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#define TOML_ENABLE_FORMATTERS 1
#include <toml++/toml.h>

#include "decoder/core/result.hpp"
#include "decoder/core/time.hpp"

namespace servotrace::simulator {

// Where the errors of one scenario go.
class Problems {
 public:
  explicit Problems(std::string origin) : origin_(std::move(origin)) {}

  // Keeps the first problem only.
  void add(const toml::source_region& where, std::string what);
  bool any() const { return error_.has_value(); }
  const Error& error() const { return *error_; }  // precondition: any()

 private:
  std::string origin_;
  std::optional<Error> error_;
};

// A word of a scenario and what it stands for.
template <class Value>
struct Choice {
  std::string_view word;
  Value value;
};

class TableReader {
 public:
  // `table` and `problems` must outlive the reader.
  TableReader(const toml::table& table, Problems& problems) : table_(table), problems_(problems) {}
  TableReader(const TableReader&) = delete;
  TableReader& operator=(const TableReader&) = delete;

  bool has(std::string_view key) const { return table_.contains(key); }
  const toml::source_region& where() const { return table_.source(); }
  const toml::source_region& where(std::string_view key) const;
  Problems& problems() { return problems_; }
  void fail(std::string_view key, std::string what) { problems_.add(where(key), std::move(what)); }

  // Each getter marks its key as known. Without a default the key must be there.
  bool boolean(std::string_view key, bool otherwise);
  std::int64_t integer(std::string_view key, std::int64_t otherwise, std::int64_t minimum, std::int64_t maximum);
  std::int64_t integer(std::string_view key, std::int64_t minimum, std::int64_t maximum);
  std::optional<std::int64_t> optional_integer(std::string_view key, std::int64_t minimum, std::int64_t maximum);
  std::string text(std::string_view key, std::string_view otherwise);
  std::string text(std::string_view key);
  // "01 2A FF": bytes in hexadecimal, spaces between bytes as one likes.
  std::vector<std::uint8_t> bytes(std::string_view key);
  std::vector<std::string> texts(std::string_view key);
  // A number, whole or not, of milliseconds or microseconds, 0 or more.
  DurationNs milliseconds(std::string_view key, DurationNs otherwise_ns);
  DurationNs microseconds(std::string_view key, DurationNs otherwise_ns);
  std::optional<DurationNs> optional_milliseconds(std::string_view key);
  std::optional<double> optional_number(std::string_view key);

  template <class Value>
  Value choice(std::string_view key, Value otherwise, std::initializer_list<Choice<Value>> choices) {
    const toml::node* node = take(key);
    if (node == nullptr) return otherwise;
    std::string words;
    for (const Choice<Value>& entry : choices) {
      if (node->is_string() && node->as_string()->get() == entry.word) return entry.value;
      words += words.empty() ? "" : ", ";
      words += entry.word;
    }
    problems_.add(node->source(), std::string(key) + " must be one of: " + words);
    return otherwise;
  }

  // nullptr where the key is absent.
  const toml::table* table(std::string_view key);
  const toml::array* array(std::string_view key);
  // [[key]] tables, in the order of the file.
  std::vector<const toml::table*> tables(std::string_view key);

  // Call once after the last getter: every key that no getter asked for is unknown.
  void done();

 private:
  const toml::node* take(std::string_view key);
  const toml::node* need(std::string_view key);
  std::int64_t checked(std::string_view key, const toml::node& node, std::int64_t otherwise, std::int64_t minimum,
                       std::int64_t maximum);
  std::optional<DurationNs> duration(std::string_view key, double unit_ns);

  const toml::table& table_;
  Problems& problems_;
  std::set<std::string, std::less<>> known_;
};

}  // namespace servotrace::simulator
