// SPDX-License-Identifier: MIT
// For each rule a trace that violates it and one that does not: what the program itself says about simulated scenarios,
// written down by generate_examples.
#pragma once

#include <string_view>

namespace servotrace::replay {

struct Example {
  std::string_view scenario;  // captures/scenarios/<scenario>.toml; empty: there is none
  std::string_view title;     // of the scenario
  std::string_view trace;     // lines, each with a line end
};

struct RuleExamples {
  std::string_view rule;  // id
  Example violation;
  Example silent;  // an opportunity that the rule looked at and found in order
};

// nullptr: no scenario raises the rule.
const RuleExamples* find_examples(std::string_view rule);

}  // namespace servotrace::replay
