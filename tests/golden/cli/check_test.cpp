// SPDX-License-Identifier: MIT
// `servotrace check`: text, exit statuses, options, and bad input of every kind.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/program.hpp"

namespace servotrace::test {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

class Check : public ::testing::Test {
 protected:
  Program program;
};

std::vector<nlohmann::json> lines_of(const std::string& text) {
  std::vector<nlohmann::json> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(nlohmann::json::parse(line));
  return lines;
}

// What a drive says is judged where the drive is known; a verdict without that must not sound like one with it.
TEST_F(Check, TellsOfDrivesItDidNotJudge) {
  program.simulate("failure_limit", "run");
  const std::string told = "; no rule of a drive was applied to 1 node whose drive is not known for certain";
  const Outcome unknown = program.run({"check", "run.pcapng"});
  EXPECT_EQ(unknown.status, 0);
  EXPECT_THAT(unknown.out, HasSubstr(told));
  program.write("known.toml", "[[devicenet.node]]\nmac_id = 5\nprofile = \"yaskawa-ns310\"\n");
  const Outcome known = program.run({"check", "run.pcapng", "--config", "known.toml"});
  EXPECT_EQ(known.status, 1);
  EXPECT_THAT(known.out, ::testing::Not(HasSubstr("no rule of a drive")));
}

TEST_F(Check, CleanCaptureIsOneLineAndZero) {
  program.simulate("rtex_clean", "clean");
  const Outcome outcome = program.run({"check", "clean.pcapng"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, StartsWith("clean: no findings in "));
  EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 1);
  EXPECT_THAT(outcome.err, IsEmpty());
}

TEST_F(Check, TextNamesFrameRuleAndEvidence) {
  program.simulate("cp102_time_backwards", "run");
  const Outcome outcome = program.run({"check", "run.pcapng"});
  EXPECT_EQ(outcome.status, 0);  // a warning, and --fail-on is error
  EXPECT_THAT(outcome.out, StartsWith("run.pcapng:"));
  EXPECT_THAT(outcome.out, HasSubstr(" warning[CP102] the timestamp is "));
  EXPECT_THAT(outcome.out, HasSubstr("\n  > "));  // the evidence
  EXPECT_THAT(outcome.out, HasSubstr("\nrule   severity findings  nodes  first frame"));
  EXPECT_THAT(outcome.out, HasSubstr("\nfindings: 0 errors, 1 warning, 0 notes in "));
}

TEST_F(Check, FailOnDecidesTheStatus) {
  program.simulate("cp102_time_backwards", "run");
  EXPECT_EQ(program.run({"check", "run.pcapng", "--fail-on", "error"}).status, 0);
  EXPECT_EQ(program.run({"check", "run.pcapng", "--fail-on", "warning"}).status, 1);
  EXPECT_EQ(program.run({"check", "run.pcapng", "--fail-on", "note"}).status, 1);
  EXPECT_EQ(program.run({"check", "run.pcapng", "--fail-on", "never"}).status, 0);
  program.simulate("rx902_alarm", "alarm");
  EXPECT_EQ(program.run({"check", "alarm.pcapng"}).status, 1);
  EXPECT_EQ(program.run({"check", "alarm.pcapng", "--fail-on", "never"}).status, 0) << "not even for an error";
  const Outcome wrong = program.run({"check", "run.pcapng", "--fail-on", "fatal"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_EQ(wrong.err, "servotrace: --fail-on: 'fatal': must be error, warning, note or never\n");
}

TEST_F(Check, SelectIgnoreAndActor) {
  program.simulate("cp102_time_backwards", "run");
  EXPECT_EQ(program.run({"check", "run.pcapng", "--fail-on", "note", "--ignore", "CP102"}).status, 0);
  EXPECT_EQ(program.run({"check", "run.pcapng", "--fail-on", "note", "--ignore", "CP"}).status, 0);
  EXPECT_EQ(program.run({"check", "run.pcapng", "--fail-on", "note", "--select", "CP101,CP103"}).status, 0);
  EXPECT_EQ(program.run({"check", "run.pcapng", "--fail-on", "note", "--select", "CP1"}).status, 1);
  EXPECT_EQ(program.run({"check", "run.pcapng", "--fail-on", "note", "--actor", "master,drive"}).status, 0);
  EXPECT_EQ(program.run({"check", "run.pcapng", "--fail-on", "note", "--actor", "capture"}).status, 1);
  EXPECT_EQ(program.run({"check", "run.pcapng", "--select", "QQ9"}).err, "servotrace: --select: no rule 'QQ9'\n");
  EXPECT_EQ(program.run({"check", "run.pcapng", "--actor", "slave"}).err,
            "servotrace: --actor: 'slave': must be master, drive, network or capture\n");
}

TEST_F(Check, SettingsAreFoundUpwardAndObeyed) {
  program.simulate("cp102_time_backwards", "run");
  program.write("servotrace.toml", "[rules]\nseverity = { CP102 = \"error\" }\n");
  const Outcome found = program.run({"check", "run.pcapng"});
  EXPECT_EQ(found.status, 1);
  EXPECT_THAT(found.out, HasSubstr("error[CP102]"));
  program.write("other.toml", "[rules]\nignore = [\"CP102\"]\n");
  EXPECT_EQ(program.run({"check", "run.pcapng", "--config", "other.toml"}).status, 0);
}

TEST_F(Check, BrokenSettingsAreOneLineWithTheirPlace) {
  program.simulate("cp102_time_backwards", "run");
  program.write("servotrace.toml", "[limits]\nechoms = 5\n");
  const Outcome outcome = program.run({"check", "run.pcapng"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.out, IsEmpty());
  EXPECT_THAT(outcome.err,
              EndsWith("servotrace.toml:2:1: unknown key 'echoms' in [limits] (did you mean 'echo_ms'?)\n"));
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1);
  EXPECT_EQ(program.run({"check", "run.pcapng", "--config", "none.toml"}).err,
            "servotrace: none.toml: cannot be opened\n");
}

TEST_F(Check, SuppressionsHideAndTheUselessAreTold) {
  program.simulate("cp102_time_backwards", "run");
  program.write("servotrace.toml",
                "[[suppress]]\nrule = \"CP102\"\nreason = \"known clock\"\nuntil = 2026-09-21\n"
                "[[suppress]]\nrule = \"CP101\"\nreason = \"none such\"\n"
                "[[suppress]]\nrule = \"CP102\"\nreason = \"long ago\"\nuntil = 2026-09-20\n");
  const Outcome outcome = program.run({"check", "run.pcapng", "--fail-on", "note"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, StartsWith("clean: no findings in "));
  EXPECT_THAT(outcome.out, EndsWith(", 1 suppressed\n"));
  EXPECT_THAT(outcome.err, HasSubstr("servotrace.toml:5:1: the suppression of CP101 hides nothing (none such)\n"));
  EXPECT_THAT(outcome.err,
              HasSubstr("servotrace.toml:8:1: the suppression of CP102 has expired on 2026-09-20 (long ago)\n"));
  EXPECT_THAT(outcome.err, Not(HasSubstr(":1:1:")));
}

TEST_F(Check, BadInputIsOneLineAndTwo) {
  program.write("notes.bin", std::string("\x01\x02\x03\x04garbage", 11));
  program.write("empty/readme.md", "nothing here\n");
  program.simulate("rtex_clean", "clean");
  const std::vector<std::vector<std::string>> cases = {
      {"check", "missing.pcapng"},
      {"check", "notes.bin"},
      {"check", "empty"},
      {"check"},
      {"check", "clean.pcapng", "--no-such-option"},
      {"check", "clean.pcapng", "--output", "pdf"},
      {"check", "clean.pcapng", "--output", "jsonl=no/such/folder/out.jsonl"},
      {"check", "clean.pcapng", "--output", "text", "--output", "jsonl"},
      {"check", "clean.pcapng", "--color", "blue"},
      {"check", "clean.pcapng", "--max-findings", "0"},
      {"check", "clean.pcapng", "--interface", "can0"},
      {"check", "-", "-"},
      {"decode", "notes.bin"},
      {"decode", "clean.pcapng", "--frames", "9-3"},
      {"info", "missing.pcapng"},
      {"simulate", "missing.toml", "-o", "x.pcapng"},
      {"annotate", "clean.pcapng", "-o", "no/such/folder/x.pcapng"},
      {"merge", "missing.jsonl"},
      {"explain", "RX999"},
      {"nonsense"},
      {},
  };
  for (const std::vector<std::string>& arguments : cases) {
    const Outcome outcome = program.run(arguments);
    const std::string shown = ::testing::PrintToString(arguments);
    EXPECT_EQ(outcome.status, 2) << shown;
    EXPECT_THAT(outcome.err, StartsWith("servotrace: ")) << shown;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << shown << outcome.err;
  }
}

// An option takes one word, so that the captures may follow it.
TEST_F(Check, OptionsMayStandBeforeTheCaptures) {
  program.simulate("rtex_clean", "clean");
  for (const std::vector<std::string>& options :
       std::vector<std::vector<std::string>>{{"--output", "jsonl"},
                                             {"--output", "text", "--output", "jsonl=out.jsonl"},
                                             {"--select", "RX"},
                                             {"--ignore", "RX,DN"},
                                             {"--actor", "master"}}) {
    std::vector<std::string> arguments = {"check"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    arguments.emplace_back("clean.pcapng");
    const Outcome outcome = program.run(arguments);
    EXPECT_EQ(outcome.status, 0) << ::testing::PrintToString(options) << outcome.err;
    EXPECT_EQ(outcome.err, "") << ::testing::PrintToString(options);
  }
}

TEST_F(Check, MistypedWordsAreSuggested) {
  EXPECT_THAT(program.run({"chekc"}).err, HasSubstr("unknown command 'chekc' (did you mean 'check'?)"));
  EXPECT_THAT(program.run({"check", "x", "--slect=RX"}).err,
              HasSubstr("unknown option '--slect' (did you mean '--select'?)"));
  EXPECT_THAT(program.run({"check", "x", "--output", "junti"}).err, HasSubstr("no such file"));
  program.simulate("rtex_clean", "x");
  EXPECT_THAT(program.run({"check", "x.pcapng", "--output", "junti"}).err, HasSubstr("(did you mean 'junit'?)"));
}

TEST_F(Check, NothingCheckedIsThree) {
  program.write("bus.log", "(1700000000.000000) can0 123#0102\n(1700000000.100000) can0 124#0102\n");
  const Outcome outcome = program.run({"check", "bus.log"});
  EXPECT_EQ(outcome.status, 3) << outcome.err;
  EXPECT_THAT(outcome.out, StartsWith("nothing checked: no frame of a known bus"));
  EXPECT_EQ(program.run({"check", "bus.log", "--allow-empty"}).status, 0);
  EXPECT_EQ(program.run({"info", "bus.log"}).status, 3);
  EXPECT_EQ(program.run({"decode", "bus.log"}).status, 3);
}

TEST_F(Check, TwoOutranksOneOutranksThree) {
  program.simulate("cp102_time_backwards", "run");
  program.write("bus.log", "(1700000000.000000) can0 123#0102\n");
  program.write("notes.pcapng", "this is no capture");
  EXPECT_EQ(program.run({"check", "run.pcapng", "bus.log", "--fail-on", "note"}).status, 1);
  EXPECT_EQ(program.run({"check", "run.pcapng", "bus.log"}).status, 3);
  EXPECT_EQ(program.run({"check", "run.pcapng", "bus.log", "notes.pcapng", "--fail-on", "note"}).status, 2);
}

TEST_F(Check, FolderAndStreamGiveTheSameAsFiles) {
  program.simulate("cp102_time_backwards", "captures_a");
  program.simulate("rtex_clean", "captures_b");
  std::filesystem::create_directories(program.folder() / "captures");
  std::filesystem::rename(program.folder() / "captures_a.pcapng", program.folder() / "captures" / "a.pcapng");
  std::filesystem::rename(program.folder() / "captures_b.pcapng", program.folder() / "captures" / "b.pcapng");
  const Outcome folder = program.run({"check", "captures"});
  const Outcome files = program.run({"check", "captures/a.pcapng", "captures/b.pcapng"});
  const Outcome jobs = program.run({"check", "captures", "--jobs", "4"});
  EXPECT_EQ(folder.out, files.out);
  EXPECT_EQ(folder.out, jobs.out);
  EXPECT_EQ(folder.status, 0);
  const Outcome stream =
      program.run({"check", "-", "--fail-on", "warning"}, (program.folder() / "captures" / "a.pcapng").string());
  EXPECT_EQ(stream.status, 1);
  EXPECT_THAT(stream.out, HasSubstr("warning[CP102]"));
}

TEST_F(Check, ManyCapturesInOneRun) {
  program.simulate("cp102_time_backwards", "first");
  for (int i = 0; i < 100; ++i) {
    std::filesystem::create_hard_link(program.folder() / "first.pcapng",
                                      program.folder() / ("copy" + std::to_string(i) + ".pcapng"));
  }
  const Outcome one = program.run({"check", ".", "--output", "jsonl", "--jobs", "1"});
  const Outcome many = program.run({"check", ".", "--output", "jsonl", "--jobs", "8"});
  EXPECT_EQ(one.out, many.out);
  const auto lines = lines_of(one.out);
  EXPECT_EQ(lines.back()["captures"], 101);
  EXPECT_EQ(lines.back()["warnings"], 101);
}

TEST_F(Check, ColourOnlyWhereAsked) {
  program.simulate("cp102_time_backwards", "run");
  EXPECT_THAT(program.run({"check", "run.pcapng"}).out, Not(HasSubstr("\x1B[")));
  EXPECT_THAT(program.run({"check", "run.pcapng", "--color", "always"}).out, HasSubstr("\x1B["));
}

TEST_F(Check, ClosedPipeAndFullDisk) {
  program.simulate("cp102_time_backwards", "run");
  const Outcome piped = program.shell("servotrace decode run.pcapng | head -1 >/dev/null; echo ${PIPESTATUS[0]}");
  EXPECT_EQ(piped.out, "0\n");
  EXPECT_THAT(piped.err, IsEmpty());
  const Outcome full = program.shell("servotrace check run.pcapng >/dev/full");
  EXPECT_EQ(full.status, 2);
  EXPECT_EQ(full.err, "servotrace: standard output: No space left on device\n");
  const Outcome full_file = program.shell("servotrace check run.pcapng --output jsonl=/dev/full");
  EXPECT_EQ(full_file.status, 2);
  EXPECT_THAT(full_file.err, HasSubstr("/dev/full"));
}

TEST_F(Check, MaxFindingsKeepsTheTrueCount) {
  program.simulate("cp104_malformed_records", "run");
  const auto count = [&](const std::vector<std::string>& arguments) {
    std::uint64_t findings = 0;
    std::uint64_t kept = 0;
    for (const nlohmann::json& line : lines_of(program.run(arguments).out)) {
      if (line["type"] == "rule" && line["rule"] == "CP104") findings = line["findings"];
      if (line["type"] == "finding" && line["rule"] == "CP104") ++kept;
    }
    return std::pair(findings, kept);
  };
  EXPECT_EQ(count({"check", "run.pcapng", "--output", "jsonl"}), std::pair(std::uint64_t{2}, std::uint64_t{2}));
}

TEST_F(Check, BaselineAcceptsCountsAndShrinks) {
  program.simulate("cp104_malformed_records", "run");
  program.simulate("rtex_clean", "clean");
  const Outcome written = program.run({"check", "run.pcapng", "--fail-on", "note", "--write-baseline", "b.json"});
  EXPECT_EQ(written.status, 0);
  const nlohmann::json baseline = nlohmann::json::parse(program.read("b.json"));
  ASSERT_EQ(baseline["findings"].size(), 1U);
  EXPECT_EQ(baseline["findings"][0]["rule"], "CP104");
  EXPECT_EQ(baseline["findings"][0]["count"], 2);
  EXPECT_TRUE(baseline["findings"][0]["mac_id"].is_null());
  const Outcome same = program.run({"check", "run.pcapng", "--fail-on", "note", "--baseline", "b.json"});
  EXPECT_EQ(same.status, 0);
  EXPECT_THAT(same.out, EndsWith(", 2 accepted by the baseline\n"));
  const Outcome twice = program.run({"check", "run.pcapng", "run.pcapng", "--fail-on", "note", "--baseline", "b.json"});
  EXPECT_EQ(twice.status, 1);
  EXPECT_THAT(twice.out, HasSubstr("findings: 0 errors, 2 warnings, 0 notes"));
  const Outcome fewer = program.run({"check", "clean.pcapng", "--baseline", "b.json"});
  EXPECT_EQ(fewer.status, 0);
  EXPECT_EQ(fewer.err, "servotrace: b.json: can shrink: CP104 accepts 2, found 0\n");
  program.write("bad.json", "{\"servotrace_baseline\": 2}");
  EXPECT_EQ(program.run({"check", "run.pcapng", "--baseline", "bad.json"}).status, 2);
}

}  // namespace
}  // namespace servotrace::test
