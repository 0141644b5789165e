// SPDX-License-Identifier: MIT
// Every layout, derived field and drive profile there is: for Wireshark's registration, the reference manual and the
// tests that hold the tables.
#pragma once

#include <span>
#include <vector>

#include "decoder/core/layout.hpp"

namespace servotrace {

struct DerivedField {
  std::string_view protocol;
  const Field* field;
};

// In a fixed order: links, RTEX, DeviceNet, profiles.
std::vector<const Layout*> all_layouts();
std::vector<DerivedField> all_derived();

}  // namespace servotrace
