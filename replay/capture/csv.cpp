// SPDX-License-Identifier: MIT
// Tables of CAN frames with a header line: python-can, SavvyCAN, and what people export by hand. Identifiers are
// hexadecimal, with or without 0x; times are seconds unless the column's name gives another unit.
#include "replay/capture/csv.hpp"

#include <algorithm>

#include "replay/capture/text_source.hpp"

namespace servotrace::replay {
namespace {

constexpr std::size_t kMaxColumns = 256;

struct Name {
  std::string_view name;
  CsvColumn column;
};
// Lower case, letters and digits only.
constexpr Name kNames[] = {
    {"timestamp", CsvColumn::kTime},
    {"time", CsvColumn::kTime},
    {"t", CsvColumn::kTime},
    {"channel", CsvColumn::kChannel},
    {"bus", CsvColumn::kChannel},
    {"interface", CsvColumn::kChannel},
    {"id", CsvColumn::kIdentifier},
    {"canid", CsvColumn::kIdentifier},
    {"arbitrationid", CsvColumn::kIdentifier},
    {"identifier", CsvColumn::kIdentifier},
    {"arbid", CsvColumn::kIdentifier},
    {"messageid", CsvColumn::kIdentifier},
    {"extended", CsvColumn::kExtended},
    {"ext", CsvColumn::kExtended},
    {"ide", CsvColumn::kExtended},
    {"isextended", CsvColumn::kExtended},
    {"isextendedid", CsvColumn::kExtended},
    {"remote", CsvColumn::kRemote},
    {"rtr", CsvColumn::kRemote},
    {"isremoteframe", CsvColumn::kRemote},
    {"error", CsvColumn::kError},
    {"iserrorframe", CsvColumn::kError},
    {"dlc", CsvColumn::kLength},
    {"len", CsvColumn::kLength},
    {"length", CsvColumn::kLength},
    {"data", CsvColumn::kData},
    {"payload", CsvColumn::kData},
    {"databytes", CsvColumn::kData},
};

struct TimeUnit {
  std::string_view name;
  std::int64_t ns;
};
constexpr TimeUnit kUnits[] = {{"ns", 1},
                               {"us", kMicrosecondNs},
                               {"\xC2\xB5s", kMicrosecondNs},
                               {"microseconds", kMicrosecondNs},
                               {"ms", kMillisecondNs},
                               {"milliseconds", kMillisecondNs},
                               {"sec", kSecondNs},
                               {"seconds", kSecondNs},
                               {"s", kSecondNs}};

// "Time [ms]", "time_us", "timestamp" to the time column and its unit.
bool is_time(const std::string& cell, std::int64_t& unit_ns) {
  const std::size_t split = cell.find_first_of(" _[(");
  const std::string head = cell.substr(0, split);
  if (head != "time" && head != "timestamp" && head != "t") return false;
  unit_ns = kSecondNs;
  if (split == std::string::npos) return true;
  std::string tail = cell.substr(split);
  tail.erase(std::remove_if(tail.begin(), tail.end(),
                            [](char c) { return std::string_view(" _[]()").find(c) != std::string_view::npos; }),
             tail.end());
  if (tail.substr(0, 5) == "stamp") tail.erase(0, 5);  // "Time Stamp"
  if (tail.empty()) return true;
  for (const TimeUnit& unit : kUnits) {
    if (unit.name == tail) {
      unit_ns = unit.ns;
      return true;
    }
  }
  return false;
}

CsvColumn column_of(std::string_view cell, std::int64_t& unit_ns) {
  const std::string name = lower(cell);
  if (is_time(name, unit_ns)) return CsvColumn::kTime;
  std::string letters;
  for (const char c : name) {
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) letters += c;
  }
  for (const Name& known : kNames) {
    if (known.name == letters) return known.column;
  }
  for (const std::string_view prefix : {"databyte", "data", "byte", "d", "b"}) {
    if (letters.size() > prefix.size() && letters.size() <= prefix.size() + 2 &&
        letters.substr(0, prefix.size()) == prefix && parse_decimal(letters.substr(prefix.size()), 64))
      return CsvColumn::kDataByte;
  }
  return CsvColumn::kOther;
}

int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+') return 62;
  if (c == '/') return 63;
  return -1;
}

// The bytes of `text`, or nothing where it is not base64 of at most 64 bytes.
std::optional<std::size_t> parse_base64(std::string_view text, std::array<std::uint8_t, 64>& into) {
  if (text.size() % 4 != 0) return std::nullopt;
  std::size_t size = 0;
  while (!text.empty()) {
    std::uint32_t bits = 0;
    std::size_t bytes = 3;
    for (std::size_t i = 0; i < 4; ++i) {
      const bool last = text.size() == 4;
      if (last && text[i] == '=' && (i == 3 || (i == 2 && text[3] == '='))) {
        bytes = i - 1;
        bits <<= 6U * (4 - i);
        break;
      }
      const int digit = base64_digit(text[i]);
      if (digit < 0) return std::nullopt;
      bits = bits << 6U | static_cast<unsigned>(digit);
    }
    if (size + bytes > into.size()) return std::nullopt;
    for (std::size_t i = 0; i < bytes; ++i) into[size++] = static_cast<std::uint8_t>(bits >> (16U - 8U * i));
    text.remove_prefix(4);
  }
  return size;
}

// "01 AB" or "01AB" or "0x01AB".
std::optional<std::size_t> parse_hex_bytes(std::string_view text, std::array<std::uint8_t, 64>& into) {
  if (text.size() > 2 && text[0] == '0' && (text[1] == 'x' || text[1] == 'X')) text.remove_prefix(2);
  std::size_t size = 0;
  while (!text.empty()) {
    if (text.front() == ' ' || text.front() == '-' || text.front() == ':') {
      text.remove_prefix(1);
      continue;
    }
    const auto byte = text.size() >= 2 ? parse_hex(text.substr(0, 2)) : std::nullopt;
    if (!byte || size == into.size()) return std::nullopt;
    into[size++] = static_cast<std::uint8_t>(*byte);
    text.remove_prefix(2);
  }
  return size;
}

std::optional<bool> parse_flag(std::string_view cell) {
  const std::string word = lower(cell);
  if (word.empty() || word == "0" || word == "false" || word == "no" || word == "n") return false;
  if (word == "1" || word == "true" || word == "yes" || word == "y" || word == "x") return true;
  return std::nullopt;
}

class CsvSource final : public TextSource {
 public:
  CsvSource(std::unique_ptr<Input> input, std::string name, std::string format)
      : TextSource(std::move(input), std::move(name), std::move(format)) {}

 private:
  Line broken(std::string_view what) {
    what_ = "no row of a table of CAN frames: " + std::string(what);
    return Line::kBroken;
  }

  Line parse(std::string_view line, CanRecord& record) override {
    if (line.empty() || line.front() == '#') return Line::kNothing;
    if (header_.columns.empty()) {
      auto header = parse_csv_header(line);
      if (!header) return broken("the header line names no time, identifier and data");
      header_ = *std::move(header);
      return Line::kNothing;
    }
    std::string_view rest = line;
    std::string_view data;
    std::optional<std::size_t> length;
    std::size_t count = 0;  // of data in columns of their own
    bool said_extended = false;
    std::size_t digits = 0;
    bool more = true;
    for (const CsvColumn column : header_.columns) {
      if (!more) break;
      const std::string_view cell = next_csv_cell(rest, header_.separator, more);
      switch (column) {
        case CsvColumn::kTime: {
          unsigned places = 0;
          const auto time = parse_time(cell, header_.time_unit_ns, &places);
          if (!time) return broken("its time is no number");
          record.time_ns = *time;
          record.resolution_ns = std::min(resolution_of(header_.time_unit_ns, places), resolution_ns_);
          resolution_ns_ = record.resolution_ns;
          break;
        }
        case CsvColumn::kChannel:
          record.channel = cell;
          break;
        case CsvColumn::kIdentifier: {
          const auto identifier = parse_hex(cell);
          if (!identifier) return broken("its identifier is no hexadecimal number");
          record.identifier = *identifier;
          digits = cell.size() - (cell.find_first_of("xX") == 1 ? 2 : 0);
          break;
        }
        case CsvColumn::kExtended:
        case CsvColumn::kRemote:
        case CsvColumn::kError: {
          const auto flag = parse_flag(cell);
          if (!flag) return broken("a flag that is neither 0 nor 1");
          if (column == CsvColumn::kExtended) {
            record.extended = *flag;
            said_extended = true;
          }
          if (column == CsvColumn::kRemote) record.remote = *flag;
          if (column == CsvColumn::kError) record.error = *flag;
          break;
        }
        case CsvColumn::kLength: {
          const auto value = parse_decimal(cell, 64);
          if (!value) return broken("its length is no number up to 64");
          length = static_cast<std::size_t>(*value);
          break;
        }
        case CsvColumn::kData:
          data = cell;
          break;
        case CsvColumn::kDataByte: {
          if (cell.empty()) break;
          const auto byte = parse_hex(cell);
          if (!byte || *byte > 0xFF || count == record.data.size()) return broken("data that are no hexadecimal bytes");
          record.data[count++] = static_cast<std::uint8_t>(*byte);
          break;
        }
        case CsvColumn::kOther:
          break;
      }
    }
    if (digits == 0) return broken("fewer columns than the header");
    if (!said_extended) record.extended = digits > 4 || record.identifier > 0x7FF;
    if (record.identifier > (record.extended || record.error ? 0x1FFFFFFFU : 0x7FFU))
      return broken("an identifier that is too large");
    return take_data(data, count, length, record);
  }

  // `text`: one cell with all data; `count`: bytes already there from cells of their own.
  Line take_data(std::string_view text, std::size_t count, std::optional<std::size_t> length, CanRecord& record) {
    if (record.remote || record.error) {
      record.length = static_cast<std::uint8_t>(record.error ? 8 : std::min<std::size_t>(length.value_or(0), 8));
      if (record.error) record.data = {};
      return Line::kRecord;
    }
    if (!text.empty()) {
      std::array<std::uint8_t, 64> bytes = {};
      // Only the length tells hexadecimal from base64; without one the data are hexadecimal.
      auto size = parse_hex_bytes(text, bytes);
      if (length && size != length) {
        bytes = {};
        size = parse_base64(text, bytes);
      }
      if (!size) return broken("data that are neither hexadecimal nor base64");
      count = *size;
      record.data = bytes;
    }
    if (length && count < *length) return broken("fewer data bytes than its length says");
    if (length) count = *length;
    record.length = static_cast<std::uint8_t>(count);
    record.fd = count > 8;
    return Line::kRecord;
  }

  CsvHeader header_;
  std::uint32_t resolution_ns_ = 0xFFFF'FFFF;  // the finest seen: trailing zeros may be missing
};

}  // namespace

std::string_view next_csv_cell(std::string_view& rest, char separator, bool& more) {
  std::size_t end = 0;
  bool quoted = false;
  while (end < rest.size() && (quoted || rest[end] != separator)) {
    if (rest[end] == '"') quoted = !quoted;
    ++end;
  }
  std::string_view cell = rest.substr(0, end);
  more = end < rest.size();
  rest.remove_prefix(more ? end + 1 : end);
  const auto trim = [&cell](char c) {
    while (!cell.empty() && cell.front() == c) cell.remove_prefix(1);
    while (!cell.empty() && cell.back() == c) cell.remove_suffix(1);
  };
  trim(' ');
  trim('\t');
  if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') cell = cell.substr(1, cell.size() - 2);
  trim(' ');
  return cell;
}

std::optional<CsvHeader> parse_csv_header(std::string_view line) {
  for (const char separator : {',', ';', '\t'}) {
    CsvHeader header{.separator = separator};
    std::string_view rest = line;
    bool more = true;
    bool has_time = false, has_identifier = false, has_data = false, has_stamp = false;
    while (more && header.columns.size() < kMaxColumns) {
      const std::string_view cell = next_csv_cell(rest, separator, more);
      std::int64_t unit_ns = kSecondNs;
      CsvColumn column = column_of(cell, unit_ns);
      if (column == CsvColumn::kTime && has_time) column = CsvColumn::kOther;
      if (column == CsvColumn::kIdentifier && has_identifier) column = CsvColumn::kOther;
      if (column == CsvColumn::kTime) {
        has_time = true;
        header.time_unit_ns = unit_ns;
        has_stamp = cell == "Time Stamp";
      }
      has_identifier = has_identifier || column == CsvColumn::kIdentifier;
      has_data = has_data || column == CsvColumn::kData || column == CsvColumn::kDataByte;
      header.columns.push_back(column);
    }
    if (!has_time || !has_identifier || !has_data) continue;
    // SavvyCAN writes "Time Stamp" in microseconds, beside one column a data byte.
    const bool separate =
        std::find(header.columns.begin(), header.columns.end(), CsvColumn::kDataByte) != header.columns.end();
    if (has_stamp && separate) header.time_unit_ns = kMicrosecondNs;
    return header;
  }
  return std::nullopt;
}

Result<std::unique_ptr<Source>> read_csv(std::unique_ptr<Input> input, std::string name, std::string format) {
  return std::unique_ptr<Source>(std::make_unique<CsvSource>(std::move(input), std::move(name), std::move(format)));
}

}  // namespace servotrace::replay
