// SPDX-License-Identifier: MIT
#include "decoder/render/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "decoder/render/key_table.hpp"
#include "decoder/render/node.hpp"
#include "decoder/render/value.hpp"

namespace servotrace {
namespace {

// How a field is spoken of, where its row does not say it.
struct Spoken {
  std::string_view word;  // of a number without a name; empty: the field says nothing
  bool unless_zero = false;
};
// Every other number without a name is left to the fields.
constexpr KeyTable<Spoken, 32> kSpoken({
    {"alarm_main_echo", {"alarm"}},
    {"alarm_main", {"alarm"}},
    {"class", {"class"}},
    {"instance", {"instance"}},
    {"attribute", {"attribute"}},
    {"service", {"service"}},
    {"general_status", {"status"}},
    {"vendor_id", {"vendor"}},
    {"serial_number", {"serial"}},
    {"block_number", {"block", true}},
    {"executing_block_number", {"block", true}},
    {"prg", {"channel", true}},
    {"ack_prg", {"channel", true}},
    // Said by the node's name or by other words, or of no interest in a sentence.
    {"mac_id", {}},
    {"cr", {}},
    {"sub_chk", {}},
    {"fragmented", {}},
    {"xid", {}},
    {"master", {}},
    {"physical_port", {}},
    {"response", {}},
    {"command_axis", {}},
    {"response_axis", {}},
    {"dir", {}},
    {"prm_ope", {}},
    {"prm_set_no", {}},
    {"prm_get_no", {}},
    {"latch_sel1", {}},
    {"latch_sel1_echo", {}},
    {"latch_sel2", {}},
    {"latch_sel2_echo", {}},
    {"alarm_sub_echo", {}},
});

}  // namespace

bool same_letters(std::string_view left, std::string_view right) {
  return left.size() == right.size() && std::equal(left.begin(), left.end(), right.begin(), [](char a, char b) {
           return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
         });
}

void join(std::string& text, std::string_view separator, std::string_view part) {
  if (part.empty()) return;
  if (!text.empty()) text += separator;
  text += part;
}

std::string name_text(const NodeRef& node, const Settings* settings) {
  return node_text(node, settings == nullptr ? std::string_view() : configured_name(*settings, node));
}

bool is_abbreviation(std::string_view word) {
  return !word.empty() && word.size() <= 10 && std::all_of(word.begin(), word.end(), [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '/' || c == '-';
  });
}

std::string_view short_label(std::string_view label) {
  const std::size_t open = label.find(" (");
  if (open == std::string_view::npos) return label;
  const std::string_view outside = label.substr(0, open);
  if (is_abbreviation(outside)) return outside;
  const std::size_t close = label.find(')', open);
  if (close == std::string_view::npos) return label;
  const std::string_view inside = label.substr(open + 2, close - open - 2);
  return is_abbreviation(inside) ? inside : outside;
}

std::string quantity_text(const Field& field, std::int64_t raw) {
  std::string text = number_text(field, raw);
  const std::string_view unit = field.unit == Unit::kCommandUnit ? std::string_view() : symbol(field.unit);
  join(text, " ", unit);
  return text;
}

bool is_flag(const Field& field) { return field.kind == Kind::kBool || field.width == 1; }

std::string field_word(const Field& field, std::int64_t raw, Bytes under) {
  const Spoken* const spoken = kSpoken.find(field.key);
  if (field.reserved || (spoken != nullptr && spoken->word.empty())) return {};
  if (slot_of(field).width == 0) {
    return field.kind == Kind::kText && !under.empty()
               ? fmt::format("{} {}", short_label(field.label), bytes_text(field, under))
               : std::string();
  }
  const ValueName* const name = find_value(field.values, raw);
  if (field.role == Role::kSignal) {
    std::string text(short_label(field.label));
    return text.append(" ").append(quantity_text(field, raw));
  }
  if (is_flag(field)) {
    if (raw == 0) return {};
    std::string label(short_label(field.label));
    // Two meanings of one bit are one word.
    for (std::size_t slash = label.find(" / "); slash != std::string::npos; slash = label.find(" / "))
      label.erase(slash + 2, 1).erase(slash, 1);
    if (name == nullptr) return label;
    // "servo on" says what "Enable" is about, "successful" not what "PRM_STS" is.
    return is_abbreviation(label) ? fmt::format("{} {}", label, name->name) : std::string(name->name);
  }
  if (name != nullptr) return name->name == "Normal" ? std::string() : std::string(name->name);
  if (spoken == nullptr || (spoken->unless_zero && raw == 0)) return {};
  return fmt::format("{} {}", spoken->word, value_text(field, raw));
}

std::string lone_quantity(const Segment& segment, Bytes bytes) {
  if (segment.layout->fields.size() != 1) return {};
  const Field& field = segment.layout->fields[0];
  if (slot_of(field).width == 0 || field.unit == Unit::kNone || field.role == Role::kSignal || !field.values.empty())
    return {};
  return fmt::format("{} {}", short_label(field.label), value_text(field, read(slot_of(field), bytes)));
}

std::string segment_words(const Segment& segment, Bytes bytes) {
  if (std::string quantity = lone_quantity(segment, bytes); !quantity.empty()) return quantity;
  std::string words;
  std::string flags;
  for_each_field(*segment.layout, bytes, [&](const Field& field, std::int64_t raw, Bytes under) {
    const std::string word = field_word(field, raw, under);
    if (is_flag(field)) {
      join(flags, is_abbreviation(word.substr(0, word.find(' '))) ? " " : ", ", word);
    } else {
      join(words, ", ", word);
    }
  });
  join(words, ", ", flags);
  return words;
}

const Derived* find_derived(const Dissection& dissection, std::string_view key) {
  for (const Derived& entry : dissection.derived) {
    if (entry.field->key == key) return &entry;
  }
  return nullptr;
}

}  // namespace servotrace
