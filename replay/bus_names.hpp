// SPDX-License-Identifier: MIT
// Names of buses: ring<N>; the interface's name of a CAN bus, else can<N> by order of appearance.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "decoder/pipeline/summary.hpp"
#include "replay/capture/source.hpp"

namespace servotrace::replay {

class BusNames {
 public:
  BusNames() = default;
  BusNames(const Summary& summary, std::span<const InterfaceInfo> interfaces);

  // Empty for the capture as a whole. Never the same for two buses of a capture.
  std::string_view name(const BusRef& bus) const;
  std::size_t size() const { return names_.size(); }

 private:
  std::vector<std::pair<BusRef, std::string>> names_;
};

}  // namespace servotrace::replay
