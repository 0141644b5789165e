// SPDX-License-Identifier: MIT
// How to read a controller's own log of RTEX memories (CSV or text): which column holds what. Written as TOML, in the
// settings under [rtex.log] or in a file of its own (`servotrace convert --map`). captures/recorder/README.md explains
// every key.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "decoder/core/result.hpp"
#include "decoder/core/slot.hpp"
#include "decoder/core/time.hpp"

namespace servotrace::replay {

// A cell of a row, by the name in the header line or by its place.
struct LogColumn {
  std::string name;
  std::size_t number = 0;  // from 1; 0: by name
  std::string after;       // the value begins behind this text ("axis="); empty: at the cell's start

  bool given() const { return number != 0 || !name.empty(); }
};

struct LogField {
  std::string key;
  Slot slot;         // in the block
  LogColumn column;  // or, where none is given:
  std::int64_t constant = 0;
};

// Where the bytes of one block come from: exactly one of the three, or nothing.
struct LogBlock {
  LogColumn block;               // all bytes, hexadecimal
  LogColumn first_byte;          // the first of consecutive columns, one byte each, or
  std::vector<LogColumn> bytes;  // columns of one byte each, in order
  std::vector<LogField> fields;  // everything else is 0

  bool given() const { return block.given() || first_byte.given() || !bytes.empty() || !fields.empty(); }
};

struct LogNode {
  std::uint8_t mac_id = 0;  // 0..31
  bool wide = false;        // 32-byte mode
  LogBlock command;
  LogBlock response;

  std::size_t block_size() const { return wide ? 32 : 16; }
};

enum class LogTime : std::uint8_t { kNumber, kDate, kClock };

struct RtexLogMap {
  char separator = '\0';  // ' ': any run of blanks; '\0': the first of , ; and tabulator that the first row has
  bool header = true;
  std::size_t skip_lines = 0;
  std::string comment = "#";
  std::string lines_with;      // only lines that hold this text; empty: all
  bool sampled = true;         // not every cycle is in the log
  std::uint32_t cycle_ns = 0;  // 0: not known
  std::uint8_t ring = 0;
  LogTime time_kind = LogTime::kNumber;
  std::int64_t time_unit_ns = kSecondNs;  // of kNumber
  LogColumn time;
  LogColumn sequence;   // communication cycle counter
  LogColumn direction;  // not given: a row holds both
  std::string command_word, response_word;
  LogColumn axis;                       // MAC-ID; not given: a row holds all axes
  bool bytes_hexadecimal = true;        // cells of single bytes
  bool fields_hexadecimal = false;      // cells of named fields
  bool fields_in_memory_order = false;  // hexadecimal fields: least significant byte first
  bool big_endian = false;              // blocks: the most significant byte of a word first
  std::size_t word_bytes = 1;           // blocks are printed as words of so many bytes
  std::vector<LogNode> nodes;           // in connection order
};

// The field of a command or response block by the name `servotrace decode` has for it; empty where there is none.
std::optional<Slot> log_field(std::string_view key, bool response);

// A map file: the keys of [rtex.log] at its root.
Result<RtexLogMap> parse_log_map(std::string_view text, std::string origin);
Result<RtexLogMap> read_log_map(const std::filesystem::path& path);

}  // namespace servotrace::replay
