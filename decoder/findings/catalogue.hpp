// SPDX-License-Identifier: MIT
// The catalogue: every rule of every block, checked at compile time. A protocol adds its block in kCatalogue, a drive
// profile in profiles.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string_view>

#include "decoder/devicenet/rules.hpp"
#include "decoder/findings/finding.hpp"
#include "decoder/findings/rule.hpp"
#include "decoder/pipeline/rules.hpp"
#include "decoder/profiles/profiles.hpp"
#include "decoder/rtex/rules.hpp"

namespace servotrace {

namespace detail {
constexpr const Rule& row_of(const Rule& row) { return row; }
// A protocol's own row: the common part is its member `row`.
template <class ProtocolRule>
constexpr const Rule& row_of(const ProtocolRule& rule) {
  return rule.row;
}

template <class List>
consteval std::size_t count_rules() {
  std::size_t count = 0;
  List::for_each_rules([&](const auto& block) { count += block.size(); });
  return count;
}

// The protocols' blocks and those of the profiles, in the order of the ids. Each block is in order itself.
template <class List, class... Blocks>
consteval auto join(const Blocks&... blocks) {
  constexpr std::size_t kCount = (std::tuple_size_v<Blocks> + ...) + count_rules<List>();
  std::array<const Rule*, kCount> rows{};
  std::size_t count = 0;
  const auto append = [&](const auto& block) {
    for (const auto& rule : block) rows[count++] = &row_of(rule);
  };
  (append(blocks), ...);
  List::for_each_rules(append);
  std::sort(rows.begin(), rows.end(), [](const Rule* left, const Rule* right) { return left->id < right->id; });
  std::array<Rule, kCount> all{};
  for (std::size_t i = 0; i < kCount; ++i) all[i] = *rows[i];
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
inline constexpr auto kCatalogue = detail::join<Profiles>(capture::kRules, devicenet::kRules, rtex::kRules);
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
