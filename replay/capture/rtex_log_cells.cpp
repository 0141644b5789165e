// SPDX-License-Identifier: MIT
#include "replay/capture/rtex_log_cells.hpp"

#include <algorithm>

#include "replay/capture/csv.hpp"
#include "replay/capture/text_source.hpp"

namespace servotrace::replay {
namespace {

constexpr std::size_t kMaxCells = 4096;

bool is_between(char c) { return c == ' ' || c == '-' || c == ':' || c == '.' || c == '_'; }

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string_view without_prefix(std::string_view text) {
  if (text.size() > 2 && text[0] == '0' && (text[1] == 'x' || text[1] == 'X')) text.remove_prefix(2);
  return text;
}

// Two digits a byte; an "0x" in front of any byte or word is passed over.
std::optional<std::size_t> hex_bytes(std::string_view text, MutableBytes into) {
  std::size_t size = 0;
  while (!text.empty()) {
    if (is_between(text.front())) {
      text.remove_prefix(1);
      continue;
    }
    text = without_prefix(text);
    if (text.size() < 2 || size == into.size()) return std::nullopt;
    const int high = hex_digit(text[0]);
    const int low = hex_digit(text[1]);
    if (high < 0 || low < 0) return std::nullopt;
    into[size++] = static_cast<std::uint8_t>(high << 4 | low);
    text.remove_prefix(2);
  }
  return size;
}

// "08:00:00.25" in nanoseconds.
std::optional<CellTime> clock_time(std::string_view text) {
  if (text.size() < 8 || text[2] != ':' || text[5] != ':') return std::nullopt;
  const auto hours = parse_decimal(text.substr(0, 2), 23);
  const auto minutes = parse_decimal(text.substr(3, 2), 59);
  unsigned places = 0;
  const auto seconds = parse_time(text.substr(6), kSecondNs, &places);
  if (!hours || !minutes || !seconds || *seconds < 0 || *seconds >= 61 * kSecondNs) return std::nullopt;
  return CellTime{static_cast<TimeNs>(*hours * 3600 + *minutes * 60) * kSecondNs + *seconds,
                  resolution_of(kSecondNs, places)};
}

std::optional<CellTime> date_time(std::string_view text) {
  if (!text.empty() && text.back() == 'Z') text.remove_suffix(1);
  if (text.size() < 19 || text[4] != '-' || text[7] != '-' || (text[10] != 'T' && text[10] != ' ')) return std::nullopt;
  const auto year = parse_decimal(text.substr(0, 4), 9999);
  const auto month = parse_decimal(text.substr(5, 2), 12);
  const auto day = parse_decimal(text.substr(8, 2), 31);
  auto time = clock_time(text.substr(11));
  if (!year || *year < 1970 || *year > 2200 || !month || *month == 0 || !day || *day == 0 || !time) return std::nullopt;
  time->time_ns = utc_ns(static_cast<std::int64_t>(*year), static_cast<unsigned>(*month), static_cast<unsigned>(*day),
                         time->time_ns);
  return time;
}

}  // namespace

char separator_of(std::string_view line) {
  for (const char separator : {',', ';', '\t'}) {
    if (line.find(separator) != std::string_view::npos) return separator;
  }
  return ' ';
}

void split_row(std::string_view line, char separator, Cells& into) {
  into.clear();
  if (separator == ' ') {
    Words words(line);
    for (std::string_view word = words.next(); !word.empty() && into.size() < kMaxCells; word = words.next())
      into.push_back(word);
    return;
  }
  bool more = true;
  while (more && into.size() < kMaxCells) into.push_back(next_csv_cell(line, separator, more));
}

std::optional<CellTime> cell_time(std::string_view cell, const RtexLogMap& map) {
  if (map.time_kind == LogTime::kClock) return clock_time(cell);
  if (map.time_kind == LogTime::kDate) return date_time(cell);
  unsigned places = 0;
  const auto time = parse_time(cell, map.time_unit_ns, &places);
  if (!time) return std::nullopt;
  return CellTime{*time, resolution_of(map.time_unit_ns, places)};
}

bool cell_block(std::string_view cell, const RtexLogMap& map, MutableBytes block) {
  const auto size = hex_bytes(cell, block);
  if (!size || *size != block.size()) return false;
  if (map.big_endian) {
    for (std::size_t at = 0; at + map.word_bytes <= block.size(); at += map.word_bytes)
      std::reverse(block.begin() + static_cast<std::ptrdiff_t>(at),
                   block.begin() + static_cast<std::ptrdiff_t>(at + map.word_bytes));
  }
  return true;
}

std::optional<std::uint8_t> cell_byte(std::string_view cell, const RtexLogMap& map) {
  if (map.bytes_hexadecimal || without_prefix(cell).size() != cell.size()) {
    const auto value = parse_hex(cell);
    return value && *value <= 0xFF ? std::optional(static_cast<std::uint8_t>(*value)) : std::nullopt;
  }
  const auto value = parse_decimal(cell, 255);
  return value ? std::optional(static_cast<std::uint8_t>(*value)) : std::nullopt;
}

std::optional<std::int64_t> cell_number(std::string_view cell, const RtexLogMap& map) {
  const std::string word = lower(cell);
  if (word == "true" || word == "on") return 1;
  if (word == "false" || word == "off") return 0;
  const bool prefixed = without_prefix(cell).size() != cell.size();
  if (map.fields_hexadecimal && !prefixed && map.fields_in_memory_order) {
    std::array<std::uint8_t, 4> bytes = {};
    const auto size = hex_bytes(cell, bytes);
    if (!size || *size == 0) return std::nullopt;
    return load_le(bytes, 0, 4);
  }
  if (prefixed || map.fields_hexadecimal) {
    const auto value = parse_hex(cell);
    return value ? std::optional<std::int64_t>(*value) : std::nullopt;
  }
  const bool negative = !cell.empty() && cell.front() == '-';
  if (!cell.empty() && (negative || cell.front() == '+')) cell.remove_prefix(1);
  const auto value = parse_decimal(cell, 0xFFFF'FFFF);
  if (!value) return std::nullopt;
  return negative ? -static_cast<std::int64_t>(*value) : static_cast<std::int64_t>(*value);
}

bool put_field(Slot slot, MutableBytes block, std::int64_t value) {
  const std::int64_t range = std::int64_t{1} << slot.width;
  if (value < -(range / 2) || value >= range) return false;
  slot.is_signed = false;
  return write(slot, block, value < 0 ? value + range : value);
}

}  // namespace servotrace::replay
