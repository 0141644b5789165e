// SPDX-License-Identifier: MIT
#include "replay/examples/rule_examples.hpp"

#include <algorithm>
#include <iterator>

namespace servotrace::replay {
namespace {

constexpr RuleExamples kExamples[] = {
#include "replay/examples/rule_examples.inc"
};

}  // namespace

const RuleExamples* find_examples(std::string_view rule) {
  const auto* const found =
      std::lower_bound(std::begin(kExamples), std::end(kExamples), rule,
                       [](const RuleExamples& row, std::string_view id) { return row.rule < id; });
  return found != std::end(kExamples) && found->rule == rule ? found : nullptr;
}

}  // namespace servotrace::replay
