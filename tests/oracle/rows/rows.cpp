// SPDX-License-Identifier: MIT
#include "tests/oracle/rows/rows.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "decoder/core/slot.hpp"
#include "tests/support/paths.hpp"

namespace servotrace::test {
namespace {

// "7-4" or "7": first and second number; the second defaults to the first.
std::pair<unsigned, unsigned> range_of(const std::string& text) {
  const std::size_t dash = text.find('-');
  const auto first = static_cast<unsigned>(std::stoul(text));
  return {first, dash == std::string::npos ? first : static_cast<unsigned>(std::stoul(text.substr(dash + 1)))};
}

OracleRow row_of(const std::string& place, const std::string& kind) {
  OracleRow row;
  row.is_text = kind == "text" || kind == "bytes";
  row.is_signed = kind == "s";
  if (!row.is_text && kind != "s" && kind != "u") throw std::runtime_error("unknown kind " + kind);
  if (place.ends_with("-end")) {
    row.first_byte = static_cast<unsigned>(std::stoul(place));
    return row;
  }
  const std::size_t dot = place.find('.');
  const auto [first, last] = range_of(place.substr(0, dot));
  row.first_byte = first;
  row.byte_count = last - first + 1;
  row.width = 8 * row.byte_count;
  if (dot != std::string::npos) {
    const auto [high, low] = range_of(place.substr(dot + 1));
    row.low_bit = low;
    row.width = high - low + 1;
  }
  return row;
}

// The bytes of a layout with `number` in the row's place and `fill` around it.
std::vector<std::uint8_t> bytes_with(const OracleRow& row, std::size_t size, std::uint64_t number, bool fill) {
  std::vector<std::uint8_t> bytes(std::max<std::size_t>(size, row.first_byte + row.byte_count), fill ? 0xFF : 0x00);
  for (unsigned bit = 0; bit < row.width; ++bit) {
    std::uint8_t& byte = bytes[row.first_byte + (row.low_bit + bit) / 8];
    const auto mask = static_cast<std::uint8_t>(1U << (row.low_bit + bit) % 8);
    byte = (number >> bit & 1U) != 0 ? static_cast<std::uint8_t>(byte | mask) : static_cast<std::uint8_t>(byte & ~mask);
  }
  return bytes;
}

}  // namespace

OracleRows OracleRows::read_all() {
  OracleRows rows;
  for (const char* name : {"rtex", "dnet", "esb", "ns310"})
    rows.read((source_dir() / "tests/oracle/rows" / (std::string(name) + ".rows")).string());
  return rows;
}

void OracleRows::read(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("no " + path);
  Section* section = nullptr;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    if (line[0] == '[') {
      section = &sections_[line.substr(1, line.size() - 2)];
      continue;
    }
    if (section == nullptr) throw std::runtime_error(path + ": a row before the first layout: " + line);
    if (line[0] == '@') {
      section->others.push_back(line.substr(1));
      continue;
    }
    std::istringstream words(line);
    std::string key;
    std::string place;
    std::string kind;
    if (!(words >> key >> place >> kind)) throw std::runtime_error(path + ": " + line);
    OracleRow row = row_of(place, kind);
    row.is_general = key == "*";
    section->rows.emplace(key, row);
  }
}

std::vector<OracleRow> OracleRows::find_in(const std::string& section, std::string_view key) const {
  std::vector<OracleRow> found;
  const auto entry = sections_.find(section);
  if (entry == sections_.end()) return found;
  const auto [first, last] = entry->second.rows.equal_range(key);
  for (auto row = first; row != last; ++row) found.push_back(row->second);
  for (std::size_t i = 0; found.empty() && i < entry->second.others.size(); ++i)
    found = find_in(entry->second.others[i], key);
  return found;
}

std::vector<OracleRow> OracleRows::find(const Layout& layout, std::string_view key) const {
  const std::string name = std::string(layout.protocol) + "." + std::string(layout.key);
  for (const std::string& section : {name + "|" + std::string(layout.title), name}) {
    for (const std::string_view wanted : {key, std::string_view("*")}) {
      std::vector<OracleRow> found = find_in(section, wanted);
      if (!found.empty()) return found;
    }
  }
  return {};
}

std::size_t OracleRows::size() const {
  std::size_t count = 0;
  for (const auto& [name, section] : sections_) count += section.rows.size();
  return count;
}

std::string complaint(const OracleRow& row, const Layout& layout, const Field& field) {
  if (row.is_text || row.byte_count == 0) {
    std::vector<std::uint8_t> message(layout.size + 5U, 0xFF);
    const Bytes found = bytes_of(field, message);
    const std::size_t wanted = row.byte_count == 0 ? message.size() - row.first_byte : row.byte_count;
    const bool right = (field.kind == Kind::kBytes || field.kind == Kind::kText) && found.size() == wanted &&
                       found.data() == message.data() + row.first_byte;
    return right ? "" : "other bytes";
  }
  const Slot slot = slot_of(field);
  if (slot.width == 0) return "no number";
  const std::uint64_t all = row.width >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << row.width) - 1;
  // Ones among zeros, zeros among ones, and a number whose bytes differ.
  constexpr std::uint64_t kBytes = 0x0807060504030201;
  const struct {
    std::uint64_t number;
    bool fill;
  } patterns[] = {{all, false}, {0, true}, {kBytes & all, false}, {all >> 1U, false}};
  for (const auto& [number, fill] : patterns) {
    const std::vector<std::uint8_t> bytes = bytes_with(row, layout.size, number, fill);
    if (std::size_t{slot.first_byte} + slot.byte_count > bytes.size()) return "outside the message";
    const bool negative = row.is_signed && row.width < 64 && (number >> (row.width - 1U) & 1U) != 0;
    const auto wanted = static_cast<std::int64_t>(negative ? number | ~all : number);
    const std::int64_t found = servotrace::read(slot, bytes);
    if (found != wanted) return "reads " + std::to_string(found) + ", not " + std::to_string(wanted);
  }
  return {};
}

}  // namespace servotrace::test
