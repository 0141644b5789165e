// SPDX-License-Identifier: MIT
#include "decoder/render/sentence.hpp"

#include <fmt/format.h>

#include "decoder/render/node.hpp"
#include "decoder/render/value.hpp"

namespace servotrace {
namespace {

// A sentence longer than this is cut between two parts: Info columns and evidence lines are one line.
constexpr std::size_t kLongest = 240;

bool same_node(const NodeRef& left, const NodeRef& right) {
  return left.bus == right.bus && left.protocol == right.protocol && left.mac_id == right.mac_id &&
         left.place == right.place;
}

void join(std::string& text, std::string_view separator, const std::string& part) {
  if (part.empty()) return;
  if (!text.empty()) text += separator;
  text += part;
}

// What of a segment is worth a word: named values, set flags, process values.
std::string segment_words(const Segment& segment, Bytes bytes) {
  std::string words;
  for_each_field(*segment.layout, bytes, [&](const Field& field, std::int64_t raw, Bytes under) {
    if (field.reserved || words.size() > kLongest) return;
    if (slot_of(field).width == 0) {
      if (field.kind == Kind::kText) join(words, ", ", fmt::format("{} {}", field.label, bytes_text(field, under)));
      return;
    }
    const ValueName* const name = find_value(field.values, raw);
    if (field.role == Role::kSignal) {
      join(words, ", ", fmt::format("{} {}", field.label, value_text(field, raw)));
    } else if (field.kind == Kind::kBool || field.width == 1) {
      if (name != nullptr && raw != 0) {
        join(words, ", ", fmt::format("{} {}", field.label, name->name));
      } else if (raw != 0) {
        join(words, ", ", std::string(field.label));
      }
    } else if (name != nullptr) {
      join(words, ", ", std::string(name->name));
    }
  });
  return words;
}

std::string subject(const NodeRef& node, Direction direction, const Settings* settings) {
  std::string text = node_text(node, settings == nullptr ? std::string_view() : configured_name(*settings, node));
  if (direction == Direction::kCommand) text += text.empty() ? "command" : " command";
  if (direction == Direction::kResponse) text += text.empty() ? "response" : " response";
  return text;
}

// The words of every segment of `node`, behind its name.
std::string node_words(const Dissection& dissection, const NodeRef& node, const Settings* settings) {
  std::string words;
  Direction direction = Direction::kNone;
  for (const Segment& segment : dissection.segments) {
    if (!same_node(segment.node, node)) continue;
    if (direction == Direction::kNone) direction = segment.direction;
    join(words, ", ", segment_words(segment, dissection.bytes(segment)));
  }
  std::string text = subject(node, direction, settings);
  join(text, ": ", words);
  return text;
}

}  // namespace

std::string sentence(const Dissection& dissection, const Settings* settings) {
  std::string text;
  for (std::size_t i = 0; i < dissection.segments.size(); ++i) {
    const Segment& segment = dissection.segments[i];
    bool told = segment.node.mac_id == kNoMacId && dissection.protocol == Protocol::kRtex;
    for (std::size_t j = 0; j < i && !told; ++j) told = same_node(dissection.segments[j].node, segment.node);
    if (told) continue;
    if (text.size() > kLongest) return text + " ...";
    join(text, "; ", node_words(dissection, segment.node, settings));
  }
  return text;
}

std::string sentence_of(const Dissection& dissection, const NodeRef& node, const Settings* settings) {
  if (node.mac_id != kNoMacId) {
    for (const Segment& segment : dissection.segments) {
      if (same_node(segment.node, node)) return node_words(dissection, segment.node, settings);
    }
  }
  return sentence(dissection, settings);
}

}  // namespace servotrace
