// SPDX-License-Identifier: GPL-2.0-or-later
#include "dissector/text.hpp"

#include <string>

#include "decoder/render/message.hpp"
#include "decoder/render/node.hpp"
#include "decoder/render/sentence.hpp"
#include "decoder/render/value.hpp"
#include "dissector/session.hpp"

namespace servotrace::plugin {

const char* pool_text(wmem_allocator_t* pool, std::string_view text) {
  return wmem_strndup(pool, text.data(), text.size());
}

const char* message_text(wmem_allocator_t* pool, const Finding& finding) { return pool_text(pool, message(finding)); }

const char* unit_text(wmem_allocator_t* pool, const Field& field, std::int64_t value) {
  const std::string_view unit = symbol(field.unit);
  if (field.scale == Ratio{}) {
    if (unit.empty()) return "";
    if (field.unit == Unit::kNanosecond) return pool_text(pool, " ns (" + duration_text(value) + ")");
    return wmem_strdup_printf(pool, " %s", pool_text(pool, unit));
  }
  std::string text = " (" + scaled_text(value, field.scale, decimal_places(field.scale));
  if (!unit.empty()) {
    text += ' ';
    text += unit;
  }
  return pool_text(pool, text + ")");
}

namespace {

std::string text_of(const NodeRef& node) {
  if (node.mac_id == kNoMacId) return node.bus.kind != BusKind::kNone ? bus_text(node.bus) : "capture";
  const Settings* const settings = session_settings();
  return servotrace::node_text(node, settings == nullptr ? std::string_view() : configured_name(*settings, node));
}

// The value of a derived field of DeviceNet, or -1.
std::int64_t derived_value(const Dissection& dissection, std::string_view key) {
  for (const Derived& derived : dissection.derived) {
    if (derived.field->key == key && derived.protocol == "dnet") return derived.value;
  }
  return -1;
}

std::string mac_text(const Dissection& dissection, std::int64_t mac_id, bool is_master) {
  if (mac_id < 0) return {};
  const std::string text =
      text_of({.bus = dissection.bus, .protocol = Protocol::kDevicenet, .mac_id = static_cast<std::int16_t>(mac_id)});
  return is_master ? "master, " + text : text;
}

}  // namespace

const char* node_text(wmem_allocator_t* pool, const NodeRef& node) { return pool_text(pool, text_of(node)); }

Ends ends_text(const Dissection& dissection) {
  const bool command = dissection.direction == Direction::kCommand;
  const bool response = dissection.direction == Direction::kResponse;
  Ends ends;
  if (dissection.protocol == Protocol::kDevicenet) {
    ends.source = mac_text(dissection, derived_value(dissection, "source"), command);
    ends.destination = mac_text(dissection, derived_value(dissection, "destination"), response);
    // A Duplicate MAC ID check is for every node of the bus.
    if (!ends.source.empty() && ends.destination.empty()) ends.destination = bus_text(dissection.bus);
    return ends;
  }
  if (dissection.protocol != Protocol::kRtex || (!command && !response)) return ends;
  // One axis by its name, several by their ring.
  NodeRef drives{.bus = dissection.bus, .protocol = Protocol::kRtex};
  bool several = false;
  for (const Segment& segment : dissection.segments) {
    if (segment.node.mac_id == kNoMacId) continue;
    several = several || (drives.mac_id != kNoMacId && drives.place != segment.node.place);
    drives = segment.node;
  }
  if (several) drives.mac_id = kNoMacId;
  ends.source = command ? "master" : text_of(drives);
  ends.destination = command ? text_of(drives) : "master";
  return ends;
}

std::string info_text(const Dissection& dissection) { return sentence(dissection, session_settings()); }

}  // namespace servotrace::plugin
