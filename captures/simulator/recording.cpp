// SPDX-License-Identifier: MIT
#include <algorithm>

#include "captures/simulator/bus.hpp"

namespace servotrace::simulator {

std::uint32_t Recording::interface(LinkType link_type, std::string_view name) {
  for (std::size_t i = 0; i < interfaces_.size(); ++i) {
    if (interfaces_[i].link_type == link_type && interfaces_[i].name == name) return static_cast<std::uint32_t>(i);
  }
  interfaces_.push_back({link_type, std::string(name)});
  return static_cast<std::uint32_t>(interfaces_.size() - 1);
}

void Recording::add_stamped(std::uint32_t interface_id, TimeNs time_ns, TimeNs stamp_ns, Bytes bytes,
                            std::uint32_t original_length) {
  entries_.push_back(
      {time_ns, {interface_id, stamp_ns, std::vector<std::uint8_t>(bytes.begin(), bytes.end()), original_length}});
}

Simulation Recording::finish() {
  std::stable_sort(entries_.begin(), entries_.end(),
                   [](const Entry& left, const Entry& right) { return left.order_ns < right.order_ns; });
  Simulation result;
  result.interfaces = std::move(interfaces_);
  result.frames.reserve(entries_.size());
  for (Entry& entry : entries_) result.frames.push_back(std::move(entry.frame));
  return result;
}

}  // namespace servotrace::simulator
