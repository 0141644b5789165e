// SPDX-License-Identifier: MIT
// The pages of a report: whole markup, every section in its order, the numbers of `check`, the documented JSON.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "tests/support/paths.hpp"
#include "tests/support/program.hpp"

namespace servotrace::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const std::vector<std::string>& scenarios() {
  static const std::vector<std::string> kNames = {"failure_lost_update",    "failure_cable",      "failure_limit",
                                                  "failure_duplicate_node", "mixed_can_and_ring", "esb_clean",
                                                  "cp103_records_lost"};
  return kNames;
}

class ReportPages : public ::testing::Test {
 protected:
  std::string page(const std::string& scenario, const std::string& ending) {
    program.simulate(scenario, "run");
    const Outcome outcome = program.run({"report", "run.pcapng", "-o", "run." + ending});
    EXPECT_EQ(outcome.status, 0) << scenario << outcome.err;
    return program.read("run." + ending);
  }
  Program program;
};

std::vector<std::string> all_matches(const std::string& text, const char* pattern) {
  const std::regex expression(pattern);
  std::vector<std::string> found;
  for (std::sregex_iterator it(text.begin(), text.end(), expression); it != std::sregex_iterator(); ++it)
    found.push_back((*it)[1].str());
  return found;
}

// Opening and closing tags match; ids are unique and links lead to one; nothing comes from outside.
void expect_whole(const std::string& html, const std::string& what) {
  const std::set<std::string> alone = {"meta", "br"};  // elements of a picture close themselves with a slash
  std::vector<std::string> open = {"html", "head", "style"};
  const std::string body = html.substr(html.find("</style>"));
  // By hand: a curve's points are too long for the recursion of std::regex.
  for (std::size_t at = body.find('<'); at != std::string::npos; at = body.find('<', at + 1)) {
    const bool closes = body[at + 1] == '/';
    const std::size_t begin = at + (closes ? 2 : 1);
    const std::size_t end = body.find('>', begin);
    ASSERT_NE(end, std::string::npos) << what;
    const std::string name =
        body.substr(begin, body.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789", begin) - begin);
    ASSERT_FALSE(name.empty()) << what << " near " << body.substr(at, 80);
    if (closes) {
      ASSERT_FALSE(open.empty()) << what << ": closes " << name;
      ASSERT_EQ(open.back(), name) << what << " near " << body.substr(at, 80);
      open.pop_back();
    } else if (body[end - 1] != '/' && alone.count(name) == 0) {
      open.push_back(name);
    }
  }
  EXPECT_TRUE(open.empty()) << what;
  std::set<std::string> ids;
  for (const std::string& id : all_matches(html, R"re( id="([^"]*)")re"))
    EXPECT_TRUE(ids.insert(id).second) << what << ": id twice: " << id;
  for (const std::string& link : all_matches(html, R"re( href="([^"]*)")re")) {
    ASSERT_TRUE(link.starts_with("#")) << what << ": a link outwards: " << link;
    EXPECT_TRUE(ids.count(link.substr(1)) == 1) << what << ": a link to nowhere: " << link;
  }
  EXPECT_THAT(html, Not(HasSubstr("<script")));
  EXPECT_THAT(html, Not(HasSubstr("src=")));
  EXPECT_THAT(html, Not(HasSubstr("url(")));
  EXPECT_THAT(html, Not(HasSubstr("@import")));
  EXPECT_EQ(all_matches(html, R"re(<(svg) [^>]*role="img" aria-label="[^"]+")re").size(),
            all_matches(html, "<(svg)").size())
      << what << ": a picture without an alternative text";
}

TEST_F(ReportPages, MarkupIsWhole) {
  for (const std::string& scenario : scenarios()) expect_whole(page(scenario, "html"), scenario);
}

// xmllint's parser is older than HTML 5: it does not know the names of some elements, everything else it must accept.
TEST_F(ReportPages, MarkupIsAccepted) {
  if (program.shell("command -v xmllint").status != 0) GTEST_SKIP() << "xmllint is not installed";
  for (const std::string& scenario : scenarios()) {
    page(scenario, "html");
    const Outcome outcome = program.shell(
        "xmllint --html --noout run.html 2>&1 | grep 'error :' | grep -v 'Tag [a-z]* "
        "invalid'");
    EXPECT_EQ(outcome.out, "") << scenario;
  }
}

TEST_F(ReportPages, SectionsStandInTheirOrder) {
  const std::string html = page("failure_lost_update", "html");
  std::size_t at = 0;
  for (const std::string title : {"Verdict", "First-out timeline", "Faults", "Axes and nodes", "The network",
                                  "Violations by rule", "What this capture cannot show"}) {
    const std::size_t next = html.find(">" + title + "</h2>");
    ASSERT_NE(next, std::string::npos) << title;
    EXPECT_GT(next, at) << title;
    at = next;
  }
  // Each as its name promises.
  EXPECT_THAT(html, HasSubstr("RTEX Update_Counter error"));
  EXPECT_THAT(html, HasSubstr("check cycles and updating ratio of controller and drive"));
  EXPECT_THAT(html, HasSubstr("Signals around the fault"));
  EXPECT_THAT(html, HasSubstr("Last command and response"));
  EXPECT_THAT(html, HasSubstr("Time between command records"));
  EXPECT_THAT(html, HasSubstr("Alarms read"));
}

// A frame of a ring is shown as the axis concerned sees it, and field by field with the bytes in question marked.
TEST_F(ReportPages, EvidenceIsShownInFull) {
  const std::string cable = page("failure_cable", "html");
  EXPECT_THAT(cable, HasSubstr("<b>388</b> axis 3 response"));
  EXPECT_THAT(cable, Not(HasSubstr("<b>388</b> axis 1")));
  const std::string lost = page("failure_lost_update", "html");
  EXPECT_THAT(lost, HasSubstr("in full</summary>"));
  EXPECT_THAT(lost, ::testing::ContainsRegex("<td>Update_Counter</td><td class=\"differs\">[0-3]</td>"));
}

// A drive that has not answered yet is no axis 0.
TEST_F(ReportPages, NoAxisThatIsNotThere) {
  const nlohmann::json report = nlohmann::json::parse(page("failure_lost_update", "json"))["captures"][0];
  for (const nlohmann::json& track : report["states"]) EXPECT_NE(track["node"]["mac_id"], 0) << track["field"];
  ASSERT_EQ(program.run({"export", "run.pcapng", "-o", "run.csv"}).status, 0);
  EXPECT_THAT(program.read("run.csv"), Not(HasSubstr("axis0")));
  EXPECT_THAT(program.read("run.csv"), HasSubstr("axis2"));
}

// Errors, warnings and every finding are those of `check`.
TEST_F(ReportPages, NumbersAgreeWithCheck) {
  for (const std::string& scenario : scenarios()) {
    const std::string html = page(scenario, "html");
    const nlohmann::json report = nlohmann::json::parse(page(scenario, "json"))["captures"][0];
    const nlohmann::json checked = nlohmann::json::parse(program.run({"check", "run.pcapng", "--output", "json"}).out);
    std::map<std::string, std::size_t> severities = {{"error", 0}, {"warning", 0}, {"note", 0}};
    std::multiset<std::string> from_check;
    const nlohmann::json& findings =
        checked.contains("findings") ? checked["findings"] : checked["captures"][0]["findings"];
    for (const nlohmann::json& finding : findings) {
      ++severities[finding["severity"]];
      from_check.insert(finding["rule"].get<std::string>() + " " + finding["frame"].dump() + " " +
                        finding["count"].dump() + " " + finding["message"].get<std::string>());
    }
    std::multiset<std::string> from_report;
    for (const nlohmann::json& finding : report["findings"]) {
      from_report.insert(finding["rule"].get<std::string>() + " " + finding["frame"].dump() + " " +
                         finding["count"].dump() + " " + finding["message"].get<std::string>());
    }
    EXPECT_EQ(from_report, from_check) << scenario;
    for (const auto& [name, count] : severities) {
      EXPECT_THAT(html, HasSubstr("<dt>" + name + "s</dt><dd>" + std::to_string(count) + "</dd>")) << scenario;
    }
  }
}

void keys_of(const nlohmann::json& value, std::set<std::string>& keys) {
  if (value.is_object()) {
    for (const auto& [key, member] : value.items()) {
      keys.insert(key);
      keys_of(member, keys);
    }
  } else if (value.is_array()) {
    for (const nlohmann::json& member : value) keys_of(member, keys);
  }
}

TEST_F(ReportPages, EveryMemberOfTheJsonIsDocumented) {
  std::set<std::string> keys;
  for (const std::string& scenario : scenarios()) keys_of(nlohmann::json::parse(page(scenario, "json")), keys);
  program.simulate("failure_parameter_overwritten", "other");
  ASSERT_EQ(program.run({"report", "run.pcapng", "--against", "other.pcapng", "-o", "both.json"}).status, 0);
  keys_of(nlohmann::json::parse(program.read("both.json")), keys);
  const Outcome page = program.shell("cat '" + (source_dir() / "decoder" / "docs" / "report-json.md").string() + "'");
  ASSERT_EQ(page.status, 0);
  for (const std::string& key : keys) EXPECT_THAT(page.out, HasSubstr("`" + key + "`")) << key;
}

TEST_F(ReportPages, SeveralCapturesHaveAnOverview) {
  program.simulate("failure_cable", "a");
  program.simulate("rtex_clean", "b");
  const Outcome outcome = program.run({"report", "a.pcapng", "b.pcapng", "-o", "all.html"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::string html = program.read("all.html");
  expect_whole(html, "overview");
  EXPECT_THAT(html, HasSubstr("<td><a href=\"#c1\">a.pcapng</a></td><td>Axis 3 failed first"));
  EXPECT_THAT(html, HasSubstr("<td><a href=\"#c2\">b.pcapng</a></td><td>Nothing failed"));
  ASSERT_EQ(program.run({"report", "a.pcapng", "b.pcapng", "-o", "all.md"}).status, 0);
  EXPECT_THAT(program.read("all.md"), HasSubstr("| b.pcapng | Nothing failed, and no rule was broken"));
}

TEST_F(ReportPages, TwoCapturesPartWhereTheAlarmRises) {
  program.simulate("failure_parameter_overwritten", "bad");
  // The same run, without what went wrong.
  std::string text =
      program
          .shell("cat '" + (source_dir() / "captures" / "scenarios" / "failure_parameter_overwritten.toml").string() +
                 "'")
          .out;
  const auto drop = [&text](const std::string& line) {
    const std::size_t at = text.find(line);
    ASSERT_NE(at, std::string::npos) << line;
    text.erase(at, text.find('\n', at) + 1 - at);
  };
  drop("  {do = \"parameter_write\"");
  drop("  {do = \"drive\", alarm");
  program.write("good.toml", text);
  ASSERT_EQ(program.run({"simulate", "good.toml", "-o", "good.pcapng"}).status, 0);
  const Outcome outcome = program.run({"report", "good.pcapng", "--against", "bad.pcapng", "-o", "part.json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json report = nlohmann::json::parse(program.read("part.json"))["captures"][0];
  const nlohmann::json& comparison = report["comparison"];
  EXPECT_EQ(comparison["file"], "bad.pcapng");
  bool alarm = false;
  for (const nlohmann::json& row : comparison["partings"]) {
    if (row["state"] != "Alarm") continue;
    alarm = true;
    EXPECT_EQ(row["here"], "stays 0");
    EXPECT_EQ(row["there"], "1");
    EXPECT_FALSE(row.contains("here_frame"));
    EXPECT_TRUE(row.contains("there_frame"));
  }
  EXPECT_TRUE(alarm);
  bool parameter = false;
  for (const nlohmann::json& row : comparison["settings"]) {
    if (row["setting"] != "Pr0.13 1st torque limit") continue;
    parameter = true;
    EXPECT_EQ(row["here"], "300");
    EXPECT_EQ(row["there"], "5");
  }
  EXPECT_TRUE(parameter);
  ASSERT_EQ(program.run({"report", "good.pcapng", "--against", "bad.pcapng", "-o", "part.html"}).status, 0);
  const std::string html = program.read("part.html");
  expect_whole(html, "against");
  EXPECT_THAT(html, HasSubstr("Where the captures part"));
  // A capture beside itself parts nowhere.
  ASSERT_EQ(program.run({"report", "bad.pcapng", "--against", "bad.pcapng", "-o", "same.html"}).status, 0);
  EXPECT_THAT(program.read("same.html"), HasSubstr("States, settings and findings agree."));
  EXPECT_EQ(program.run({"report", "bad.pcapng", "good.pcapng", "--against", "bad.pcapng", "-o", "x.html"}).status, 2);
}

// The trace decodes with the tool of the format's makers, and begins with descriptors of tracks.
TEST_F(ReportPages, PerfettoTraceDecodesWithProtoc) {
  if (program.shell("command -v protoc").status != 0) GTEST_SKIP() << "protoc is not installed";
  program.simulate("mixed_can_and_ring", "run");
  ASSERT_EQ(program.run({"export", "run.pcapng", "-o", "run.pftrace"}).status, 0);
  const Outcome outcome = program.shell("protoc --decode_raw < run.pftrace");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(outcome.out.starts_with("1 {\n  60 {\n    1: 1\n    2: \"ring0\"\n")) << outcome.out.substr(0, 200);
  EXPECT_THAT(outcome.out, HasSubstr("2: \"can0\""));
  EXPECT_THAT(outcome.out, HasSubstr("23: \"Servo_On\""));  // a slice's name
  EXPECT_THAT(outcome.out, HasSubstr("44: 0x"));            // a counter's value
}

}  // namespace
}  // namespace servotrace::test
