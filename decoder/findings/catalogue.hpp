// SPDX-License-Identifier: MIT
// The catalogue: every rule of every block, checked at compile time. A block adds itself by one line in kCatalogue.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

#include "decoder/devicenet/rules.hpp"
#include "decoder/findings/finding.hpp"
#include "decoder/findings/rule.hpp"
#include "decoder/pipeline/rules.hpp"
#include "decoder/profiles/nsk_esb/rules.hpp"
#include "decoder/profiles/yaskawa_ns310/rules.hpp"
#include "decoder/rtex/rules.hpp"

namespace servotrace {

namespace detail {
constexpr const Rule& row_of(const Rule& row) { return row; }
// A protocol's own row: the common part is its member `row`.
template <class ProtocolRule>
constexpr const Rule& row_of(const ProtocolRule& rule) {
  return rule.row;
}

template <class... Blocks>
consteval auto join(const Blocks&... blocks) {
  std::array<Rule, (std::tuple_size_v<Blocks> + ...)> all{};
  std::size_t next = 0;
  const auto append = [&](const auto& block) {
    for (const auto& rule : block) all[next++] = row_of(rule);
  };
  (append(blocks), ...);
  return all;
}

template <std::size_t kSize>
consteval bool legal(const std::array<Rule, kSize>& rules) {
  for (std::size_t i = 0; i < kSize; ++i) {
    if (!well_formed(rules[i])) return false;
    if (i > 0 && !(rules[i - 1].id < rules[i].id)) return false;
  }
  return true;
}
}  // namespace detail

// In the order of the ids. That no slug stands twice in a block is held in catalogue.cpp, which alone pays for the
// comparison.
inline constexpr auto kCatalogue =
    detail::join(capture::kRules, devicenet::kRules, esb::kRules, rtex::kRules, ns310::kRules);
inline constexpr std::size_t kRuleCount = kCatalogue.size();
static_assert(detail::legal(kCatalogue), "a rule row is incomplete, or out of the order of the ids");

// The rule of this id. An unknown id does not compile.
consteval RuleId rule(std::string_view id) {
  for (std::size_t i = 0; i < kRuleCount; ++i) {
    if (kCatalogue[i].id == id) return static_cast<RuleId>(i);
  }
  throw "no such rule in the catalogue";
}

constexpr const Rule& rule_row(RuleId id) { return kCatalogue[static_cast<std::size_t>(id)]; }

// The same at run time (command line, settings): the index of `id`, or kRuleCount.
constexpr std::size_t find_rule(std::string_view id) {
  for (std::size_t i = 0; i < kRuleCount; ++i) {
    if (kCatalogue[i].id == id) return i;
  }
  return kRuleCount;
}

}  // namespace servotrace
