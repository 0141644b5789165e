// SPDX-License-Identifier: MIT
// Block NK: the rules of the drive profile nsk_esb.
#pragma once

#include <array>

#include "decoder/findings/rule.hpp"

namespace servotrace::esb {

inline constexpr std::array<Rule, 0> kRules{};

}  // namespace servotrace::esb
