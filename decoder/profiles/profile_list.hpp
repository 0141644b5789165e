// SPDX-License-Identifier: MIT
// A list of drive profiles as a type, light enough for the catalogue: it holds their rules; what else a profile is
// stands behind its row().
#pragma once

#include <array>
#include <cstddef>

namespace servotrace {

struct DriveProfile;

// A profile P of the list has the rules P::kRules and the row P::row().
template <class... P>
struct ProfileList {
  static std::array<const DriveProfile*, sizeof...(P)> rows() { return {&P::row()...}; }
  // visit(P::kRules) for every profile.
  template <class Visit>
  static constexpr void for_each_rules(Visit visit) {
    (visit(P::kRules), ...);
  }
};

}  // namespace servotrace
