// SPDX-License-Identifier: MIT
// DN301 to DN303: fragments of polls (an ESB's messages of ten bytes) and of explicit messages.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "decoder/devicenet/fragments.hpp"
#include "tests/unit/devicenet/bench.hpp"

namespace servotrace::devicenet {
namespace {

using test::Bench;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr const char* kFirst = "00 00 00 00 00 00 00 00";
constexpr const char* kLast = "81 00 00 00";

// One whole poll pair of an ESB, four frames.
Bench& pair(Bench& bench) {
  return bench.frame(0x42D, kFirst, 10).frame(0x42D, kLast).frame(0x3C5, kFirst).frame(0x3C5, kLast);
}
Bench& esb(Bench& bench) { return pair(bench.start(5).allocate(5)); }  // frames 1 to 9

TEST(IoFragments, WholeMessages) {
  Bench bench{Bench::with_profile(5, "nsk-esb")};
  pair(pair(esb(bench)));
  EXPECT_THAT(bench.findings(), IsEmpty());
  EXPECT_EQ(bench.dissection().reassembled.size(), 10U);
  EXPECT_EQ(bench.dissection().links[0].kind, LinkKind::kFirstFragment);
  EXPECT_EQ(bench.dissection().links[0].frame, bench.number() - 1);
}

TEST(Dn301, CountGap) {
  Bench bench{Bench::with_profile(5, "nsk-esb")};
  esb(bench).frame(0x42D, kFirst, 10).frame(0x42D, "82 00 00 00");
  EXPECT_THAT(bench.findings(), ElementsAre("DN301@11"));
  EXPECT_EQ(bench.last().arguments[2], 2);
  EXPECT_EQ(bench.last().arguments[3], 1);
  EXPECT_EQ(bench.last().related[0], 10U);
  pair(bench);
  EXPECT_EQ(bench.findings().size(), 1U);
}

TEST(Dn302, AnotherMessageBegun) {
  Bench bench{Bench::with_profile(5, "nsk-esb")};
  esb(bench).frame(0x42D, kFirst, 10).frame(0x42D, kFirst, 10).frame(0x42D, kLast);
  EXPECT_THAT(bench.findings(), ElementsAre("DN302@11"));
}

TEST(Dn302, LastWithoutAFirst) {
  Bench bench{Bench::with_profile(5, "nsk-esb")};
  esb(bench).frame(0x42D, kLast, 10);
  EXPECT_THAT(bench.findings(), ElementsAre("DN302@10"));
}

TEST(Dn302, NoFurtherFragment) {
  Bench bench{Bench::with_profile(5, "nsk-esb")};
  esb(bench).frame(0x42D, kFirst, 10).frame(0x7C0, "", 1990);
  EXPECT_THAT(bench.findings(), IsEmpty());
  bench.frame(0x7C0, "", 20);
  EXPECT_THAT(bench.findings(), ElementsAre("DN302@12"));
}

TEST(Dn302, SilentWhereTheCaptureBegins) {
  Bench bench{Bench::with_profile(5, "nsk-esb")};
  bench.frame(0x42D, kLast).frame(0x3C5, kFirst).frame(0x3C5, kLast);
  pair(bench);
  EXPECT_THAT(bench.findings(), IsEmpty());
}

TEST(Dn302, SilentAcrossAGap) {
  Bench bench{Bench::with_profile(5, "nsk-esb")};
  esb(bench).frame(0x42D, kFirst, 10).gap().frame(0x42D, kLast);
  pair(bench);
  bench.frame(0x42D, kFirst, 10).gap().frame(0x7C0, "", 5000);
  EXPECT_THAT(bench.findings(), IsEmpty());
}

TEST(Dn301, SilentForTheOnlyFragment) {
  Bench bench;
  bench.start(5).allocate(5);
  // The device tells 64 bytes both ways: every message is fragmented, even one that would fit.
  bench.frame(0x42C, "01 0E 05 02 07").frame(0x42B, "01 8E 40 00");
  bench.frame(0x42C, "01 0E 05 02 08").frame(0x42B, "01 8E 40 00");
  bench.poll(5, "3F 01 02", "3F 03");
  EXPECT_THAT(bench.findings(), IsEmpty());
  EXPECT_EQ(bench.dissection().reassembled.size(), 1U);
}

// Started, allocated, and a request of the product name (frame 6).
Bench& asked(Bench& bench) { return bench.start(5).allocate(5).frame(0x42C, "01 0E 01 01 07"); }

TEST(Dn303, SilentWithItsAcknowledgements) {
  Bench bench;
  asked(bench).frame(0x42B, "81 00 8E 08 41 42 43 44").frame(0x42C, "81 C0 00");
  bench.frame(0x42B, "81 41 45 46 47").frame(0x42C, "81 C1 00");
  bench.frame(0x42B, "81 41 45 46 47").frame(0x42C, "81 C1 00");  // sent and acknowledged again
  bench.frame(0x42B, "81 82 48").frame(0x42C, "81 C2 00", 990).frame(0x7C0, "", 3000);
  EXPECT_THAT(bench.findings(), IsEmpty());
}

TEST(Dn303, RepeatedWithoutAcknowledgement) {
  Bench bench;
  asked(bench).frame(0x42B, "81 00 8E 08 41 42 43 44").frame(0x42B, "81 00 8E 08 41 42 43 44", 900);
  bench.frame(0x7C0, "", 3000);
  EXPECT_THAT(bench.findings(), ElementsAre("DN303@8"));  // the first of DN301-DN303 only
}

TEST(Dn303, FollowedWithoutAcknowledgement) {
  Bench bench;
  asked(bench).frame(0x42B, "81 00 8E 02 41 42").frame(0x42B, "81 81 43");
  EXPECT_THAT(bench.findings(), ElementsAre("DN303@8"));
}

TEST(Dn303, OneSecondOld) {
  Bench bench;
  asked(bench).frame(0x42B, "81 00 8E 08 41 42 43 44").frame(0x7C0, "", 990).frame(0x7C0, "", 20);
  EXPECT_THAT(bench.findings(), ElementsAre("DN303@9"));
}

TEST(Dn303, OfAnotherCountAndWithAStatus) {
  Bench bench;
  asked(bench).frame(0x42B, "81 00 8E 08 41 42 43 44").frame(0x42C, "81 C3 00").frame(0x42C, "81 C0 01");
  EXPECT_THAT(bench.findings(), ElementsAre("DN303@8", "DN303@9"));
  EXPECT_EQ(bench.all()[0].actor, Actor::kNetwork);
  EXPECT_EQ(bench.all()[1].actor, Actor::kDrive);  // the drive sent too much
}

TEST(Dn303, TheMasterSentTooMuch) {
  Bench bench;
  bench.start(5).allocate(5).frame(0x42C, "81 00 10 64 01 1E 01 02").frame(0x42B, "81 C0 01");
  EXPECT_THAT(bench.findings(), ElementsAre("DN303@7"));
  EXPECT_EQ(bench.last().actor, Actor::kMaster);
}

TEST(Dn302, ExplicitRequestBrokenOffByAnother) {
  Bench bench;
  bench.start(5).allocate(5).frame(0x42C, "81 00 10 64 01 1E 01 02").frame(0x42B, "81 C0 00");
  bench.frame(0x42C, "01 0E 01 01 01").frame(0x42B, "01 8E 2C 00");
  EXPECT_THAT(bench.findings(), ElementsAre("DN302@8"));
}

TEST(Transfer, CountsWrapAround) {
  Transfer transfer{false};
  std::uint64_t frame = 1;
  const auto payload = servotrace::test::hex("01 02 03 04 05 06 07");
  EXPECT_TRUE(transfer.push(FragmentType::kFirst, 0, 0, payload, frame, 0, false).begins);
  for (unsigned i = 1; i <= 64; ++i) {
    const auto count = static_cast<std::uint8_t>(i & 0x3F);  // 63, then 0
    EXPECT_EQ(transfer.push(FragmentType::kMiddle, count, 0, payload, ++frame, 0, false).fault, FragmentFault::kNone);
  }
  EXPECT_TRUE(transfer.push(FragmentType::kLast, 1, 0, payload, ++frame, 0, false).complete);
  EXPECT_EQ(transfer.message().size(), 66U * 7U);
}

TEST(Transfer, AMessageThatIsTooLongIsNotComplete) {
  Transfer transfer{false};
  const auto payload = servotrace::test::hex("01 02 03 04 05 06 07");
  transfer.push(FragmentType::kFirst, 0, 0, payload, 1, 0, false);
  for (unsigned i = 1; i <= 200; ++i)
    transfer.push(FragmentType::kMiddle, static_cast<std::uint8_t>(i & 0x3F), 0, payload, 2, 0, false);
  const FragmentResult result = transfer.push(FragmentType::kLast, 201 & 0x3F, 0, payload, 3, 0, false);
  EXPECT_FALSE(result.complete);
  EXPECT_TRUE(transfer.overflowed());
  EXPECT_EQ(transfer.message().size(), Transfer::kCapacity);
}

}  // namespace
}  // namespace servotrace::devicenet
