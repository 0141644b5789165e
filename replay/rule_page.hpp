// SPDX-License-Identifier: MIT
// What there is to say about a rule, as a page for a terminal.
#pragma once

#include <string>
#include <string_view>

#include "decoder/findings/rule.hpp"
#include "replay/console.hpp"

namespace servotrace::replay {

std::string rule_page(const Rule& row, const Style& style);

// When the rule is raised again, in words.
std::string_view repeat_text(Repeat repeat);

// Breaks a text at blanks into lines of at most `width` letters, each behind `indent` blanks, each with a line end.
std::string wrapped(std::string_view text, std::size_t indent, std::size_t width = 100);

}  // namespace servotrace::replay
