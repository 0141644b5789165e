// SPDX-License-Identifier: MIT
// The verdict of a report names the true cause first: ten failures as they happen, each written by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "tests/support/paths.hpp"
#include "tests/support/program.hpp"
#include "tests/support/scenarios.hpp"

namespace servotrace::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

struct Expected {
  std::string scenario;
  std::string kind;   // of the verdict
  std::string first;  // rule of what failed first
  int mac_id;
  std::string who;    // the headline begins with it
  std::string what;   // and holds this
  std::string cause;  // rule of the likeliest cause, or
  std::string parameter;
  int cause_mac_id;
  std::string why;  // in the text of that cause
};

class FailureReports : public ::testing::TestWithParam<Expected> {};

nlohmann::json report_of(const Program& program, const std::string& scenario) {
  const simulator::Scenario read = load_scenario(source_dir() / "captures" / "scenarios" / (scenario + ".toml"));
  program.write("servotrace.toml", read.settings);
  program.simulate(scenario, "run");
  const Outcome outcome = program.run({"report", "run.pcapng", "-o", "run.json"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return nlohmann::json::parse(program.read("run.json"))["captures"][0];
}

TEST_P(FailureReports, NameTheTrueCauseFirst) {
  const Expected& expected = GetParam();
  const Program program;
  const nlohmann::json report = report_of(program, expected.scenario);
  const nlohmann::json& verdict = report["verdict"];
  EXPECT_EQ(verdict["kind"], expected.kind);
  const std::string headline = verdict["headline"];
  EXPECT_THAT(headline, HasSubstr(expected.who));
  EXPECT_THAT(headline, HasSubstr(expected.what));
  EXPECT_EQ(verdict["first"]["rule"], expected.first);
  EXPECT_EQ(verdict["first"]["node"]["mac_id"], expected.mac_id);
  ASSERT_TRUE(verdict.contains("cause")) << verdict.dump(1);
  const nlohmann::json& cause = verdict["cause"];
  EXPECT_EQ(cause["supported"], true);
  EXPECT_EQ(cause["node"]["mac_id"], expected.cause_mac_id);
  EXPECT_THAT(std::string(cause["text"]), HasSubstr(expected.why));
  if (expected.parameter.empty()) {
    EXPECT_EQ(cause["rule"], expected.cause);
  } else {
    EXPECT_THAT(std::string(cause["parameter"]), StartsWith(expected.parameter));
    EXPECT_LT(cause["frame"], verdict["first"]["frame"]);
  }
  // The verdict is the first fault's first supported cause, or of a capture without faults its gravest violation.
  if (expected.kind == "fault") {
    EXPECT_EQ(report["faults"][0]["frame"], verdict["first"]["frame"]);
    EXPECT_EQ(report["faults"][0]["causes"][0], cause);
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, FailureReports,
    ::testing::Values(Expected{"failure_lost_update", "fault", "RX902", 2, "Axis 2 (Y) failed first",
                               "86.2 RTEX Update_Counter error", "RX201", "", 2,
                               "did not update Update_Counter in time"},
                      Expected{"failure_mode_change_in_motion", "fault", "RX902", 1, "Axis 1 failed first",
                               "91.1 RTEX command error", "RX404", "", 1,
                               "control mode was changed during a profile motion"},
                      Expected{"failure_cable", "fault", "RX110", 3, "Axis 3 failed first",
                               "CRC error responses on 3 consecutive", "RX101", "", 3, "only place 3 of the 4"},
                      Expected{"failure_parameter_overwritten", "fault", "RX902", 1, "Axis 1 failed first",
                               "24.0 position deviation excess", "", "Pr0.13 ", 1, "1st torque limit was changed"},
                      Expected{"failure_homing_half_done", "fault", "RX902", 1, "Axis 1 failed first",
                               "94.2 homing error", "RX503", "", 1, "homing was abandoned"},
                      Expected{"failure_poll_timeout", "fault", "DN204", 5, "Node 5 (axis) failed first",
                               "no poll command for 2008", "DN204", "", 5, "the master let the connection run out"},
                      Expected{"failure_limit", "fault", "YS901", 5, "Node 5 (axis) failed first",
                               "alarm 0Ah Over Load", "YS201", "", 5, "started into an active limit"},
                      Expected{"failure_duplicate_node", "fault", "DN102", 7, "Node 7 (plain) failed first",
                               "vendor 700", "DN102", "", 7, "second device with this MAC ID"},
                      Expected{"failure_servo_on_jump", "fault", "RX902", 2, "Axis 2 (lift) failed first",
                               "26.0 over-speed", "RX702", "", 2, "the axis jumped"},
                      Expected{"failure_endless_block", "violations", "YS304", 5, "node 5 (axis)",
                               "never ends and never waits", "YS304", "", 5, "chain of command blocks"}),
    [](const ::testing::TestParamInfo<Expected>& row) { return row.param.scenario; });

// The alarm counts from its rise, though its code is read (and the finding made) later.
TEST(FailureReportsTimes, AnAlarmIsDatedByItsRise) {
  const Program program;
  const nlohmann::json report = report_of(program, "failure_limit");
  const nlohmann::json& fault = report["faults"][0];
  std::uint64_t risen = 0;
  for (const nlohmann::json& track : report["states"]) {
    if (!std::string(track["field"]).ends_with(".alarm")) continue;
    for (const nlohmann::json& change : track["changes"])
      risen = risen == 0 ? change["frame"].get<std::uint64_t>() : risen;
  }
  ASSERT_NE(risen, 0U);
  EXPECT_EQ(fault["began_frame"], risen);
  EXPECT_LT(fault["began_frame"], fault["frame"]);
  EXPECT_LT(std::string(fault["began"]), std::string(fault["time"]));
  EXPECT_THAT(std::string(report["verdict"]["headline"]),
              HasSubstr(" (frame " + std::to_string(risen) + "): alarm 0Ah"));
  for (const nlohmann::json& pair : fault["messages"]) EXPECT_LE(pair["frame"], risen);
}

// Without its profile a drive is not judged, and a verdict that finds nothing says so; with it there is nothing to say.
TEST(FailureReportsTimes, AVerdictDoesNotClearADriveItDoesNotKnow) {
  const Program program;
  program.simulate("failure_limit", "run");
  program.simulate("esb_clean", "known");
  const auto said = [&](const std::string& capture, const std::vector<std::string>& more) {
    std::vector<std::string> command = {"report", capture, "-o", "run.json"};
    command.insert(command.end(), more.begin(), more.end());
    const Outcome outcome = program.run(command);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const nlohmann::json report = nlohmann::json::parse(program.read("run.json"))["captures"][0];
    EXPECT_EQ(report["verdict"]["kind"], "clean") << capture;
    return report["verdict"]["headline"].dump() + report["cannot_show"].dump();
  };
  const std::string unknown = said("run.pcapng", {});
  EXPECT_THAT(unknown, HasSubstr("was not judged of node 5."));
  EXPECT_THAT(unknown, HasSubstr("Node 5 on can0: its drive is not known"));
  program.write("known.toml", load_scenario(source_dir() / "captures" / "scenarios" / "esb_clean.toml").settings);
  EXPECT_THAT(said("known.pcapng", {"--config", "known.toml"}),
              ::testing::Not(::testing::AnyOf(HasSubstr("judged of"), HasSubstr("no rule of a drive"))));
}

// The close-up of a silence begins at the last message before it, and the node's last words are shown beside others of
// their kind.
TEST(FailureReportsTimes, ASilenceIsShownFromItsBeginning) {
  const Program program;
  const nlohmann::json report = report_of(program, "failure_poll_timeout");
  bool response = false;
  for (const nlohmann::json& pair : report["faults"][0]["messages"]) {
    if (pair["direction"] != "response") continue;
    response = true;
    EXPECT_TRUE(pair.contains("before_frame"));
    EXPECT_LT(pair["frame"], report["faults"][0]["frame"]);
  }
  EXPECT_TRUE(response);
  ASSERT_EQ(program.run({"report", "run.pcapng", "-o", "run.html"}).status, 0);
  const std::string html = program.read("run.html");
  const std::size_t window = html.find("The window before it");
  ASSERT_NE(window, std::string::npos);
  EXPECT_THAT(html.substr(window),
              HasSubstr("<text x=\"4.0\" y=\"20.0\" class=\"lane-name\" text-anchor=\"start\">Current Speed"));
}

// Every scenario of a failure has its line above.
TEST(FailureReportsList, IsWhole) {
  std::size_t failures = 0;
  for (const std::filesystem::path& file : scenario_files()) {
    failures += file.stem().string().starts_with("failure_") ? 1 : 0;
  }
  EXPECT_EQ(failures, 10U);
}

}  // namespace
}  // namespace servotrace::test
