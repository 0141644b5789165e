// SPDX-License-Identifier: MIT
#include "replay/bus_names.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace servotrace::replay {

BusNames::BusNames(const Summary& summary, std::span<const InterfaceInfo> interfaces) {
  const auto is_taken = [this](std::string_view name) {
    return std::any_of(names_.begin(), names_.end(), [name](const auto& entry) { return entry.second == name; });
  };
  std::size_t can_buses = 0;
  for (const BusSummary& entry : summary.buses) {
    const BusRef& bus = entry.bus;
    std::string name;
    if (bus.kind == BusKind::kRing) {
      name = fmt::format("ring{}", bus.number);
    } else {
      // An interface that carries several buses (cooked "any") names none of them.
      const bool several = std::any_of(summary.buses.begin(), summary.buses.end(), [&bus](const BusSummary& other) {
        return other.bus.kind == BusKind::kCan && other.bus.interface_id == bus.interface_id && other.bus != bus;
      });
      if (!several && bus.interface_id < interfaces.size()) name = interfaces[bus.interface_id].name;
      if (name.empty()) name = fmt::format("can{}", can_buses);
      ++can_buses;
    }
    // Two rings of one number on two interfaces, or two interfaces of one name.
    const std::string first = name;
    for (unsigned next = 2; is_taken(name); ++next) name = fmt::format("{}#{}", first, next);
    names_.emplace_back(bus, std::move(name));
  }
}

std::string_view BusNames::name(const BusRef& bus) const {
  for (const auto& [ref, name] : names_) {
    if (ref == bus) return name;
  }
  return {};
}

}  // namespace servotrace::replay
