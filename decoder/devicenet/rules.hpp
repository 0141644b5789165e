// SPDX-License-Identifier: MIT
// Block DN: the rules of DeviceNet.
#pragma once

#include <array>

#include "decoder/findings/rule.hpp"

namespace servotrace::devicenet {

inline constexpr std::array<Rule, 0> kRules{};

}  // namespace servotrace::devicenet
