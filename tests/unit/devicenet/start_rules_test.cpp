// SPDX-License-Identifier: MIT
// DN101 to DN104: identifiers, the Duplicate MAC ID check, CAN error frames. Each rule raised, and as close as possible
// to it not raised.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "decoder/pipeline/rules.hpp"
#include "tests/unit/devicenet/bench.hpp"

namespace servotrace::devicenet {
namespace {

using test::Bench;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr const char* kOwn = "00 2C 00 01 02 03 04";
constexpr const char* kOther = "00 07 00 99 02 03 04";

TEST(Dn101, InvalidIdentifiers) {
  Bench bench;
  bench.frame(0x7F0, "").frame(0x7F0, "").frame(0x8001042D, "").frame(0x4000042D, "");
  EXPECT_THAT(bench.findings(), ElementsAre("DN101@1", "DN101@3", "DN101@4"));
  EXPECT_EQ(bench.all()[0].count, 2U);
  EXPECT_EQ(bench.all()[0].arguments[1], 0x7F0);
  EXPECT_EQ(bench.all()[0].node.mac_id, kNoMacId);
  EXPECT_EQ(bench.all()[0].node.bus.kind, BusKind::kCan);
}

TEST(Dn101, SilentOnEveryValidIdentifier) {
  Bench bench;
  for (std::uint32_t id = 0x7C0; id < 0x7F0; ++id) bench.frame(id, "");
  EXPECT_THAT(bench.findings(), IsEmpty());
}

TEST(Dn101, SilentOnCanThatIsNotKnownToBeDevicenet) {
  Bench bench{Settings{}};
  bench.frame(0x8001042D, "01 02").frame(0x7FF, "");
  EXPECT_THAT(bench.findings(), IsEmpty());
  EXPECT_EQ(bench.pipeline().checked_frames(), 0U);
}

TEST(Dn102, ChallengerWithinFiveSeconds) {
  Bench bench;
  bench.start(5).allocate(5);                  // 1-5
  bench.frame(0x42F, kOther, 4000);            // 6
  bench.frame(0x42F, "80 2C 00 01 02 03 04");  // 7: the node answers: the same challenger
  bench.frame(0x42F, "00 07 00 98 02 03 04");  // 8: another one
  EXPECT_THAT(bench.findings(), ElementsAre("DN102@6", "DN102@8"));
  EXPECT_EQ(bench.all()[0].count, 2U);
  EXPECT_EQ(bench.all()[0].arguments[1], 7);
  EXPECT_EQ(bench.all()[0].node.mac_id, 5);
}

TEST(Dn102, AnswerAloneProvesIt) {
  Bench bench;
  bench.frame(0x42F, "80 2C 00 01 02 03 04");
  EXPECT_THAT(bench.findings(), ElementsAre("DN102@1"));
}

TEST(Dn102, ChallengersAreNoRestart) {
  Bench bench;
  bench.start(5).allocate(5).poll(5, "", "01 02");
  bench.frame(0x42F, kOther).frame(0x42F, kOther, 1000).poll(5, "", "01 02");
  EXPECT_THAT(bench.findings(), ElementsAre("DN102@8"));  // and no DN201
}

TEST(Dn102, SilentForAReplacedDriveAndForARestart) {
  Bench bench;
  bench.start(5).allocate(5);
  bench.frame(0x42F, kOther, 5100).frame(0x42F, kOther, 1000);  // the drive was replaced
  bench.frame(0x42F, kOther, 1000);                             // and restarts
  EXPECT_THAT(bench.findings(), IsEmpty());
}

// A capture that begins in the middle: whose pair this is cannot be known, so nothing is said of a restart.
TEST(Dn102, MidCaptureChallenger) {
  Bench bench;
  bench.poll(5, "", "01").poll(5, "", "01");
  bench.frame(0x42F, kOther).frame(0x42F, "80 2C 00 01 02 03 04");
  bench.poll(5, "", "01");
  EXPECT_THAT(bench.findings(), ElementsAre("DN102@6"));
}

TEST(Dn103, OnLineAfterOneRequest) {
  Bench bench;
  bench.frame(0x7C0, "").frame(0x42F, kOwn, 1600).frame(0x3C5, "", 1500);
  EXPECT_THAT(bench.findings(), ElementsAre("DN103@3"));
  EXPECT_EQ(bench.last().related[0], 2U);
}

TEST(Dn103, SilentAfterTwoRequests) {
  Bench bench;
  bench.start(5).frame(0x3C5, "", 1500);
  EXPECT_THAT(bench.findings(), IsEmpty());
}

TEST(Dn103, SilentForALoneNodeThatRepeats) {
  Bench bench;
  bench.start(5);
  for (int i = 0; i < 20; ++i) bench.frame(0x42F, kOwn);
  bench.frame(0x3C5, "", 1500);
  EXPECT_THAT(bench.findings(), IsEmpty());
}

TEST(Dn103, SilentWhereTheFirstMayHaveComeBeforeTheCapture) {
  Bench bench;
  bench.frame(0x7C0, "").frame(0x42F, kOwn, 1400).frame(0x3C5, "", 1500);
  EXPECT_THAT(bench.findings(), IsEmpty());
}

TEST(Dn103, SilentAcrossAGap) {
  Bench bench;
  bench.frame(0x7C0, "").frame(0x42F, kOwn, 1600).gap().frame(0x3C5, "", 1500);
  EXPECT_THAT(bench.findings(), IsEmpty());
}

TEST(Dn104, ErrorFrames) {
  Bench bench;
  bench.frame(0x20000088, "00 00 04 00 00 00 00 00");        // protocol violation, bus error
  bench.frame(0x20000088, "00 00 04 00 00 00 00 00", 500);   // the same condition
  bench.frame(0x20000040, "00 00 00 00 00 00 00 00", 500);   // bus-off is its own finding
  bench.frame(0x20000020, "00 00 00 00 00 00 00 00", 2000);  // later: another
  EXPECT_THAT(bench.findings(), ElementsAre("DN104@1", "DN104@3", "DN104@4"));
  EXPECT_EQ(bench.all()[0].count, 2U);
  EXPECT_EQ(bench.all()[1].arguments[1], 91);
  EXPECT_EQ(bench.all()[2].arguments[1], 79);
  EXPECT_EQ(test::derived_value(bench.dissection(), "error_class"), 0x20);
}

TEST(Dn104, SilentOnWhatIsNoFault) {
  Bench bench;
  bench.frame(0x20000002, "05 00 00 00 00 00 00 00");  // lost arbitration
  bench.frame(0x20000100, "00 00 00 00 00 00 00 00");  // restarted
  bench.frame(0x20000004, "00 40 00 00 00 00 00 00");  // back to error active
  EXPECT_THAT(bench.findings(), IsEmpty());
}

TEST(Dn104, ReceiveOverflowIsALossOfTheCapture) {
  Bench bench;
  bench.start(5).allocate(5).poll(5, "", "01").frame(0x42D, "");
  bench.frame(0x20000004, "00 01 00 00 00 00 00 00");
  bench.frame(0x42D, "");  // the poll before is not blamed
  EXPECT_THAT(bench.findings(), IsEmpty());
  ASSERT_EQ(bench.all().size(), 1U);
  EXPECT_EQ(rule_row(bench.last().rule).id, "CP103");
  EXPECT_EQ(bench.last().arguments[0], capture::kLostOverflow);
  EXPECT_EQ(bench.last().node.bus.kind, BusKind::kNone);
}

}  // namespace
}  // namespace servotrace::devicenet
