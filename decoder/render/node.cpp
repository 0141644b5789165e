// SPDX-License-Identifier: MIT
#include "decoder/render/node.hpp"

#include <fmt/format.h>

namespace servotrace {

std::string_view configured_name(const Settings& settings, const NodeRef& node) {
  if (node.mac_id == kNoMacId) return {};
  if (node.protocol == Protocol::kRtex) {
    const RtexAxisSettings* const axis = settings.axis(node.bus.number, node.mac_id);
    return axis == nullptr ? std::string_view() : axis->name;
  }
  const DevicenetNodeSettings* const entry = settings.node(node.mac_id);
  return entry == nullptr ? std::string_view() : entry->name;
}

std::string node_text(const NodeRef& node, std::string_view name) {
  if (node.mac_id == kNoMacId) return {};
  const fmt::format_int number(node.mac_id);
  std::string text = node.protocol == Protocol::kRtex ? "axis " : "node ";
  text.append(number.data(), number.size());
  if (!name.empty()) text.append(" (").append(name).append(")");
  return text;
}

}  // namespace servotrace
