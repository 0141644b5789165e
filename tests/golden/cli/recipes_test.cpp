// SPDX-License-Identifier: MIT
// The recipes of docs/ci.md, run as they stand: the shell of each, in a folder with captures. What only a CI service
// has (its checkout, its upload) is not run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/golden/cli/markdown_blocks.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/program.hpp"

namespace servotrace::test {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;

class Recipes : public ::testing::Test {
 protected:
  void SetUp() override {
    program.write("captures/.keep", "");
    program.simulate("rtex_clean", "captures/first");
    program.simulate("cp104_malformed_records", "captures/second");
    program.simulate("rx202_update_counter_skip", "captures/third");
  }
  // The blocks under a heading.
  static std::vector<std::string> recipe(const std::string& heading) {
    std::vector<std::string> texts;
    for (const Block& block : blocks_of((source_dir() / "docs" / "ci.md").string())) {
      if (block.heading == heading) texts.push_back(block.text);
    }
    EXPECT_FALSE(texts.empty()) << heading;
    return texts;
  }
  // The shell commands a YAML or Groovy recipe runs; those that install are left out.
  std::string commands(const std::string& text, const std::string& script) const {
    program.write("recipe", text);
    program.write("commands.py", script);
    const Outcome outcome = program.shell("/usr/bin/python3 commands.py recipe");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("servotrace check captures/"));
    return outcome.out;
  }
  bool has(const std::string& command) const { return program.shell(command + " >/dev/null 2>&1").status == 0; }
  std::size_t findings_in_junit() const {
    const Outcome count = program.shell("xmllint --xpath 'string(/testsuites/@failures)' servotrace.xml");
    return count.status == 0 ? std::stoul(count.out) : 0;
  }

  Program program;
};

TEST_F(Recipes, StartWithABaseline) {
  const Outcome outcome = program.shell("set -e\n" + recipe("Start with a machine that is not clean")[0]);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, EndsWith(" accepted by the baseline\n"));
}

TEST_F(Recipes, GithubActions) {
  if (!has("/usr/bin/python3 -c 'import yaml'")) GTEST_SKIP() << "no PyYAML";
  const std::string run = commands(recipe("GitHub Actions")[0],
                                   "import sys, yaml\n"
                                   "for step in yaml.safe_load(open(sys.argv[1]))['jobs']['servotrace']['steps']:\n"
                                   "  if step.get('name') != 'Install' and 'run' in step: print(step['run'])\n");
  const Outcome outcome = program.shell("export GITHUB_STEP_SUMMARY=step.md\n" + run);
  EXPECT_THAT(outcome.out, HasSubstr("::error file=captures/third.pcapng,line="));
  EXPECT_THAT(program.read("step.md"), HasSubstr("## servotrace: findings"));
  EXPECT_TRUE(nlohmann::json::accept(program.read("servotrace.sarif")));
}

TEST_F(Recipes, GitlabCi) {
  if (!has("/usr/bin/python3 -c 'import yaml'")) GTEST_SKIP() << "no PyYAML";
  const std::string run =
      commands(recipe("GitLab CI")[0],
               "import sys, yaml\nprint('\\n'.join(yaml.safe_load(open(sys.argv[1]))['traffic']['script']))\n");
  EXPECT_EQ(program.shell(run).status, 1);
  EXPECT_EQ(findings_in_junit(), 2U);
}

TEST_F(Recipes, Jenkins) {
  const std::string run = commands(recipe("Jenkins")[0],
                                   "import re, sys\n"
                                   "print('\\n'.join(re.findall(r\"sh '([^']*)'\", open(sys.argv[1]).read())))\n");
  EXPECT_EQ(program.shell(run).status, 1);
  EXPECT_EQ(findings_in_junit(), 2U);
}

TEST_F(Recipes, PreCommitHook) {
  if (!has("git --version")) GTEST_SKIP() << "no git";
  program.write("hook", recipe("A pre-commit hook over recorded captures")[0]);
  ASSERT_EQ(
      program
          .shell("git init -q repo && cp hook repo/.git/hooks/pre-commit && chmod +x repo/.git/hooks/pre-commit && "
                 "cd repo && git config user.name t && git config user.email t@example.org")
          .status,
      0);
  const Outcome clean = program.shell(
      "cd repo && cp ../captures/first.pcapng . && echo text > readme && git add . && git commit -q -m clean");
  EXPECT_EQ(clean.status, 0) << clean.err << clean.out;
  const Outcome broken =
      program.shell("cd repo && mkdir sub && cp ../captures/third.pcapng sub && git add . && git commit -q -m broken");
  EXPECT_NE(broken.status, 0);
  EXPECT_THAT(broken.out + broken.err, HasSubstr("sub/third.pcapng:181: error[RX202]"));
  // The working tree's settings count, and what is not staged does not.
  const Outcome accepted =
      program.shell("cd repo && printf '[rules]\\nignore = [\"RX202\"]\\n' > servotrace.toml && git commit -q -m now");
  EXPECT_EQ(accepted.status, 0) << accepted.err << accepted.out;
  const Outcome other = program.shell("cd repo && rm servotrace.toml && git rm -q readme && git commit -q -m text");
  EXPECT_EQ(other.status, 0) << other.err << other.out;
}

TEST_F(Recipes, GnuParallel) {
  if (!has("parallel --version")) GTEST_SKIP() << "no GNU parallel";
  const Outcome outcome = program.shell("export HOME=$PWD\n" + recipe("GNU parallel")[0]);
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("findings: 1 error, 2 warnings, 0 notes in "));
  EXPECT_THAT(outcome.out, EndsWith(" of 3 captures\n"));
  EXPECT_EQ(findings_in_junit(), 1U);  // merge fails on errors, as check does
}

TEST_F(Recipes, SlurmArray) {
  const std::vector<std::string> scripts = recipe("A Slurm array over thousands");
  ASSERT_EQ(scripts.size(), 2U);
  program.write("task.sh", scripts[0]);
  // What the scheduler does: the script once for each number of the array.
  const Outcome tasks = program.shell(
      "export SLURM_ARRAY_TASK_COUNT=5\n"
      "for SLURM_ARRAY_TASK_ID in 0 1 2 3 4; do export SLURM_ARRAY_TASK_ID; sh task.sh || exit 9; done");
  EXPECT_EQ(tasks.status, 0) << tasks.err;
  const Outcome outcome = program.shell(scripts[1]);
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_THAT(outcome.out, EndsWith(" of 3 captures\n"));
}

}  // namespace
}  // namespace servotrace::test
