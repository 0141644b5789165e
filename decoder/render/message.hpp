// SPDX-License-Identifier: MIT
// The text of a finding, made from its rule row and its numbers.
#pragma once

#include <string>

#include "decoder/findings/finding.hpp"
#include "decoder/findings/rule.hpp"

namespace servotrace {

// One argument as its format prints it: "0Dh (Deviation Excess)".
std::string argument_text(const Argument& argument, std::int64_t value);

// The row's message with the finding's arguments in their places. No full stop.
std::string message(const Finding& finding);

}  // namespace servotrace
