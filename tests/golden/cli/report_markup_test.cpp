// SPDX-License-Identifier: MIT
// The HTML of the report before public validators (tidy of Debian; the Nu checker of the W3C, which scripts/bootstrap
// gets from npm), and what makes it accessible: headings in order, landmarks, names of pictures, heads of tables.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/support/paths.hpp"
#include "tests/support/program.hpp"
#include "tests/support/scenarios.hpp"

namespace servotrace::test {
namespace {

using ::testing::HasSubstr;

class ReportMarkup : public ::testing::Test {
 protected:
  // Reports of every kind: failures, clean and empty captures, several captures in one, one against another.
  void SetUp() override {
    std::vector<std::string> scenarios = {"mixed_can_and_ring", "esb_clean", "cp103_records_lost", "can_not_devicenet"};
    for (const std::filesystem::path& file : scenario_files()) {
      if (file.stem().string().starts_with("failure_")) scenarios.push_back(file.stem().string());
    }
    for (const std::string& scenario : scenarios) {
      const simulator::Scenario read = load_scenario(source_dir() / "captures" / "scenarios" / (scenario + ".toml"));
      program.write("servotrace.toml", read.settings);
      program.simulate(scenario, scenario);
      make({scenario + ".pcapng"}, scenario);
    }
    make({"failure_cable.pcapng", "esb_clean.pcapng", "failure_limit.pcapng"}, "several");
    make({"failure_cable.pcapng", "--against", "failure_lost_update.pcapng"}, "against");
    ASSERT_GE(pages.size(), 16U);
  }
  void make(std::vector<std::string> arguments, const std::string& name) {
    arguments.insert(arguments.begin(), "report");
    arguments.insert(arguments.end(), {"-o", name + ".html"});
    ASSERT_NE(program.run(arguments).status, 2) << name;
    pages.push_back(name + ".html");
  }
  std::string all_pages() const {
    std::string list;
    for (const std::string& page : pages) list += " " + page;
    return list;
  }
  Program program;
  std::vector<std::string> pages;
};

TEST_F(ReportMarkup, TidyAcceptsIt) {
  if (program.shell("command -v tidy").status != 0) GTEST_SKIP() << "tidy is not installed: scripts/bootstrap does";
  // Its 5.6 does not know yet that groups of a <dl> may stand in a <div> (HTML 5.2).
  const Outcome outcome =
      program.shell("tidy -quiet -errors" + all_pages() + " 2>&1 | grep -v -e 'dl>' -e '<dt>' -e '<dd>'");
  EXPECT_EQ(outcome.out, "");
  program.write("wrong.html",
                "<!DOCTYPE html><html lang=\"en\"><head><title>x</title></head><body><p><dv>x</dv></body></html>");
  EXPECT_THAT(program.shell("tidy -quiet -errors wrong.html 2>&1").out, HasSubstr("<dv> is not recognized"));
}

TEST_F(ReportMarkup, TheNuCheckerAcceptsIt) {
  const char* const set = std::getenv("SERVOTRACE_HTML_VALIDATOR");
  const std::string jar =
      set != nullptr
          ? set
          : (source_dir() / "out" / "tools" / "node_modules" / "vnu-jar" / "build" / "dist" / "vnu.jar").string();
  if (!std::filesystem::exists(jar)) GTEST_SKIP() << "no HTML checker at " << jar << ": scripts/bootstrap installs it";
  if (program.shell("command -v java").status != 0)
    GTEST_SKIP() << "no java to run the HTML checker (Debian: default-jre-headless)";
  const Outcome outcome = program.shell("java -jar '" + jar + "' --stdout" + all_pages());
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.out, "");
  program.write("wrong.html",
                "<!DOCTYPE html><html lang=\"en\"><head><title>x</title></head><body><p id=\"a b\">x</body></html>");
  EXPECT_THAT(program.shell("java -jar '" + jar + "' --stdout wrong.html").out, HasSubstr("error: Bad value"));
}

std::size_t count(const std::string& text, const std::string& word) {
  std::size_t found = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++found;
  return found;
}

TEST_F(ReportMarkup, HeadingsNeverSkipALevel) {
  for (const std::string& page : pages) {
    const std::string html = program.read(page);
    char level = '0';
    for (std::size_t at = html.find("<h"); at != std::string::npos; at = html.find("<h", at + 1)) {
      const char next = html[at + 2];
      if (next < '1' || next > '6') continue;
      EXPECT_LE(next, level + 1) << page << ": " << html.substr(at, 60);
      level = next;
    }
    EXPECT_EQ(count(html, "<h1"), 1U) << page;
  }
}

TEST_F(ReportMarkup, HasLandmarksAndNames) {
  for (const std::string& page : pages) {
    const std::string html = program.read(page);
    EXPECT_THAT(html, HasSubstr("<html lang=\"en\">")) << page;
    EXPECT_THAT(html, HasSubstr("<a class=\"skip\" href=\"#main\">")) << page;
    EXPECT_THAT(html, HasSubstr("<main id=\"main\">")) << page;
    EXPECT_EQ(count(html, "<main"), 1U) << page;
    EXPECT_EQ(count(html, "<header>"), 1U) << page;
    EXPECT_EQ(count(html, "<footer>"), 1U) << page;
    EXPECT_EQ(count(html, "<nav"), count(html, "<nav aria-label=")) << page;
    EXPECT_EQ(count(html, "<th"), count(html, "<th scope=") + count(html, "<thead"))
        << page << ": a head without scope";
    EXPECT_EQ(count(html, "<table>"), count(html, "<thead>")) << page << ": a table without a head";
    EXPECT_EQ(count(html, "<svg "), count(html, "<svg viewBox=")) << page;
    EXPECT_EQ(count(html, "<svg "), count(html, "role=\"img\" aria-label=\"")) << page;
    EXPECT_EQ(count(html, "<svg "), count(html, "<figcaption>")) << page << ": a picture without words";
  }
}

}  // namespace
}  // namespace servotrace::test
