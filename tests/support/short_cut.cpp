// SPDX-License-Identifier: MIT
#include "tests/support/short_cut.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "decoder/findings/catalogue.hpp"
#include "tests/support/scenarios.hpp"

namespace servotrace::test {
namespace {

Pipeline judge(const simulator::Simulation& simulation, Settings settings, bool every_block) {
  settings.judge_every_block = every_block;
  return judged(simulation, settings);
}

std::string text(const Finding& finding) {
  std::string result =
      std::string(rule_row(finding.rule).id) + " frame " + std::to_string(finding.frame) + ".." +
      std::to_string(finding.last_frame) + " x" + std::to_string(finding.count) + " severity " +
      std::to_string(static_cast<int>(finding.severity)) + " place " + std::to_string(finding.node.place) + " mac " +
      std::to_string(finding.node.mac_id) + " channel " + std::to_string(static_cast<int>(finding.node.channel)) +
      " bytes " + std::to_string(finding.where.offset) + "+" + std::to_string(finding.where.length) + " basis " +
      std::to_string(static_cast<int>(finding.basis.kind)) + "@" + std::to_string(finding.basis.frame) + " cause " +
      std::to_string(finding.cause.frame) + " related";
  for (const std::uint64_t related : finding.related) result += " " + std::to_string(related);
  result += " arguments";
  for (const std::int64_t argument : finding.arguments) result += " " + std::to_string(argument);
  return result;
}

std::vector<std::string> texts(const Summary& summary) {
  std::vector<std::string> all;
  for (const BusSummary& bus : summary.buses) {
    all.push_back("frames " + std::to_string(bus.frames));
    for (const NodeSummary& node : bus.nodes) {
      for (const Fact& fact : node.facts)
        all.push_back(fact.key + " = " + fact.value + " @" + std::to_string(fact.basis.frame));
    }
    for (const Statistic& entry : bus.statistics) {
      all.push_back(entry.key + " " + std::to_string(entry.node.mac_id) + " x" + std::to_string(entry.count) + " " +
                    std::to_string(entry.minimum_ns) + ".." + std::to_string(entry.maximum_ns) + " mean " +
                    std::to_string(entry.mean_ns));
    }
  }
  return all;
}

std::vector<std::string> texts(const Dissection& dissection) {
  std::vector<std::string> all;
  const auto text_of = [](const NodeRef& node) {
    return " mac " + std::to_string(node.mac_id) + " channel " + std::to_string(static_cast<int>(node.channel));
  };
  for (const Derived& derived : dissection.derived) {
    all.push_back(std::string(derived.field->key) + " = " + std::to_string(derived.value) + std::string(derived.text) +
                  text_of(derived.node));
  }
  for (const Link& link : dissection.links) {
    all.push_back("link " + std::to_string(static_cast<int>(link.kind)) + " to " + std::to_string(link.frame) +
                  " after " + std::to_string(link.after_ns) + text_of(link.node));
  }
  return all;
}

// What is shown of each frame beside its bytes.
void expect_same_shown(const simulator::Simulation& simulation, Settings settings) {
  settings.judge_every_block = true;
  Pipeline full(settings);
  settings.judge_every_block = false;
  Pipeline quick(settings);
  const auto expected = std::make_unique<Dissection>();
  const auto found = std::make_unique<Dissection>();
  for (std::size_t i = 0; i < simulation.frames.size(); ++i) {
    const RawFrame raw = raw_frame(simulation, i);
    full.push(raw, expected.get());
    quick.push(raw, found.get());
    ASSERT_EQ(texts(*found), texts(*expected)) << "frame " << raw.number;
  }
}

}  // namespace

void expect_same(const simulator::Simulation& simulation, const Settings& settings) {
  const Pipeline full = judge(simulation, settings, true);
  const Pipeline quick = judge(simulation, settings, false);
  const std::span<const Finding> expected = full.findings().all();
  const std::span<const Finding> found = quick.findings().all();
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(text(found[i]), text(expected[i]));
  for (std::size_t i = 0; i < kRuleCount; ++i) {
    const auto rule = static_cast<RuleId>(i);
    EXPECT_EQ(quick.findings().times_checked(rule), full.findings().times_checked(rule)) << rule_row(rule).id;
    EXPECT_EQ(quick.findings().total(rule), full.findings().total(rule)) << rule_row(rule).id;
  }
  EXPECT_EQ(texts(quick.summary()), texts(full.summary()));
  expect_same_shown(simulation, settings);
}

}  // namespace servotrace::test
