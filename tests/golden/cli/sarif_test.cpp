// SPDX-License-Identifier: MIT
// SARIF before the public validator (npm: @microsoft/sarif-multitool, put into out/tools by scripts/bootstrap), which
// holds the schema of SARIF 2.1.0 and the rules of GitHub code scanning. And what sarif-github promises.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "tests/support/paths.hpp"
#include "tests/support/program.hpp"

namespace servotrace::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class SarifValidator : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* const set = std::getenv("SERVOTRACE_SARIF_VALIDATOR");
    validator = set != nullptr ? set
                               : (source_dir() / "out" / "tools" / "node_modules" / "@microsoft" /
                                  "sarif-multitool-linux" / "Sarif.Multitool")
                                     .string();
    if (program.shell("'" + validator + "' help >/dev/null 2>&1; [ $? -le 1 ]").status != 0) {
      GTEST_SKIP() << "no SARIF validator at " << validator << ": scripts/bootstrap installs it";
    }
    std::filesystem::create_directories(program.folder() / "captures");
    for (const auto& entry : std::filesystem::directory_iterator(source_dir() / "captures")) {
      if (entry.path().extension() == ".pcapng" || entry.path().extension() == ".toml") {
        std::filesystem::copy(entry.path(), program.folder() / "captures");
      }
    }
    program.write("captures/notes.pcapng", "no capture");
    program.write("captures/odd name+\xC3\xA4.pcapng", program.read("captures/rx201_update_counter_stuck.pcapng"));
  }
  // The complaints of the validator: errors and warnings. SARIF2005 wants the home page of the tool, and there is none.
  std::vector<std::string> complaints(const std::string& file) const {
    const Outcome outcome = program.shell("'" + validator + "' validate " + file + " --rule-kind 'Sarif;Ghas' 2>&1");
    EXPECT_THAT(outcome.out, HasSubstr("Done. 1 files scanned."));
    std::vector<std::string> lines;
    std::istringstream stream(outcome.out);
    static const std::regex kComplaint(": (error|warning) ([A-Z]+[0-9]+)");
    for (std::string line; std::getline(stream, line);) {
      std::smatch match;
      if (std::regex_search(line, match, kComplaint) && match[2] != "SARIF2005") lines.push_back(line);
    }
    return lines;
  }

  Program program;
  std::string validator;
};

TEST_F(SarifValidator, AcceptsBothKinds) {
  for (const std::string format : {"sarif", "sarif-github"}) {
    const Outcome outcome = program.run({"check", "captures", "--output", format + "=out.sarif"});
    EXPECT_EQ(outcome.status, 2) << "notes.pcapng is no capture";
    EXPECT_GT(json::parse(program.read("out.sarif"))["runs"][0]["results"].size(), 30U);
    EXPECT_THAT(complaints("out.sarif"), IsEmpty()) << format;
  }
}

TEST_F(SarifValidator, IsNotBlind) {
  ASSERT_EQ(program.run({"check", "captures", "--output", "sarif=out.sarif"}).status, 2);
  json broken = json::parse(program.read("out.sarif"));
  broken["runs"][0]["results"][0].erase("message");
  program.write("out.sarif", broken.dump(1));
  EXPECT_FALSE(complaints("out.sarif").empty()) << "a result needs a message by the schema";
}

class SarifGithub : public ::testing::Test {
 protected:
  static std::set<std::string> prints(const std::string& text) {
    std::set<std::string> all;
    const json document = json::parse(text);
    for (const json& result : document["runs"][0]["results"]) {
      all.insert(result["partialFingerprints"]["primaryLocationLineHash"].get<std::string>());
    }
    return all;
  }
  Program program;
};

// The finding stands in another frame of the next recording: it is the same alert.
TEST_F(SarifGithub, FingerprintsDoNotDependOnFrames) {
  const std::filesystem::path folder = source_dir() / "captures" / "scenarios";
  program.simulate("rx202_update_counter_skip", "run");
  const std::string first = program.run({"check", "run.pcapng", "--output", "sarif-github"}).out;
  program.shell("sed 's/at_cycle = 90/at_cycle = 98/' '" + (folder / "rx202_update_counter_skip.toml").string() +
                "' > later.toml");
  ASSERT_EQ(program.run({"simulate", "later.toml", "-o", "run.pcapng"}).status, 0);
  const std::string second = program.run({"check", "run.pcapng", "--output", "sarif-github"}).out;
  EXPECT_NE(first, second) << "the change of the scenario moved nothing";
  EXPECT_EQ(prints(first), prints(second));
  EXPECT_EQ(prints(first).size(), 1U);
}

TEST_F(SarifGithub, IsCappedAtWhatCodeScanningTakes) {
  program.simulate("cp104_malformed_records", "run");
  ASSERT_EQ(program.run({"check", "run.pcapng", "--output", "jsonl=one.jsonl"}).status, 0);
  // Results of 5,100 captures, as merge reads them: one of them holds an error.
  const std::string one = program.read("one.jsonl");
  const std::string body = one.substr(0, one.rfind("{\"type\":\"end\""));
  std::string all;
  for (int i = 0; i < 5100; ++i) {
    std::string copy = body;
    const std::string name = "f" + std::to_string(i) + ".pcapng";
    for (std::size_t at = 0; (at = copy.find("run.pcapng", at)) != std::string::npos; at += name.size()) {
      copy.replace(at, 10, name);
    }
    if (i == 5099) {
      for (std::size_t at = 0; (at = copy.find("\"severity\":\"warning\"", at)) != std::string::npos;) {
        copy.replace(at, 20, "\"severity\":\"error\"");
      }
    }
    // Only what the findings need: the rule lines of so many captures would only take time.
    std::istringstream lines(copy);
    for (std::string line; std::getline(lines, line);) {
      if (line.find("\"type\":\"rule\"") == std::string::npos) all += line + "\n";
    }
  }
  program.write("all.jsonl", all + one.substr(body.size()));
  const Outcome outcome = program.run({"merge", "all.jsonl", "--output", "sarif-github"});
  const json run = json::parse(outcome.out)["runs"][0];
  EXPECT_EQ(run["results"].size(), 5000U);
  EXPECT_EQ(run["results"][0]["level"], "error") << "the worst come first and are kept";
  EXPECT_THAT(run["invocations"][0]["toolExecutionNotifications"][0]["message"]["text"].get<std::string>(),
              HasSubstr("100 results are left out"));
}

}  // namespace
}  // namespace servotrace::test
