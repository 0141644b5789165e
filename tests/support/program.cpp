// SPDX-License-Identifier: MIT
#include "tests/support/program.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "tests/support/paths.hpp"

namespace servotrace::test {
namespace {

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

}  // namespace

Program::Program() {
  const ::testing::TestInfo* const info = ::testing::UnitTest::GetInstance()->current_test_info();
  // Below the root, so that no servotrace.toml of the machine lies above it by accident.
  folder_ = std::filesystem::path(::testing::TempDir()) / "servotrace_cli" / info->test_suite_name() / info->name();
  std::filesystem::remove_all(folder_);
  std::filesystem::create_directories(folder_);
}

Program::~Program() { std::filesystem::remove_all(folder_); }

Outcome Program::spawn(const std::vector<std::string>& words, const std::string& input) const {
  const std::filesystem::path out = folder_ / ".out";
  const std::filesystem::path err = folder_ / ".err";
  const pid_t child = ::fork();
  if (child == 0) {
    const auto redirect = [](int to, const char* path, int flags) {
      const int descriptor = ::open(path, flags, 0600);
      if (descriptor < 0 || ::dup2(descriptor, to) < 0) ::_exit(127);
    };
    if (::chdir(folder_.c_str()) != 0) ::_exit(127);
    redirect(0, input.c_str(), O_RDONLY);
    redirect(1, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC);
    redirect(2, err.c_str(), O_WRONLY | O_CREAT | O_TRUNC);
    ::setenv("SOURCE_DATE_EPOCH", "1790000000", 1);  // 2026-09-21
    ::unsetenv("NO_COLOR");
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    ::execv(arguments[0], arguments.data());
    ::_exit(127);
  }
  int state = 0;
  ::rusage usage = {};
  ::wait4(child, &state, 0, &usage);
  Outcome outcome;
  outcome.peak_kb = usage.ru_maxrss;
  outcome.status = WIFEXITED(state) ? WEXITSTATUS(state) : 128 + WTERMSIG(state);
  outcome.out = content(out);
  outcome.err = content(err);
  std::filesystem::remove(out);
  std::filesystem::remove(err);
  return outcome;
}

Outcome Program::run(const std::vector<std::string>& arguments, const std::string& input) const {
  std::vector<std::string> words{(binary_dir() / "replay" / "servotrace").string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return spawn(words, input);
}

Outcome Program::shell(const std::string& command) const {
  const std::string path = (binary_dir() / "replay").string();
  return spawn({"/bin/bash", "-c", "PATH=" + path + ":$PATH; " + command}, "/dev/null");
}

void Program::simulate(const std::string& scenario, const std::string& name) const {
  const std::filesystem::path source = source_dir() / "captures" / "scenarios" / (scenario + ".toml");
  const Outcome outcome = run({"simulate", source.string(), "-o", name + ".pcapng"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
}

void Program::write(const std::string& name, const std::string& text) const {
  std::filesystem::create_directories((folder_ / name).parent_path());
  std::ofstream(folder_ / name, std::ios::binary) << text;
}

std::string Program::read(const std::string& name) const { return content(folder_ / name); }

}  // namespace servotrace::test
