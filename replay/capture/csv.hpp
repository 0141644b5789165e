// SPDX-License-Identifier: MIT
// The header line of a table of CAN frames: which column holds what.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace servotrace::replay {

enum class CsvColumn : std::uint8_t {
  kOther,
  kTime,
  kChannel,
  kIdentifier,
  kExtended,
  kRemote,
  kError,
  kLength,
  kData,      // all bytes, hexadecimal or base64
  kDataByte,  // one of several columns
};

struct CsvHeader {
  char separator = ',';
  std::int64_t time_unit_ns = 1'000'000'000;
  std::vector<CsvColumn> columns;
};

// Empty where the line is no such header: it needs a time, an identifier and data.
std::optional<CsvHeader> parse_csv_header(std::string_view line);

// The next cell of a row; quotes around a cell are taken off (a separator inside them does not end it). `more`: there
// is another one.
std::string_view next_csv_cell(std::string_view& rest, char separator, bool& more);

}  // namespace servotrace::replay
