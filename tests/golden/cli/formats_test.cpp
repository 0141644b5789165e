// SPDX-License-Identifier: MIT
// Every output format: read back by an independent reader, the same findings in each, the same bytes each time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/paths.hpp"
#include "tests/support/program.hpp"

namespace servotrace::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class Formats : public ::testing::Test {
 protected:
  void SetUp() override {
    program.simulate("cp104_malformed_records", "run");
    program.simulate("rtex_clean", "clean");
  }
  std::string output(const std::string& format, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"check", "run.pcapng", "clean.pcapng", "--output", format};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome first = program.run(arguments);
    const Outcome second = program.run(arguments);
    EXPECT_EQ(first.status, 0) << first.err;
    EXPECT_EQ(first.out, second.out);
    return first.out;
  }

  Program program;
};

std::vector<json> lines_of(const std::string& text) {
  std::vector<json> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(json::parse(line));
  return lines;
}

TEST_F(Formats, JsonLinesHoldEverythingOfTheInterface) {
  std::size_t captures = 0;
  std::vector<json> findings;
  std::size_t rules = 0;
  const std::vector<json> lines = lines_of(output("jsonl"));
  for (const json& line : lines) {
    if (line["type"] == "capture") {
      ++captures;
      EXPECT_EQ(line["format"], "pcapng");
      EXPECT_EQ(line["link_types"], json::array({252}));
      EXPECT_GT(line["frames"], 0);
      EXPECT_TRUE(line["first_time"].is_string());
    }
    if (line["type"] == "finding") findings.push_back(line);
    if (line["type"] == "rule") ++rules;
  }
  EXPECT_EQ(captures, 2U);
  EXPECT_GT(rules, 8U);
  ASSERT_EQ(findings.size(), 2U);
  const json& finding = findings[0];
  EXPECT_EQ(finding["file"], "run.pcapng");
  EXPECT_EQ(finding["rule"], "CP104");
  EXPECT_EQ(finding["slug"], "malformed-record");
  EXPECT_EQ(finding["severity"], "warning");
  EXPECT_EQ(finding["actor"], "capture");
  EXPECT_TRUE(finding["node"]["bus"].is_null());
  EXPECT_TRUE(finding["node"]["mac_id"].is_null());
  EXPECT_EQ(finding["count"], 1);
  EXPECT_EQ(finding["frame"], finding["last_frame"]);
  EXPECT_LT(finding["frame"], findings[1]["frame"]);
  EXPECT_THAT(finding["message"].get<std::string>(), StartsWith("malformed record: "));
  EXPECT_TRUE(finding["related"].is_array());
  const std::string time = finding["time"];
  EXPECT_EQ(time.size() - time.find('.'), 10U);
  const json& end = lines.back();
  EXPECT_EQ(end["type"], "end");
  EXPECT_EQ(end["verdict"], "findings");
  EXPECT_EQ(end["errors"], 0);
  EXPECT_EQ(end["warnings"], 2);
  EXPECT_EQ(end["exit_status"], 0);
}

TEST_F(Formats, JsonIsTheSameAsOneDocument) {
  const json document = json::parse(output("json"));
  ASSERT_EQ(document["captures"].size(), 2U);
  EXPECT_EQ(document["captures"][0]["file"], "run.pcapng");
  std::vector<json> from_lines;
  for (json line : lines_of(output("jsonl"))) {
    if (line["type"] != "finding") continue;
    line.erase("type");
    line.erase("file");
    from_lines.push_back(line);
  }
  EXPECT_EQ(document["captures"][0]["findings"], json(from_lines));
  EXPECT_EQ(document["end"]["verdict"], "findings");
}

TEST_F(Formats, SarifPointsAtBytes) {
  const json sarif = json::parse(output("sarif"));
  EXPECT_EQ(sarif["version"], "2.1.0");
  const json& run = sarif["runs"][0];
  const json& rules = run["tool"]["driver"]["rules"];
  EXPECT_GT(rules.size(), 4U);
  ASSERT_EQ(run["results"].size(), 2U);
  for (const json& result : run["results"]) {
    EXPECT_EQ(rules[result["ruleIndex"].get<std::size_t>()]["id"], result["ruleId"]);
    const json& place = result["locations"][0]["physicalLocation"];
    EXPECT_EQ(place["artifactLocation"]["uri"], "run.pcapng");
    // The frame's bytes: an exported PDU of the RTEX record.
    const std::string file = program.read("run.pcapng");
    const auto offset = place["region"]["byteOffset"].get<std::size_t>();
    const auto length = place["region"]["byteLength"].get<std::size_t>();
    ASSERT_LE(offset + length, file.size());
    EXPECT_NE(file.substr(offset, length).find("RTEX"), std::string::npos);
    EXPECT_EQ(result["level"], "warning");
  }
  EXPECT_NE(run["results"][0]["partialFingerprints"], run["results"][1]["partialFingerprints"]);
  EXPECT_EQ(run["invocations"][0]["executionSuccessful"], true);
  EXPECT_EQ(run["invocations"][0]["exitCode"], 0);
}

TEST_F(Formats, SarifForGithubHasLinesAndCollapses) {
  const json run = json::parse(output("sarif-github"))["runs"][0];
  ASSERT_EQ(run["results"].size(), 1U);
  const json& result = run["results"][0];
  EXPECT_EQ(result["locations"][0]["physicalLocation"]["region"]["startLine"], result["properties"]["frame"]);
  EXPECT_THAT(result["message"]["text"].get<std::string>(), HasSubstr("(first of 2 findings)"));
  EXPECT_TRUE(result["partialFingerprints"].contains("primaryLocationLineHash"));
}

TEST_F(Formats, JunitCountsFailuresAndSkips) {
  program.write("r.xml", output("junit", {"--fail-on", "never"}));
  const Outcome lint = program.shell("xmllint --noout --schema '" +
                                     (source_dir() / "tests" / "golden" / "cli" / "junit.xsd").string() + "' r.xml");
  EXPECT_EQ(lint.status, 0) << lint.err;
  const Outcome failing = program.run({"check", "run.pcapng", "--output", "junit", "--fail-on", "warning"});
  EXPECT_EQ(failing.status, 1);
  EXPECT_THAT(failing.out, HasSubstr("failures=\"1\" errors=\"0\""));
  EXPECT_THAT(failing.out, HasSubstr("<testcase classname=\"run.pcapng\" name=\"CP104 malformed-record\" time=\"0\">\n"
                                     "      <failure message=\"2 findings: A record is malformed\" type=\"warning\">"));
  EXPECT_THAT(failing.out, HasSubstr("<skipped/>"));
  program.write("notes.pcapng", "no capture <&>");
  const Outcome broken = program.run({"check", "notes.pcapng", "--output", "junit=broken.xml"});
  EXPECT_EQ(broken.status, 2);
  EXPECT_THAT(program.read("broken.xml"), HasSubstr("<error message=\"notes.pcapng: "));
}

TEST_F(Formats, GithubAnnotationsWorstFirst) {
  program.write("servotrace.toml", "[rules]\nseverity = { CP104 = \"error\" }\n");
  program.simulate("cp102_time_backwards", "a,b");
  const Outcome outcome = program.run({"check", "a,b.pcapng", "run.pcapng", "--output", "github"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, StartsWith("::error file=run.pcapng,line="));
  EXPECT_THAT(outcome.out, HasSubstr(",title=CP104 malformed-record::malformed record: "));
  EXPECT_THAT(outcome.out, HasSubstr("\n::warning file=a%2Cb.pcapng,line="));
}

TEST_F(Formats, MarkdownListsRulesAndCaptures) {
  const std::string text = output("markdown");
  EXPECT_THAT(text, StartsWith("## servotrace: findings\n\n0 errors, 2 warnings, 0 notes in "));
  EXPECT_THAT(text, HasSubstr("\n| CP104 | warning | 2 | 1 | A record is malformed | run.pcapng:"));
  EXPECT_THAT(text, HasSubstr("\n| run.pcapng | "));
  EXPECT_EQ(text.find("| clean.pcapng |"), std::string::npos);
}

TEST_F(Formats, SeveralAtOnceIntoFiles) {
  const Outcome outcome = program.run({"check", "run.pcapng", "--output", "text", "--output", "jsonl=a.jsonl",
                                       "--output", "sarif=a.sarif", "--output", "junit=a.xml"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, StartsWith("run.pcapng:"));
  EXPECT_EQ(program.read("a.jsonl"), program.run({"check", "run.pcapng", "--output", "jsonl"}).out);
  EXPECT_EQ(program.read("a.sarif"), program.run({"check", "run.pcapng", "--output", "sarif"}).out);
  EXPECT_EQ(program.read("a.xml"), program.run({"check", "run.pcapng", "--output", "junit"}).out);
}

TEST_F(Formats, MergeIsAssociativeAndIndependentOfOrder) {
  program.simulate("cp102_time_backwards", "other");
  ASSERT_EQ(program.run({"check", "run.pcapng", "--output", "jsonl=1.jsonl"}).status, 0);
  ASSERT_EQ(program.run({"check", "clean.pcapng", "--output", "jsonl=2.jsonl"}).status, 0);
  ASSERT_EQ(program.run({"check", "other.pcapng", "--output", "jsonl=3.jsonl"}).status, 0);
  const std::string all = program.run({"merge", "1.jsonl", "2.jsonl", "3.jsonl"}).out;
  EXPECT_EQ(program.run({"merge", "3.jsonl", "1.jsonl", "2.jsonl"}).out, all);
  program.write("12.jsonl", program.run({"merge", "2.jsonl", "1.jsonl"}).out);
  EXPECT_EQ(program.run({"merge", "12.jsonl", "3.jsonl"}).out, all);
  // The same as one check of all, in the order of the names.
  const std::vector<std::string> check{"check", "clean.pcapng", "other.pcapng", "run.pcapng", "--output"};
  for (const std::string format : {"jsonl", "json", "sarif", "sarif-github", "junit", "github", "markdown"}) {
    std::vector<std::string> once = check;
    once.push_back(format);
    EXPECT_EQ(program.run({"merge", "1.jsonl", "2.jsonl", "3.jsonl", "--output", format}).out, program.run(once).out)
        << format;
  }
}

TEST_F(Formats, MergeRefusesWhatIsCutOrForeign) {
  ASSERT_EQ(program.run({"check", "run.pcapng", "--output", "jsonl=1.jsonl"}).status, 0);
  std::string text = program.read("1.jsonl");
  program.write("cut.jsonl", text.substr(0, text.rfind("{\"type\":\"end\"")));
  EXPECT_EQ(program.run({"merge", "cut.jsonl"}).err,
            "servotrace: cut.jsonl: has no 'end' line: the check that wrote it did not finish\n");
  program.write("foreign.jsonl", "not JSON\n");
  EXPECT_EQ(program.run({"merge", "foreign.jsonl"}).status, 2);
}

TEST_F(Formats, AnnotateWritesCommentsOnTheSameFrames) {
  const Outcome outcome = program.run({"annotate", "run.pcapng", "-o", "annotated.pcapng"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  // The same findings in the same frames: comments change nothing of the traffic.
  const auto findings = [&](const std::string& file) {
    std::vector<json> found;
    for (json line : lines_of(program.run({"check", file, "--output", "jsonl"}).out)) {
      if (line["type"] != "finding") continue;
      for (const char* const key : {"file", "byte_offset", "byte_length"}) line.erase(key);
      found.push_back(line);
    }
    return found;
  };
  const std::vector<json> before = findings("run.pcapng");
  EXPECT_EQ(findings("annotated.pcapng"), before);
  EXPECT_THAT(program.read("annotated.pcapng"), HasSubstr("warning[CP104] malformed record: "));
  if (program.shell("command -v tshark").status != 0) GTEST_SKIP() << "no tshark";
  const Outcome tshark = program.shell(
      "HOME=/nonexistent tshark -r annotated.pcapng -Y frame.comment -T fields -e frame.number -e frame.comment");
  for (const json& finding : before) {
    EXPECT_THAT(tshark.out, HasSubstr(std::to_string(finding["frame"].get<std::uint64_t>()) + "\twarning[CP104]"));
  }
}

TEST_F(Formats, DecodeShowsEveryField) {
  const Outcome text = program.run({"decode", "clean.pcapng", "--frames", "1-2"});
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_THAT(text.out, StartsWith("1 "));
  EXPECT_THAT(text.out, HasSubstr("RTEX record header\n    Magic: \"RTEX\"\n    Version: 1\n"));
  EXPECT_THAT(text.out, HasSubstr("    Update_Counter: "));
  const Outcome lines = program.run({"decode", "clean.pcapng", "--frames", "1-2", "--format", "jsonl"});
  const std::vector<json> frames = lines_of(lines.out);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0]["frame"], 1);
  EXPECT_EQ(frames[0]["protocol"], "rtex");
  EXPECT_EQ(frames[0]["bus"], "ring0");
  EXPECT_EQ(frames[0]["segments"][0]["fields"]["version"]["value"], 1);
  const Outcome brief = program.run({"decode", "clean.pcapng", "--frames", "3", "--brief"});
  EXPECT_EQ(std::count(brief.out.begin(), brief.out.end(), '\n'), 1);
}

// ESB 5.3.1: a channel that is edited, line by line, in the manual's notation; read out again, the same.
TEST_F(Formats, DecodeOfAProgramEditPrintsTheProgram) {
  program.simulate("nk203_silent", "edit");
  program.write("servotrace.toml", "[[devicenet.node]]\nmac_id = 9\nprofile = \"nsk-esb\"\n");
  const Outcome text = program.run({"decode", "edit.pcapng", "--config", "servotrace.toml"});
  EXPECT_EQ(text.status, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("IR/EX100/4&, CV1.0000, CA1.00]\n")) << "611 with 660 to 663";
}

// A sub-command channel at rest says nothing; a monitored quantity is in the sentence.
TEST_F(Formats, BriefOfMonitorsAndTheSubChannel) {
  program.simulate("rtex_clean_wide", "wide");
  const Outcome brief = program.run({"decode", "wide.pcapng", "--brief"});
  EXPECT_THAT(brief.out, Not(HasSubstr("type code 00h, index 0")));
  program.write("monitor.toml",
                "title = \"Monitors\"\nsilent = [\"RX308\"]\n[[ring]]\ncycle_us = 500\naxis = [{mac_id = 1}]\n"
                "step = [{do = \"wait\", cycles = 40}, {do = \"monitor\", type = 0x62}]\n");
  ASSERT_EQ(program.run({"simulate", "monitor.toml", "-o", "monitor.pcapng"}).status, 0);
  EXPECT_THAT(program.run({"decode", "monitor.pcapng", "--brief"}).out, HasSubstr("Servo driver temperature 41 degC"));
}

TEST_F(Formats, InfoTellsBusesAndTimes) {
  const Outcome text = program.run({"info", "clean.pcapng"});
  EXPECT_EQ(text.status, 0);
  EXPECT_THAT(text.out, StartsWith("clean.pcapng\n  format: pcapng\n"));
  EXPECT_THAT(text.out, HasSubstr("\n  bus ring0: rtex"));
  for (const json& line : lines_of(program.run({"info", "clean.pcapng", "--format", "jsonl"}).out)) {
    EXPECT_TRUE(line.contains("type"));
  }
}

TEST_F(Formats, RulesAndExplain) {
  const json rules = json::parse(program.run({"rules", "--format", "json"}).out);
  ASSERT_GT(rules.size(), 4U);
  const Outcome text = program.run({"rules"});
  EXPECT_EQ(static_cast<std::size_t>(std::count(text.out.begin(), text.out.end(), '\n')), rules.size());
  for (const json& rule : rules) {
    const Outcome page = program.run({"explain", rule["id"].get<std::string>()});
    ASSERT_EQ(page.status, 0);
    EXPECT_THAT(page.out, HasSubstr(rule["slug"].get<std::string>()));
    EXPECT_THAT(page.out, HasSubstr("Why it matters"));
    if (rule["id"] == "CP105") break;  // one block is enough: every page is made by one function
  }
  EXPECT_THAT(program.run({"explain", "malformed-record"}).out, StartsWith("CP104 malformed-record\n"));
  EXPECT_THAT(program.run({"explain", "malformd-record"}).err, HasSubstr("(did you mean 'CP104', malformed-record?)"));
  EXPECT_THAT(program.run({"explain", "YS901"}).out,
              HasSubstr("\nCodes\n    01h (Power Element Error)\n        MS flashes red; SGDH: A.03 main circuit"));
  EXPECT_THAT(program.run({"explain", "RX902"}).out, HasSubstr("\n    83.0 (RTEX continuous communication error 1)\n"));
  EXPECT_THAT(program.run({"explain", "NK901"}).out, HasSubstr("\n    F1 Excess position error\n        DRDY = 0, "));
  EXPECT_THAT(program.run({"rules", "--format", "markdown"}).out, HasSubstr("\n| CP101 | warning | capture | "));
}

TEST_F(Formats, HelpOfEveryCommand) {
  const Outcome all = program.run({"--help"});
  EXPECT_EQ(all.status, 0);
  for (const std::string command : {"check", "decode", "info", "explain", "rules", "simulate", "annotate", "merge"}) {
    EXPECT_THAT(all.out, HasSubstr("\n  " + command + " "));
    const Outcome help = program.run({command, "--help"});
    EXPECT_EQ(help.status, 0);
    EXPECT_THAT(help.out, HasSubstr("servotrace " + command));
  }
}

}  // namespace
}  // namespace servotrace::test
