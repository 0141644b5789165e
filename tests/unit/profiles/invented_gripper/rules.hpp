// SPDX-License-Identifier: MIT
// An invented drive with rules of its own: the part of its folder that the list of profiles includes.
#pragma once

#include <array>

#include "decoder/findings/rule.hpp"
#include "decoder/profiles/profile_list.hpp"

namespace servotrace::gripper {

inline constexpr auto kRules = std::to_array<Rule>({
    {.id = "GR101",
     .slug = "closed-on-nothing",
     .severity = Severity::kWarning,
     .title = "The gripper closed on nothing",
     .message = "the fingers met at {0}",
     .section = "invented 2",
     .why = "Nothing was gripped.",
     .fix = "Bring a part."},
    {.id = "GR901",
     .slug = "alarm",
     .severity = Severity::kError,
     .actor = Actor::kDrive,
     .title = "The gripper reports an alarm",
     .message = "alarm {0}",
     .section = "invented 2",
     .why = "It stopped.",
     .fix = "Clear it."},
});

struct Profile {
  static constexpr const auto& kRules = gripper::kRules;
  static const DriveProfile& row();
};

}  // namespace servotrace::gripper
