// SPDX-License-Identifier: MIT
#include "replay/capture/rtex_log_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "decoder/rtex/layouts.hpp"
#include "replay/capture/text_source.hpp"

namespace servotrace::replay {
namespace {

constexpr DurationNs kDay = 86'400 * kSecondNs;
constexpr std::size_t kLongestShown = 40;  // of a cell in a message

std::string shown(std::string_view cell) {
  return cell.size() <= kLongestShown ? std::string(cell) : std::string(cell.substr(0, kLongestShown)) + "...";
}

// The cell, from behind the column's `after`; empty where the row is too short.
std::string_view cell_at(const Cells& cells, const LogPlace& place) {
  if (place.at >= cells.size()) return {};
  std::string_view text = cells[place.at];
  if (place.after.empty()) return text;
  const std::size_t found = text.find(place.after);
  return found == std::string_view::npos ? std::string_view{} : text.substr(found + place.after.size());
}

}  // namespace

bool LogRows::find(const Cells& cells, const LogColumn& column, std::optional<LogPlace>& place) {
  if (!column.given()) return true;
  if (column.number != 0) {
    place = LogPlace{column.number - 1, column.after};
    return true;
  }
  if (!map_.header) return fail("the map names column '" + column.name + "', but 'header' is false: give its number");
  const auto found = std::find(cells.begin(), cells.end(), column.name);
  if (found != cells.end()) {
    place = LogPlace{static_cast<std::size_t>(found - cells.begin()), column.after};
    return true;
  }
  std::string there;
  for (const std::string_view cell : cells) there += (there.empty() ? "" : ", ") + shown(cell);
  return fail("no column '" + column.name + "'; the header line has: " + there.substr(0, 400));
}

bool LogRows::find_block(const Cells& cells, const LogBlock& block, std::size_t size, LogBlockPlaces& places) {
  if (!find(cells, block.block, places.block)) return false;
  std::optional<LogPlace> first;
  if (!find(cells, block.first_byte, first)) return false;
  for (std::size_t i = 0; first && i < size; ++i) places.bytes.push_back({first->at + i, first->after});
  for (const LogColumn& column : block.bytes) {
    std::optional<LogPlace> place;
    if (!find(cells, column, place)) return false;
    places.bytes.push_back(*place);
  }
  if (!places.bytes.empty() && places.bytes.size() != size)
    return fail(fmt::format("the map has {} columns of bytes for a block of {}", places.bytes.size(), size));
  for (const LogField& field : block.fields) {
    if (field.slot.first_byte + field.slot.byte_count > size)
      return fail(fmt::format("'{}' belongs to 32-byte blocks: the axis needs data_size = 32", field.key));
    LogFieldPlace entry{&field, {}};
    if (!find(cells, field.column, entry.place)) return false;
    places.fields.push_back(std::move(entry));
  }
  return true;
}

bool LogRows::locate(const Cells& cells) {
  places_[0].assign(map_.nodes.size(), {});
  places_[1].assign(map_.nodes.size(), {});
  if (!find(cells, map_.time, time_) || !find(cells, map_.sequence, sequence_) ||
      !find(cells, map_.direction, direction_) || !find(cells, map_.axis, axis_)) {
    return false;
  }
  for (std::size_t i = 0; i < map_.nodes.size(); ++i) {
    const LogNode& node = map_.nodes[i];
    if (!find_block(cells, node.command, node.block_size(), places_[0][i])) return false;
    if (!find_block(cells, node.response, node.block_size(), places_[1][i])) return false;
  }
  return true;
}

bool LogRows::read(const Cells& cells, LogRow& row) {
  const std::string_view time_cell = cell_at(cells, *time_);
  const auto time = cell_time(time_cell, map_);
  if (!time) return fail("'" + shown(time_cell) + "' is no time of the map's unit");
  TimeNs time_ns = time->time_ns;
  if (map_.time_kind == LogTime::kClock) {
    time_ns += days_ * kDay;
    if (time_ns < last_time_ns_ - kDay / 2) {  // past midnight
      ++days_;
      time_ns += kDay;
    }
    last_time_ns_ = time_ns;
  }
  row.time_ns = time_ns;
  row.resolution_ns = time->resolution_ns;
  if (sequence_) {
    const auto value = parse_decimal(cell_at(cells, *sequence_), std::uint64_t{1} << 53U);
    if (!value) return fail("'" + shown(cell_at(cells, *sequence_)) + "' is no cycle number");
    row.sequence = static_cast<std::uint32_t>(*value);
  }
  if (direction_) {
    const std::string_view word = cell_at(cells, *direction_);
    row.of_command = word == map_.command_word;
    row.of_response = word == map_.response_word;
    if (!row.of_command && !row.of_response)
      return fail(fmt::format("the direction '{}' is neither '{}' nor '{}'", shown(word), map_.command_word,
                              map_.response_word));
  }
  row.first_node = 0;
  row.end_node = map_.nodes.size();
  if (axis_) {
    const std::string_view text = cell_at(cells, *axis_);
    const auto mac_id = parse_decimal(text, 31);
    const auto node = std::find_if(map_.nodes.begin(), map_.nodes.end(),
                                   [&](const LogNode& entry) { return mac_id && entry.mac_id == *mac_id; });
    if (node == map_.nodes.end()) return fail("the map has no axis '" + shown(text) + "'");
    row.first_node = static_cast<std::size_t>(node - map_.nodes.begin());
    row.end_node = row.first_node + 1;
  }
  return true;
}

bool LogRows::read_block(const Cells& cells, std::size_t node_at, bool response, MutableBytes block, bool& blank) {
  const LogNode& node = map_.nodes[node_at];
  const LogBlockPlaces& places = places_[response ? 1 : 0][node_at];
  if (places.block) {
    const std::string_view text = cell_at(cells, *places.block);
    blank = text.empty();
    if (!blank && !cell_block(text, map_, block))
      return fail(fmt::format("'{}' is no block of {} hexadecimal bytes", shown(text), block.size()));
    return true;
  }
  for (std::size_t i = 0; i < places.bytes.size(); ++i) {
    const std::string_view text = cell_at(cells, places.bytes[i]);
    if (text.empty() && blank) continue;
    const auto byte = cell_byte(text, map_);
    if (!byte || (blank && i > 0)) return fail(fmt::format("byte {} of the block is '{}'", i, shown(text)));
    block[i] = *byte;
    blank = false;
  }
  if (places.fields.empty()) return true;
  for (const LogFieldPlace& entry : places.fields) {
    std::int64_t value = entry.field->constant;
    if (entry.place) {
      const std::string_view text = cell_at(cells, *entry.place);
      if (text.empty()) continue;
      blank = false;
      const auto number = cell_number(text, map_);
      if (!number) return fail(fmt::format("{}: '{}' is no number", entry.field->key, shown(text)));
      value = *number;
    }
    if (!put_field(entry.field->slot, block, value))
      return fail(fmt::format("{}: {} does not fit its {} bits", entry.field->key, value, entry.field->slot.width));
  }
  // What a controller knows without logging it.
  const bool named = std::any_of(places.fields.begin(), places.fields.end(),
                                 [](const LogFieldPlace& entry) { return entry.field->key == "mac_id"; });
  const Layout& header = response ? rtex::kResponse : rtex::kCommand;
  bool written = named || write(slot_of(*header.find("mac_id")), block, node.mac_id);
  if (response) written = write(slot_of(*header.find("cr")), block, 1) && written;
  if (!response && node.wide) written = write(*log_field("sub_chk", false), block, 1) && written;
  assert(written);
  static_cast<void>(written);
  return true;
}

}  // namespace servotrace::replay
