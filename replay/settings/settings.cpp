// SPDX-License-Identifier: MIT
#include "replay/settings/settings.hpp"

#include <charconv>
#include <fstream>
#include <sstream>
#include <utility>
#include <vector>

#include "decoder/pipeline/registry.hpp"
#include "replay/settings/limit_rows.hpp"
#include "replay/settings/rtex_log_reader.hpp"
#include "replay/settings/toml_reader.hpp"

namespace servotrace::replay {
namespace {

constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();

// "7.23" to 0717h.
std::optional<std::uint16_t> parameter_index(std::string_view text) {
  const std::size_t dot = text.find('.');
  if (dot == std::string_view::npos || dot == 0 || dot + 1 == text.size()) return {};
  unsigned group = 0;
  unsigned number = 0;
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), text.data() + dot, group);
  const auto second = std::from_chars(text.data() + dot + 1, end, number);
  if (first.ec != std::errc() || first.ptr != text.data() + dot || second.ec != std::errc() || second.ptr != end) {
    return {};
  }
  if (group > 15 || number > 255) return {};
  return static_cast<std::uint16_t>(group << 8U | number);
}

// Response byte 3, bits 3..7, and their two meanings (SX-DSV02203 4-3-4).
struct InputMeaning {
  std::string_view first;
  std::string_view second;
};
constexpr InputMeaning kInputs[8] = {{},
                                     {},
                                     {},
                                     {"SI-MON1", "EXT1"},
                                     {"SI-MON2", "EXT2"},
                                     {"SI-MON3", "EXT3"},
                                     {"SI-MON4", "EX-SON"},
                                     {"SI-MON5", "E-STOP"}};

void read_parameters(const toml::table& source, RtexAxisSettings& axis, TomlErrors& errors) {
  for (auto&& [key, node] : source) {
    const std::optional<std::uint16_t> index = parameter_index(key.str());
    if (!index) {
      errors.add(key.source(),
                 fmt::format("'{}' is no parameter: write class and number in quotes, \"7.23\"", key.str()));
      continue;
    }
    const std::string name = fmt::format("Pr{}.{:02}", *index >> 8U, *index & 0xFFU);
    const auto value = integer_of(node, name, INT32_MIN, INT32_MAX, errors);
    if (!value) continue;
    if (!axis.parameters.emplace(*index, static_cast<std::int32_t>(*value)).second) {
      errors.add(key.source(), fmt::format("{} is given twice", name));
    }
  }
}

void read_inputs(const toml::table& source, RtexAxisSettings& axis, TomlErrors& errors) {
  const TomlTable inputs(source, "inputs", {"SI-MON1", "SI-MON2", "SI-MON3", "SI-MON4", "SI-MON5"}, errors);
  for (std::size_t bit = 3; bit < 8; ++bit) {
    const auto& [first, second] = kInputs[bit];
    if (const auto choice = inputs.choice(first, {first, second})) axis.input_second_meaning[bit] = *choice == 1;
  }
}

void read_axis(const toml::table& source, RtexSettings& rtex, TomlErrors& errors) {
  const TomlTable table(
      source, "[[rtex.axis]]",
      {"ring", "mac_id", "name", "data_size", "control", "position", "parameters", "inputs", "max_speed"}, errors);
  RtexAxisSettings axis;
  if (const auto ring = table.integer("ring", 0, 255)) axis.ring = static_cast<std::uint8_t>(*ring);
  table.require("mac_id");
  if (const auto mac_id = table.integer("mac_id", 0, 31)) axis.mac_id = static_cast<std::uint8_t>(*mac_id);
  axis.name = table.text("name").value_or("");
  if (const auto size = table.integer("data_size", 16, 32)) {
    if (*size == 16 || *size == 32) {
      axis.data_size = static_cast<std::uint8_t>(*size);
    } else {
      table.fail("data_size", fmt::format("'data_size' = {}: must be 16 or 32", *size));
    }
  }
  if (const auto control = table.choice("control", {"semi-closed", "full-closed"})) axis.full_closed = *control == 1;
  if (const auto position = table.choice("position", {"incremental", "absolute"})) axis.absolute = *position == 1;
  if (const toml::table* const parameters = table.table("parameters")) read_parameters(*parameters, axis, errors);
  if (const toml::table* const inputs = table.table("inputs")) read_inputs(*inputs, axis, errors);
  axis.max_speed = table.integer("max_speed", 1, kMost);
  for (const RtexAxisSettings& other : rtex.axes) {
    if (other.mac_id == axis.mac_id && other.ring == axis.ring) {
      table.fail("mac_id", fmt::format("axis {} of this ring is given twice", axis.mac_id));
    }
  }
  rtex.axes.push_back(std::move(axis));
}

void read_rtex(const toml::table& source, FileSettings& settings, TomlErrors& errors) {
  RtexSettings& rtex = settings.decoder.rtex;
  const TomlTable table(source, "[rtex]",
                        {"communication_cycle_us", "command_update_ratio", "sync", "user_link_type", "ethertype",
                         "udp_port", "axis", "log"},
                        errors);
  if (const auto cycle_us = table.number("communication_cycle_us")) {
    rtex.communication_cycle_ns = nearest_cycle_ns(*cycle_us);
    if (!rtex.communication_cycle_ns) {
      table.fail(
          "communication_cycle_us",
          fmt::format("'communication_cycle_us' = {}: must be 83.333, 166.667, 500 or 1000 (within 2 %)", *cycle_us));
    }
  }
  if (const auto ratio = table.integer("command_update_ratio", 1, 2)) {
    rtex.command_update_ratio = static_cast<std::uint8_t>(*ratio);
  }
  if (const auto sync = table.choice("sync", {"semi", "full"})) rtex.full_sync = *sync == 1;
  if (const auto type = table.integer("user_link_type", 147, 162)) {
    rtex.user_link_type = static_cast<std::uint16_t>(*type);
  }
  if (const auto type = table.integer("ethertype", 0x0600, 0xFFFF)) rtex.ethertype = static_cast<std::uint16_t>(*type);
  if (const auto port = table.integer("udp_port", 1, 65535)) rtex.udp_port = static_cast<std::uint16_t>(*port);
  table.each_table("axis", [&](const toml::table& entry) { read_axis(entry, rtex, errors); });
  if (const toml::table* const log = table.table("log")) settings.log = read_log_table(*log, errors);
}

void read_devicenet(const toml::table& source, DevicenetSettings& devicenet, TomlErrors& errors) {
  const TomlTable table(source, "[devicenet]", {"node"}, errors);
  table.each_table("node", [&](const toml::table& entry) {
    const TomlTable row(entry, "[[devicenet.node]]", {"mac_id", "name", "profile"}, errors);
    DevicenetNodeSettings node;
    row.require("mac_id");
    if (const auto mac_id = row.integer("mac_id", 0, 63)) node.mac_id = static_cast<std::uint8_t>(*mac_id);
    node.name = row.text("name").value_or("");
    if (row.choice("profile", profile_keys())) node.profile = *row.text("profile");
    for (const DevicenetNodeSettings& other : devicenet.nodes) {
      if (other.mac_id == node.mac_id) row.fail("mac_id", fmt::format("node {} is given twice", node.mac_id));
    }
    devicenet.nodes.push_back(std::move(node));
  });
}

void read_limits(const toml::table& source, Limits& limits, TomlErrors& errors) {
  std::vector<std::string_view> keys{"moving_speed"};
  for (const LimitRow& row : kLimitRows) keys.push_back(row.key);
  const TomlTable table(source, "[limits]", std::move(keys), errors);
  for (const LimitRow& row : kLimitRows) {
    if (const auto value = table.integer(row.key, row.minimum, row.maximum)) limits.*row.member = *value;
  }
  if (const auto speed = table.integer("moving_speed", 1, INT32_MAX)) limits.moving_speed = *speed;
}

void check_pattern(std::string_view pattern, const toml::source_region& place, TomlErrors& errors) {
  if (!names_rules(pattern)) errors.add(place, fmt::format("no rule '{}'{}", pattern, did_you_mean_rule(pattern)));
}

void read_rules(const toml::table& source, RuleSettings& rules, TomlErrors& errors) {
  const TomlTable table(source, "[rules]", {"ignore", "severity"}, errors);
  if (const toml::array* const list = table.array("ignore")) {
    for (const toml::node& element : *list) {
      const toml::value<std::string>* const text = element.as_string();
      if (text == nullptr) {
        errors.add(element.source(), fmt::format("'ignore' must hold strings, not {}", type_name(element)));
        continue;
      }
      check_pattern(text->get(), element.source(), errors);
      rules.ignore.push_back(text->get());
    }
  }
  if (const toml::table* const changes = table.table("severity")) {
    for (auto&& [key, node] : *changes) {
      check_pattern(key.str(), key.source(), errors);
      const std::string_view text = node.is_string() ? std::string_view(node.as_string()->get()) : std::string_view();
      bool known = false;
      for (const Severity severity : {Severity::kNote, Severity::kWarning, Severity::kError}) {
        if (text != name_of(severity)) continue;
        rules.severity.push_back({std::string(key.str()), severity});
        known = true;
      }
      if (!known) {
        errors.add(node.source(),
                   fmt::format("the severity of '{}' must be \"error\", \"warning\" or \"note\"", key.str()));
      }
    }
  }
}

void read_suppression(const toml::table& source, RuleSettings& rules, TomlErrors& errors) {
  const TomlTable table(source, "[[suppress]]", {"rule", "mac_id", "reason", "until"}, errors);
  Suppression suppression;
  suppression.where = errors.place(source.source());
  table.require("rule");
  table.require("reason");
  suppression.rule = table.text("rule").value_or("");
  if (!suppression.rule.empty()) check_pattern(suppression.rule, source.get("rule")->source(), errors);
  suppression.reason = table.text("reason").value_or("");
  if (const auto mac_id = table.integer("mac_id", 0, 63)) suppression.mac_id = static_cast<std::int16_t>(*mac_id);
  suppression.until = table.date("until");
  rules.suppressions.push_back(std::move(suppression));
}

FileSettings read_root(const toml::table& root, TomlErrors& errors) {
  FileSettings settings;
  const TomlTable table(root, "", {"rtex", "devicenet", "limits", "rules", "suppress"}, errors);
  if (const toml::table* const rtex = table.table("rtex")) read_rtex(*rtex, settings, errors);
  if (const toml::table* const devicenet = table.table("devicenet")) {
    read_devicenet(*devicenet, settings.decoder.devicenet, errors);
  }
  if (const toml::table* const limits = table.table("limits")) read_limits(*limits, settings.decoder.limits, errors);
  if (const toml::table* const rules = table.table("rules")) read_rules(*rules, settings.rules, errors);
  table.each_table("suppress", [&](const toml::table& entry) { read_suppression(entry, settings.rules, errors); });
  return settings;
}

}  // namespace

std::optional<DurationNs> nearest_cycle_ns(double cycle_us) {
  for (const DurationNs cycle_ns : {83333, 166667, 500000, 1000000}) {
    const double exact_us = static_cast<double>(cycle_ns) / 1000;
    if (cycle_us > exact_us * 0.98 && cycle_us < exact_us * 1.02) return cycle_ns;
  }
  return {};
}

Result<FileSettings> parse_settings(std::string_view text, std::string origin) {
  TomlErrors errors(origin);
  try {
    const toml::table root = toml::parse(text);
    FileSettings settings = read_root(root, errors);
    if (errors.first()) return *errors.first();
    settings.origin = std::move(origin);
    return settings;
  } catch (const toml::parse_error& error) {
    return Error{errors.place(error.source()), std::string(error.description())};
  }
}

Result<FileSettings> read_settings(const std::filesystem::path& path) {
  std::error_code code;
  if (std::filesystem::is_directory(path, code)) return Error{path.string(), "is a folder, not a settings file"};
  std::ifstream file(path, std::ios::binary);
  if (!file) return Error{path.string(), "cannot be opened"};
  std::ostringstream text;
  text << file.rdbuf();
  if (file.bad()) return Error{path.string(), "cannot be read"};
  return parse_settings(text.str(), path.string());
}

std::optional<std::filesystem::path> find_settings_above(const std::filesystem::path& folder) {
  std::error_code code;
  std::filesystem::path place = std::filesystem::absolute(folder.empty() ? "." : folder, code).lexically_normal();
  if (code) return {};
  while (true) {
    const std::filesystem::path candidate = place / kSettingsName;
    if (std::filesystem::is_regular_file(candidate, code)) return candidate;
    const std::filesystem::path above = place.parent_path();
    if (above == place || above.empty()) return {};
    place = above;
  }
}

std::optional<std::filesystem::path> find_settings(const std::filesystem::path& capture) {
  if (!capture.empty()) {
    std::error_code code;
    const bool is_folder = std::filesystem::is_directory(capture, code);
    if (auto found = find_settings_above(is_folder ? capture : capture.parent_path())) return found;
  }
  return find_settings_above(".");
}

}  // namespace servotrace::replay
