// SPDX-License-Identifier: MIT
// Reads and writes that the report lists.
#include "replay/report/accesses.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "decoder/pipeline/pipeline.hpp"
#include "tests/support/scenarios.hpp"
#include "tests/support/traffic.hpp"

namespace servotrace::test {
namespace {

using ::testing::ElementsAre;

std::vector<std::string> accesses_of(const simulator::Simulation& simulation) {
  Pipeline pipeline{Settings{}};
  report::AccessLog log;
  const auto dissection = std::make_unique<Dissection>();
  for (std::size_t i = 0; i < simulation.frames.size(); ++i) {
    const RawFrame frame = raw_frame(simulation, i);
    pipeline.push(frame, dissection.get());
    log.add(frame, *dissection);
  }
  std::vector<std::string> texts;
  for (const report::Access& access : log.take()) texts.push_back(access.what + " = " + access.value);
  return texts;
}

std::string reads(const std::string& axis, const std::string& step) {
  return "title = \"reads\"\n[[ring]]\ncycle_us = 500\naxis = [{" + axis +
         "}]\nstep = [\n  {do = \"wait\", cycles = 40},\n" + step + "  {do = \"wait\", cycles = 40},\n]\n";
}

// The answer stands for some cycles; behind it come the words of the sub channel.
TEST(Accesses, OfAWideBlockAreThoseOfANarrowOne) {
  const std::string steps =
      "  {do = \"parameter_write\", parameter = \"0.08\", value = 10000, hold_ms = 10},\n"
      "  {do = \"parameter_read\", parameter = \"0.08\", hold_ms = 10},\n";
  constexpr const char* kPulses = "Pr0.08 number of command pulses per motor revolution";
  for (const char* const size : {"16", "32"}) {
    EXPECT_THAT(accesses_of(make_traffic(reads(std::string("mac_id = 1, data_size = ") + size, steps))),
                ElementsAre(std::string(kPulses) + " = 10000", std::string(kPulses) + " = 10000"))
        << size;
  }
}

}  // namespace
}  // namespace servotrace::test
