// SPDX-License-Identifier: MIT
// The scenario file: what is read, and that every mistake is named with line and column.
#include <gtest/gtest.h>

#include "captures/simulator/scenario.hpp"

namespace servotrace::simulator {
namespace {

std::string error_of(std::string_view text) {
  Result<Scenario> scenario = parse_scenario(text, "s.toml");
  if (!scenario) return scenario.error().text();
  Result<Simulation> simulation = simulate(*scenario);
  return simulation ? "" : simulation.error().text();
}

TEST(ScenarioReader, ReadsEveryKey) {
  Result<Scenario> scenario = parse_scenario(R"(title = "A capture with a foreign link type"
description = "Two frames."
rules = ["CP105"]
silent = ["CP101"]
shipped = true
[settings.rtex]
communication_cycle_us = 500
[[settings.rtex.axis]]
mac_id = 3
[[expect]]
rule = "CP105"
mac_id = -1
channel = "main"
findings = 2
severity = "note"
cause = "CP104"
[[raw]]
link_type = 9
)",
                                             "folder/foreign.toml");
  ASSERT_TRUE(scenario) << scenario.error().text();
  EXPECT_EQ(scenario->name, "foreign");
  EXPECT_EQ(scenario->title, "A capture with a foreign link type");
  EXPECT_EQ(scenario->description, "Two frames.");
  EXPECT_EQ(scenario->rules, std::vector<std::string>{"CP105"});
  EXPECT_EQ(scenario->silent, std::vector<std::string>{"CP101"});
  EXPECT_TRUE(scenario->shipped);
  ASSERT_EQ(scenario->expect.size(), 1U);
  EXPECT_FALSE(scenario->expect[0].any_node);
  EXPECT_EQ(scenario->expect[0].mac_id, -1);
  EXPECT_EQ(scenario->expect[0].channel, "main");
  EXPECT_EQ(scenario->expect[0].findings, 2U);
  EXPECT_EQ(scenario->expect[0].severity, "note");
  EXPECT_EQ(scenario->expect[0].cause, "CP104");
  EXPECT_NE(scenario->settings.find("communication_cycle_us = 500"), std::string::npos) << scenario->settings;
  EXPECT_NE(scenario->settings.find("[[rtex.axis]]"), std::string::npos) << scenario->settings;
}

TEST(ScenarioReader, NamesLineAndColumnOfEachMistake) {
  EXPECT_EQ(error_of("title = 3\n"), "s.toml:1:9: \"title\" must be a text");
  EXPECT_EQ(error_of("title = \"t\"\nshiped = true\n[[raw]]\n"), "s.toml:2:1: unknown key \"shiped\"");
  EXPECT_EQ(error_of("title = \"t\"\n[[raw]]\nlink_type = 70000\n"),
            "s.toml:3:13: \"link_type\" must be from 0 to 65535");
  EXPECT_EQ(error_of("title = \"t\"\n[[raw]]\nlink_type = 1\n[[raw.frame]]\nbytes = \"1\"\n"),
            "s.toml:5:9: \"bytes\" ends with half a byte");
  EXPECT_EQ(error_of("title = \"t\"\n[[raw]]\nlink_type = 1\n[[raw.frame]]\nat_ms = -1\n"),
            "s.toml:5:9: \"at_ms\" must be a time from 0 to one day");
  EXPECT_EQ(error_of("title = \"t\"\n[[raw]]\nlink_type = 1\n[[raw.frame]]\nwhen = 1\n"),
            "s.toml:5:1: unknown key \"when\"");
  EXPECT_EQ(error_of("title = \"t\"\n[[expect]]\nrule = \"CP999\"\n[[raw]]\n"),
            "s.toml:3:8: there is no rule \"CP999\"");
  EXPECT_EQ(error_of("title = \"t\"\nrules = [\"CP105\"]\n[[raw]]\nlink_type = 1\n"),
            "s.toml:2:9: \"rules\" names CP105, which no [[expect]] row does");
  EXPECT_EQ(error_of("[[raw]]\nlink_type = 1\n").substr(0, 11), "s.toml:1:1:");
  EXPECT_EQ(error_of("title = \"t\"\n"), "s.toml:1:1: a scenario needs a [[ring]], a [[can]] or a [[raw]] table");
  EXPECT_EQ(error_of("title = \"t\n").substr(0, 9), "s.toml:1:");
}

TEST(ScenarioReader, MergesBusesByTimeAndKeepsTheRecordersErrors) {
  Result<Scenario> scenario = parse_scenario(R"(title = "t"
[[raw]]
link_type = 9
frame = [{at_ms = 2, bytes = "02"}, {at_ms = 3, bytes = "03 04", original_length = 9, stamped_early_ms = 1.5}]
[[raw]]
link_type = 9
interface = "other"
frame = [{at_ms = 1, bytes = "01"}, {at_ms = 2, bytes = "FF"}]
)",
                                             "s.toml");
  ASSERT_TRUE(scenario) << scenario.error().text();
  Result<Simulation> simulation = simulate(*scenario);
  ASSERT_TRUE(simulation) << simulation.error().text();
  ASSERT_EQ(simulation->interfaces.size(), 2U);
  EXPECT_EQ(simulation->interfaces[0].name, "raw0");
  EXPECT_EQ(simulation->interfaces[1].name, "other");
  ASSERT_EQ(simulation->frames.size(), 4U);
  EXPECT_EQ(simulation->frames[0].bytes, std::vector<std::uint8_t>{0x01});
  EXPECT_EQ(simulation->frames[1].bytes, std::vector<std::uint8_t>{0x02});
  EXPECT_EQ(simulation->frames[2].bytes, std::vector<std::uint8_t>{0xFF});
  EXPECT_EQ(simulation->frames[3].original_length, 9U);
  EXPECT_EQ(simulation->frames[3].time_ns - simulation->frames[0].time_ns, 500'000);
}

}  // namespace
}  // namespace servotrace::simulator
