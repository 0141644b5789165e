// SPDX-License-Identifier: MIT
#include "decoder/render/dissection_text.hpp"

#include <fmt/format.h>

#include <iterator>

#include "decoder/render/node.hpp"
#include "decoder/render/value.hpp"

namespace servotrace {
namespace {

std::string node_name(const NodeRef& node, const Settings& settings) {
  return node_text(node, configured_name(settings, node));
}

void append_field(std::string& out, const Field& field, std::int64_t raw, Bytes bytes, const TextOptions& options) {
  const bool number = slot_of(field).width != 0;
  const std::string violation = violation_text(field, raw);
  if (field.reserved && violation.empty() && !options.reserved) return;
  fmt::format_to(std::back_inserter(out), "    {}: {}", field.label,
                 number ? value_text(field, raw) : bytes_text(field, bytes));
  if (!violation.empty()) fmt::format_to(std::back_inserter(out), "  <- {}", violation);
  out += '\n';
  if (!options.explanations) return;
  const ValueName* const name = number ? find_value(field.values, raw) : nullptr;
  if (name != nullptr && !name->explanation.empty()) {
    fmt::format_to(std::back_inserter(out), "        {}\n", name->explanation);
  } else if (!field.explanation.empty()) {
    fmt::format_to(std::back_inserter(out), "        {}\n", field.explanation);
  }
  fmt::format_to(std::back_inserter(out), "        [{}]\n", field.section);
}

void write_field(JsonWriter& json, const Field& field, std::int64_t raw, Bytes bytes) {
  json.key(field.key).begin_object();
  json.member("label", field.label);
  if (slot_of(field).width == 0) {
    json.member(field.kind == Kind::kText ? "text" : "bytes",
                field.kind == Kind::kText ? std::string(characters(bytes)) : bytes_text(field, bytes));
  } else {
    if (field.kind == Kind::kBool) {
      json.member("value", raw != 0);
    } else {
      json.key("value").raw(field.base == Base::kHex || (field.kind == Kind::kUnsigned && raw < 0)
                                ? fmt::format("{}", static_cast<std::uint64_t>(raw))
                                : scaled_text(raw, field.scale));
      if (field.scale != Ratio{}) json.member("raw", raw);
    }
    if (const ValueName* const name = find_value(field.values, raw)) json.member("name", name->name);
    if (const std::string_view unit = symbol(field.unit); !unit.empty()) json.member("unit", unit);
    if (const std::string violation = violation_text(field, raw); !violation.empty()) {
      json.member("violation", violation);
    }
  }
  json.end_object();
}

void write_node(JsonWriter& json, const NodeRef& node, const Settings& settings) {
  if (node.mac_id == kNoMacId) return;
  json.member("mac_id", int{node.mac_id});
  if (const std::string_view name = configured_name(settings, node); !name.empty()) json.member("name", name);
  if (node.channel != Channel::kNone) json.member("channel", name_of(node.channel));
}

std::string derived_text(const Derived& entry) {
  return entry.field->kind == Kind::kText ? std::string(entry.text) : value_text(*entry.field, entry.value);
}

}  // namespace

std::string_view name_of(LinkKind kind) {
  switch (kind) {
    case LinkKind::kRequestIn:
      return "request in";
    case LinkKind::kAcceptedIn:
      return "accepted in";
    case LinkKind::kPreviousOfNode:
      return "previous of this node";
    case LinkKind::kFirstFragment:
      return "first fragment";
    case LinkKind::kReassembledFrom:
      return "reassembled from";
  }
  return "";
}

void append_text(std::string& out, const Dissection& dissection, const Settings& settings, const TextOptions& options) {
  const auto to = std::back_inserter(out);
  for (const Segment& segment : dissection.segments) {
    const std::string node = node_name(segment.node, settings);
    fmt::format_to(to, "  {}{}{}{}{}\n", node, node.empty() ? "" : ": ", segment.layout->title,
                   segment.guessed ? " (a guess)" : "", segment.buffer == Buffer::kReassembled ? " (reassembled)" : "");
    for_each_field(*segment.layout, dissection.bytes(segment), [&](const Field& field, std::int64_t raw, Bytes bytes) {
      append_field(out, field, raw, bytes, options);
    });
  }
  for (const Derived& entry : dissection.derived) {
    const std::string node = node_name(entry.node, settings);
    fmt::format_to(to, "  [{}{}{}: {}]\n", node, node.empty() ? "" : ": ", entry.field->label, derived_text(entry));
  }
  for (const Link& link : dissection.links) {
    const std::string node = node_name(link.node, settings);
    fmt::format_to(to, "  [{}{}{} frame {}, {} before]\n", node, node.empty() ? "" : ": ", name_of(link.kind),
                   link.frame, duration_text(link.after_ns));
  }
  const std::uint32_t dropped =
      dissection.segments.dropped() + dissection.derived.dropped() + dissection.links.dropped();
  if (dropped != 0) fmt::format_to(to, "  [{} parts of this frame are not shown: too many]\n", dropped);
}

void write_json(JsonWriter& json, const Dissection& dissection, const Settings& settings) {
  json.key("segments").begin_array();
  for (const Segment& segment : dissection.segments) {
    json.begin_object();
    json.member("protocol", segment.layout->protocol);
    json.member("layout", segment.layout->key);
    json.member("title", segment.layout->title);
    write_node(json, segment.node, settings);
    json.member("buffer", segment.buffer == Buffer::kFrame ? "frame" : "reassembled");
    json.member("offset", std::uint64_t{segment.offset});
    json.member("length", std::uint64_t{segment.length});
    if (segment.guessed) json.member("guessed", true);
    json.key("fields").begin_object();
    for_each_field(*segment.layout, dissection.bytes(segment), [&](const Field& field, std::int64_t raw, Bytes bytes) {
      if (!field.reserved || raw != 0) write_field(json, field, raw, bytes);
    });
    json.end_object().end_object();
  }
  json.end_array();
  json.key("derived").begin_array();
  for (const Derived& entry : dissection.derived) {
    json.begin_object();
    json.member("protocol", entry.protocol);
    json.member("key", entry.field->key);
    json.member("label", entry.field->label);
    write_node(json, entry.node, settings);
    if (entry.field->kind == Kind::kText) {
      json.member("text", entry.text);
    } else {
      json.key("value").raw(scaled_text(entry.value, entry.field->scale));
      if (const ValueName* const name = find_value(entry.field->values, entry.value)) json.member("name", name->name);
      if (const std::string_view unit = symbol(entry.field->unit); !unit.empty()) json.member("unit", unit);
    }
    json.end_object();
  }
  json.end_array();
  json.key("links").begin_array();
  for (const Link& link : dissection.links) {
    json.begin_object();
    json.member("kind", name_of(link.kind));
    json.member("frame", link.frame);
    json.member("after", seconds_text(link.after_ns));
    write_node(json, link.node, settings);
    json.end_object();
  }
  json.end_array();
}

}  // namespace servotrace
