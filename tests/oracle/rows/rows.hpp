// SPDX-License-Identifier: MIT
// The manuals' tables, row by row, as text of their own: where a field lies, and whether it has a sign. The files are
// typed from the manuals and share nothing with the layout tables.
//
//   [protocol.layout]            the rows that follow are of every layout of this key
//   [protocol.layout|Title]      ... of the layout of this title alone, which goes first
//   key 2.7-5 u                  bits 7 to 5 of byte 2, unsigned; "2.7" is one bit, "2" the byte, "2-5" four bytes
//   key 0-1.11-0 s               bits 11 to 0 of the number in bytes 0 and 1, with a sign
//   key 1-end text               bytes to the end of the message; "bytes" or "text"
//   * 0-3 s                      every key of the layout that has no row of its own
//   @protocol.layout             the rows of another layout count here, too
// A key may have several rows, where the places of several layouts of one key differ.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "decoder/core/layout.hpp"

namespace servotrace::test {

struct OracleRow {
  unsigned first_byte = 0;
  unsigned byte_count = 0;  // 0: to the end
  unsigned low_bit = 0;     // of the number in these bytes
  unsigned width = 0;       // bits
  bool is_signed = false;
  bool is_text = false;     // bytes or text
  bool is_general = false;  // of a "*" line
};

class OracleRows {
 public:
  // Of tests/oracle/rows/*.rows. Throws where a line cannot be read.
  static OracleRows read_all();

  // The rows that speak about this field of this layout; empty where none does.
  std::vector<OracleRow> find(const Layout& layout, std::string_view key) const;
  std::size_t size() const;

 private:
  struct Section {
    std::multimap<std::string, OracleRow, std::less<>> rows;
    std::vector<std::string> others;
  };
  void read(const std::string& path);
  std::vector<OracleRow> find_in(const std::string& section, std::string_view key) const;

  std::map<std::string, Section, std::less<>> sections_;
};

// What is wrong with a field by this row: it reads other values from the row's bytes. Empty: nothing.
std::string complaint(const OracleRow& row, const Layout& layout, const Field& field);

}  // namespace servotrace::test
