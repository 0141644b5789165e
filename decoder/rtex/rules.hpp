// SPDX-License-Identifier: MIT
// Block RX: the rules of RTEX.
#pragma once

#include <array>

#include "decoder/findings/rule.hpp"

namespace servotrace::rtex {

inline constexpr std::array<Rule, 0> kRules{};

}  // namespace servotrace::rtex
