// SPDX-License-Identifier: MIT
// The rows of a controller's log by its map: where each column is, and what a row says.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "replay/capture/rtex_log_cells.hpp"

namespace servotrace::replay {

// A column found in the header: its place in a row.
struct LogPlace {
  std::size_t at = 0;
  std::string after;
};
struct LogFieldPlace {
  const LogField* field = nullptr;
  std::optional<LogPlace> place;  // empty: the constant
};
struct LogBlockPlaces {
  std::optional<LogPlace> block;
  std::vector<LogPlace> bytes;
  std::vector<LogFieldPlace> fields;
};

struct LogRow {
  TimeNs time_ns = 0;
  std::uint32_t resolution_ns = 1;
  std::optional<std::uint32_t> sequence;  // communication cycle
  bool of_command = true, of_response = true;
  std::size_t first_node = 0, end_node = 0;  // places in the connection order
};

class LogRows {
 public:
  explicit LogRows(const RtexLogMap& map) : map_(map) {}  // `map` outlives it

  // Each of these is false where something is wrong; what() then says what.
  // The header line, or the first row where there is none.
  bool locate(const Cells& cells);
  bool read(const Cells& cells, LogRow& row);
  // `block` is zero before. `blank`: the row does not hold this block.
  bool read_block(const Cells& cells, std::size_t node_at, bool response, MutableBytes block, bool& blank);
  const std::string& what() const { return what_; }

 private:
  bool fail(std::string what) {
    what_ = std::move(what);
    return false;
  }
  bool find(const Cells& cells, const LogColumn& column, std::optional<LogPlace>& place);
  bool find_block(const Cells& cells, const LogBlock& block, std::size_t size, LogBlockPlaces& places);

  const RtexLogMap& map_;
  std::string what_;
  std::optional<LogPlace> time_, sequence_, direction_, axis_;
  std::array<std::vector<LogBlockPlaces>, 2> places_;  // command, response; by node
  TimeNs last_time_ns_ = 0;
  std::int64_t days_ = 0;
};

}  // namespace servotrace::replay
