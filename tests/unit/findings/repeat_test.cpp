// SPDX-License-Identifier: MIT
// The repeat policy: one finding an episode, one a node for once-rules, a bound on what is kept, causes.
#include <gtest/gtest.h>

#include "decoder/findings/repeat.hpp"
#include "decoder/render/message.hpp"

namespace servotrace {
namespace {

RawFrame frame(std::uint64_t number) {
  return RawFrame{.number = number, .time_ns = static_cast<TimeNs>(number) * 1000};
}
const NodeRef kNode{.bus = {BusKind::kRing, 0, 0}, .protocol = Protocol::kRtex, .mac_id = 3};

TEST(Findings, AnEpisodeIsOneFindingWithACount) {
  Findings findings;
  const OwnerId owner = findings.owner(kNode);
  EXPECT_TRUE(findings.raise(frame(5), {.rule = rule("CP101"), .owner = owner}));
  EXPECT_FALSE(findings.raise(frame(6), {.rule = rule("CP101"), .owner = owner}));
  findings.calm(owner, rule("CP101"));
  EXPECT_TRUE(findings.raise(frame(9), {.rule = rule("CP101"), .owner = owner}));
  ASSERT_EQ(findings.all().size(), 2U);
  EXPECT_EQ(findings.all()[0].frame, 5U);
  EXPECT_EQ(findings.all()[0].last_frame, 6U);
  EXPECT_EQ(findings.all()[0].count, 2U);
  EXPECT_EQ(findings.all()[1].count, 1U);
  EXPECT_EQ(findings.last_frame(owner, rule("CP101")), 9U);
  EXPECT_EQ(findings.total(rule("CP101")), 2U);
}

TEST(Findings, AnotherVariantIsAnotherEpisode) {
  Findings findings;
  const OwnerId owner = findings.owner(kNode);
  EXPECT_TRUE(findings.raise(frame(1), {.rule = rule("CP101"), .owner = owner, .variant = 0x2E}));
  EXPECT_TRUE(findings.raise(frame(2), {.rule = rule("CP101"), .owner = owner, .variant = 0x31}));
  EXPECT_FALSE(findings.raise(frame(3), {.rule = rule("CP101"), .owner = owner, .variant = 0x31}));
}

TEST(Findings, OnceRulesStayOnceAVariantAcrossCalms) {
  Findings findings;
  const OwnerId owner = findings.owner(kNode);
  EXPECT_TRUE(findings.raise(frame(1), {.rule = rule("CP105"), .owner = owner, .variant = 9}));
  findings.calm(owner, rule("CP105"));
  EXPECT_FALSE(findings.raise(frame(2), {.rule = rule("CP105"), .owner = owner, .variant = 9}));
  EXPECT_TRUE(findings.raise(frame(3), {.rule = rule("CP105"), .owner = owner, .variant = 10}));
  EXPECT_EQ(findings.all()[0].count, 2U);
}

TEST(Findings, TheBoundCountsAllVariantsOfARule) {
  Findings findings(2);
  const OwnerId owner = findings.owner(kNode);
  for (std::int64_t variant = 1; variant <= 4; ++variant) {
    const bool added = findings.raise(frame(1), {.rule = rule("CP105"), .owner = owner, .variant = variant});
    EXPECT_EQ(added, variant <= 2) << variant;
  }
  EXPECT_EQ(findings.all().size(), 2U);
  EXPECT_EQ(findings.total(rule("CP105")), 4U);
  EXPECT_TRUE(findings.raise(frame(2), {.rule = rule("CP104"), .owner = owner})) << "another rule has its own";
}

TEST(Findings, OwnersAreApart) {
  Findings findings;
  const OwnerId first = findings.owner(kNode);
  NodeRef other = kNode;
  other.mac_id = 4;
  const OwnerId second = findings.owner(other);
  EXPECT_NE(first, second);
  EXPECT_EQ(findings.owner(kNode), first);
  EXPECT_TRUE(findings.raise(frame(1), {.rule = rule("CP101"), .owner = first}));
  EXPECT_TRUE(findings.raise(frame(1), {.rule = rule("CP101"), .owner = second}));
  EXPECT_EQ(findings.all()[1].node.mac_id, 4);
}

TEST(Findings, KeepsAtMostTheLimitAndTheTrueCount) {
  Findings findings(3);
  const OwnerId owner = findings.owner(kNode);
  for (std::uint64_t i = 1; i <= 10; ++i) findings.raise(frame(i), {.rule = rule("CP103"), .owner = owner});
  EXPECT_EQ(findings.all().size(), 3U);
  EXPECT_EQ(findings.total(rule("CP103")), 10U);
}

TEST(Findings, FreshAreThoseSinceTheMark) {
  Findings findings;
  const OwnerId owner = findings.owner(kNode);
  findings.raise(frame(1), {.rule = rule("CP103"), .owner = owner});
  findings.mark();
  EXPECT_TRUE(findings.fresh().empty());
  findings.raise(frame(2), {.rule = rule("CP103"), .owner = owner});
  ASSERT_EQ(findings.fresh().size(), 1U);
  EXPECT_EQ(findings.fresh()[0].frame, 2U);
}

TEST(Message, PutsTheArgumentsInTheirPlaces) {
  Finding finding;
  finding.rule = rule("CP101");
  finding.arguments = {12, 40};
  EXPECT_EQ(message(finding), "only 12 of 40 bytes of the record were captured");
  finding.rule = rule("CP102");
  finding.arguments = {1'500'000};
  EXPECT_EQ(message(finding), "the timestamp is 1.500 ms earlier than that of the frame before on the same interface");
}

}  // namespace
}  // namespace servotrace
