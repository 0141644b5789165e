// SPDX-License-Identifier: MIT
#include "replay/signals.hpp"

#include <fmt/format.h>

#include "decoder/core/slot.hpp"
#include "decoder/render/value.hpp"
#include "decoder/rtex/layouts.hpp"

namespace servotrace::replay {

bool Answered::operator()(const Dissection& dissection, const Segment& segment) {
  if (segment.layout == &rtex::kResponse) answered_ = read(slot(rtex::kResponse, "cr"), dissection.bytes(segment)) != 0;
  return answered_ || segment.direction != Direction::kResponse;
}

const std::vector<SeriesList::Column>& SeriesList::columns(const Segment& segment, bool states) {
  const NodeRef& node = segment.node;
  const Place place{segment.layout, static_cast<std::uint64_t>(node.bus.interface_id) << 32U |
                                        static_cast<std::uint64_t>(node.bus.kind) << 24U |
                                        static_cast<std::uint64_t>(node.bus.number) << 16U |
                                        static_cast<std::uint16_t>(node.mac_id)};
  const auto [entry, is_new] = columns_.try_emplace(place);
  if (!is_new) return entry->second;
  for (const Field& field : segment.layout->fields) {
    if (field.role == Role::kPlain || (field.role == Role::kState && !states)) continue;
    const Slot slot = slot_of(field);
    if (slot.width != 0) entry->second.push_back({&field, slot, number(segment, field)});
  }
  return entry->second;
}

void SeriesList::note(const Dissection& dissection, bool states) {
  Answered answered;
  for (const Segment& segment : dissection.segments) {
    if (answered(dissection, segment) && segment.node.mac_id != kNoMacId) columns(segment, states);
  }
}

std::size_t SeriesList::number(const Segment& segment, const Field& field) {
  const NodeRef& node = segment.node;
  const Key key{node.bus.interface_id,
                static_cast<std::uint8_t>(node.bus.kind),
                node.bus.number,
                node.mac_id,
                segment.layout->protocol,
                segment.layout->key,
                field.key};
  const auto [entry, is_new] = numbers_.try_emplace(key, entries_.size());
  if (is_new) entries_.push_back({node, segment.layout, &field});
  return entry->second;
}

std::vector<Series> SeriesList::named(const BusNames& buses) const {
  std::vector<Series> list;
  for (const Entry& entry : entries_) {
    const std::string_view word = entry.node.protocol == Protocol::kRtex ? "axis" : "node";
    std::string name = fmt::format("{}.{}{}", buses.name(entry.node.bus), word, entry.node.mac_id);
    if (!entry.layout->key.empty()) name += fmt::format(".{}", entry.layout->key);
    list.push_back({fmt::format("{}.{}", name, entry.field->key), entry.field, entry.node});
  }
  return list;
}

std::string state_text(const Field& field, std::int64_t raw) {
  if (const ValueName* const name = find_value(field.values, raw)) return std::string(name->name);
  return number_text(field, raw);
}

}  // namespace servotrace::replay
