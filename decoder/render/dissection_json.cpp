// SPDX-License-Identifier: MIT
#include "decoder/render/dissection_json.hpp"

#include <fmt/format.h>

#include <bit>

#include "decoder/core/slot.hpp"
#include "decoder/render/dissection_text.hpp"
#include "decoder/render/node.hpp"
#include "decoder/render/value.hpp"

namespace servotrace {
namespace {

std::uint64_t mixed(const void* row, std::uint64_t value) {
  constexpr std::uint64_t kOdd = 0xD6E8FEB86659FD93U;
  const std::uint64_t sum = std::bit_cast<std::uintptr_t>(row) + value * kOdd;
  return sum ^ sum >> 29U;
}

std::uint64_t number_of(const NodeRef& node) {
  return std::uint64_t{node.bus.interface_id} << 32U | std::uint64_t{node.bus.number} << 24U |
         std::uint64_t{node.place} << 16U | static_cast<std::uint64_t>(node.channel) << 8U |
         static_cast<std::uint8_t>(node.mac_id);
}

void write_name_and_unit(JsonWriter& json, const Field& field, std::int64_t raw) {
  if (const ValueName* const name = find_value(field.values, raw)) json.member("name", name->name);
  if (const std::string_view unit = symbol(field.unit); !unit.empty()) json.member("unit", unit);
}

void write_number(JsonWriter& json, const Field& field, std::int64_t raw) {
  if (field.kind == Kind::kBool) {
    json.member("value", raw != 0);
  } else {
    json.key("value");
    if (field.base == Base::kHex || (field.kind == Kind::kUnsigned && raw < 0)) {
      json.value(static_cast<std::uint64_t>(raw));
    } else {
      json.raw(scaled_text(raw, field.scale));
    }
    if (field.scale != Ratio{}) json.member("raw", raw);
  }
  write_name_and_unit(json, field, raw);
  if (const std::string violation = violation_text(field, raw); !violation.empty()) json.member("violation", violation);
}

void begin_field(JsonWriter& json, const Field& field) {
  json.key(field.key).begin_object().member("label", field.label);
}

void write_bytes_field(JsonWriter& json, const Field& field, Bytes bytes) {
  begin_field(json, field);
  if (field.kind == Kind::kText) {
    json.member("text", characters(bytes));
  } else {
    json.member("bytes", bytes_text(field, bytes));
  }
  json.end_object();
}

void write_node(JsonWriter& json, const NodeRef& node, const Settings& settings) {
  if (node.mac_id == kNoMacId) return;
  json.member("mac_id", int{node.mac_id});
  if (const std::string_view name = configured_name(settings, node); !name.empty()) json.member("name", name);
  if (node.channel != Channel::kNone) json.member("channel", name_of(node.channel));
}

}  // namespace

std::uint64_t DissectionJson::FieldKey::hash() const { return mixed(field, static_cast<std::uint64_t>(raw)); }

std::uint64_t DissectionJson::HeadKey::hash() const {
  return mixed(layout, number_of(node) ^ std::uint64_t{offset} << 20U ^ std::uint64_t{length} << 40U);
}

std::uint64_t DissectionJson::DerivedKey::hash() const {
  return mixed(field, static_cast<std::uint64_t>(value) ^ number_of(node) << 24U);
}

void DissectionJson::write_segment(JsonWriter& json, const Segment& segment, Bytes bytes) {
  const HeadKey key{.layout = segment.layout,
                    .node = segment.node,
                    .offset = segment.offset,
                    .length = segment.length,
                    .buffer = segment.buffer,
                    .guessed = segment.guessed};
  const std::string_view head = heads_.get(key, [&](std::string& text) {
    JsonWriter members(text);
    members.member("protocol", key.layout->protocol).member("layout", key.layout->key);
    members.member("title", key.layout->title);
    write_node(members, key.node, settings_);
    members.member("buffer", key.buffer == Buffer::kFrame ? "frame" : "reassembled");
    members.member("offset", key.offset).member("length", key.length);
    if (key.guessed) members.member("guessed", true);
  });
  json.begin_object().raw(head).key("fields").begin_object();
  for_each_field(*segment.layout, bytes, [&](const Field& field, std::int64_t raw, Bytes under) {
    if (field.reserved && raw == 0) return;
    if (slot_of(field).width == 0) {
      write_bytes_field(json, field, under);
      return;
    }
    json.raw(fields_.get({&field, raw}, [&](std::string& text) {
      JsonWriter member(text);
      begin_field(member, field);
      write_number(member, field, raw);
      member.end_object();
    }));
  });
  json.end_object().end_object();
}

void DissectionJson::write_derived(JsonWriter& json, const Derived& entry) {
  const bool is_text = entry.field->kind == Kind::kText;
  const DerivedKey key{
      .field = entry.field, .protocol = entry.protocol, .value = is_text ? 0 : entry.value, .node = entry.node};
  const std::string_view head = derived_.get(key, [&](std::string& text) {
    JsonWriter members(text);
    members.member("protocol", key.protocol).member("key", key.field->key).member("label", key.field->label);
    write_node(members, key.node, settings_);
    if (is_text) return;
    members.key("value").raw(scaled_text(key.value, key.field->scale));
    write_name_and_unit(members, *key.field, key.value);
  });
  json.begin_object().raw(head);
  if (is_text) json.member("text", entry.text);
  json.end_object();
}

void DissectionJson::write(JsonWriter& json, const Dissection& dissection) {
  json.key("segments").begin_array();
  for (const Segment& segment : dissection.segments) write_segment(json, segment, dissection.bytes(segment));
  json.end_array();
  json.key("derived").begin_array();
  for (const Derived& entry : dissection.derived) write_derived(json, entry);
  json.end_array();
  json.key("links").begin_array();
  for (const Link& link : dissection.links) {
    json.begin_object().member("kind", name_of(link.kind)).member("frame", link.frame);
    json.member("after", seconds_text(link.after_ns));
    write_node(json, link.node, settings_);
    json.end_object();
  }
  json.end_array();
}

}  // namespace servotrace
