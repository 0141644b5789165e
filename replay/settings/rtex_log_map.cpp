// SPDX-License-Identifier: MIT
#include "replay/settings/rtex_log_map.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "replay/settings/rtex_log_reader.hpp"

namespace servotrace::replay {
namespace {

constexpr std::int64_t kMaxColumn = 1000;
constexpr std::int64_t kMaxBlocks = 32;  // of the ASIC's memories (4-1)

// "name", 3, or {column = "name" or 3, after = "axis="}.
LogColumn read_column(const TomlTable& table, std::string_view key, const toml::node* node, TomlErrors& errors,
                      std::vector<std::string_view> more_keys = {}) {
  LogColumn column;
  if (node == nullptr) return column;
  if (const toml::table* const parts = node->as_table()) {
    more_keys.insert(more_keys.end(), {"column", "after"});
    const TomlTable entry(*parts, fmt::format("'{}'", key), std::move(more_keys), errors);
    entry.require("column");
    column = read_column(entry, "column", parts->get("column"), errors);
    column.after = entry.text("after").value_or("");
    return column;
  }
  if (const auto* const name = node->as_string()) {
    column.name = name->get();
    if (column.name.empty()) errors.add(node->source(), fmt::format("'{}' must not be empty", key));
    return column;
  }
  if (node->is_integer()) {
    column.number = static_cast<std::size_t>(integer_of(*node, key, 1, kMaxColumn, errors).value_or(1));
    return column;
  }
  table.fail(key, fmt::format("'{}' must be a column: its name, its number from 1, or a table with 'column'", key));
  return column;
}

LogField read_field(const TomlTable& table, std::string_view key, const toml::node& node, bool response,
                    const toml::source_region& place, TomlErrors& errors) {
  LogField field{.key = std::string(key)};
  if (const auto found = log_field(key, response)) {
    field.slot = *found;
  } else {
    errors.add(place, fmt::format("a {} has no field '{}'", response ? "response" : "command", key));
    return field;
  }
  const toml::table* const parts = node.as_table();
  if (parts == nullptr || !parts->contains("value")) {
    field.column = read_column(table, key, &node, errors);
    return field;
  }
  const TomlTable entry(*parts, fmt::format("'{}'", key), {"value"}, errors);
  const std::int64_t most = static_cast<std::int64_t>((std::uint64_t{1} << field.slot.width) - 1);
  field.constant = entry.integer("value", -(most / 2) - 1, most).value_or(0);
  return field;
}

LogBlock read_block(const toml::table& source, const std::string& title, bool response, TomlErrors& errors) {
  const TomlTable table(source, title, {"block", "bytes", "fields"}, errors);
  LogBlock block;
  const int kinds = (table.has("block") ? 1 : 0) + (table.has("bytes") ? 1 : 0) + (table.has("fields") ? 1 : 0);
  if (kinds != 1) {
    errors.add(source.source(), title + " needs one of 'block', 'bytes' and 'fields'");
    return block;
  }
  block.block = read_column(table, "block", source.get("block"), errors);
  if (const toml::node* const bytes = source.get("bytes")) {
    const toml::array* const list = bytes->as_array();
    if (list == nullptr) block.first_byte = read_column(table, "bytes", bytes, errors);
    for (std::size_t i = 0; list != nullptr && i < list->size(); ++i)
      block.bytes.push_back(read_column(table, "bytes", list->get(i), errors));
    if (list != nullptr && block.bytes.size() != 16 && block.bytes.size() != 32)
      table.fail("bytes",
                 fmt::format("'bytes' names {} columns: must be 16 or 32, or the first one only", block.bytes.size()));
  }
  if (const toml::table* const fields = table.table("fields")) {
    if (fields->empty()) table.fail("fields", "'fields' names no field");
    for (auto&& [key, node] : *fields)
      block.fields.push_back(read_field(table, key.str(), node, response, key.source(), errors));
    const bool any_column = std::any_of(block.fields.begin(), block.fields.end(),
                                        [](const LogField& field) { return field.column.given(); });
    if (!any_column && !errors.first()) table.fail("fields", title + ": none of the fields comes from a column");
  }
  return block;
}

bool has_field(const LogBlock& block, std::string_view key) {
  for (const LogField& field : block.fields) {
    if (field.key == key) return true;
  }
  return false;
}

// Named fields leave the rest 0: what a rule would take for a fact has to be there.
void check_fields(const toml::table& source, const LogNode& node, bool sampled, TomlErrors& errors) {
  const auto need = [&](const LogBlock& block, std::string_view key, std::string_view also, const char* why) {
    if (block.fields.empty() || has_field(block, key) || (!also.empty() && has_field(block, also))) return;
    errors.add(source.source(), fmt::format("axis {}: the fields need '{}'{}", node.mac_id, key, why));
  };
  need(node.command, "cyclic_command", "command_code", " (or 'command_code'): without it every command is NOP");
  if (sampled) return;
  need(node.command, "update_counter", "", ": a log without it does not show every cycle, so 'sampled' must be true");
  need(node.response, "update_counter_echo", "",
       ": a log without it does not show every cycle, so 'sampled' must be true");
}

LogNode read_node(const toml::table& source, const LogNode& defaults, TomlErrors& errors) {
  const TomlTable table(source, "[[node]]", {"mac_id", "data_size", "command", "response"}, errors);
  LogNode node = defaults;
  table.require("mac_id");
  if (const auto mac_id = table.integer("mac_id", 0, 31)) node.mac_id = static_cast<std::uint8_t>(*mac_id);
  if (const auto size = table.integer("data_size", 16, 32)) {
    if (*size != 16 && *size != 32) table.fail("data_size", fmt::format("'data_size' = {}: must be 16 or 32", *size));
    node.wide = *size == 32;
  }
  if (const toml::table* const command = table.table("command"))
    node.command = read_block(*command, "'command'", false, errors);
  if (const toml::table* const response = table.table("response"))
    node.response = read_block(*response, "'response'", true, errors);
  if (!node.command.given() && !node.response.given() && !table.has("command") && !table.has("response"))
    errors.add(source.source(), fmt::format("axis {} has neither 'command' nor 'response'", node.mac_id));
  return node;
}

void read_time(const TomlTable& table, const toml::table& source, RtexLogMap& map, TomlErrors& errors) {
  table.require("time");
  const toml::node* const node = source.get("time");
  map.time = read_column(table, "time", node, errors, {"unit"});
  const toml::table* const parts = node == nullptr ? nullptr : node->as_table();
  if (parts == nullptr) return;
  const TomlTable entry(*parts, "'time'", {"column", "after", "unit"}, errors);
  static constexpr std::int64_t kUnits[] = {kSecondNs, kMillisecondNs, kMicrosecondNs, 1};
  if (const auto unit = entry.choice("unit", {"s", "ms", "us", "ns", "date", "clock"})) {
    if (*unit < std::size(kUnits)) map.time_unit_ns = kUnits[*unit];
    if (*unit >= std::size(kUnits)) map.time_kind = *unit == 4 ? LogTime::kDate : LogTime::kClock;
  }
}

void read_direction(const TomlTable& table, const toml::table& source, RtexLogMap& map, TomlErrors& errors) {
  const toml::node* const node = source.get("direction");
  if (node == nullptr) return;
  const toml::table* const parts = table.table("direction");
  if (parts == nullptr) return;
  map.direction = read_column(table, "direction", node, errors, {"command", "response"});
  const TomlTable entry(*parts, "'direction'", {"column", "after", "command", "response"}, errors);
  entry.require("command");
  entry.require("response");
  map.command_word = entry.text("command").value_or("");
  map.response_word = entry.text("response").value_or("");
  if (!map.command_word.empty() && map.command_word == map.response_word)
    entry.fail("response", "'command' and 'response' are the same word");
}

void read_rows(const TomlTable& table, RtexLogMap& map) {
  if (const auto separator = table.text("separator")) {
    if (*separator == "tab") {
      map.separator = '\t';
    } else if (*separator == "blank") {
      map.separator = ' ';
    } else if (separator->size() == 1) {
      map.separator = separator->front();
    } else {
      table.fail("separator",
                 fmt::format("'separator' = \"{}\": must be one character, \"tab\" or \"blank\"", *separator));
    }
  }
  map.header = table.boolean("header").value_or(true);
  map.skip_lines = static_cast<std::size_t>(table.integer("skip_lines", 0, 1'000'000).value_or(0));
  if (const auto comment = table.text("comment")) map.comment = *comment;
  map.lines_with = table.text("lines_with").value_or("");
  map.sampled = table.boolean("sampled").value_or(true);
  if (const auto number = table.choice("number", {"hex", "decimal"}))
    map.bytes_hexadecimal = map.fields_hexadecimal = *number == 0;
  if (const auto endian = table.choice("endian", {"little", "big"})) {
    map.big_endian = *endian == 1;
    map.fields_in_memory_order = *endian == 0;
  }
  if (const auto bytes = table.integer("word_bytes", 1, 4)) {
    if (*bytes == 3) table.fail("word_bytes", "'word_bytes' = 3: must be 1, 2 or 4");
    map.word_bytes = static_cast<std::size_t>(*bytes);
  }
  if (const auto ring = table.integer("ring", 0, 255)) map.ring = static_cast<std::uint8_t>(*ring);
  if (const auto cycle_us = table.number("communication_cycle_us")) {
    const auto cycle_ns = nearest_cycle_ns(*cycle_us);
    if (!cycle_ns) {
      table.fail(
          "communication_cycle_us",
          fmt::format("'communication_cycle_us' = {}: must be 83.333, 166.667, 500 or 1000 (within 2 %)", *cycle_us));
    } else {
      map.cycle_ns = static_cast<std::uint32_t>(*cycle_ns);
    }
  }
}

void check_nodes(const toml::table& source, const RtexLogMap& map, TomlErrors& errors) {
  if (errors.first()) return;  // what follows from it is not worth a word
  std::int64_t blocks = 0;
  for (std::size_t i = 0; i < map.nodes.size(); ++i) {
    const LogNode& node = map.nodes[i];
    blocks += node.wide ? 2 : 1;
    check_fields(source, node, map.sampled, errors);
    for (std::size_t j = 0; j < i; ++j) {
      if (map.nodes[j].mac_id == node.mac_id)
        errors.add(source.source(), fmt::format("axis {} is given twice", node.mac_id));
    }
  }
  if (map.nodes.empty())
    errors.add(source.source(), "no axis is named: write a [[node]] for each, in connection order");
  if (blocks > kMaxBlocks) errors.add(source.source(), fmt::format("{} blocks: the ASIC's memories hold 32", blocks));
}

}  // namespace

RtexLogMap read_log_table(const toml::table& source, TomlErrors& errors) {
  const TomlTable table(
      source, "[rtex.log]",
      {"separator", "header", "skip_lines", "comment", "lines_with", "sampled", "number", "endian", "word_bytes",
       "ring", "communication_cycle_us", "time", "sequence", "direction", "axis", "command", "response", "node"},
      errors);
  RtexLogMap map;
  read_rows(table, map);
  read_time(table, source, map, errors);
  map.sequence = read_column(table, "sequence", source.get("sequence"), errors);
  read_direction(table, source, map, errors);
  map.axis = read_column(table, "axis", source.get("axis"), errors);
  LogNode defaults;
  if (const toml::table* const command = table.table("command"))
    defaults.command = read_block(*command, "'command'", false, errors);
  if (const toml::table* const response = table.table("response"))
    defaults.response = read_block(*response, "'response'", true, errors);
  table.each_table("node", [&](const toml::table& entry) { map.nodes.push_back(read_node(entry, defaults, errors)); });
  check_nodes(source, map, errors);
  return map;
}

Result<RtexLogMap> parse_log_map(std::string_view text, std::string origin) {
  TomlErrors errors(std::move(origin));
  try {
    const toml::table root = toml::parse(text);
    RtexLogMap map = read_log_table(root, errors);
    if (errors.first()) return *errors.first();
    return map;
  } catch (const toml::parse_error& error) {
    return Error{errors.place(error.source()), std::string(error.description())};
  }
}

Result<RtexLogMap> read_log_map(const std::filesystem::path& path) {
  std::error_code code;
  if (std::filesystem::is_directory(path, code)) return Error{path.string(), "is a folder, not a column map"};
  std::ifstream file(path, std::ios::binary);
  if (!file) return Error{path.string(), "cannot be opened"};
  std::ostringstream text;
  text << file.rdbuf();
  if (file.bad()) return Error{path.string(), "cannot be read"};
  return parse_log_map(text.str(), path.string());
}

}  // namespace servotrace::replay
