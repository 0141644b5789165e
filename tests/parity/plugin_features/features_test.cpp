// SPDX-License-Identifier: MIT
// What the plugin offers beside findings: fields without a setting, statistics, links, process values an axis, tables.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <set>

#include "tests/support/paths.hpp"
#include "tests/support/recording.hpp"
#include "tests/support/tshark.hpp"

namespace servotrace::test {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;

class Plugin : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = std::make_unique<Tshark>();
    if (!shared_->available()) return;
    const auto scenario = simulator::read_scenario(source_dir() / "captures" / "scenarios" / "rtex_clean.toml");
    ASSERT_TRUE(scenario) << scenario.error().text();
    auto simulation = simulator::simulate(*scenario);
    ASSERT_TRUE(simulation) << simulation.error().text();
    clean_ = {scenario->name, std::move(simulation->interfaces), std::move(simulation->frames)};
    write_capture(shared_->folder() / "clean.pcapng", {clean_});
    file_ = shared_->copy(shared_->folder() / "clean.pcapng").string();
  }
  static void TearDownTestSuite() { shared_.reset(); }
  void SetUp() override {
    if (!shared_->available()) GTEST_SKIP() << shared_->why_not();
  }
  std::string run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"-r", file_});
    const Ran ran = tshark_.run(arguments);
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(ran.err, "");
    return ran.out;
  }
  static inline std::unique_ptr<Tshark> shared_;
  static inline Recording clean_;
  static inline std::string file_;
  const Tshark& tshark_ = *shared_;
};

// SX-DSV02203 4-2-2: bits 6-5 of byte 0 of each command block, printed with no setting.
TEST_F(Plugin, PrintsTheUpdateCounterOfEveryCommandBlock) {
  const auto rows = rows_of(run({"-T", "fields", "-e", "rtex.command.update_counter"}));
  ASSERT_EQ(rows.size(), clean_.frames.size());
  std::size_t blocks = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::vector<std::uint8_t>& bytes = clean_.frames[i].bytes;
    const std::size_t record = 12;  // behind the tags of the exported PDU
    std::string expected;
    if ((bytes[record + 6] & 1U) == 0) {
      for (std::size_t node = 0; node < bytes[record + 20]; ++node) {
        if (!expected.empty()) expected += ",";
        expected += std::to_string(bytes[record + 24 + 16 * node] >> 5U & 3U);
        ++blocks;
      }
    }
    ASSERT_EQ(rows[i][0], expected) << "frame " << i + 1;
  }
  EXPECT_GT(blocks, 0U);
}

TEST_F(Plugin, FieldsOfOneNameHaveOneKind) {
  const Ran ran = tshark_.run({"-G", "fields"});
  EXPECT_EQ(ran.status, 0);
  EXPECT_EQ(ran.err, "");  // Wireshark complains there of fields it cannot compare
  for (const char* const field : {"\trtex.record.sequence\t", "\trtex.command.mac_id\t", "\tservotrace.rule\t",
                                  "\trtex.axis31.actual_position\t", "\tdnet.source\t", "\tesb.output.drdy\t"})
    EXPECT_THAT(ran.out, HasSubstr(field));
}

TEST_F(Plugin, StatisticsOfEachKind) {
  const std::string out = run({"-q", "-z", "servotrace_findings,tree", "-z", "rtex_ring,tree", "-z",
                               "rtex_handshake,tree", "-z", "dnet_nodes,tree"});
  EXPECT_THAT(out, HasSubstr("servotrace/Findings:"));
  EXPECT_THAT(out, HasSubstr("servotrace/RTEX handshakes:"));
  EXPECT_THAT(out, HasSubstr("servotrace/DeviceNet nodes:"));
  std::size_t commands = 0;
  for (const auto& frame : clean_.frames) commands += (frame.bytes[18] & 1U) == 0 ? 1U : 0U;
  EXPECT_THAT(out, ContainsRegex("Command records +" + std::to_string(commands) + " "));
  EXPECT_THAT(out, ContainsRegex("Time between commands \\(us\\) +" + std::to_string(commands - 1) + " "));
}

// A process value of each axis, apart from the others of the same record.
TEST_F(Plugin, ProcessValuesOfOneAxis) {
  const auto rows = rows_of(run({"-Y", "rtex.axis1.command_position", "-T", "fields", "-e", "frame.number", "-e",
                                 "rtex.axis1.command_position", "-e", "rtex.axis2.command_position"}));
  ASSERT_FALSE(rows.empty());
  for (const auto& row : rows) {
    ASSERT_EQ(row.size(), 3U);
    const std::vector<std::uint8_t>& bytes = clean_.frames[std::stoul(row[0]) - 1].bytes;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const std::size_t at = 12 + 24 + 16 * axis + 4;
      std::uint32_t raw = 0;
      for (std::size_t i = 0; i < 4; ++i) raw |= std::uint32_t{bytes[at + i]} << (8 * i);
      EXPECT_EQ(row[1 + axis], std::to_string(static_cast<std::int32_t>(raw)));
    }
  }
  EXPECT_THAT(run({"-q", "-z", "io,stat,0,MAX(rtex.axis1.actual_position)rtex.axis1.actual_position"}),
              ContainsRegex("MAX"));
}

// What no single frame holds: how far each axis is behind its command, how long the drive took to echo, how long a
// cycle was; against the bytes and times of the records themselves, and as -z io,stat adds them up.
TEST_F(Plugin, DeviationEchoLatencyAndCycleTimeOfOneAxis) {
  const auto position = [](const std::vector<std::uint8_t>& bytes, std::size_t axis) {
    const std::size_t at = 12 + 24 + 16 * axis + 4;
    std::uint32_t raw = 0;
    for (std::size_t i = 0; i < 4; ++i) raw |= std::uint32_t{bytes[at + i]} << (8 * i);
    return static_cast<std::int32_t>(raw);
  };
  const auto rows = rows_of(
      run({"-T", "fields", "-e", "rtex.axis1.deviation", "-e", "rtex.axis2.deviation", "-e", "rtex.axis1.echo_time_ns",
           "-e", "rtex.axis2.echo_time_ns", "-e", "rtex.accepted_command", "-e", "rtex.cycle_time_ns"}));
  ASSERT_EQ(rows.size(), clean_.frames.size());
  std::size_t last_command = rows.size();
  std::size_t deviations = 0;
  std::size_t latencies = 0;
  std::int64_t most = INT64_MIN;
  std::int64_t longest = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ASSERT_EQ(rows[i].size(), 6U);
    const auto& frame = clean_.frames[i];
    const bool response = (frame.bytes[12 + 6] & 1U) != 0;
    if (!response) {
      EXPECT_EQ(rows[i][5],
                last_command == rows.size() ? "" : std::to_string(frame.time_ns - clean_.frames[last_command].time_ns))
          << "frame " << i + 1;
      last_command = i;
      continue;
    }
    for (std::size_t axis = 0; axis < 2; ++axis) {
      if (rows[i][axis].empty()) continue;
      const std::int64_t expected =
          std::int64_t{position(clean_.frames[last_command].bytes, axis)} - position(frame.bytes, axis);
      EXPECT_EQ(rows[i][axis], std::to_string(expected)) << "frame " << i + 1;
      if (axis == 0) most = std::max(most, expected);
      ++deviations;
    }
    std::multiset<std::string> shown;
    std::multiset<std::string> expected;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      if (!rows[i][2 + axis].empty()) shown.insert(rows[i][2 + axis]);
    }
    if (!rows[i][2].empty()) longest = std::max<std::int64_t>(longest, std::stoll(rows[i][2]));
    if (!rows[i][4].empty()) {
      for (const std::string& command : parts_of(rows[i][4], ','))
        expected.insert(std::to_string(frame.time_ns - clean_.frames[std::stoul(command) - 1].time_ns));
    }
    EXPECT_EQ(shown, expected) << "frame " << i + 1;
    latencies += shown.size();
  }
  EXPECT_GT(deviations, rows.size() / 2);
  EXPECT_GT(latencies, 0U);
  EXPECT_GT(longest, 0);
  const std::string sums = run({"-q", "-z",
                                "io,stat,0,MAX(rtex.axis1.deviation)rtex.axis1.deviation,"
                                "MAX(rtex.axis1.echo_time_ns)rtex.axis1.echo_time_ns"});
  EXPECT_THAT(sums,
              ContainsRegex("<>[^|]*\\| +" + std::to_string(most) + " +\\| +" + std::to_string(longest) + " +\\|"));
}

// The same of a DeviceNet node.
TEST_F(Plugin, ProcessValuesOfOneNode) {
  const std::string file = shared_->copy(source_dir() / "captures" / "ns310_clean.pcapng").string();
  const Ran ran = tshark_.run({"-r", file, "-Y", "ns310.response.current_position", "-T", "fields", "-e",
                               "ns310.response.current_position", "-e", "ns310.node5.current_position", "-e",
                               "ns310.node3.current_position"});
  ASSERT_EQ(ran.status, 0) << ran.err;
  const auto rows = rows_of(ran.out);
  ASSERT_FALSE(rows.empty());
  for (const auto& row : rows) {
    ASSERT_GE(row.size(), 2U);
    EXPECT_EQ(row[0], row[1]);
    EXPECT_TRUE(row.size() == 2 || row[2].empty());
  }
}

TEST_F(Plugin, TablesNameAxes) {
  const std::string out = run({"-c", "20", "-o", R"(uat:servotrace_axes:"","1","left","","","","7.23=0x20","")", "-o",
                               R"(uat:servotrace_axes:"0","2","right","16","semi-closed","absolute","","1000")"});
  EXPECT_THAT(out, HasSubstr("axis 1 (left)"));
  EXPECT_THAT(out, HasSubstr("axis 2 (right)"));
}

TEST_F(Plugin, TablesRefuseWhatTheSettingsFileRefuses) {
  const Ran ran = tshark_.run({"-r", file_, "-o", R"(uat:servotrace_axes:"","99","left","","","","","")"});
  EXPECT_NE(ran.status, 0);
  EXPECT_THAT(ran.err, HasSubstr("99"));
}

TEST_F(Plugin, ASettingsFileWithAMistakeIsReported) {
  const Ran ran = tshark_.run({"-r", file_, "-c", "1", "-o", "servotrace.settings_file:/nonexistent/servotrace.toml"});
  EXPECT_EQ(ran.status, 0);
  EXPECT_THAT(ran.err, HasSubstr("/nonexistent/servotrace.toml"));
}

TEST_F(Plugin, SourceAndDestination) {
  const auto rows = rows_of(
      run({"-c", "2", "-T", "fields", "-e", "_ws.col.Source", "-e", "_ws.col.Destination", "-e", "_ws.col.Protocol"}));
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0], (std::vector<std::string>{"master", "ring0", "RTEX"}));
  EXPECT_EQ(rows[1], (std::vector<std::string>{"ring0", "master", "RTEX"}));
}

}  // namespace
}  // namespace servotrace::test
