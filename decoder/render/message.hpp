// SPDX-License-Identifier: MIT
// The text of a finding, made from its rule row and its numbers.
#pragma once

#include <string>

#include "decoder/findings/finding.hpp"

namespace servotrace {

// The row's message with the finding's arguments in their places. No full stop.
std::string message(const Finding& finding);

}  // namespace servotrace
