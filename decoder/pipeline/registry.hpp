// SPDX-License-Identifier: MIT
// Every layout, derived field and drive profile there is: for Wireshark's registration, the reference manual and the
// tests that hold the tables.
#pragma once

#include <string_view>
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
// The keys of the drive profiles, as settings name them; "generic" (no profile) last.
std::vector<std::string_view> profile_keys();

}  // namespace servotrace
