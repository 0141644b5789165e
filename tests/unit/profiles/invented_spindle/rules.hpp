// SPDX-License-Identifier: MIT
// What the list of profiles needs of the invented spindle, which has no rules.
#pragma once

#include <array>

#include "decoder/findings/rule.hpp"
#include "decoder/profiles/profile_list.hpp"

namespace servotrace::spindle {

inline constexpr std::array<Rule, 0> kRules{};

struct Profile {
  static constexpr const auto& kRules = spindle::kRules;
  static const DriveProfile& row();
};

}  // namespace servotrace::spindle
