// SPDX-License-Identifier: MIT
// "axis 1 (X) command: CP 128000, Servo_On, parameter writing Pr7.23 ... = 32, waiting for echo, counter 3": the cyclic
// command first, then status, then what the non-cyclic command is about and how far it is.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "decoder/render/value.hpp"
#include "decoder/render/words.hpp"
#include "decoder/rtex/codes.hpp"
#include "decoder/rtex/layouts.hpp"

namespace servotrace {
namespace {

constexpr std::string_view kCommunicationError = "communication error";

// What the main or the sub-channel of a block says.
struct Part {
  std::string cyclic;    // "CP", in a command "CP 128000"
  std::string status;    // flags
  std::string values;    // process values
  std::string command;   // "Parameter"
  std::string type;      // "parameter reading"
  std::string argument;  // " Pr7.23 RTEX function expansion setup 2"
  std::string value;     // of the parameter, alarm or string
  std::string progress;  // flags of the answer: busy, ERR
  std::string error;
  std::string counter;
  std::int64_t alarm = 0;
};

bool is_one_of(std::string_view key, std::initializer_list<std::string_view> keys) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

std::string name_or(const Field& field, std::int64_t raw, std::string_view otherwise) {
  const ValueName* const name = find_value(field.values, raw);
  return name != nullptr ? std::string(name->name) : fmt::format("{} {}", otherwise, number_text(field, raw));
}

void take_code(Part& part, const Field& field, std::int64_t raw) {
  if (raw == 0) return;  // the standard command
  part.command = name_or(field, raw, "non-cyclic command");
}

// Fields that a sentence has a place of its own for. False: any other.
bool take_argument(Part& part, const Field& field, std::int64_t raw, Bytes under) {
  const std::string_view key = field.key;
  if (is_one_of(key, {"type_code", "type_code_echo"})) {
    part.type = name_or(field, raw, "type code");
  } else if (is_one_of(key, {"index", "index_echo"})) {
    if (raw != 0) part.argument = fmt::format(" index {}", raw);
  } else if (is_one_of(key, {"parameter", "parameter_echo"})) {
    const ValueName* const name = find_value(field.values, raw);
    part.argument =
        name != nullptr ? fmt::format(" {}", name->name) : fmt::format(" Pr{}.{:02}", raw >> 8 & 0xFF, raw & 0xFF);
  } else if (is_one_of(key, {"setting_data", "setting_data_echo", "parameter_value", "parameter_count"})) {
    part.value = quantity_text(field, raw);
  } else if (is_one_of(key, {"monitor_select", "feedforward"})) {
    part.value = value_text(field, raw);
  } else if (key == "characters") {
    part.value = bytes_text(field, under);
  } else if (is_one_of(key, {"error_code", "sub_error_code"})) {
    part.error = name_or(field, raw, "error");
  } else {
    return false;
  }
  return true;
}

void take_field(Part& part, const Layout& layout, const Field& field, std::int64_t raw, Bytes under) {
  const std::string_view key = field.key;
  if (is_one_of(key, {"update_counter", "update_counter_echo"})) {
    part.counter = fmt::format("counter {}", raw);
  } else if (is_one_of(key, {"cyclic_command", "cyclic_command_echo"})) {
    part.cyclic = name_or(field, raw, "cyclic command");
  } else if (is_one_of(key, {"non_cyclic_command", "non_cyclic_command_echo", "command", "command_echo"})) {
    take_code(part, field, raw);
  } else if (&layout == &rtex::kAlarmCode) {
    if (key == "alarm_main") {
      part.alarm = raw;
      part.value = raw == 0 ? "no alarm" : std::string();
    } else if (key == "alarm_sub" && part.alarm != 0) {
      const ValueName* const name = find_value(layout.find("alarm_main")->values, part.alarm);
      part.value = fmt::format("Err{}.{}{}{}", part.alarm, raw, name == nullptr ? "" : " ",
                               name == nullptr ? std::string_view() : name->name);
    } else if (key == "warning_code" && raw != 0) {
      join(part.value, ", ", name_or(field, raw, "warning"));
    }
  } else if (is_one_of(key, {"cmd_error", "cmd_err"})) {
    if (raw != 0 && part.error.empty()) part.error = "command error";
  } else if (is_one_of(key, {"busy", "wng", "err"})) {
    if (raw != 0) join(part.progress, ", ", field.key == "busy" ? "busy" : field.label);
  } else if (!take_argument(part, field, raw, under)) {
    std::string word = field_word(field, raw, under);
    const bool alone = layout.fields.size() == 1 && field.unit != Unit::kNone && field.values.empty();
    if (word.empty() && alone) word = fmt::format("{} {}", short_label(field.label), quantity_text(field, raw));
    const bool leads = field.role == Role::kSignal && layout.key == "command" && part.values.empty() &&
                       !part.cyclic.empty() && part.cyclic.find(' ') == std::string::npos;
    if (leads) {
      part.cyclic += " " + quantity_text(field, raw);
    } else {
      join(is_flag(field) ? part.status : part.values, is_flag(field) ? " " : ", ", word);
    }
  }
}

bool says(std::string_view text, std::string_view word) {
  return std::search(text.begin(), text.end(), word.begin(), word.end(), [](char a, char b) {
           return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
         }) != text.end();
}

// "parameter reading Pr7.23 ... = 32", "System ID vendor name = "Pana""; empty for the standard command.
std::string command_phrase(const Part& part) {
  if (part.command.empty()) return {};
  std::string text = says(part.type, part.command) ? std::string() : part.command;
  join(text, " ", part.type);
  text += part.argument;
  if (!part.value.empty()) text += (part.command == "Alarm" ? ": " : " = ") + part.value;
  return text;
}

std::string_view handshake_words(const Dissection& dissection, const NodeRef& node, Channel channel) {
  for (const Derived& entry : dissection.derived) {
    if (entry.field->key != "handshake" || entry.node.place != node.place || entry.node.channel != channel) continue;
    const ValueName* const name = find_value(entry.field->values, entry.value);
    if (name != nullptr) return name->name;
  }
  return {};
}

}  // namespace

std::string block_sentence(const Dissection& dissection, const NodeRef& node, const Settings* settings) {
  Part parts[2];
  Direction direction = Direction::kNone;
  bool guessed = false;
  for (const Segment& segment : dissection.segments) {
    if (segment.node.bus != node.bus || segment.node.mac_id != node.mac_id || segment.node.place != node.place)
      continue;
    if (direction == Direction::kNone) direction = segment.direction;
    guessed = guessed || segment.guessed;
    Part& part = parts[segment.layout->key.starts_with("sub_") ? 1 : 0];
    if (segment.layout == &rtex::kCommunicationError) part.error = kCommunicationError;
    for_each_field(*segment.layout, dissection.bytes(segment), [&](const Field& field, std::int64_t raw, Bytes under) {
      if (!field.reserved) take_field(part, *segment.layout, field, raw, under);
    });
  }
  // Its echoes are all ones: no command (6-11).
  if (parts[0].error == kCommunicationError) parts[0].cyclic = parts[0].command = {};
  std::string text = name_text(node, settings);
  if (direction == Direction::kCommand) join(text, " ", "command");
  if (direction == Direction::kResponse) join(text, " ", "response");
  if (guessed) text += " (guessed)";
  std::string words = parts[0].cyclic;
  for (const bool sub : {false, true}) {
    const Part& part = parts[sub ? 1 : 0];
    join(words, ", ", part.values);
    join(words, ", ", part.status);
    const std::string phrase = command_phrase(part);
    if (!phrase.empty()) {
      join(words, ", ", sub ? "sub-command " + phrase : phrase);
      join(words, ", ", handshake_words(dissection, node, sub ? Channel::kSub : Channel::kMain));
    }
    join(words, ", ", part.progress);
    if (part.error == kCommunicationError) {
      join(words, ", ", part.error);
    } else if (!part.error.empty()) {
      join(words, phrase.empty() || !part.progress.empty() ? ", " : " ", "refused: " + part.error);
    }
  }
  join(words, ", ", parts[0].counter);
  join(text, ": ", words);
  return text;
}

}  // namespace servotrace
