// SPDX-License-Identifier: MIT
// Settings in the plugin: the file, the tables above it, the shipped profile. The preferences of carriers are in
// tests/parity/plugin, against the command line with the same settings.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "tests/support/paths.hpp"
#include "tests/support/tshark.hpp"

namespace servotrace::test {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::Not;

class PluginSettings : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { shared_ = std::make_unique<Tshark>(); }
  static void TearDownTestSuite() { shared_.reset(); }
  void SetUp() override {
    if (!tshark_.available()) GTEST_SKIP() << tshark_.why_not();
  }
  std::string copy(const std::string& name) const { return tshark_.copy(source_dir() / "captures" / name).string(); }

  // What is seen of captures/nk301_in_alarm.pcapng, whose node 9 is an ESB that nothing on the bus names.
  struct Shown {
    std::set<std::string> rules;
    std::set<std::string> nodes;
    std::vector<std::string> guesses;  // sentences that say so
  };
  Shown shown(const std::vector<std::string>& preferences) const {
    std::vector<std::string> arguments = {"-r", copy("nk301_in_alarm.pcapng"),
                                          "-T", "fields",
                                          "-e", "_ws.col.Info",
                                          "-e", "servotrace.rule",
                                          "-e", "servotrace.node"};
    for (const std::string& preference : preferences) arguments.insert(arguments.end(), {"-o", preference});
    const Ran ran = tshark_.run(arguments);
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(ran.err, "");
    Shown result;
    for (const auto& row : rows_of(ran.out)) {
      if (row[0].find("guessed") != std::string::npos) result.guesses.push_back(row[0]);
      for (const std::string& rule : parts_of(row.size() > 1 ? row[1] : "", ',')) result.rules.insert(rule);
      for (const std::string& node : parts_of(row.size() > 2 ? row[2] : "", ',')) result.nodes.insert(node);
    }
    result.rules.erase("");
    result.nodes.erase("");
    return result;
  }
  static inline std::unique_ptr<Tshark> shared_;
  const Tshark& tshark_ = *shared_;
};

TEST_F(PluginSettings, WithoutAnyADriveIsGuessedAndNotJudged) {
  const Shown seen = shown({});
  EXPECT_FALSE(seen.guesses.empty());
  EXPECT_TRUE(seen.rules.empty());
}

TEST_F(PluginSettings, TheSettingsFile) {
  const Shown seen = shown({"servotrace.settings_file:" + copy("servotrace.toml")});
  EXPECT_TRUE(seen.guesses.empty());
  EXPECT_THAT(seen.rules, Contains("NK301"));
  EXPECT_EQ(seen.nodes, std::set<std::string>{"node 9 (indexer)"});
}

TEST_F(PluginSettings, TheTableOfNodes) {
  const Shown seen = shown({R"(uat:servotrace_nodes:"9","turntable","nsk-esb")"});
  EXPECT_TRUE(seen.guesses.empty());
  EXPECT_THAT(seen.rules, Contains("NK301"));
  EXPECT_EQ(seen.nodes, std::set<std::string>{"node 9 (turntable)"});
}

TEST_F(PluginSettings, ALineOfTheTableStandsAboveTheFile) {
  const Shown seen = shown(
      {"servotrace.settings_file:" + copy("servotrace.toml"), R"(uat:servotrace_nodes:"9","turntable","nsk-esb")"});
  EXPECT_THAT(seen.rules, Contains("NK301"));
  EXPECT_EQ(seen.nodes, std::set<std::string>{"node 9 (turntable)"});
}

// The profile alone: CAN is DeviceNet from the first frame, its columns are there, each of its filters is one Wireshark
// can compile.
TEST_F(PluginSettings, TheShippedProfile) {
  const fs::path home = tshark_.folder() / "home";
  const fs::path profile = home / ".config" / "wireshark" / "profiles" / "servotrace";
  fs::create_directories(profile.parent_path());
  fs::copy(source_dir() / "dissector" / "profile" / "servotrace", profile, fs::copy_options::recursive);
  fs::permissions(home, fs::perms::others_all, fs::perm_options::add);
  std::vector<std::string> filters;
  for (const char* const name : {"colorfilters", "dfilter_buttons"}) {
    std::ifstream in(profile / name);
    for (std::string line; std::getline(in, line);) {
      if (line.empty() || line[0] == '#') continue;
      // @name@filter@[background][foreground], "enabled","name","filter","comment" with \x22 for a quotation mark.
      std::string filter = parts_of(line, line[0])[line[0] == '@' ? 2 : 5];
      for (std::size_t at; (at = filter.find("\\x22")) != std::string::npos;) filter.replace(at, 4, "\"");
      filters.push_back(filter);
    }
  }
  ASSERT_GT(filters.size(), 8U);
  std::string any = "frame.number < 20";
  for (const std::string& filter : filters) any += " || (" + filter + ")";
  const std::vector<std::string> environment = {"HOME=" + home.string(),
                                                "XDG_CONFIG_HOME=" + (home / ".config").string()};
  Ran ran = tshark_.run({"-C", "servotrace", "-r", copy("esb_guessed.pcapng"), "-Y", any}, "tshark", environment);
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_EQ(ran.err, "");
  const std::vector<std::string> lines = parts_of(ran.out.substr(0, ran.out.find_last_of('\n')), '\n');
  EXPECT_THAT(lines, Each(HasSubstr("node 10")));
  EXPECT_THAT(lines, Not(Contains(HasSubstr("CAN  "))));
  EXPECT_THAT(lines, Contains(HasSubstr("(guessed)")));
  ran = tshark_.run({"-C", "servotrace", "-r", copy("lost_update.pcapng"), "-Y", "servotrace"}, "tshark", environment);
  EXPECT_THAT(ran.out, HasSubstr("RTEX RX201 axis 1 command"));  // protocol, rule, sentence
}

}  // namespace
}  // namespace servotrace::test
