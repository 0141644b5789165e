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
