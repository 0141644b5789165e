// SPDX-License-Identifier: MIT
// A DeviceNet frame is one message, or a fragment of one. What its identifier and the sessions say comes first.
#include <fmt/format.h>

#include "decoder/render/value.hpp"
#include "decoder/render/words.hpp"

namespace servotrace {
namespace {

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

// The value of an attribute that is one number or one text.
std::string attribute_words(const Segment& segment, Bytes bytes, std::string_view attribute) {
  if (segment.layout->title != attribute) return {};
  std::string words;
  std::size_t values = 0;
  for_each_field(*segment.layout, bytes, [&](const Field& field, std::int64_t raw, Bytes under) {
    if (field.key == "length") return;  // of a text
    ++values;
    const ValueName* const name = find_value(field.values, raw);
    if (field.kind == Kind::kText) {
      words = bytes_text(field, under);
    } else if (slot_of(field).width != 0) {
      words = name != nullptr ? std::string(name->name) : quantity_text(field, raw);
    }
  });
  return values == 1 ? words : std::string();
}

std::string fragment_words(const Segment& segment, Bytes bytes) {
  std::string words;
  for_each_field(*segment.layout, bytes, [&](const Field& field, std::int64_t raw, Bytes) {
    const ValueName* const name = find_value(field.values, raw);
    if (field.key == "type" && name != nullptr)
      words = name->name == "acknowledge" ? "fragment acknowledged" : fmt::format("{} fragment", name->name);
    if (field.key == "ack_status" && raw != 0)
      words += fmt::format(": {}", name == nullptr ? value_text(field, raw) : std::string(name->name));
  });
  return words;
}

// The code of a poll command that asks for what the response is to hold, where it asks for anything.
std::string asked_words(const Segment& segment, Bytes bytes) {
  const Field* const field = segment.layout->find("response_code");
  if (field == nullptr || segment.direction != Direction::kCommand) return {};
  const std::int64_t raw = read(slot_of(*field), bytes);
  const ValueName* const name = find_value(field->values, raw);
  return raw == 0 || name == nullptr ? std::string() : fmt::format("asks for {}", name->name);
}

// Codes that say what the process value behind them says again.
bool is_said_by(const Dissection& dissection, std::string_view word) {
  for (const Segment& segment : dissection.segments) {
    for (const Field& field : segment.layout->fields) {
      if (field.role == Role::kSignal && same_letters(field.label, word)) return true;
    }
  }
  return false;
}

std::string io_words(const Dissection& dissection, const Segment& segment, Bytes bytes) {
  std::string words;
  std::string values;
  std::string flags;
  bool idles = false;  // a code that asks for nothing
  for_each_field(*segment.layout, bytes, [&](const Field& field, std::int64_t raw, Bytes under) {
    if (field.key == "response_code" && segment.direction == Direction::kCommand) return;
    const std::string word = field_word(field, raw, under);
    if (word.empty() || is_said_by(dissection, word)) return;
    if (is_flag(field)) {
      join(flags, is_abbreviation(word.substr(0, word.find(' '))) ? " " : ", ", word);
    } else if (field.role == Role::kSignal) {
      join(values, ", ", word);
    } else if (word == "NOP") {
      idles = true;
    } else {
      join(words, ", ", word);
    }
  });
  join(values, ", ", words);
  join(values, ", ", flags);
  return values.empty() && idles ? "NOP" : values;
}

NodeRef node_of(const Dissection& dissection) {
  for (const Segment& segment : dissection.segments) {
    if (segment.node.mac_id != kNoMacId) return segment.node;
  }
  for (const Derived& entry : dissection.derived) {
    if (entry.node.mac_id != kNoMacId) return entry.node;
  }
  return {};
}

// Of the message or the part of one that the frame holds.
bool is_all_zero(const Dissection& dissection) {
  bool any = false;
  for (const Segment& segment : dissection.segments) {
    if (segment.layout->key == "fragment") continue;
    for (const std::uint8_t byte : dissection.bytes(segment)) {
      if (byte != 0) return false;
      any = true;
    }
  }
  return any;
}

std::string flag_words(const Derived& entry) {
  if (entry.field->kind != Kind::kBool || entry.value == 0) return {};
  // Labels of fields are names; these two are said in full.
  if (entry.field->key == "fragment_or_data") return "fragment or data, connection size not known";
  if (entry.field->key == "idle") return "idle (no data)";
  return std::string(entry.field->label);
}

}  // namespace

std::string devicenet_sentence(const Dissection& dissection, const Settings* settings) {
  std::string text = name_text(node_of(dissection), settings);
  join(text, " ", derived_words(dissection, "message"));
  bool guessed = false;
  for (const Segment& segment : dissection.segments) guessed = guessed || segment.guessed;
  if (guessed) text += " (guessed)";

  std::string words;
  for (const std::string_view key : {"service_name", "object_name", "attribute_name"})
    join(words, " ", derived_words(dissection, key));
  const bool has_service = !words.empty();
  const bool object_told = !derived_words(dissection, "object_name").empty();
  const std::string_view attribute = derived_words(dissection, "attribute_name");
  const std::string_view transaction = derived_words(dissection, "transaction");
  join(words, ", ", transaction);
  for (const Derived& entry : dissection.derived) join(words, ", ", flag_words(entry));

  std::string asked;
  for (const Segment& segment : dissection.segments) {
    const Bytes bytes = dissection.bytes(segment);
    if (segment.layout->key == "fragment") {
      // Of a message that is complete, the fragment is not the news.
      if (dissection.reassembled.empty()) join(words, ", ", fragment_words(segment, bytes));
      continue;
    }
    // The header of an explicit message is what service_name and its like have said.
    if (has_service && segment.layout->protocol == "dnet" && segment.layout->key == "explicit") {
      join(words, ", ", explicit_words(segment, bytes, object_told, !attribute.empty()));
      continue;
    }
    if (!attribute.empty()) {
      const std::string value = attribute_words(segment, bytes, attribute);
      join(words, value.empty() ? ", " : " = ", value.empty() ? segment_words(segment, bytes) : value);
      continue;
    }
    // What a transaction is about it has said itself.
    if (transaction.empty()) join(words, ", ", lone_quantity(segment, bytes));
    join(words, ", ", io_words(dissection, segment, bytes));
    join(asked, ", ", asked_words(segment, bytes));
  }
  join(words, ", ", asked);
  if (words.empty() && is_all_zero(dissection)) words = "all bits 0";
  const std::string_view why = derived_words(dissection, "allocation_error");
  if (!why.empty()) words += fmt::format(" ({})", why);
  join(text, ": ", words);
  return text;
}

}  // namespace servotrace
