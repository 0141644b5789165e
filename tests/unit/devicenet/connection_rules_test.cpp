// SPDX-License-Identifier: MIT
// DN201 to DN212 and DN304, DN401: allocation, polls, watchdogs, requests and responses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/devicenet/bench.hpp"

namespace servotrace::devicenet {
namespace {

using test::Bench;
using testing::ElementsAre;
using testing::IsEmpty;

// Started and allocated (frames 1 to 5), the expected packet rate set (6 and 7), one poll pair (8 and 9).
Bench& established(Bench& bench, std::string_view rate = "64 00") {
  bench.start(5).allocate(5);
  bench.frame(0x42C, "01 10 05 02 09 " + std::string(rate)).frame(0x42B, "01 90 " + std::string(rate));
  return bench.poll(5, "", "01 02 03");
}

TEST(Dn201, PollAfterAStartWithoutAllocation) {
  Bench bench;
  bench.start(5).frame(0x42D, "").frame(0x42D, "", 10).frame(0x3C5, "01").frame(0x42D, "", 10);
  EXPECT_THAT(bench.findings(), ElementsAre("DN201@4"));  // a poll response ends it
  EXPECT_EQ(bench.all()[0].count, 2U);
}

TEST(Dn201, AfterARelease) {
  Bench bench;
  established(bench);
  bench.frame(0x42E, "01 4C 03 01 02").frame(0x42B, "01 CC").frame(0x42D, "");
  EXPECT_THAT(bench.findings(), ElementsAre("DN201@12"));
}

TEST(Dn201, AfterARefusal) {
  Bench bench;
  bench.start(5);
  bench.frame(0x42E, "01 4B 03 01 06 01").frame(0x42B, "01 94 02 02").frame(0x42D, "");
  EXPECT_THAT(bench.findings(), ElementsAre("DN202@5", "DN201@6"));
}

TEST(Dn201, SilentWhereThePollConnectionIsKnown) {
  Bench bench;
  established(bench);
  bench.frame(0x42E, "01 4B 03 01 06 01").frame(0x42B, "01 94 02 02").poll(5, "", "01");
  EXPECT_THAT(bench.findings(), ElementsAre("DN202@11"));
}

TEST(Dn201, SilentMidCaptureAndAfterAGap) {
  Bench bench;
  bench.frame(0x42D, "").frame(0x42D, "", 10);
  bench.start(5).gap().frame(0x42D, "");
  EXPECT_THAT(bench.findings(), IsEmpty());
}

TEST(Dn202, SeverityByCode) {
  Bench bench;
  bench.start(5);
  bench.frame(0x42E, "01 4B 03 01 02 01").frame(0x42B, "01 94 09 02");
  bench.frame(0x42E, "01 4B 03 01 02 01").frame(0x42B, "01 94 09 02");  // tried again: the same finding
  bench.frame(0x42E, "01 4B 03 01 02 01").frame(0x42B, "01 94 0B 02");
  bench.frame(0x42E, "01 4B 03 01 02 01").frame(0x42B, "01 94 0C 01");
  EXPECT_THAT(bench.findings(), ElementsAre("DN202@5", "DN202@9 note", "DN202@11 warning"));
  EXPECT_EQ(bench.all()[0].count, 2U);
  EXPECT_EQ(bench.all()[0].related[0], 4U);
  EXPECT_EQ(bench.all()[0].node.channel, Channel::kUnconnected);
}

TEST(Dn202, SilentOnTheConnectedPort) {
  Bench bench;
  bench.start(5).frame(0x42C, "01 4B 03 01 03 01").frame(0x42B, "01 CB 00").poll(5, "", "01");
  EXPECT_THAT(bench.findings(), IsEmpty());
}

TEST(Dn203, LengthOfAKnownDrive) {
  Bench bench{Bench::with_profile(5, "yaskawa-ns310")};
  bench.start(5).allocate(5).poll(5, "00 00 20 20 00 00 00 00", "00 00 00 20 00 00 00 00");
  bench.poll(5, "00 00 20 20 00 00 00", "00 00 00 20 00 00 00 00");
  EXPECT_THAT(bench.findings(), ElementsAre("DN203@8"));
  EXPECT_EQ(bench.all()[0].arguments, (std::array<std::int64_t, 4>{0, 7, 8, 0}));
}

TEST(Dn203, SilentWhenIdle) {
  Bench bench{Bench::with_profile(5, "yaskawa-ns310")};
  bench.start(5).allocate(5).poll(5, "", "").poll(5, "", "00 00 00 20 00 00 00 00");
  EXPECT_THAT(bench.findings(), IsEmpty());
}

TEST(Dn203, AProfileThatDoesNotFitIsOneFinding) {
  Bench bench{Bench::with_profile(5, "nsk-esb")};
  bench.start(5).allocate(5);
  for (int i = 0; i < 20; ++i) bench.poll(5, "80 00 20 20 00 00 00 00", "C3 00 00 20 00 00 00 00");
  EXPECT_THAT(bench.findings(), ElementsAre(testing::StartsWith("DN203@")));
  EXPECT_EQ(bench.all()[0].arguments[3], 1);
}

TEST(Dn204, FourTimesTheRate) {
  Bench bench;
  established(bench).frame(0x42D, "", 405).frame(0x42D, "", 10);
  EXPECT_THAT(bench.findings(), ElementsAre("DN204@10"));  // timed out: no DN205 then
  EXPECT_EQ(bench.last().basis.kind, BasisKind::kCapture);
  EXPECT_EQ(bench.last().basis.frame, 7U);
  EXPECT_EQ(bench.last().arguments[1], 400 * kMillisecondNs);
}

TEST(Dn204, SilentInTime) {
  Bench bench;
  established(bench);
  bench.poll(5, "", "01", 395).poll(5, "", "01", 395);
  EXPECT_THAT(bench.findings(), IsEmpty());
}

TEST(Dn204, TenSecondsUntilTheFirstPoll) {
  Bench bench;
  bench.start(5).allocate(5).frame(0x42C, "01 10 05 02 09 64 00").frame(0x42B, "01 90 64 00");
  bench.frame(0x7C0, "", 9900);
  EXPECT_THAT(bench.findings(), IsEmpty());
  bench.frame(0x7C0, "", 200);
  EXPECT_THAT(bench.findings(), ElementsAre("DN204@9"));
}

TEST(Dn204, TheRateOfTheResponseCounts) {
  Bench bench;
  bench.start(5).allocate(5).frame(0x42C, "01 10 05 02 09 64 00").frame(0x42B, "01 90 C8 00");
  bench.poll(5, "", "01").poll(5, "", "01", 700);
  EXPECT_THAT(bench.findings(), IsEmpty());
}

TEST(Dn204, SilentAfterReleaseResetAndStart) {
  for (const char* end : {"release", "reset", "start"}) {
    SCOPED_TRACE(end);
    Bench bench;
    established(bench);
    if (std::string_view(end) == "release") bench.frame(0x42E, "01 4C 03 01 03").frame(0x42B, "01 CC");
    if (std::string_view(end) == "reset") bench.frame(0x42C, "01 05 01 01").frame(0x42B, "01 85");
    if (std::string_view(end) == "start") bench.frame(0x42F, "00 2C 00 01 02 03 04").frame(0x7C0, "");
    bench.frame(0x7C0, "", 20000);
    EXPECT_THAT(bench.findings(), IsEmpty());
  }
}

TEST(Dn204, SilentAcrossAGap) {
  Bench bench;
  established(bench).gap().poll(5, "", "01", 3000);
  EXPECT_THAT(bench.findings(), IsEmpty());
  bench.frame(0x42D, "", 500);  // known again from the first poll on
  EXPECT_THAT(bench.findings(), ElementsAre("DN204@12"));
}

TEST(Dn205, UnansweredPoll) {
  Bench bench;
  established(bench).frame(0x42D, "", 10).frame(0x42D, "", 10).frame(0x42D, "", 10).frame(0x3C5, "01 02 03");
  EXPECT_THAT(bench.findings(), ElementsAre("DN205@11"));
  EXPECT_EQ(bench.all()[0].count, 2U);
  EXPECT_EQ(bench.all()[0].related[0], 10U);
}

TEST(Dn205, SilentBeforeTheConnectionIsEstablished) {
  Bench bench;
  bench.start(5).allocate(5).frame(0x42D, "").frame(0x42D, "", 10);
  EXPECT_THAT(bench.findings(), IsEmpty());
}

TEST(Dn205, SilentForChangeOfState) {
  Bench bench;
  bench.start(5).allocate(5, 0x13).poll(5, "01", "02").frame(0x42D, "01").frame(0x42D, "02", 10);
  EXPECT_THAT(bench.findings(), IsEmpty());
}

TEST(Dn205, SilentAcrossAGap) {
  Bench bench;
  established(bench).frame(0x42D, "", 10).gap().frame(0x42D, "", 10).frame(0x3C5, "01");
  EXPECT_THAT(bench.findings(), IsEmpty());
}

// The connection size is not known: the second fragment is no new command.
TEST(Dn205, SilentForFragmentsOfUnknownSize) {
  Bench bench;
  bench.start(5).allocate(5).poll(5, "", "01");
  for (int i = 0; i < 2; ++i) {
    bench.frame(0x42D, "00 01 02 03 04 05 06 07", 10).frame(0x42D, "81 08 09 0A");
    bench.frame(0x3C5, "00 01 02 03 04 05 06 07").frame(0x3C5, "81 08 09 0A");
  }
  EXPECT_THAT(bench.findings(), IsEmpty());
}

// The NS310 reports Trajectory_In_Progress in bit 0 of its first byte (SIE-C718-7 5.3.2).
constexpr const char* kAtRest = "80 00 01 21 00 00 00 00";
constexpr const char* kMoving = "81 00 01 21 00 00 00 00";

Bench ns310() { return Bench{Bench::with_profile(5, "yaskawa-ns310")}; }

TEST(Dn206, ReleaseOrResetOfADriveInMotion) {
  const char* takes[] = {"01 4C 03 01 03", "01 4C 03 01 02", "01 05 01 01 00", "01 05 05 02"};
  for (const char* take : takes) {
    Bench bench = ns310();
    bench.start(5).allocate(5).poll(5, "80 00 20 20 00 00 00 00", kMoving).frame(0x42C, take, 999);
    EXPECT_THAT(bench.findings(), ElementsAre("DN206@8")) << take;
    EXPECT_EQ(bench.all()[0].arguments[0], take[4] == 'C' ? 0 : 1);
    EXPECT_EQ(bench.all()[0].arguments[1], 999 * kMillisecondNs);
    EXPECT_EQ(bench.all()[0].related[0], 7U);
  }
}

TEST(Dn206, SilentAtRestLaterOrWithoutAnIoChoice) {
  Bench rest = ns310();
  rest.start(5).allocate(5).poll(5, "80 00 20 20 00 00 00 00", kAtRest).frame(0x42C, "01 4C 03 01 03");
  EXPECT_THAT(rest.findings(), IsEmpty());
  Bench later = ns310();
  later.start(5).allocate(5).poll(5, "80 00 20 20 00 00 00 00", kMoving).frame(0x42C, "01 4C 03 01 03", 1001);
  EXPECT_THAT(later.findings(), IsEmpty());
  for (const char* other : {"01 4C 03 01 01", "01 05 05 01"}) {  // the explicit connection only
    Bench bench = ns310();
    bench.start(5).allocate(5).poll(5, "80 00 20 20 00 00 00 00", kMoving).frame(0x42C, other);
    EXPECT_THAT(bench.findings(), IsEmpty()) << other;
  }
}

TEST(Dn207, NoResponseInTime) {
  Bench bench;
  established(bench, "00 00").frame(0x42C, "01 0E 01 01 01").frame(0x7C0, "", 999);
  EXPECT_THAT(bench.findings(), IsEmpty());
  bench.frame(0x7C0, "", 2);
  EXPECT_THAT(bench.findings(), ElementsAre("DN207@12"));
  EXPECT_EQ(bench.last().related[0], 10U);
  bench.frame(0x42B, "01 8E 2C 00", 500);  // the late answer
  EXPECT_EQ(bench.findings().size(), 1U);
}

TEST(Dn207, ANewRequestWithTheSameXid) {
  Bench bench;
  established(bench, "00 00").frame(0x42C, "01 0E 01 01 01").frame(0x42C, "01 0E 01 01 02", 100);
  bench.frame(0x42B, "01 8E 2C 00").frame(0x42B, "01 8E 2C 00", 100);
  EXPECT_THAT(bench.findings(), ElementsAre("DN207@11"));
}

TEST(Dn207, SilentWhenAnswered) {
  Bench bench;
  established(bench, "00 00").frame(0x42C, "01 0E 01 01 01").frame(0x42B, "01 8E 2C 00", 990).frame(0x7C0, "", 2000);
  EXPECT_THAT(bench.findings(), IsEmpty());
}

TEST(Dn207, AFirstFragmentCountsAsTheResponse) {
  Bench bench;
  established(bench, "00 00").frame(0x42C, "01 0E 01 01 07").frame(0x42B, "81 00 8E 0A 4A 55 53 50");
  bench.frame(0x42C, "81 C0 00").frame(0x42B, "81 41 2D 4E 53 33 31 30", 900).frame(0x42C, "81 C1 00");
  bench.frame(0x42B, "81 82 21", 900).frame(0x42C, "81 C2 00").frame(0x7C0, "", 3000);
  EXPECT_THAT(bench.findings(), IsEmpty());
}

TEST(Dn207, ANoteForANodeNotHeard) {
  Bench bench;
  bench.frame(0x42E, "01 4B 03 01 03 01").frame(0x7C0, "", 1100);
  EXPECT_THAT(bench.findings(), ElementsAre("DN207@2 note"));
}

TEST(Dn207, AnErrorForANodeThatWasHeard) {
  Bench bench;
  bench.frame(0x3C5, "01").frame(0x42E, "01 4B 03 01 03 01").frame(0x7C0, "", 1100);
  EXPECT_THAT(bench.findings(), ElementsAre("DN207@3"));
}

TEST(Dn207, UcmmOpenMayStayUnanswered) {
  Bench bench;
  bench.frame(0x781, "05 4B 00 33").frame(0x7C0, "", 3000);
  EXPECT_THAT(bench.findings(), IsEmpty());
}

TEST(Dn208, ResponseWithoutRequest) {
  Bench bench;
  established(bench, "00 00").frame(0x42B, "01 8E 2C 00");
  EXPECT_THAT(bench.findings(), ElementsAre("DN208@10"));
}

TEST(Dn208, AnotherXidIsAnotherRequest) {
  Bench bench;
  established(bench, "00 00").frame(0x42C, "01 0E 01 01 01").frame(0x42B, "41 8E 2C 00").frame(0x42B, "01 8E 2C 00");
  EXPECT_THAT(bench.findings(), ElementsAre("DN208@11"));
}

TEST(Dn208, SilentAtTheBeginningAndAfterAGap) {
  Bench bench;
  bench.frame(0x7C0, "").frame(0x42B, "01 8E 2C 00", 990);
  bench.frame(0x7C0, "", 5000).gap().frame(0x42B, "01 8E 2C 00", 2000);
  EXPECT_THAT(bench.findings(), IsEmpty());
}

TEST(Dn209, TwoRequestsAtOnce) {
  Bench bench;
  established(bench, "00 00").frame(0x42C, "01 0E 01 01 01").frame(0x42C, "41 0E 01 01 02");
  bench.frame(0x42B, "01 8E 2C 00").frame(0x42B, "41 8E 00 00");
  EXPECT_THAT(bench.findings(), ElementsAre("DN209@11"));
  EXPECT_EQ(bench.last().related[0], 10U);
}

TEST(Dn209, SilentOneAfterTheOther) {
  Bench bench;
  established(bench, "00 00").frame(0x42C, "01 0E 01 01 01").frame(0x42B, "01 8E 2C 00");
  bench.frame(0x42C, "41 0E 01 01 02").frame(0x42B, "41 8E 00 00");
  EXPECT_THAT(bench.findings(), IsEmpty());
}

TEST(Dn210, RateZeroOfAKnownDrive) {
  Bench bench{Bench::with_profile(5, "yaskawa-ns310")};
  bench.start(5).allocate(5).frame(0x42C, "01 10 05 02 09 00 00").frame(0x42B, "01 90 00 00");
  EXPECT_THAT(bench.findings(), ElementsAre("DN210@7"));
}

TEST(Dn210, SilentForAnUnknownDrive) {
  Bench bench;
  bench.start(5).allocate(5).frame(0x42C, "01 10 05 02 09 00 00").frame(0x42B, "01 90 00 00");
  EXPECT_THAT(bench.findings(), IsEmpty());
}

TEST(Dn210, LessThanThePollPeriod) {
  Bench bench;
  bench.start(5).allocate(5).poll(5, "", "01").poll(5, "", "01", 100).poll(5, "", "01", 100);
  bench.frame(0x42C, "01 10 05 02 09 14 00").frame(0x42B, "01 90 14 00");
  bench.poll(5, "", "01", 100).poll(5, "", "01", 100);
  EXPECT_THAT(bench.findings(), ElementsAre("DN210@13"));  // then not DN204
}

TEST(Dn210, SilentWhereFourTimesSuffice) {
  Bench bench;
  bench.start(5).allocate(5).poll(5, "", "01").poll(5, "", "01", 100).poll(5, "", "01", 100);
  bench.frame(0x42C, "01 10 05 02 09 1E 00").frame(0x42B, "01 90 1E 00");
  EXPECT_THAT(bench.findings(), IsEmpty());
}

TEST(Dn211, RequestWithoutConnection) {
  Bench bench;
  bench.start(5).frame(0x42C, "01 0E 01 01 01").frame(0x7C0, "", 1500);
  EXPECT_THAT(bench.findings(), ElementsAre("DN211@4"));  // and no DN207
}

TEST(Dn211, RequestOfAnotherMaster) {
  Bench bench;
  established(bench, "00 00").frame(0x42C, "02 0E 01 01 01").frame(0x7C0, "", 1500);
  EXPECT_THAT(bench.findings(), ElementsAre("DN211@10"));
  EXPECT_EQ(bench.last().arguments[1], 2);
}

TEST(Dn211, SilentForAnAllocationAndWhereNothingIsKnown) {
  Bench bench;
  bench.frame(0x42C, "01 0E 01 01 01").frame(0x42B, "01 8E 2C 00");
  bench.start(5).frame(0x42C, "01 4B 03 01 03 01").frame(0x42B, "01 CB 00");
  bench.frame(0x42C, "01 0E 01 01 01").frame(0x42B, "01 8E 2C 00");
  EXPECT_THAT(bench.findings(), IsEmpty());
}

TEST(Dn212, ZeroLengthResponseToData) {
  Bench bench;
  established(bench, "00 00").poll(5, "01 02", "01").poll(5, "01 02", "").poll(5, "01 02", "");
  EXPECT_THAT(bench.findings(), ElementsAre("DN212@13"));
  EXPECT_EQ(bench.last().count, 2U);
}

TEST(Dn212, SilentWhereTheMasterIsIdle) {
  Bench bench;
  established(bench, "00 00").poll(5, "", "");
  EXPECT_THAT(bench.findings(), IsEmpty());
}

TEST(Dn212, SilentForAnAcknowledgeOfUnknownKind) {
  Bench bench;
  bench.poll(5, "01 02", "").poll(5, "01 02", "");
  EXPECT_THAT(bench.findings(), IsEmpty());
}

TEST(Dn212, ShutdownMessage) {
  Bench bench;
  bench.frame(0x745, "01 4E 01 00 01 00 02 00");
  EXPECT_THAT(bench.findings(), ElementsAre("DN212@1"));
  EXPECT_EQ(test::field_value(bench.dissection(), "unconnected", "shutdown_code"), 2);
}

TEST(Dn304, TooShort) {
  Bench bench;
  established(bench, "00 00").frame(0x42C, "").frame(0x42C, "01").frame(0x42C, "81").frame(0x42C, "41 0E 01");
  EXPECT_THAT(bench.findings(), ElementsAre("DN304@10", "DN304@11", "DN304@12", "DN304@13"));
  bench.frame(0x7C0, "", 3000);  // nobody must answer them
  EXPECT_EQ(bench.findings().size(), 4U);
}

TEST(Dn304, SilentOnTheShortestWholeRequest) {
  Bench bench;
  established(bench, "00 00").frame(0x42C, "01 05 05 02").frame(0x42B, "01 85");
  EXPECT_THAT(bench.findings(), IsEmpty());
}

TEST(Dn401, SeverityByWhatWasAsked) {
  Bench bench;
  established(bench, "00 00");
  bench.frame(0x42C, "01 0E 01 01 63").frame(0x42B, "01 94 14 FF");     // Get: a note
  bench.frame(0x42C, "01 10 05 02 0C 09").frame(0x42B, "01 94 09 FF");  // Set
  bench.frame(0x42C, "01 0E 01 01 07").frame(0x42B, "01 94 10 FF");     // Get, another code
  bench.frame(0x42E, "01 4C 03 01 04").frame(0x42B, "01 94 0B FF");     // Release: a note
  EXPECT_THAT(bench.findings(), ElementsAre("DN401@11 note", "DN401@13", "DN401@15", "DN401@17 note"));
  EXPECT_EQ(bench.all()[1].arguments, (std::array<std::int64_t, 4>{0x10, 0x09, 0xFF, 5}));
}

TEST(Dn401, NamesItsCause) {
  Bench bench;
  established(bench, "00 00").frame(0x42C, "01 0E").frame(0x42B, "01 94 16 FF");
  ASSERT_THAT(bench.findings(), ElementsAre("DN304@10", "DN401@11 note"));
  EXPECT_EQ(bench.last().cause.frame, 10U);
  EXPECT_EQ(rule_row(bench.last().cause.rule).id, "DN304");
}

}  // namespace
}  // namespace servotrace::devicenet
