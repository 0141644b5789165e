// SPDX-License-Identifier: MIT
// `servotrace export` and `config --init`, and the shell completion.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "tests/support/paths.hpp"
#include "tests/support/program.hpp"

namespace servotrace::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class Export : public ::testing::Test {
 protected:
  void SetUp() override { program.simulate("rtex_clean", "clean"); }
  Program program;
};

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line + ",");
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

TEST_F(Export, CsvHasOneColumnASignal) {
  const Outcome outcome = program.run({"export", "clean.pcapng", "-o", "out.csv"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::istringstream stream(program.read("out.csv"));
  std::string line;
  std::getline(stream, line);
  const std::vector<std::string> header = split(line);
  EXPECT_EQ(header[0], "time_s");
  EXPECT_EQ(header[2], "frame");
  EXPECT_THAT(header, Contains("ring0.axis1.command.command_position [command units]"));
  EXPECT_THAT(header, Contains("ring0.axis1.response.actual_position [command units]"));
  std::vector<std::string> sorted = header;
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(std::adjacent_find(sorted.begin(), sorted.end()), sorted.end()) << "a column stands twice";
  std::size_t rows = 0;
  while (std::getline(stream, line)) {
    EXPECT_EQ(split(line).size(), header.size());
    ++rows;
  }
  EXPECT_GT(rows, 100U);
}

// The value of a frame in the CSV is what decode says of it.
TEST_F(Export, CsvAgreesWithDecode) {
  ASSERT_EQ(program.run({"export", "clean.pcapng", "-o", "out.csv"}).status, 0);
  std::istringstream stream(program.read("out.csv"));
  std::string line;
  std::getline(stream, line);
  const std::vector<std::string> header = split(line);
  const auto column = static_cast<std::size_t>(
      std::find(header.begin(), header.end(), "ring0.axis1.command.command_position [command units]") - header.begin());
  std::vector<std::string> last;
  while (std::getline(stream, line)) {
    if (const std::vector<std::string> row = split(line); !row[column].empty()) last = row;
  }
  ASSERT_FALSE(last.empty());
  const Outcome decoded = program.run({"decode", "clean.pcapng", "--frames", last[2]});
  EXPECT_THAT(decoded.out, HasSubstr("Command position (CPOS): " + last[column] + " command units\n"));
}

TEST_F(Export, PerfettoTraceIsProtobuf) {
  ASSERT_EQ(program.run({"export", "clean.pcapng", "-o", "out.pftrace"}).status, 0);
  const std::string trace = program.read("out.pftrace");
  EXPECT_THAT(trace, HasSubstr("ring0"));
  EXPECT_THAT(trace, HasSubstr("Servo_On"));
  // The file is a sequence of packets of field 1, each with its length, and nothing else.
  std::size_t at = 0;
  std::size_t packets = 0;
  while (at < trace.size()) {
    ASSERT_EQ(trace[at++], '\x0A');
    std::size_t length = 0;
    for (unsigned shift = 0;; shift += 7) {
      ASSERT_LT(at, trace.size());
      const auto byte = static_cast<unsigned char>(trace[at++]);
      length |= static_cast<std::size_t>(byte & 0x7FU) << shift;
      if (byte < 0x80) break;
    }
    at += length;
    ++packets;
  }
  EXPECT_EQ(at, trace.size());
  EXPECT_GT(packets, 100U);
}

TEST_F(Export, RefusesOtherEndings) {
  EXPECT_EQ(program.run({"export", "clean.pcapng", "-o", "out.xlsx"}).err,
            "servotrace: out.xlsx: the ending must be .csv or .pftrace\n");
  EXPECT_EQ(program.run({"export", "-", "-o", "out.csv"}).status, 2);
}

TEST_F(Export, ConfigIsReadBack) {
  const Outcome outcome = program.run({"config", "--init", "clean.pcapng", "-o", "servotrace.toml"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(program.read("servotrace.toml"), HasSubstr("\n[rtex]\n"));
  EXPECT_EQ(program.run({"check", "clean.pcapng"}).status, 0);
  const Outcome again = program.run({"config", "--init", "clean.pcapng", "-o", "servotrace.toml"});
  EXPECT_EQ(again.status, 2);
  EXPECT_THAT(again.err, HasSubstr("exists already"));
}

TEST_F(Export, BashCompletionKnowsCommandsAndOptions) {
  const std::string script = (source_dir() / "replay" / "completions" / "servotrace.bash").string();
  const Outcome commands = program.shell("source '" + script +
                                         "'; COMP_WORDS=(servotrace ch) COMP_CWORD=1; _servotrace; "
                                         "echo \"${COMPREPLY[@]}\"");
  EXPECT_EQ(commands.out, "check\n") << commands.err;
  const Outcome options = program.shell("source '" + script +
                                        "'; COMP_WORDS=(servotrace check --fail) COMP_CWORD=2; _servotrace; "
                                        "echo \"${COMPREPLY[@]}\"");
  EXPECT_THAT(options.out, StartsWith("--fail-on")) << options.err;
}

TEST_F(Export, ConfigWithEveryLineInForceIsReadBack) {
  const Outcome made = program.run({"config", "--init", "clean.pcapng"});
  ASSERT_EQ(made.status, 0) << made.err;
  // The limits as they stand behind their #: the defaults, so nothing changes.
  program.write("made.toml", made.out);
  ASSERT_EQ(
      program
          .shell("sed -E '/^.limits/,/^.rules/s/^# ([a-z_]+ = [0-9]+ *(#.*)?)$/\\1/' made.toml > servotrace.toml; "
                 "[ $(sed -n '/^.limits/,/^.rules/p' servotrace.toml | grep -c '^[a-z_]* = ') = 24 ]")
          .status,
      0)
      << program.read("servotrace.toml");
  const Outcome check = program.run({"check", "clean.pcapng"});
  EXPECT_EQ(check.status, 0) << check.err;
  EXPECT_EQ(check.err, "");
}

// The completion of zsh, with the functions of its completion system replaced by ones that print what they are given.
TEST_F(Export, ZshCompletionKnowsCommandsAndOptions) {
  if (program.shell("command -v zsh").status != 0) GTEST_SKIP() << "no zsh";
  const std::string script = (source_dir() / "replay" / "completions" / "_servotrace").string();
  EXPECT_EQ(program.shell("zsh -n '" + script + "'").err, "");
  const auto complete = [&](const std::string& words, int current) {
    program.write("try.zsh",
                  "compadd() { [[ $1 == -- ]] && shift; print -l -- $@ }\n"
                  "_describe() { print -l -- ${(P)2} }\n_files() { print files }\n"
                  "words=(" +
                      words + ") CURRENT=" + std::to_string(current) + " PREFIX=${words[-1]}\nsource '" + script +
                      "'\n");
    const Outcome outcome = program.shell("zsh -f try.zsh");
    EXPECT_EQ(outcome.err, "");
    return outcome.out;
  };
  EXPECT_THAT(complete("servotrace ch", 2), HasSubstr("check:verifies captures"));
  EXPECT_THAT(complete("servotrace check --fail", 3), HasSubstr("--fail-on\n"));
  EXPECT_THAT(complete("servotrace check x --fail-on ''", 5), HasSubstr("warning\n"));
  EXPECT_THAT(complete("servotrace check --output ''", 4), HasSubstr("sarif-github\n"));
  EXPECT_THAT(complete("servotrace explain R", 3), HasSubstr("RX201\n"));
  EXPECT_EQ(complete("servotrace check x", 3), "files\n");
}

}  // namespace
}  // namespace servotrace::test
