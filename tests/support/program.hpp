// SPDX-License-Identifier: MIT
// Runs the built program in a folder of its own and catches what it says.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace servotrace::test {

struct Outcome {
  int status = -1;  // exit status, or 128 + the signal that ended it
  std::string out;
  std::string err;
  long peak_kb = 0;  // most memory it held
};

class Program {
 public:
  // A fresh, empty folder named after the test.
  Program();
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  const std::filesystem::path& folder() const { return folder_; }
  // Runs `servotrace ARGUMENTS...` in folder(). Standard input is the file `input`, else empty.
  Outcome run(const std::vector<std::string>& arguments, const std::string& input = "/dev/null") const;
  // Runs a shell command in folder(); `servotrace` in it is the built program.
  Outcome shell(const std::string& command) const;
  // Makes NAME.pcapng in folder() from captures/scenarios/SCENARIO.toml.
  void simulate(const std::string& scenario, const std::string& name) const;
  void write(const std::string& name, const std::string& text) const;
  std::string read(const std::string& name) const;
  bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }

 private:
  Outcome spawn(const std::vector<std::string>& words, const std::string& input) const;

  std::filesystem::path folder_;
};

}  // namespace servotrace::test
