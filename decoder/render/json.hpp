// SPDX-License-Identifier: MIT
// Writes JSON: the same calls give the same bytes. Text that is no UTF-8 (names in captures, file names) becomes U+FFFD
// where it is broken, so the result always is.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace servotrace {

// `text` with U+FFFD for every byte that is no UTF-8.
std::string valid_utf8(std::string_view text);

// Appends `text` in quotes, escaped.
void append_json_string(std::string& out, std::string_view text);

class JsonWriter {
 public:
  // Appends to `out`, which must outlive the writer. indent 0: everything on one line. Several members or elements
  // outside any bracket are a piece for raw().
  explicit JsonWriter(std::string& out, unsigned indent = 0) : out_(out), indent_(indent) {}

  JsonWriter& begin_object() { return begin('{'); }
  JsonWriter& end_object() { return end('}'); }
  JsonWriter& begin_array() { return begin('['); }
  JsonWriter& end_array() { return end(']'); }
  JsonWriter& key(std::string_view name);
  JsonWriter& value(std::string_view text);
  JsonWriter& value(const char* text) { return value(std::string_view(text)); }
  JsonWriter& value(const std::string& text) { return value(std::string_view(text)); }
  JsonWriter& value(std::int64_t number);
  JsonWriter& value(std::uint64_t number);
  JsonWriter& value(int number) { return value(std::int64_t{number}); }
  JsonWriter& value(unsigned number) { return value(std::uint64_t{number}); }
  JsonWriter& value(bool truth) { return raw(truth ? "true" : "false"); }
  JsonWriter& null() { return raw("null"); }
  // What the caller has written: a number ("0.001"), members or elements kept from another writer of one line.
  JsonWriter& raw(std::string_view text);

  template <class Value>
  JsonWriter& member(std::string_view name, const Value& content) {
    return key(name).value(content);
  }

 private:
  JsonWriter& begin(char bracket);
  JsonWriter& end(char bracket);
  void separate();
  void new_line();

  std::string& out_;
  unsigned indent_;
  unsigned depth_ = 0;        // open brackets
  std::uint64_t filled_ = 0;  // a bit for each of them, the innermost lowest: something stands in it
  bool after_key_ = false;
};

}  // namespace servotrace
