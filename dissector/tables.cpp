// SPDX-License-Identifier: GPL-2.0-or-later
// A line of a table is written out as the servotrace.toml it stands for and read by the reader of that file, so that
// both know the same words and refuse the same mistakes.
#include "dissector/tables.hpp"

#include <algorithm>
#include <string>

#include "replay/settings/settings.hpp"

// What the macros of epan/uat.h make callbacks of must be plain structs of C strings.
struct ServotraceAxisLine {
  char* ring;
  char* mac_id;
  char* name;
  char* data_size;
  char* control;
  char* position;
  char* parameters;
  char* max_speed;
};
struct ServotraceNodeLine {
  char* mac_id;
  char* name;
  char* profile;
};

namespace servotrace::plugin {
namespace {

std::string quoted(const char* text) {
  std::string result = "\"";
  for (; *text != '\0'; ++text) {
    if (*text == '"' || *text == '\\') result += '\\';
    result += *text;
  }
  return result + "\"";
}

void add_number(std::string& toml, const char* key, const char* value) {
  if (value != nullptr && *value != '\0') toml += std::string(key) + " = " + value + "\n";
}
void add_text(std::string& toml, const char* key, const char* value) {
  if (value != nullptr && *value != '\0') toml += std::string(key) + " = " + quoted(value) + "\n";
}

// "7.23=0x20 7.35=1" (blanks or commas between) to { "7.23" = 0x20, "7.35" = 1 }.
void add_parameters(std::string& toml, const char* value) {
  if (value == nullptr || *value == '\0') return;
  std::string table;
  std::string part;
  const auto flush = [&table, &part] {
    if (part.empty()) return;
    const std::size_t equals = part.find('=');
    if (!table.empty()) table += ", ";
    table += equals == std::string::npos ? quoted(part.c_str())
                                         : quoted(part.substr(0, equals).c_str()) + " = " + part.substr(equals + 1);
    part.clear();
  };
  for (; *value != '\0'; ++value) {
    if (*value == ' ' || *value == ',' || *value == ';') {
      flush();
    } else if (*value != '\n' && *value != '\r') {
      part += *value;
    }
  }
  flush();
  toml += "parameters = { " + table + " }\n";
}

std::string toml_of(const ServotraceAxisLine& line) {
  std::string toml = "[[rtex.axis]]\n";
  add_number(toml, "ring", line.ring);
  add_number(toml, "mac_id", line.mac_id);
  add_text(toml, "name", line.name);
  add_number(toml, "data_size", line.data_size);
  add_text(toml, "control", line.control);
  add_text(toml, "position", line.position);
  add_parameters(toml, line.parameters);
  add_number(toml, "max_speed", line.max_speed);
  return toml;
}

std::string toml_of(const ServotraceNodeLine& line) {
  std::string toml = "[[devicenet.node]]\n";
  add_number(toml, "mac_id", line.mac_id);
  add_text(toml, "name", line.name);
  add_text(toml, "profile", line.profile);
  return toml;
}

template <class Line>
WsBool check_line(void* line, char** error) {
  const Result<replay::FileSettings> read = replay::parse_settings(toml_of(*static_cast<const Line*>(line)), {});
  if (read) return true;
  *error = g_strdup(read.error().what.c_str());
  return false;
}

constexpr char* ServotraceAxisLine::*kAxisTexts[] = {&ServotraceAxisLine::ring,       &ServotraceAxisLine::mac_id,
                                                     &ServotraceAxisLine::name,       &ServotraceAxisLine::data_size,
                                                     &ServotraceAxisLine::control,    &ServotraceAxisLine::position,
                                                     &ServotraceAxisLine::parameters, &ServotraceAxisLine::max_speed};
constexpr char* ServotraceNodeLine::*kNodeTexts[] = {&ServotraceNodeLine::mac_id, &ServotraceNodeLine::name,
                                                     &ServotraceNodeLine::profile};
constexpr auto& texts_of(const ServotraceAxisLine*) { return kAxisTexts; }
constexpr auto& texts_of(const ServotraceNodeLine*) { return kNodeTexts; }

template <class Line>
void* copy_line(void* to, const void* from, std::size_t) {
  Line* const target = static_cast<Line*>(to);
  const Line* const source = static_cast<const Line*>(from);
  for (const auto text : texts_of(source)) target->*text = g_strdup(source->*text);
  return to;
}

template <class Line>
void free_line(void* line) {
  Line* const target = static_cast<Line*>(line);
  for (const auto text : texts_of(target)) g_free(target->*text);
}

struct Tables {
  ServotraceAxisLine* axes = nullptr;
  guint axis_count = 0;
  ServotraceNodeLine* nodes = nullptr;
  guint node_count = 0;
};
Tables& tables() {
  static Tables instance;
  return instance;
}

UAT_CSTRING_CB_DEF(axis, ring, ServotraceAxisLine)
UAT_CSTRING_CB_DEF(axis, mac_id, ServotraceAxisLine)
UAT_CSTRING_CB_DEF(axis, name, ServotraceAxisLine)
UAT_CSTRING_CB_DEF(axis, data_size, ServotraceAxisLine)
UAT_CSTRING_CB_DEF(axis, control, ServotraceAxisLine)
UAT_CSTRING_CB_DEF(axis, position, ServotraceAxisLine)
UAT_CSTRING_CB_DEF(axis, parameters, ServotraceAxisLine)
UAT_CSTRING_CB_DEF(axis, max_speed, ServotraceAxisLine)
UAT_CSTRING_CB_DEF(node, mac_id, ServotraceNodeLine)
UAT_CSTRING_CB_DEF(node, name, ServotraceNodeLine)
UAT_CSTRING_CB_DEF(node, profile, ServotraceNodeLine)

}  // namespace

void register_tables(module_t* module) {
  static uat_field_t axis_fields[] = {
      UAT_FLD_CSTRING(axis, ring, "Ring", "Number of the ring; empty: every ring"),
      UAT_FLD_CSTRING(axis, mac_id, "MAC ID", "0 to 31"),
      UAT_FLD_CSTRING(axis, name, "Name", "What the axis is called"),
      UAT_FLD_CSTRING(axis, data_size, "Data size", "16 or 32 bytes; empty: learnt"),
      UAT_FLD_CSTRING(axis, control, "Control", "semi-closed or full-closed; empty: learnt"),
      UAT_FLD_CSTRING(axis, position, "Position", "incremental or absolute; empty: not known"),
      UAT_FLD_CSTRING(axis, parameters, "Parameters", "Values the drive has, 7.23=0x20 7.35=1"),
      UAT_FLD_CSTRING(axis, max_speed, "Maximum speed", "Command units a second; empty: not known"),
      UAT_END_FIELDS};
  static uat_field_t node_fields[] = {
      UAT_FLD_CSTRING(node, mac_id, "MAC ID", "0 to 63"),
      UAT_FLD_CSTRING(node, name, "Name", "What the node is called"),
      UAT_FLD_CSTRING(node, profile, "Profile",
                      "yaskawa-ns310, nsk-esb or generic; empty: recognised from the capture"),
      UAT_END_FIELDS};
  Tables& all = tables();
  uat_t* const axes =
      uat_new("RTEX axes", sizeof(ServotraceAxisLine), "servotrace_axes", TRUE, &all.axes, &all.axis_count,
              UAT_AFFECTS_DISSECTION, nullptr, copy_line<ServotraceAxisLine>, check_line<ServotraceAxisLine>,
              free_line<ServotraceAxisLine>, nullptr, nullptr, axis_fields);
  uat_t* const nodes =
      uat_new("DeviceNet nodes", sizeof(ServotraceNodeLine), "servotrace_nodes", TRUE, &all.nodes, &all.node_count,
              UAT_AFFECTS_DISSECTION, nullptr, copy_line<ServotraceNodeLine>, check_line<ServotraceNodeLine>,
              free_line<ServotraceNodeLine>, nullptr, nullptr, node_fields);
  prefs_register_uat_preference(module, "axes", "RTEX axes",
                                "Names and settings of axes; a line here stands above the settings file", axes);
  prefs_register_uat_preference(module, "nodes", "DeviceNet nodes",
                                "Names and drive profiles of nodes; a line here stands above the settings file", nodes);
}

void apply_tables(Settings& settings) {
  const Tables& all = tables();
  for (guint i = 0; i < all.axis_count; ++i) {
    Result<replay::FileSettings> read = replay::parse_settings(toml_of(all.axes[i]), {});
    if (!read) continue;  // refused when it was entered
    for (const RtexAxisSettings& axis : read->decoder.rtex.axes) {
      std::erase_if(settings.rtex.axes, [&axis](const RtexAxisSettings& other) {
        return other.mac_id == axis.mac_id && (!axis.ring || other.ring == axis.ring);
      });
      settings.rtex.axes.push_back(axis);
    }
  }
  for (guint i = 0; i < all.node_count; ++i) {
    Result<replay::FileSettings> read = replay::parse_settings(toml_of(all.nodes[i]), {});
    if (!read) continue;
    for (const DevicenetNodeSettings& node : read->decoder.devicenet.nodes) {
      std::erase_if(settings.devicenet.nodes,
                    [&node](const DevicenetNodeSettings& other) { return other.mac_id == node.mac_id; });
      settings.devicenet.nodes.push_back(node);
    }
  }
}

}  // namespace servotrace::plugin
