// SPDX-License-Identifier: MIT
// Block YS: the rules of the drive profile yaskawa_ns310.
#pragma once

#include <array>

#include "decoder/findings/rule.hpp"

namespace servotrace::ns310 {

inline constexpr std::array<Rule, 0> kRules{};

}  // namespace servotrace::ns310
