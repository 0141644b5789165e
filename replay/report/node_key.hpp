// SPDX-License-Identifier: MIT
// A node of the capture as a number.
#pragma once

#include <cstdint>

#include "decoder/findings/finding.hpp"

namespace servotrace::report {

inline std::uint64_t node_key(const NodeRef& node) {
  return static_cast<std::uint64_t>(node.bus.kind) << 60U | std::uint64_t{node.bus.interface_id} << 24U |
         std::uint64_t{node.bus.number} << 16U | (static_cast<std::uint64_t>(node.mac_id) & 0xFFU) << 8U;
}

}  // namespace servotrace::report
