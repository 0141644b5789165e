// SPDX-License-Identifier: MIT
// Runs the stock tshark with the plugin that was just built, without installing it. As root, tshark passes over plugin
// folders of its own accord, so there it runs as nobody: what it is to read is copied to where nobody may read it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace servotrace::test {

struct Ran {
  int status = 0;  // of the program, or 128 + the signal that ended it
  std::string out;
  std::string err;
};

class Tshark {
 public:
  Tshark();
  ~Tshark();
  Tshark(const Tshark&) = delete;
  Tshark& operator=(const Tshark&) = delete;

  // False where tshark or the plugin is missing: skip the test, and say why.
  bool available() const { return why_not_.empty(); }
  const std::string& why_not() const { return why_not_; }
  // A folder that nobody may read and write too.
  const std::filesystem::path& folder() const { return folder_; }
  // A copy of `file` in folder().
  std::filesystem::path copy(const std::filesystem::path& file) const;
  // `program`: tshark, or another of Wireshark's that loads plugins.
  Ran run(const std::vector<std::string>& arguments, const std::string& program = "tshark",
          const std::vector<std::string>& environment = {}) const;

 private:
  std::filesystem::path folder_;
  std::string why_not_;
};

// Rows of `-T fields` output: one a line, its columns apart by tabs.
std::vector<std::vector<std::string>> rows_of(const std::string& text);
// "a,b,c" to its parts.
std::vector<std::string> parts_of(const std::string& text, char separator);

}  // namespace servotrace::test
