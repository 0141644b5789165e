// SPDX-License-Identifier: MIT
// Every option of every command is exercised, and every exit status reached: what the help of a command offers stands
// in a table with the test that uses it, and that test must name it.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "tests/support/paths.hpp"
#include "tests/support/program.hpp"

namespace servotrace::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

class EveryOption : public ::testing::Test {
 protected:
  Program program;
};

// Two polls without any evidence of DeviceNet, and an identifier that group 4 does not have (DN101).
constexpr const char* kBus =
    "(1700000000.000000) can0 43D#0102\n(1700000000.001000) can0 3C7#0102\n(1700000000.002000) can0 7F5#00\n";

TEST_F(EveryOption, DevicenetCountsInEveryCommandThatTakesIt) {
  program.write("bus.log", kBus);
  EXPECT_EQ(program.run({"decode", "bus.log"}).status, 3);
  EXPECT_THAT(program.run({"decode", "bus.log", "--devicenet"}).out, HasSubstr("DeviceNet"));
  EXPECT_THAT(program.run({"info", "bus.log"}).out, HasSubstr("no evidence of DeviceNet"));
  EXPECT_THAT(program.run({"info", "bus.log", "--devicenet"}).out, Not(HasSubstr("no evidence of DeviceNet")));
  EXPECT_EQ(program.run({"report", "bus.log", "-o", "r.json"}).status, 3);
  EXPECT_EQ(program.run({"report", "bus.log", "-o", "r.json", "--devicenet"}).status, 0);
  EXPECT_EQ(json::parse(program.read("r.json"))["captures"][0]["verdict"]["first"]["rule"], "DN101");
  EXPECT_EQ(program.run({"export", "bus.log", "-o", "x.csv"}).status, 3);
  EXPECT_EQ(program.run({"export", "bus.log", "-o", "x.csv", "--devicenet"}).status, 0);
  EXPECT_EQ(program.run({"config", "--init", "bus.log"}).status, 3);
  EXPECT_THAT(program.run({"config", "--init", "bus.log", "--devicenet"}).out, HasSubstr("servotrace"));
  ASSERT_EQ(program.run({"annotate", "bus.log", "-o", "plain.pcapng"}).status, 0);
  ASSERT_EQ(program.run({"annotate", "bus.log", "-o", "marked.pcapng", "--devicenet"}).status, 0);
  EXPECT_THAT(program.read("plain.pcapng"), Not(HasSubstr("DN101")));
  EXPECT_THAT(program.read("marked.pcapng"), HasSubstr("DN101"));
}

// Records of another link type than the usual one are records only where the settings say so.
TEST_F(EveryOption, ConfigCountsInEveryCommandThatTakesIt) {
  program.simulate("rtex_clean", "run");
  program.write("user.toml", "[rtex]\nuser_link_type = 150\n");
  ASSERT_EQ(
      program.run({"convert", "run.pcapng", "-o", "u.pcapng", "--carrier", "user", "--config", "user.toml"}).status, 0);
  const std::vector<std::string> config = {"--config", "user.toml"};
  const auto status = [&](std::vector<std::string> arguments, bool configured) {
    if (configured) arguments.insert(arguments.end(), config.begin(), config.end());
    return program.run(arguments).status;
  };
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"check", "u.pcapng"},
                                             {"decode", "u.pcapng"},
                                             {"report", "u.pcapng", "-o", "r.html"},
                                             {"export", "u.pcapng", "-o", "x.csv"},
                                             {"config", "--init", "u.pcapng"}}) {
    EXPECT_EQ(status(arguments, false), 3) << arguments[0];
    EXPECT_EQ(status(arguments, true), 0) << arguments[0];
  }
  EXPECT_THAT(program.run({"info", "u.pcapng"}).out, Not(HasSubstr("bus ring0")));
  EXPECT_THAT(program.run({"info", "u.pcapng", "--config", "user.toml"}).out, HasSubstr("bus ring0: rtex"));
  program.simulate("rx201_update_counter_stuck", "stuck");
  ASSERT_EQ(
      program.run({"convert", "stuck.pcapng", "-o", "s.pcapng", "--carrier", "user", "--config", "user.toml"}).status,
      0);
  EXPECT_EQ(status({"annotate", "s.pcapng", "-o", "a.pcapng"}, false), 0);
  EXPECT_THAT(program.read("a.pcapng"), Not(HasSubstr("RX201")));
  EXPECT_EQ(status({"annotate", "s.pcapng", "-o", "a.pcapng"}, true), 0);
  EXPECT_THAT(program.read("a.pcapng"), HasSubstr("RX201"));
}

TEST_F(EveryOption, AnnotateSelectsRulesAndActors) {
  program.simulate("lost_update", "run");
  const auto annotated = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"annotate", "run.pcapng", "-o", "a.pcapng"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(program.run(arguments).status, 0);
    const std::string bytes = program.read("a.pcapng");
    std::set<std::string> rules;
    const std::regex rule("\\[([A-Z]{2}[0-9]{3})\\]");
    for (std::sregex_iterator it(bytes.begin(), bytes.end(), rule); it != std::sregex_iterator(); ++it)
      rules.insert((*it)[1]);
    return rules;
  };
  const std::set<std::string> all = annotated({});
  ASSERT_GE(all.size(), 2U);
  const std::string first = *all.begin();
  EXPECT_EQ(annotated({"--select", first}), std::set<std::string>{first});
  std::set<std::string> others = all;
  others.erase(first);
  EXPECT_EQ(annotated({"--ignore", first}), others);
  std::set<std::string> together;
  for (const std::string actor : {"master", "drive", "network", "capture"}) {
    const std::set<std::string> some = annotated({"--actor", actor});
    EXPECT_NE(some, all) << actor;
    together.insert(some.begin(), some.end());
  }
  EXPECT_EQ(together, all);
}

TEST_F(EveryOption, DecodeExplainsShowsAllAndColours) {
  program.simulate("rtex_clean", "run");
  const auto decoded = [&](const std::string& option) {
    return program.run({"decode", "run.pcapng", "--frames", "1", option}).out;
  };
  const std::string plain = program.run({"decode", "run.pcapng", "--frames", "1"}).out;
  EXPECT_THAT(plain, Not(HasSubstr("SX-DSV02203")));
  EXPECT_THAT(decoded("--explain"), HasSubstr("SX-DSV02203"));
  EXPECT_GT(decoded("--all").size(), plain.size()) << "reserved bits";
  EXPECT_THAT(plain, Not(HasSubstr("\x1B[")));
  EXPECT_THAT(decoded("--color=always"), HasSubstr("\x1B["));
  EXPECT_EQ(decoded("--color=never"), plain);
  EXPECT_EQ(program.run({"decode", "run.pcapng", "--color", "green"}).status, 2);
  program.write("bus.log", kBus);
  EXPECT_EQ(program.run({"decode", "bus.log", "--all"}).status, 0);
}

TEST_F(EveryOption, ConvertReadsALogByItsMap) {
  program.write("log.txt", "t,c\n1,16\n2,127\n");
  program.write("map.toml", "time = \"t\"\n[[node]]\nmac_id = 1\ncommand = {fields = {command_code = \"c\"}}\n");
  EXPECT_EQ(program.run({"convert", "log.txt", "-o", "log.pcapng"}).status, 2);
  const Outcome outcome = program.run({"convert", "log.txt", "-o", "log.pcapng", "--map", "map.toml"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(program.run({"info", "log.pcapng"}).out, HasSubstr("frames: 2 (2 of a known bus)"));
}

TEST_F(EveryOption, RulesSelects) {
  const Outcome outcome = program.run({"rules", "--select", "CP,RX201"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, HasSubstr("CP101"));
  EXPECT_THAT(outcome.out, HasSubstr("RX201"));
  EXPECT_THAT(outcome.out, Not(HasSubstr("RX202")));
  EXPECT_EQ(program.run({"rules", "--select", "XX9"}).status, 2);
}

TEST_F(EveryOption, MergeFailsOnASeverity) {
  program.simulate("cp104_malformed_records", "run");
  ASSERT_EQ(program.run({"check", "run.pcapng", "--output", "jsonl=r.jsonl"}).status, 0);
  EXPECT_THAT(program.run({"merge", "r.jsonl", "--output", "junit"}).out, HasSubstr("failures=\"0\""));
  EXPECT_THAT(program.run({"merge", "r.jsonl", "--output", "junit", "--fail-on", "warning"}).out,
              HasSubstr("failures=\"1\""));
  EXPECT_EQ(program.run({"merge", "r.jsonl", "--fail-on", "often"}).status, 2);
}

// Evidence travels with the results: the text of a merge is the text of the check.
TEST_F(EveryOption, MergeShowsTheEvidence) {
  program.simulate("rx201_update_counter_stuck", "run");
  const std::string text = program.run({"check", "run.pcapng"}).out;
  EXPECT_THAT(text, HasSubstr("\n  > "));
  EXPECT_EQ(program.run({"check", "run.pcapng", "--output", "jsonl=r.jsonl"}).status, 1);
  EXPECT_EQ(program.run({"merge", "r.jsonl", "--output", "text"}).out, text);
  EXPECT_EQ(program.run({"merge", "r.jsonl", "--output", "jsonl"}).out, program.read("r.jsonl"));
}

TEST_F(EveryOption, ExplainHasNoBarePlaceholders) {
  for (const json& rule : json::parse(program.run({"rules", "--format", "json"}).out)) {
    const Outcome page = program.run({"explain", rule["id"].get<std::string>()});
    EXPECT_FALSE(std::regex_search(page.out, std::regex("\\{[0-9]\\}"))) << rule["id"];
  }
  EXPECT_THAT(program.run({"explain", "DN204"}).out, HasSubstr("\n    no poll command for <time> ms, the connection "));
}

// Statuses as documented, for every command that has them.
TEST_F(EveryOption, EveryExitStatusIsReached) {
  program.simulate("rx201_update_counter_stuck", "bad");
  program.simulate("rtex_clean", "clean");
  program.write("bus.log", kBus);
  program.write("notes.txt", "no capture\n");
  for (const std::string name : {"bad.pcapng", "clean.pcapng", "bus.log", "notes.txt"})
    program.run({"check", name, "--output", "jsonl=" + name + ".jsonl"});
  const std::vector<std::string> inputs = {"clean.pcapng", "bad.pcapng", "bus.log", "notes.txt"};
  const std::vector<std::pair<std::vector<std::string>, std::vector<int>>> rows = {
      {{"check", "INPUT"}, {0, 1, 3, 2}},
      {{"report", "INPUT", "-o", "r.html"}, {0, 0, 3, 2}},
      {{"decode", "INPUT"}, {0, 0, 3, 2}},
      {{"info", "INPUT"}, {0, 0, 3, 2}},
      {{"convert", "INPUT", "-o", "c.pcapng"}, {0, 0, 0, 2}},
      {{"annotate", "INPUT", "-o", "a.pcapng"}, {0, 0, 0, 2}},
      {{"export", "INPUT", "-o", "x.csv"}, {0, 0, 3, 2}},
      {{"export", "INPUT", "-o", "x.pftrace"}, {0, 0, 3, 2}},
      {{"config", "--init", "INPUT"}, {0, 0, 3, 2}},
      {{"merge", "INPUT.jsonl"}, {0, 1, 3, 2}},
  };
  for (const auto& [arguments, expected] : rows) {
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      std::vector<std::string> words;
      for (const std::string& word : arguments)
        words.push_back(std::regex_replace(word, std::regex("INPUT"), inputs[i]));
      EXPECT_EQ(program.run(words).status, expected[i]) << arguments[0] << " " << inputs[i];
    }
  }
  EXPECT_EQ(program.run({"rules"}).status, 0);
  EXPECT_EQ(program.run({"rules", "--format", "yaml"}).status, 2);
  EXPECT_EQ(program.run({"explain", "RX201"}).status, 0);
  EXPECT_EQ(program.run({"explain", "RX999"}).status, 2);
  EXPECT_EQ(program.run({"simulate", "notes.txt", "-o", "s.pcapng"}).status, 2);
  EXPECT_EQ(program.run({"check"}).status, 2);
}

// The tests' sources, by "Suite.Test": the text from its head to the next one.
std::map<std::string, std::string> test_bodies() {
  std::map<std::string, std::string> bodies;
  const std::regex head("\\nTEST(?:_F|_P)?\\((\\w+), (\\w+)\\)");
  for (const auto& entry : std::filesystem::directory_iterator(source_dir() / "tests" / "golden" / "cli")) {
    if (entry.path().extension() != ".cpp") continue;
    std::ifstream file(entry.path());
    const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    std::string name;
    std::size_t begin = 0;
    for (std::sregex_iterator it(text.begin(), text.end(), head); it != std::sregex_iterator(); ++it) {
      const auto at = static_cast<std::size_t>(it->position());
      if (!name.empty()) bodies[name] = text.substr(begin, at - begin);
      name = (*it)[1].str() + "." + (*it)[2].str();
      begin = at;
    }
    if (!name.empty()) bodies[name] = text.substr(begin);
  }
  return bodies;
}

struct Exercised {
  std::string command;
  std::string option;
  std::string test;
};

const std::vector<Exercised>& exercised() {
  static const std::vector<Exercised> kRows = {
      {"annotate", "--output", "Formats.AnnotateWritesCommentsOnTheSameFrames"},
      {"annotate", "--config", "EveryOption.ConfigCountsInEveryCommandThatTakesIt"},
      {"annotate", "--devicenet", "EveryOption.DevicenetCountsInEveryCommandThatTakesIt"},
      {"annotate", "--select", "EveryOption.AnnotateSelectsRulesAndActors"},
      {"annotate", "--ignore", "EveryOption.AnnotateSelectsRulesAndActors"},
      {"annotate", "--actor", "EveryOption.AnnotateSelectsRulesAndActors"},
      {"check", "--interface", "Live.FindingsAsTheyHappenAndASummaryOnCtrlC"},
      {"check", "--config", "Check.SettingsAreFoundUpwardAndObeyed"},
      {"check", "--devicenet", "Options.DevicenetTakesElevenBitCanForIt"},
      {"check", "--select", "Check.SelectIgnoreAndActor"},
      {"check", "--ignore", "Check.SelectIgnoreAndActor"},
      {"check", "--actor", "Check.SelectIgnoreAndActor"},
      {"check", "--fail-on", "Check.FailOnDecidesTheStatus"},
      {"check", "--output", "Formats.SeveralAtOnceIntoFiles"},
      {"check", "--baseline", "Check.BaselineAcceptsCountsAndShrinks"},
      {"check", "--write-baseline", "Check.BaselineAcceptsCountsAndShrinks"},
      {"check", "--max-findings", "Options.MaxFindingsLimitsTheListAndNotTheCount"},
      {"check", "--jobs", "Check.ManyCapturesInOneRun"},
      {"check", "--color", "Options.ColourFollowsTheTerminalAndNoColor"},
      {"check", "--progress", "Options.ProgressTellsRateAndTimeLeft"},
      {"check", "--join", "Convert.JoinedFilesAreOneRecording"},
      {"check", "--statistics", "Options.StatisticsWhereNothingIsWrong"},
      {"check", "--allow-empty", "Check.NothingCheckedIsThree"},
      {"config", "--init", "Export.ConfigIsReadBack"},
      {"config", "--output", "Export.ConfigIsReadBack"},
      {"config", "--config", "EveryOption.ConfigCountsInEveryCommandThatTakesIt"},
      {"config", "--devicenet", "EveryOption.DevicenetCountsInEveryCommandThatTakesIt"},
      {"convert", "--output", "Convert.LogBecomesPcapng"},
      {"convert", "--config", "EveryOption.ConfigCountsInEveryCommandThatTakesIt"},
      {"convert", "--carrier", "Convert.CarriersSayTheSame"},
      {"convert", "--map", "EveryOption.ConvertReadsALogByItsMap"},
      {"convert", "--partial", "Fault.ARecordingThatWasCutIsConvertedOnRequest"},
      {"decode", "--config", "EveryOption.ConfigCountsInEveryCommandThatTakesIt"},
      {"decode", "--devicenet", "EveryOption.DevicenetCountsInEveryCommandThatTakesIt"},
      {"decode", "--format", "Formats.DecodeShowsEveryField"},
      {"decode", "--frames", "Formats.DecodeShowsEveryField"},
      {"decode", "--brief", "Formats.DecodeShowsEveryField"},
      {"decode", "--explain", "EveryOption.DecodeExplainsShowsAllAndColours"},
      {"decode", "--all", "EveryOption.DecodeExplainsShowsAllAndColours"},
      {"decode", "--color", "EveryOption.DecodeExplainsShowsAllAndColours"},
      {"export", "--output", "Export.CsvHasOneColumnASignal"},
      {"export", "--config", "EveryOption.ConfigCountsInEveryCommandThatTakesIt"},
      {"export", "--devicenet", "EveryOption.DevicenetCountsInEveryCommandThatTakesIt"},
      {"info", "--config", "EveryOption.ConfigCountsInEveryCommandThatTakesIt"},
      {"info", "--devicenet", "EveryOption.DevicenetCountsInEveryCommandThatTakesIt"},
      {"info", "--format", "Formats.InfoTellsBusesAndTimes"},
      {"merge", "--output", "EveryOption.MergeShowsTheEvidence"},
      {"merge", "--fail-on", "EveryOption.MergeFailsOnASeverity"},
      {"merge", "--statistics", "Options.StatisticsWhereNothingIsWrong"},
      {"report", "--output", "ReportPages.SeveralCapturesHaveAnOverview"},
      {"report", "--against", "ReportPages.TwoCapturesPartWhereTheAlarmRises"},
      {"report", "--config", "EveryOption.ConfigCountsInEveryCommandThatTakesIt"},
      {"report", "--devicenet", "EveryOption.DevicenetCountsInEveryCommandThatTakesIt"},
      {"rules", "--format", "Formats.RulesAndExplain"},
      {"rules", "--select", "EveryOption.RulesSelects"},
      {"simulate", "--output", "Formats.BriefOfMonitorsAndTheSubChannel"},
  };
  return kRows;
}

TEST_F(EveryOption, StandsInTheTableWithATestThatUsesIt) {
  const std::map<std::string, std::string> bodies = test_bodies();
  ASSERT_GT(bodies.size(), 80U);
  std::set<std::pair<std::string, std::string>> known;
  for (const Exercised& row : exercised()) {
    known.emplace(row.command, row.option);
    const auto body = bodies.find(row.test);
    ASSERT_NE(body, bodies.end()) << row.test;
    const bool is_short = row.option == "--output" && body->second.find("\"-o\"") != std::string::npos;
    EXPECT_TRUE(is_short || body->second.find(row.option) != std::string::npos)
        << row.test << " without " << row.option;
  }
  std::set<std::pair<std::string, std::string>> offered;
  const std::regex option("\\n  (?:-[a-z],)?(--[a-z][a-z-]*)");
  const std::string overview = program.run({"--help"}).out;
  const std::regex command("\\n  ([a-z]{3,}) +[^ \\n]");
  for (std::sregex_iterator it(overview.begin(), overview.end(), command); it != std::sregex_iterator(); ++it) {
    const std::string name = (*it)[1];
    if (name == "servotrace" || name == "dumpcap") continue;  // the examples
    const std::string help = program.run({name, "--help"}).out;
    for (std::sregex_iterator found(help.begin(), help.end(), option); found != std::sregex_iterator(); ++found) {
      if ((*found)[1] != "--help") offered.emplace(name, (*found)[1]);
    }
  }
  EXPECT_EQ(offered, known);
}

// Each format of check is read back by some test, each of the others is covered by the table above.
TEST_F(EveryOption, EveryFormatHasATest) {
  const std::map<std::string, std::string> tests = {{"text", "Check.TextNamesFrameRuleAndEvidence"},
                                                    {"jsonl", "Formats.JsonLinesHoldEverythingOfTheInterface"},
                                                    {"json", "Formats.JsonIsTheSameAsOneDocument"},
                                                    {"sarif", "Formats.SarifPointsAtBytes"},
                                                    {"sarif-github", "Formats.SarifForGithubHasLinesAndCollapses"},
                                                    {"junit", "Formats.JunitCountsFailuresAndSkips"},
                                                    {"github", "Formats.GithubAnnotationsWorstFirst"},
                                                    {"markdown", "Formats.MarkdownListsRulesAndCaptures"}};
  const std::map<std::string, std::string> bodies = test_bodies();
  for (const auto& [format, test] : tests) EXPECT_EQ(bodies.count(test), 1U) << test;
  program.simulate("rtex_clean", "clean");
  std::string names = program.run({"check", "clean.pcapng", "--output", "yaml"}).err;
  for (const auto& [format, test] : tests) EXPECT_THAT(names, HasSubstr(format));
  const std::size_t commas = static_cast<std::size_t>(std::count(names.begin(), names.end(), ','));
  EXPECT_EQ(commas + 1, tests.size()) << names;
}

}  // namespace
}  // namespace servotrace::test
