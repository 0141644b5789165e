// SPDX-License-Identifier: MIT
// Rows of a controller's log: cells, and the blocks, times and numbers in them.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "decoder/core/bytes.hpp"
#include "replay/settings/rtex_log_map.hpp"

namespace servotrace::replay {

using Cells = std::vector<std::string_view>;

// Which of , ; and tabulator the line has; ' ' where it has none of them.
char separator_of(std::string_view line);
// `separator` ' ': any run of blanks or tabulators. `into` is emptied before.
void split_row(std::string_view line, char separator, Cells& into);

struct CellTime {
  TimeNs time_ns = 0;
  std::uint32_t resolution_ns = 1;
};
// By the map's unit: a number, "2026-01-05T08:00:00.25" (UTC), or "08:00:00.25" (of one day: since midnight).
std::optional<CellTime> cell_time(std::string_view cell, const RtexLogMap& map);

// Exactly `block.size()` bytes in hexadecimal, with or without blanks between; words of the map turned round where
// their most significant byte comes first.
bool cell_block(std::string_view cell, const RtexLogMap& map, MutableBytes block);
std::optional<std::uint8_t> cell_byte(std::string_view cell, const RtexLogMap& map);
// A named field: decimal, "0x..." or, where the map says so, hexadecimal; true and false. Empty where it is no number.
std::optional<std::int64_t> cell_number(std::string_view cell, const RtexLogMap& map);
// Signed or unsigned, as it fits. False where it does not.
bool put_field(Slot slot, MutableBytes block, std::int64_t value);

}  // namespace servotrace::replay
