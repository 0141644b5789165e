// SPDX-License-Identifier: MIT
// What the Info column and the evidence lines say of an RTEX record.
#include "decoder/render/sentence.hpp"

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
  EXPECT_THAT(all[0], MatchesRegex(std::string("axis [0-9]+ command: CP -?[0-9]+, .*") + kWhat +
                                   ", waiting for echo, counter [0-3].*"));
  EXPECT_THAT(all[1], MatchesRegex("axis [0-9]+ response: CP, APOS .*counter [0-3].*"));
  EXPECT_THAT(all, Contains(MatchesRegex(std::string("axis [0-9]+ response: .*") + kWhat + " = 10000, counter.*")));
  EXPECT_THAT(all.back(), Not(HasSubstr("waiting")));
}

TEST_F(Sentences, OfARefusedCommand) {
  bench_.cycles(5);
  bench_.at(0).error_code = 0x0045;
  const std::vector<std::string> all = said(6, 0x010, 0x0900);
  EXPECT_THAT(all[0], HasSubstr("parameter reading Pr9.00, waiting for echo"));
  EXPECT_THAT(all, Contains(HasSubstr("Parameter refused: ")));
}

}  // namespace
}  // namespace servotrace::rtex::test
