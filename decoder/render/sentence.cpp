// SPDX-License-Identifier: MIT
#include "decoder/render/sentence.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "decoder/render/node.hpp"
#include "decoder/render/value.hpp"

namespace servotrace {
namespace {

// A sentence longer than this is cut between two parts: Info columns and evidence lines are one line.
constexpr std::size_t kLongest = 240;

// Numbers without names that are worth a word, and the word. Every other one is left to the fields.
struct Spoken {
  std::string_view key;
  std::string_view word;
};
constexpr Spoken kSpoken[] = {
    {"update_counter", "counter"},
    {"update_counter_echo", "counter"},
    {"index", "index"},
    {"index_echo", "index"},
    {"parameter", "parameter"},
    {"parameter_echo", "parameter"},
    {"setting_data", "value"},
    {"parameter_value", "value"},
    {"type_code", "type code"},
    {"type_code_echo", "type code"},
    {"error_code", "error"},
    {"sub_error_code", "error"},
    {"alarm_main", "alarm"},
    {"class", "class"},
    {"instance", "instance"},
    {"attribute", "attribute"},
    {"service", "service"},
    {"general_status", "status"},
    {"prm_set_no", "number"},
    {"prm_get_no", "number"},
    {"block_number", "block"},
    {"executing_block_number", "block"},
    {"vendor_id", "vendor"},
    {"serial_number", "serial"},
};
// Said by the node's name, or of no interest in a sentence.
constexpr std::string_view kSilent[] = {"mac_id",        "cr",
                                        "sub_chk",       "fragmented",
                                        "xid",           "master",
                                        "physical_port", "response",
                                        "command_axis",  "response_axis",
                                        "dir",           "prm_ope",
                                        "latch_sel1",    "latch_sel1_echo",
                                        "latch_sel2",    "latch_sel2_echo"};

bool is_short(std::string_view word) {
  return !word.empty() && word.size() <= 10 && std::all_of(word.begin(), word.end(), [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '/' || c == '-';
  });
}

// The manual's abbreviation where a label holds one: "CPOS" of "Command position (CPOS)", "SVON" of "SVON (Servo ON)".
std::string_view short_label(std::string_view label) {
  const std::size_t open = label.find(" (");
  if (open == std::string_view::npos) return label;
  const std::string_view outside = label.substr(0, open);
  if (is_short(outside)) return outside;
  const std::size_t close = label.find(')', open);
  if (close == std::string_view::npos) return label;
  const std::string_view inside = label.substr(open + 2, close - open - 2);
  return is_short(inside) ? inside : outside;
}

bool same_node(const NodeRef& left, const NodeRef& right) {
  return left.bus == right.bus && left.protocol == right.protocol && left.mac_id == right.mac_id &&
         left.place == right.place;
}

void join(std::string& text, std::string_view separator, std::string_view part) {
  if (part.empty()) return;
  if (!text.empty()) text += separator;
  text += part;
}

std::string field_word(const Field& field, std::int64_t raw, Bytes under) {
  if (field.reserved || std::find(std::begin(kSilent), std::end(kSilent), field.key) != std::end(kSilent)) return {};
  if (slot_of(field).width == 0) {
    return field.kind == Kind::kText && !under.empty()
               ? fmt::format("{} {}", short_label(field.label), bytes_text(field, under))
               : std::string();
  }
  const ValueName* const name = find_value(field.values, raw);
  if (field.role == Role::kSignal) {
    const std::string_view unit = symbol(field.unit);
    return fmt::format("{} {}{}{}", short_label(field.label), number_text(field, raw), unit.empty() ? "" : " ", unit);
  }
  if (field.kind == Kind::kBool || field.width == 1) {
    if (raw == 0) return {};
    return name == nullptr ? std::string(short_label(field.label))
                           : fmt::format("{} {}", short_label(field.label), name->name);
  }
  if (name != nullptr) return name->name == "Normal" ? std::string() : std::string(name->name);
  for (const Spoken& spoken : kSpoken) {
    if (spoken.key == field.key) return fmt::format("{} {}", spoken.word, value_text(field, raw));
  }
  return {};
}

// The sub-command channel at rest: its Type_Code and Index mean nothing.
bool is_idle_sub(const Layout& layout, Bytes bytes) {
  if (!layout.key.starts_with("sub_")) return false;
  for (const std::string_view key : {"command", "command_echo"}) {
    const Field* const code = layout.find(key);
    if (code != nullptr && read(slot_of(*code), bytes) == 0) return true;
  }
  return false;
}
bool is_argument(const Field& field) {
  static constexpr std::string_view kArguments[] = {"type_code", "type_code_echo", "index", "index_echo"};
  return std::find(std::begin(kArguments), std::end(kArguments), field.key) != std::end(kArguments);
}

// What of a segment is worth a word: named values, set flags, process values, and a quantity that stands alone.
std::string segment_words(const Segment& segment, Bytes bytes) {
  std::string words;
  std::string flags;
  const bool idle_sub = is_idle_sub(*segment.layout, bytes);
  for_each_field(*segment.layout, bytes, [&](const Field& field, std::int64_t raw, Bytes under) {
    if (idle_sub && is_argument(field)) return;
    const bool alone = segment.layout->fields.size() == 1 && slot_of(field).width != 0;
    if (alone && field.unit != Unit::kNone && field.role != Role::kSignal && field.values.empty()) {
      words = fmt::format("{} {}", short_label(field.label), value_text(field, raw));
      return;
    }
    const bool flag = field.kind == Kind::kBool || field.width == 1;
    join(flag ? flags : words, flag ? " " : ", ", field_word(field, raw, under));
  });
  join(words, ", ", flags);
  return words;
}

std::string name_text(const NodeRef& node, const Settings* settings) {
  return node_text(node, settings == nullptr ? std::string_view() : configured_name(*settings, node));
}

// RTEX: one part of the record.
std::string block_words(const Dissection& dissection, const NodeRef& node, const Settings* settings) {
  std::string words;
  Direction direction = Direction::kNone;
  bool guessed = false;
  for (const Segment& segment : dissection.segments) {
    if (!same_node(segment.node, node)) continue;
    if (direction == Direction::kNone) direction = segment.direction;
    guessed = guessed || segment.guessed;
    join(words, ", ", segment_words(segment, dissection.bytes(segment)));
  }
  std::string text = name_text(node, settings);
  if (direction == Direction::kCommand) join(text, " ", "command");
  if (direction == Direction::kResponse) join(text, " ", "response");
  if (guessed) text += " (guessed)";
  join(text, ": ", words);
  return text;
}

const Derived* find_derived(const Dissection& dissection, std::string_view key) {
  for (const Derived& entry : dissection.derived) {
    if (entry.field->key == key) return &entry;
  }
  return nullptr;
}

std::string_view derived_words(const Dissection& dissection, std::string_view key) {
  const Derived* const entry = find_derived(dissection, key);
  return entry == nullptr ? std::string_view() : entry->text;
}

// Of the body of an explicit message, what service, object and attribute do not say: the choices of an allocation, why
// a request was refused.
std::string explicit_words(const Segment& segment, Bytes bytes, bool object_told, bool attribute_told) {
  std::string words;
  for_each_field(*segment.layout, bytes, [&](const Field& field, std::int64_t raw, Bytes) {
    const ValueName* const name = find_value(field.values, raw);
    if (field.key == "general_status") {
      join(words, ", ", fmt::format("refused: {}", name == nullptr ? value_text(field, raw) : std::string(name->name)));
    } else if (field.key.starts_with("choice_") && raw != 0) {
      join(words, ", ", field.label);
    } else if (!object_told && (field.key == "class" || field.key == "instance")) {
      join(words, ", ", fmt::format("{} {}", field.key, value_text(field, raw)));
    } else if (!attribute_told && field.key == "attribute") {
      join(words, ", ", fmt::format("attribute {}", raw));
    } else if (field.key == "reset_type") {
      join(words, ", ", name == nullptr ? value_text(field, raw) : std::string(name->name));
    }
  });
  return words;
}

// The value of an attribute that is one number.
std::string attribute_words(const Segment& segment, Bytes bytes, std::string_view attribute) {
  const std::span<const Field> fields = segment.layout->fields;
  if (attribute.empty() || segment.layout->title != attribute) return {};
  if (fields.size() != 1 || slot_of(fields[0]).width == 0) return {};
  return value_text(fields[0], read(slot_of(fields[0]), bytes));
}

// DeviceNet: a frame is one message, or a fragment of one. What its identifier and the sessions say comes first.
std::string message_words(const Dissection& dissection, const Settings* settings) {
  NodeRef node;
  for (const Segment& segment : dissection.segments) {
    if (node.mac_id == kNoMacId) node = segment.node;
  }
  for (const Derived& entry : dissection.derived) {
    if (node.mac_id == kNoMacId) node = entry.node;
  }
  std::string text = name_text(node, settings);
  const std::string_view message = derived_words(dissection, "message");
  join(text, text.empty() ? "" : " ", message);
  std::string words;
  for (const std::string_view key : {"service_name", "object_name", "attribute_name"}) {
    join(words, " ", derived_words(dissection, key));
  }
  for (const Derived& entry : dissection.derived) {
    const bool told = entry.field->kind == Kind::kBool && entry.value != 0;
    if (told) join(words, ", ", entry.field->label);
  }
  const bool has_service = !derived_words(dissection, "service_name").empty();
  const std::string_view attribute = derived_words(dissection, "attribute_name");
  const bool attribute_told = !attribute.empty();
  const bool object_told = !derived_words(dissection, "object_name").empty();
  for (const Segment& segment : dissection.segments) {
    // The header of an explicit message is what service_name and its like have said.
    const Bytes bytes = dissection.bytes(segment);
    if (has_service && segment.layout->protocol == "dnet" && segment.layout->key == "explicit") {
      join(words, ", ", explicit_words(segment, bytes, object_told, attribute_told));
      continue;
    }
    std::string part = attribute_words(segment, bytes, attribute);
    if (!part.empty()) {
      join(words, " = ", part);
      continue;
    }
    part = segment_words(segment, bytes);
    if (!part.empty() && segment.guessed) part += " (guessed)";
    join(words, ", ", part);
  }
  const std::string_view why = derived_words(dissection, "allocation_error");
  if (!why.empty()) words += fmt::format(" ({})", why);
  join(text, ": ", words);
  return text;
}

std::string cut(std::string text) {
  if (text.size() <= kLongest) return text;
  // At a separator, so that no number is cut in two.
  const std::size_t end = text.find_last_of(",;", kLongest);
  text.resize(end == std::string::npos || end == 0 ? kLongest : end);
  return text + " ...";
}

}  // namespace

std::string sentence(const Dissection& dissection, const Settings* settings) {
  if (dissection.protocol == Protocol::kDevicenet) return cut(message_words(dissection, settings));
  std::string text;
  for (std::size_t i = 0; i < dissection.segments.size() && text.size() <= kLongest; ++i) {
    const NodeRef& node = dissection.segments[i].node;
    bool told = node.mac_id == kNoMacId;
    for (std::size_t j = 0; j < i && !told; ++j) told = same_node(dissection.segments[j].node, node);
    if (!told) join(text, "; ", block_words(dissection, node, settings));
  }
  return cut(std::move(text));
}

std::string sentence_of(const Dissection& dissection, const NodeRef& node, const Settings* settings) {
  if (node.mac_id != kNoMacId && dissection.protocol == Protocol::kRtex) {
    for (const Segment& segment : dissection.segments) {
      if (same_node(segment.node, node)) return cut(block_words(dissection, segment.node, settings));
    }
  }
  return sentence(dissection, settings);
}

}  // namespace servotrace
