// SPDX-License-Identifier: MIT
// The simulated ring against the manual's own examples: echo timing (SX-DSV02203 3-1) and the answers of chapter 6.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "captures/simulator/scenario.hpp"
#include "decoder/link/rtex_record.hpp"
#include "tests/support/bytes.hpp"

namespace servotrace::simulator {
namespace {

struct Cycle {
  std::vector<std::uint8_t> command;  // the blocks of all axes
  std::vector<std::uint8_t> response;
};

// The ring of a scenario, cycle by cycle.
std::vector<Cycle> run_ring(const std::string& ring) {
  Result<Scenario> scenario = parse_scenario("title = \"t\"\n[[ring]]\n" + ring, "ring.toml");
  if (!scenario) {
    ADD_FAILURE() << scenario.error().text();
    return {};
  }
  Result<Simulation> simulation = simulate(*scenario);
  if (!simulation) {
    ADD_FAILURE() << simulation.error().text();
    return {};
  }
  std::vector<Cycle> cycles;
  for (const SimulatedFrame& frame : simulation->frames) {
    const Bytes record = Bytes(frame.bytes).subspan(12);  // behind the exported PDU tags
    std::vector<std::uint8_t> blocks(record.begin() + 24, record.end());
    if (read(slot(rtex::kRecord, "direction"), record) == 0) {
      cycles.push_back({std::move(blocks), {}});
    } else {
      cycles.back().response = std::move(blocks);
    }
  }
  return cycles;
}

unsigned counter_of(const std::vector<std::uint8_t>& block) { return block[0] >> 5U & 3U; }

// The first response whose bytes 8 to 15 are `wanted`.
bool is_answered(const std::vector<Cycle>& cycles, std::string_view wanted) {
  const std::vector<std::uint8_t> bytes = test::hex(wanted);
  return std::any_of(cycles.begin(), cycles.end(), [&](const Cycle& cycle) {
    return std::equal(bytes.begin(), bytes.end(), cycle.response.begin() + 8);
  });
}

TEST(SimulatedRing, EchoesTheCounterOneCycleLaterAndTheCodeTwo) {
  for (const char* timing :
       {"cycle_us = 166.667\n", "cycle_us = 500\n", "cycle_us = 500\nratio = 2\n", "cycle_us = 1000\n"}) {
    SCOPED_TRACE(timing);
    const std::vector<Cycle> cycles =
        run_ring(std::string(timing) +
                 "axis = [{mac_id = 1}]\nstep = [{do = \"wait\", cycles = 10}, {do = \"monitor\", type = 6}]\n");
    ASSERT_GT(cycles.size(), 40U);
    for (std::size_t i = 3; i < cycles.size(); ++i) {
      EXPECT_EQ(counter_of(cycles[i].response), counter_of(cycles[i - 1].command)) << i;
      EXPECT_EQ(cycles[i].response[1], cycles[i - 2].command[1]) << i;
    }
  }
}

TEST(SimulatedRing, EchoesTheCodeTwoOrThreeCyclesLaterAtTheShortestCycle) {
  const std::vector<Cycle> cycles = run_ring(
      "cycle_us = 83.333\naxis = [{mac_id = 1}]\n"
      "step = [{do = \"wait\", cycles = 10}, {do = \"monitor\", type = 6}]\n");
  ASSERT_GT(cycles.size(), 40U);
  for (std::size_t i = 4; i < cycles.size(); ++i) {
    EXPECT_EQ(counter_of(cycles[i].response), counter_of(cycles[i - 1].command)) << i;
    EXPECT_EQ(cycles[i].response[1], cycles[i - 2 - i % 2].command[1]) << i;
  }
}

TEST(SimulatedRing, CountsFromOneOnceItLeavesNop) {
  const std::vector<Cycle> cycles = run_ring("nop_cycles = 6\naxis = [{mac_id = 1}]\nstep = []\n");
  ASSERT_GT(cycles.size(), 12U);
  for (std::size_t i = 0; i < 12; ++i) {
    EXPECT_EQ(cycles[i].command[1], i < 6 ? 0x00 : 0x20) << i;
    EXPECT_EQ(counter_of(cycles[i].command), i < 6 ? 0 : (i - 5) % 4) << i;
  }
}

// 6-4-2, 6-4-4
TEST(SimulatedDrive, AnswersTheSystemIdExamples) {
  const std::vector<Cycle> cycles = run_ring(
      "axis = [{mac_id = 1}]\n"
      "step = [{do = \"system_id\", type = 0x01, count = 3}, {do = \"system_id\", type = 0x15, count = 2}]\n");
  EXPECT_TRUE(is_answered(cycles, "01 00 00 00 50 61 6E 61"));  // Pana
  EXPECT_TRUE(is_answered(cycles, "01 00 01 00 73 6F 6E 69"));  // soni
  EXPECT_TRUE(is_answered(cycles, "01 00 02 00 63 00 00 00"));  // c
  EXPECT_TRUE(is_answered(cycles, "15 00 00 00 31 30 31 31"));  // 1011
  EXPECT_TRUE(is_answered(cycles, "15 00 01 00 31 31 00 00"));  // 11
}

// 6-7-1, 6-7-2, 6-7-4: Pr7.23 is 0717h, -1000 is FFFFFC18h, the attribute of Pr0.08 00009010h
TEST(SimulatedDrive, AnswersTheParameterExamples) {
  const std::vector<Cycle> cycles = run_ring(
      "axis = [{mac_id = 1}]\n"
      "step = [{do = \"parameter_write\", parameter = \"7.23\", value = -1000},"
      "{do = \"parameter_read\", parameter = \"7.23\"}, {do = \"parameter_attribute\", parameter = \"0.08\"},"
      "{do = \"parameter_count\", class = 8}, {do = \"command\", code = 6, type = 1}]\n");
  EXPECT_TRUE(is_answered(cycles, "11 00 17 07 18 FC FF FF"));
  EXPECT_TRUE(is_answered(cycles, "10 00 17 07 18 FC FF FF"));
  EXPECT_TRUE(is_answered(cycles, "40 00 08 00 10 90 00 00"));
  EXPECT_TRUE(is_answered(cycles, "30 00 00 08 14 00 00 00"));  // 6-7-3: 20 parameters
  EXPECT_TRUE(is_answered(cycles, "31 00 00 00 00 00 00 00"));  // 0031h: a code of the A4N
}

// 7-2-1: the master leaves when Homing_Complete is 1; the trigger's place is position 0 from then on.
TEST(SimulatedDrive, HomesToASensorInCyclicPositionMode) {
  const std::vector<Cycle> cycles = run_ring(
      "axis = [{mac_id = 1, position = 500, home = [900, 2000]}]\n"
      "step = [{do = \"servo_on\"}, {do = \"control\", homing_ctrl = true}, {do = \"homing\", type = 0x12, speed = "
      "20000},"
      "{do = \"control\", homing_ctrl = false}, {do = \"move\", to = 100}]\n");
  ASSERT_FALSE(cycles.empty());
  const std::vector<std::uint8_t>& last = cycles.back().response;
  EXPECT_EQ(last[2] & 0x04, 0x04);  // Homing_Complete
  EXPECT_EQ(last[4], 100);
}

TEST(SimulatedDrive, HomesByAProfile) {
  for (const char* type : {"homing1", "homing2", "homing3"}) {
    SCOPED_TRACE(type);
    const std::vector<Cycle> cycles = run_ring(
        "axis = [{mac_id = 1, mode = \"pp\", position = 500, home = [900, 20000]}]\n"
        "step = [{do = \"servo_on\"}, {do = \"profile\", type = \"" +
        std::string(type) + "\", give_up_ms = 60000}]\n");
    ASSERT_FALSE(cycles.empty());
    const std::vector<std::uint8_t>& last = cycles.back().response;
    EXPECT_EQ(last[2] & 0x06, 0x04);  // Homing_Complete, no longer In_Progress
    EXPECT_EQ(last[4], 0);
  }
}

TEST(SimulatedRing, GivesTheSameBytesEachTime) {
  const std::string ring =
      "axis = [{mac_id = 1}, {mac_id = 2, data_size = 32}]\n"
      "step = [{do = \"servo_on\"}, {do = \"move\", by = 777}, {do = \"servo_off\"}]\n";
  const std::vector<Cycle> first = run_ring(ring);
  const std::vector<Cycle> second = run_ring(ring);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].command, second[i].command);
    EXPECT_EQ(first[i].response, second[i].response);
  }
}

TEST(SimulatedRing, NamesAStepThatNeverEnds) {
  Result<Scenario> scenario = parse_scenario(
      "title = \"t\"\n[[ring]]\naxis = [{mac_id = 1, alarm = 38}]\nstep = [\n{do = \"servo_on\"}]\n", "s.toml");
  ASSERT_TRUE(scenario);
  Result<Simulation> simulation = simulate(*scenario);
  ASSERT_FALSE(simulation);
  EXPECT_EQ(simulation.error().text(), "s.toml:5:1: axis 1 waits in vain for the end of this step");
}

}  // namespace
}  // namespace servotrace::simulator
