// SPDX-License-Identifier: MIT
// DN402 to DN405: requests against the object tables of a known drive (NS310, SIE-C718-7 Appendix B).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/devicenet/bench.hpp"

namespace servotrace::devicenet {
namespace {

using test::Bench;
using testing::ElementsAre;
using testing::IsEmpty;

// Frames 1 to 5; the request is frame 6.
Bench drive() {
  Bench bench{Bench::with_profile(5, "yaskawa-ns310")};
  bench.start(5).allocate(5);
  return bench;
}

TEST(Dn402, SetOfAGetOnlyAttributeAndAServiceTheObjectLacks) {
  Bench set = drive();
  set.frame(0x42C, "01 10 24 01 01 0A");
  EXPECT_THAT(set.findings(), ElementsAre("DN402@6"));
  EXPECT_EQ(set.all()[0].arguments, (std::array<std::int64_t, 4>{0, 0x24, 1, 0x10}));
  Bench service = drive();
  service.frame(0x42C, "01 05 25 01");
  EXPECT_THAT(service.findings(), ElementsAre("DN402@6"));
  EXPECT_EQ(service.all()[0].arguments, (std::array<std::int64_t, 4>{1, 0x25, -1, 0x05}));
}

TEST(Dn402, GetOfASetOnlyAttributeIsANoteOnceAnswered) {
  Bench bench = drive();
  bench.frame(0x42C, "01 0E 24 01 06");
  EXPECT_THAT(bench.findings(), IsEmpty());
  bench.frame(0x42B, "01 8E 01");
  EXPECT_THAT(bench.findings(), ElementsAre("DN402@7 note"));
  Bench refused = drive();
  refused.frame(0x42C, "01 0E 24 01 06").frame(0x42B, "01 94 14 FF");
  EXPECT_THAT(refused.findings(), ElementsAre("DN401@7 note"));
}

TEST(Dn402, SilentWhereTheTableAllowsIt) {
  Bench bench = drive();
  bench.frame(0x42C, "01 0E 24 01 01").frame(0x42B, "01 8E 0A").frame(0x42C, "01 10 24 01 06 01").frame(0x42B, "01 90");
  EXPECT_THAT(bench.findings(), IsEmpty());
}

TEST(Dn402, SilentForADriveThatIsNotKnown) {
  Bench bench;
  bench.start(5).allocate(5).frame(0x42C, "01 10 24 01 01 0A").frame(0x42C, "41 10 25 01 08 01", 1);
  EXPECT_THAT(bench.findings(), ElementsAre("DN209@7"));
}

// 25h/254 Home Fast Speed: 1 and up, printed as a signed DINT.
TEST(Dn403, OutsideTheRange) {
  Bench bench = drive();  // 0, in 9 bytes: fragments
  bench.frame(0x42C, "81 00 10 25 01 FE 00 00").frame(0x42B, "81 C0 00").frame(0x42C, "81 81 00 00");
  EXPECT_THAT(bench.findings(), ElementsAre("DN403@8"));
  EXPECT_EQ(bench.all()[0].arguments, (std::array<std::int64_t, 4>{254, 0, 1, 2'147'483'647}));
  Bench negative = drive();
  negative.frame(0x42C, "81 00 10 25 01 FE FF FF").frame(0x42B, "81 C0 00").frame(0x42C, "81 81 FF FF");
  EXPECT_THAT(negative.findings(), ElementsAre("DN403@8"));
  EXPECT_EQ(negative.all()[0].arguments[1], -1);
}

TEST(Dn403, SilentAtItsEnd) {
  Bench bench = drive();
  bench.frame(0x42C, "81 00 10 25 01 FE 01 00").frame(0x42B, "81 C0 00").frame(0x42C, "81 81 00 00");
  bench.frame(0x42B, "81 C1 00").frame(0x42B, "01 90");
  EXPECT_THAT(bench.findings(), IsEmpty());
}

TEST(Dn404, AnotherLengthThanTheType) {
  Bench bench = drive();
  bench.frame(0x42C, "01 10 25 01 08 64");
  EXPECT_THAT(bench.findings(), ElementsAre("DN404@6"));
  EXPECT_EQ(bench.all()[0].arguments, (std::array<std::int64_t, 4>{8, 1, 4, 0x25}));
}

// Its range, 0 to 100,000, does not fit the UINT the manual prints (B.10): either size is accepted.
TEST(Dn404, SilentForBothSizesOfThePositioningTimeout) {
  Bench two = drive();
  two.frame(0x42C, "01 10 64 01 5B 88 13").frame(0x42B, "01 90");
  EXPECT_EQ(two.findings(), std::vector<std::string>{});
  Bench four = drive();  // 100,000 = 000186A0h
  four.frame(0x42C, "81 00 10 64 01 5B A0 86").frame(0x42B, "81 C0 00").frame(0x42C, "81 81 01 00");
  EXPECT_EQ(test::field_value(four.dissection(), "control_parameter", "positioning_timeout_wide"), 100'000);
  four.frame(0x42B, "81 C1 00").frame(0x42B, "01 90");
  EXPECT_THAT(four.findings(), IsEmpty());
}

TEST(Dn404, ThreeBytesFitNeither) {
  Bench bench = drive();
  bench.frame(0x42C, "01 10 64 01 5B 88 13 00");
  EXPECT_THAT(bench.findings(), ElementsAre("DN404@6"));
}

TEST(Dn405, NoSuchObjectInstanceOrAttribute) {
  const char* requests[] = {"01 0E 70 01 01", "01 0E 25 02 01", "01 0E 25 01 C8"};
  for (std::int64_t kind = 0; kind < 3; ++kind) {
    Bench bench = drive();
    bench.frame(0x42C, requests[kind]);
    EXPECT_THAT(bench.findings(), ElementsAre("DN405@6")) << requests[kind];
    EXPECT_EQ(bench.all()[0].arguments[0], kind);
    EXPECT_EQ(bench.all()[0].severity, Severity::kNote);
  }
}

TEST(Dn405, SilentForTheLastOnesListed) {
  for (const char* request : {"01 0E 27 FF 01", "01 0E 25 01 FF", "01 0E 66 01 BF"}) {
    Bench bench = drive();
    bench.frame(0x42C, request);
    EXPECT_THAT(bench.findings(), IsEmpty()) << request;
  }
}

}  // namespace
}  // namespace servotrace::devicenet
