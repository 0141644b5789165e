// SPDX-License-Identifier: MIT
// Options of `check` that need a terminal, a log, a compressed file or many findings; and that each is documented.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "replay/settings/limit_rows.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/program.hpp"
#include "tests/support/sanitized.hpp"

namespace servotrace::test {
namespace {

using nlohmann::json;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

class Options : public ::testing::Test {
 protected:
  std::vector<json> lines_of(const std::vector<std::string>& arguments) const {
    std::vector<json> lines;
    std::istringstream stream(program.run(arguments).out);
    for (std::string line; std::getline(stream, line);) lines.push_back(json::parse(line));
    return lines;
  }
  // What the command shows on a terminal (standard output and error are one there).
  std::string on_terminal(const std::string& command) const {
    return program.shell("script -qec '" + command + "' /dev/null </dev/null").out;
  }
  void make_many(int number) const {
    program.simulate("rtex_clean", "first");
    std::filesystem::create_directories(program.folder() / "many");
    for (int i = 0; i < number; ++i) {
      std::filesystem::create_hard_link(program.folder() / "first.pcapng",
                                        program.folder() / "many" / (std::to_string(i) + ".pcapng"));
    }
  }
  Program program;
};

TEST_F(Options, ColourFollowsTheTerminalAndNoColor) {
  program.simulate("cp102_time_backwards", "run");
  if (program.shell("command -v script").status != 0) GTEST_SKIP() << "no script(1) to make a terminal";
  const std::string check = "TERM=xterm servotrace check run.pcapng --progress never";
  EXPECT_THAT(on_terminal(check), HasSubstr("\x1B[1;33mwarning[CP102]"));
  EXPECT_THAT(on_terminal("NO_COLOR=1 " + check), Not(HasSubstr("\x1B[")));
  EXPECT_THAT(on_terminal("TERM=dumb servotrace check run.pcapng --progress never"), Not(HasSubstr("\x1B[")));
  EXPECT_THAT(on_terminal(check + " --color never"), Not(HasSubstr("\x1B[")));
  EXPECT_THAT(on_terminal("NO_COLOR=1 " + check + " --color always"), HasSubstr("\x1B["));
}

TEST_F(Options, ProgressTellsRateAndTimeLeft) {
  make_many(kSanitized ? 100 : 1500);
  const Outcome always = program.run({"check", "many", "--progress", "always"});
  EXPECT_EQ(always.status, 0);
  EXPECT_TRUE(
      std::regex_search(always.err, std::regex(R"(\r\[=* *\] +[0-9]+ %  [0-9.]+ (kB|MB|GB)/s  [0-9]+:[0-9]{2} left)")))
      << always.err.substr(0, 200);
  EXPECT_THAT(always.err, EndsWith("\r\x1B[K")) << "the bar is cleared at the end";
  EXPECT_THAT(always.out, StartsWith("clean: no findings in "));
  EXPECT_THAT(program.run({"check", "many", "--progress", "never"}).err, IsEmpty());
  EXPECT_THAT(program.run({"check", "many"}).err, IsEmpty()) << "auto: standard error is no terminal";
  EXPECT_EQ(program.run({"check", "first.pcapng", "--progress", "often"}).err,
            "servotrace: --progress: 'often': must be auto, always or never\n");
}

// Results are handed on capture by capture: ten times as many take no more memory.
TEST_F(Options, MemoryDoesNotGrowWithTheCaptures) {
  if (kSanitized) GTEST_SKIP() << "the sanitizer's own memory is in the way";
  make_many(1500);
  for (const std::string format : {"text", "jsonl", "sarif", "junit", "markdown"}) {
    const std::string file = format + "=out";
    const long few = program.run({"check", "first.pcapng", "--output", file}).peak_kb;
    const Outcome many = program.run({"check", "many", "--jobs", "2", "--output", file});
    EXPECT_EQ(many.status, 0);
    EXPECT_LT(many.peak_kb, few + 12 * 1024) << format;
  }
}

// merge reads capture by capture, and what JUnit has to keep waits on the disk.
TEST_F(Options, MemoryDoesNotGrowWithTheFindings) {
  if (kSanitized) GTEST_SKIP() << "the sanitizer's own memory is in the way";
  program.simulate("cp104_malformed_records", "run");
  ASSERT_EQ(program.run({"check", "run.pcapng", "--output", "jsonl=one.jsonl"}).status, 0);
  std::istringstream one(program.read("one.jsonl"));
  std::string capture, finding, end;
  for (std::string line; std::getline(one, line);) {
    if (line.find("\"type\":\"capture\"") != std::string::npos) capture = line + "\n";
    if (line.find("\"type\":\"finding\"") != std::string::npos) finding = line + "\n";
    if (line.find("\"type\":\"end\"") != std::string::npos) end = line + "\n";
  }
  const std::string rule =
      "{\"type\":\"rule\",\"file\":\"run.pcapng\",\"rule\":\"CP104\",\"checked\":1,\"findings\":100}\n";
  std::string all;
  for (int i = 0; i < 500; ++i) {
    all += capture;
    for (int k = 0; k < 100; ++k) all += finding;
    all += rule;
  }
  program.write("few.jsonl", capture + finding + rule + end);
  program.write("all.jsonl", all + end);
  for (const std::string format : {"jsonl", "junit", "sarif"}) {
    const long few = program.run({"merge", "few.jsonl", "--output", format + "=out"}).peak_kb;
    const Outcome many = program.run({"merge", "all.jsonl", "--output", format + "=out"});
    EXPECT_EQ(many.status, 0) << many.err;
    EXPECT_LT(many.peak_kb, few + 16 * 1024) << format;
  }
}

TEST_F(Options, MergeReadsAPipe) {
  program.simulate("cp104_malformed_records", "run");
  program.simulate("rtex_clean", "clean");
  ASSERT_EQ(program.run({"check", "run.pcapng", "--output", "jsonl=b.jsonl"}).status, 0);
  ASSERT_EQ(program.run({"check", "clean.pcapng", "--output", "jsonl=a.jsonl"}).status, 0);
  const Outcome piped = program.shell("servotrace merge b.jsonl <(cat a.jsonl)");
  EXPECT_EQ(piped.status, 0) << piped.err;
  EXPECT_EQ(piped.out, program.run({"merge", "a.jsonl", "b.jsonl"}).out);
  EXPECT_THAT(piped.out, EndsWith("\"captures\":2,\"exit_status\":0}\n"));
}

TEST_F(Options, OptionsStandBeforeBetweenAndBehindTheCaptures) {
  program.simulate("cp102_time_backwards", "run");
  program.simulate("rtex_clean", "clean");
  const std::string behind = program
                                 .run({"check", "run.pcapng", "clean.pcapng", "--output", "jsonl", "--select", "CP,RX2",
                                       "--ignore", "RX201", "--actor", "capture,master"})
                                 .out;
  EXPECT_THAT(behind, EndsWith("\"captures\":2,\"exit_status\":0}\n"));
  EXPECT_EQ(program
                .run({"check", "--output", "jsonl", "--select", "CP", "run.pcapng", "--select", "RX2", "--ignore",
                      "RX201", "clean.pcapng", "--actor", "capture", "--actor=master"})
                .out,
            behind);
  ASSERT_EQ(program.run({"check", "--output", "jsonl=r.jsonl", "run.pcapng"}).status, 0);
  EXPECT_EQ(program.run({"merge", "--output", "jsonl", "r.jsonl"}).out, program.read("r.jsonl"));
}

TEST_F(Options, DevicenetTakesElevenBitCanForIt) {
  // A poll command and its response, no evidence of DeviceNet.
  program.write("bus.log", "(1700000000.000000) can0 43D#0102\n(1700000000.001000) can0 3C7#0102\n");
  EXPECT_EQ(program.run({"check", "bus.log"}).status, 3);
  const Outcome outcome = program.run({"check", "bus.log", "--devicenet"});
  EXPECT_EQ(outcome.status, 0) << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("in 2 checked frames of 1 capture"));
}

TEST_F(Options, CompressedCapturesSayTheSame) {
  program.simulate("cp102_time_backwards", "run");
  const std::string plain = program.run({"check", "run.pcapng"}).out;
  ASSERT_EQ(program.shell("gzip -k run.pcapng && zstd -q run.pcapng").status, 0);
  for (const std::string name : {"run.pcapng.gz", "run.pcapng.zst"}) {
    std::string out = program.run({"check", name}).out;
    for (std::size_t at = 0; (at = out.find(name, at)) != std::string::npos;)
      out.replace(at, name.size(), "run.pcapng");
    EXPECT_EQ(std::regex_replace(out, std::regex(" +"), " "), std::regex_replace(plain, std::regex(" +"), " ")) << name;
    const Outcome stream = program.shell("servotrace check - --fail-on warning < " + name);
    EXPECT_EQ(stream.status, 1) << stream.err;
    EXPECT_THAT(stream.out, HasSubstr("warning[CP102]"));
  }
}

TEST_F(Options, MaxFindingsLimitsTheListAndNotTheCount) {
  program.simulate("cp104_malformed_records", "run");
  std::size_t kept = 0;
  for (const json& line : lines_of({"check", "run.pcapng", "--output", "jsonl", "--max-findings", "1"})) {
    if (line["type"] == "finding") ++kept;
    if (line["type"] == "rule" && line["rule"] == "CP104") {
      EXPECT_EQ(line["findings"], 2);
    }
    if (line["type"] == "end") {
      EXPECT_EQ(line["warnings"], 2);
    }
  }
  EXPECT_EQ(kept, 1U);
}

// A baseline counts what --max-findings leaves out of the list too.
TEST_F(Options, BaselineCountsWhatTheListLeavesOut) {
  program.simulate("cp104_malformed_records", "run");
  const std::vector<std::string> check{"check", "run.pcapng", "--max-findings", "1", "--fail-on", "note"};
  const auto with = [&](const std::string& option) {
    std::vector<std::string> arguments = check;
    arguments.insert(arguments.end(), {option, "b.json"});
    return program.run(arguments);
  };
  EXPECT_EQ(with("--write-baseline").status, 0);
  EXPECT_EQ(json::parse(program.read("b.json"))["findings"][0]["count"], 2);
  const Outcome same = with("--baseline");
  EXPECT_EQ(same.status, 0) << same.out;
  EXPECT_THAT(same.err, IsEmpty());
  program.write("b.json", std::regex_replace(program.read("b.json"), std::regex("\"count\": 2"), "\"count\": 0"));
  const Outcome fewer = with("--baseline");
  EXPECT_EQ(fewer.status, 1);
  EXPECT_THAT(fewer.out, HasSubstr("findings: 0 errors, 2 warnings, 0 notes in "));
  EXPECT_EQ(fewer.out.find("warning[CP104]"), fewer.out.rfind("warning[CP104]")) << "one stands in the list";
}

TEST_F(Options, StatisticsWhereNothingIsWrong) {
  program.simulate("rtex_clean", "ring");
  program.simulate("ns310_clean", "bus");
  const Outcome text = program.run({"check", "ring.pcapng", "bus.pcapng", "--statistics"});
  EXPECT_EQ(text.status, 0);
  EXPECT_THAT(text.out, HasSubstr("  measured (count, least, mean, 99 % within, most):\n    ring0 cycle: 268, "));
  EXPECT_THAT(text.out, HasSubstr("\n    ring0 cycle jitter: "));
  EXPECT_THAT(text.out, HasSubstr("\n    axis 1 Parameter echo: 1, "));
  EXPECT_THAT(text.out, HasSubstr("\n    node 5 poll interval: 179, "));
  EXPECT_THAT(text.out, HasSubstr("\n    node 5 poll jitter: "));
  EXPECT_THAT(text.out, HasSubstr("\n    node 5 poll response: 180, "));
  EXPECT_THAT(text.out, HasSubstr("\n  can0 bus_load_percent"));
  EXPECT_TRUE(std::regex_search(text.out, std::regex("\n    RX201 +[0-9]+ +0  Update_Counter does not move\n")));
  EXPECT_THAT(text.out, EndsWith(" of 2 captures\n"));
  // The same numbers in the JSON of the same run.
  const json document = json::parse(program.run({"check", "ring.pcapng", "--output", "json"}).out);
  const json& capture = document["captures"][0];
  std::set<std::string> keys;
  for (const json& statistic : capture["statistics"]) {
    keys.insert(statistic["key"].get<std::string>());
    EXPECT_LE(statistic["minimum_ns"], statistic["percentile_99_ns"]);
    EXPECT_LE(statistic["percentile_99_ns"], statistic["maximum_ns"]);
    EXPECT_GE(statistic["count"], 1);
  }
  EXPECT_TRUE(keys.contains("cycle") && keys.contains("cycle jitter") && keys.contains("Parameter echo"));
  const auto rule = std::find_if(capture["rules"].begin(), capture["rules"].end(),
                                 [](const json& entry) { return entry["rule"] == "RX201"; });
  ASSERT_NE(rule, capture["rules"].end());
  EXPECT_GT((*rule)["checked"], 100);
  EXPECT_EQ((*rule)["findings"], 0);
  // merge shows them too.
  ASSERT_EQ(program.run({"check", "ring.pcapng", "--output", "jsonl=r.jsonl"}).status, 0);
  EXPECT_EQ(program.run({"merge", "r.jsonl", "--output", "text", "--statistics"}).out,
            program.run({"check", "ring.pcapng", "--statistics"}).out);
}

TEST_F(Options, EveryOptionHasItsPlaceInTheManualAndTheHelpHasExamples) {
  std::ifstream file(source_dir() / "replay" / "man" / "servotrace.1");
  std::string manual((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  manual = std::regex_replace(manual, std::regex(R"(\\-)"), "-");
  const std::regex option("--[a-z][a-z-]*");
  const std::string help = program.run({"check", "--help"}).out;
  EXPECT_THAT(help, HasSubstr("Examples:\n"));
  std::size_t seen = 0;
  for (auto match = std::sregex_iterator(help.begin(), help.end(), option); match != std::sregex_iterator(); ++match) {
    if (match->str() == "--help") continue;
    EXPECT_THAT(manual, HasSubstr(match->str()));
    ++seen;
  }
  EXPECT_GE(seen, 18U);
  std::istringstream all(program.run({"--help"}).out);
  std::size_t commands = 0;
  for (std::string line; std::getline(all, line);) {
    std::smatch match;
    if (!std::regex_match(line, match, std::regex("  ([a-z]{3,}) +[^ ].*"))) continue;
    const std::string command = match[1];
    if (command == "servotrace" || command == "dumpcap") continue;
    EXPECT_THAT(manual, HasSubstr(".B " + command)) << command;
    EXPECT_THAT(program.run({command, "--help"}).out, HasSubstr("xample")) << command;
    ++commands;
  }
  EXPECT_GE(commands, 12U);
}

// The page of servotrace.toml names every limit with its default, and every other key.
TEST_F(Options, EverySettingHasItsPlaceInTheManual) {
  std::ifstream file(source_dir() / "replay" / "man" / "servotrace.toml.5");
  const std::string manual((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const Limits defaults;
  for (const replay::LimitRow& row : replay::kLimitRows) {
    EXPECT_TRUE(
        std::regex_search(manual, std::regex(fmt::format("\\n\\.B {}\\n{}(;|\\n)", row.key, defaults.*row.member))))
        << row.key;
  }
  // The keys a mistake is told of: what the program takes.
  for (const std::string table :
       {"[rtex]", "[[rtex.axis]]", "[[devicenet.node]]", "[limits]", "[rules]", "[[suppress]]"})
    EXPECT_THAT(manual, HasSubstr(table));
  for (const std::string key : {"communication_cycle_us",
                                "command_update_ratio",
                                "sync",
                                "user_link_type",
                                "ethertype",
                                "udp_port",
                                "mac_id",
                                "ring",
                                "name",
                                "data_size",
                                "control",
                                "position",
                                "parameters",
                                "inputs",
                                "max_speed",
                                "profile",
                                "moving_speed",
                                "ignore",
                                "severity",
                                "rule",
                                "reason",
                                "until"}) {
    EXPECT_TRUE(std::regex_search(manual, std::regex("\\n\\.BR? [^\\n]*\\b" + key + "\\b"))) << key;
  }
}

}  // namespace
}  // namespace servotrace::test
