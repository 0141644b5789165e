// SPDX-License-Identifier: MIT
// "axis 1 (X) command: CP 128000, Servo_On, parameter writing Pr7.23 ... = 32, waiting for echo, counter 3": the cyclic
// command first, then status, then what the non-cyclic command is about and how far it is.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "decoder/render/key_table.hpp"
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

// Fields that a sentence has a place of its own for.
enum class Place : std::uint8_t {
  kCounter,
  kCyclic,
  kNonCyclic,
  kCommandError,
  kProgress,
  kType,
  kIndex,
  kParameter,
  kQuantity,
  kValue,
  kCharacters,
  kError
};
constexpr KeyTable<Place, 28> kPlaces({
    {"update_counter", Place::kCounter},
    {"update_counter_echo", Place::kCounter},
    {"cyclic_command", Place::kCyclic},
    {"cyclic_command_echo", Place::kCyclic},
    {"non_cyclic_command", Place::kNonCyclic},
    {"non_cyclic_command_echo", Place::kNonCyclic},
    {"command", Place::kNonCyclic},
    {"command_echo", Place::kNonCyclic},
    {"cmd_error", Place::kCommandError},
    {"cmd_err", Place::kCommandError},
    {"busy", Place::kProgress},
    {"wng", Place::kProgress},
    {"err", Place::kProgress},
    {"type_code", Place::kType},
    {"type_code_echo", Place::kType},
    {"index", Place::kIndex},
    {"index_echo", Place::kIndex},
    {"parameter", Place::kParameter},
    {"parameter_echo", Place::kParameter},
    {"setting_data", Place::kQuantity},
    {"setting_data_echo", Place::kQuantity},
    {"parameter_value", Place::kQuantity},
    {"parameter_count", Place::kQuantity},
    {"monitor_select", Place::kValue},
    {"feedforward", Place::kValue},
    {"characters", Place::kCharacters},
    {"error_code", Place::kError},
    {"sub_error_code", Place::kError},
});

std::string name_or(const Field& field, std::int64_t raw, std::string_view otherwise) {
  const ValueName* const name = find_value(field.values, raw);
  return name != nullptr ? std::string(name->name) : fmt::format("{} {}", otherwise, number_text(field, raw));
}

void take_code(Part& part, const Field& field, std::int64_t raw) {
  if (raw == 0) return;  // the standard command
  part.command = name_or(field, raw, "non-cyclic command");
}

std::string parameter_words(const Field& field, std::int64_t raw) {
  const ValueName* const name = find_value(field.values, raw);
  return name != nullptr ? fmt::format(" {}", name->name) : fmt::format(" Pr{}.{:02}", raw >> 8 & 0xFF, raw & 0xFF);
}

void take_alarm(Part& part, const Field& field, std::int64_t raw) {
  if (field.key == "alarm_main") {
    part.alarm = raw;
    part.value = raw == 0 ? "no alarm" : std::string();
  } else if (field.key == "alarm_sub" && part.alarm != 0) {
    const ValueName* const name = find_value(rtex::kAlarmCode.find("alarm_main")->values, part.alarm);
    part.value = fmt::format("Err{}.{}{}{}", part.alarm, raw, name == nullptr ? "" : " ",
                             name == nullptr ? std::string_view() : name->name);
  } else if (field.key == "warning_code" && raw != 0) {
    join(part.value, ", ", name_or(field, raw, "warning"));
  }
}

void take_word(Part& part, const Layout& layout, const Field& field, std::int64_t raw, Bytes under) {
  const bool leads = field.role == Role::kSignal && layout.key == "command" && part.values.empty() &&
                     !part.cyclic.empty() && part.cyclic.find(' ') == std::string::npos;
  if (leads) {
    part.cyclic += " " + quantity_text(field, raw);
    return;
  }
  std::string word = field_word(field, raw, under);
  const bool alone = layout.fields.size() == 1 && field.unit != Unit::kNone && field.values.empty();
  if (word.empty() && alone) word = fmt::format("{} {}", short_label(field.label), quantity_text(field, raw));
  join(is_flag(field) ? part.status : part.values, is_flag(field) ? " " : ", ", word);
}

void take_field(Part& part, const Layout& layout, const Field& field, std::int64_t raw, Bytes under) {
  const Place* const place = kPlaces.find(field.key);
  if (place == nullptr) {
    if (&layout == &rtex::kAlarmCode) {
      take_alarm(part, field, raw);
    } else {
      take_word(part, layout, field, raw, under);
    }
    return;
  }
  switch (*place) {
    case Place::kCounter:
      part.counter = "counter " + fmt::format_int(raw).str();
      break;
    case Place::kCyclic:
      part.cyclic = name_or(field, raw, "cyclic command");
      break;
    case Place::kNonCyclic:
      take_code(part, field, raw);
      break;
    case Place::kCommandError:
      if (raw != 0 && part.error.empty()) part.error = "command error";
      break;
    case Place::kProgress:
      if (raw != 0) join(part.progress, ", ", field.key == "busy" ? "busy" : field.label);
      break;
    case Place::kType:
      part.type = name_or(field, raw, "type code");
      break;
    case Place::kIndex:
      if (raw != 0) part.argument = fmt::format(" index {}", raw);
      break;
    case Place::kParameter:
      part.argument = parameter_words(field, raw);
      break;
    case Place::kQuantity:
      part.value = quantity_text(field, raw);
      break;
    case Place::kValue:
      part.value = value_text(field, raw);
      break;
    case Place::kCharacters:
      part.value = bytes_text(field, under);
      break;
    case Place::kError:
      part.error = name_or(field, raw, "error");
      break;
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
