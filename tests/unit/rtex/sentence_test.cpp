// SPDX-License-Identifier: MIT
// What the Info column and the evidence lines say of an RTEX record.
#include "decoder/render/sentence.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/rtex/bench.hpp"

namespace servotrace::rtex::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;

class Sentences : public ::testing::Test {
 protected:
  // Of every frame of some cycles with this non-cyclic command.
  std::vector<std::string> said(std::uint8_t code, std::uint16_t type_code, std::uint16_t index) {
    std::vector<std::string> all;
    bench_.on_frame = [&all](std::uint64_t, const Dissection& dissection) { all.push_back(sentence(dissection)); };
    bench_.non_cyclic(0, code, type_code, index);
    bench_.cycles(4);
    return all;
  }
  Bench bench_;
};

TEST_F(Sentences, OfAParameterReadAndItsAnswers) {
  bench_.cycles(5);
  bench_.at(0).data = 10'000;
  const std::vector<std::string> all = said(6, 0x010, 0x0008);
  constexpr const char* kWhat = "parameter reading Pr0\\.08 number of command pulses per motor revolution";
  EXPECT_THAT(all[0], MatchesRegex(fmt::format(
                          "axis [0-9]+ command: CP -?[0-9]+, .*{}, waiting for echo, counter [0-3].*", kWhat)));
  EXPECT_THAT(all[1], MatchesRegex("axis [0-9]+ response: CP, APOS .*counter [0-3].*"));
  EXPECT_THAT(all, Contains(MatchesRegex(fmt::format("axis [0-9]+ response: .*{} = 10000, counter.*", kWhat))));
  EXPECT_THAT(all.back(), Not(HasSubstr("waiting")));
}

TEST_F(Sentences, OfARefusedCommand) {
  bench_.cycles(5);
  bench_.at(0).error_code = 0x0045;
  const std::vector<std::string> all = said(6, 0x010, 0x0900);
  EXPECT_THAT(all[0], HasSubstr("parameter reading Pr9.00, waiting for echo"));
  EXPECT_THAT(all, Contains(HasSubstr("Parameter refused: ")));
}

// A bit of two meanings is one word among the others.
TEST_F(Sentences, OfABitWhoseMeaningIsNotKnown) {
  bench_.cycles(5);
  bench_.at(0).in_progress = true;
  std::vector<std::string> all;
  bench_.on_frame = [&all](std::uint64_t, const Dissection& dissection) { all.push_back(sentence(dissection)); };
  bench_.cycles(1);
  EXPECT_THAT(all[1], HasSubstr("In_Progress/AC_OFF Servo_Ready, counter"));
}

// 4-3-1: the value of a monitor select is the Type_Code of a monitor.
TEST_F(Sentences, OfAMonitorSelectThatIsWritten) {
  bench_.cycles(5);
  bench_.non_cyclic(0, 6, 0x011, 0x071D, 1);
  std::vector<std::string> all;
  bench_.on_frame = [&all](std::uint64_t, const Dissection& dissection) { all.push_back(sentence(dissection)); };
  bench_.cycles(1);
  EXPECT_THAT(all[0],
              HasSubstr("parameter writing Pr7.29 RTEX monitor select 1 = 1 (Position deviation (PERR)), waiting"));
}

// The labels of the response's bits Pr7.23 decides on, of the last frame: status bit 1, then bits 0 and 1 of byte 3.
std::string labels(Bench& bench) {
  std::string text;
  bench.on_frame = [&text](std::uint64_t, const Dissection& dissection) {
    for (const Segment& segment : dissection.segments) {
      if (!is_response_header(*segment.layout)) continue;
      text.clear();
      for (const std::string_view key : {"in_progress", "not_pot", "pot_not"})
        text += std::string(segment.layout->find(key)->label) + ", ";
    }
  };
  bench.cycles(1);
  bench.on_frame = nullptr;
  return text;
}

// 4-3-3-2, 4-3-4: known from the read on, and not before.
TEST_F(Sentences, NameTheBitsOfPr7_23WhereItIsKnown) {
  bench_.cycles(5);
  EXPECT_EQ(labels(bench_), "In_Progress / AC_OFF, NOT / POT, POT / NOT, ");
  bench_.at(0).data = 0x0108;
  bench_.non_cyclic(0, 6, 0x010, 0x0717);
  bench_.cycles(4);
  bench_.normal(0);
  bench_.cycles(4);
  EXPECT_EQ(labels(bench_), "AC_OFF, POT, NOT, ");

  Settings settings;
  settings.rtex.axes.push_back({.mac_id = 0, .parameters = {{0x0717, 0}}});
  Bench configured(1, settings);
  EXPECT_EQ(labels(configured), "In_Progress, NOT, POT, ");
}

}  // namespace
}  // namespace servotrace::rtex::test
