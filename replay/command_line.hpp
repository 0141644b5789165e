// SPDX-License-Identifier: MIT
// Subcommands and their arguments. Every command parses its own words with CLI11; a mistake is one line on standard
// error and exit status 2.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "decoder/core/result.hpp"
#include "replay/settings/settings.hpp"

namespace CLI {
class App;
}

namespace servotrace::replay {

// The words behind the subcommand's name.
using Arguments = std::vector<std::string>;

// Parses into what `app` was set up with. A value: the exit status to return at once (help was shown, or the words are
// wrong).
std::optional<int> parse(CLI::App& app, const Arguments& arguments);

// --config and --devicenet, and the settings that follow from them for each capture.
class CaptureOptions {
 public:
  void add_to(CLI::App& app);
  // --config alone, for a command that takes frames as they are.
  void add_config_to(CLI::App& app);
  // The settings of a capture (an empty path: a stream): --config, else servotrace.toml found upward, else defaults.
  // Read once a file. The pointer is never null.
  Result<std::shared_ptr<const FileSettings>> settings(const std::filesystem::path& capture);

  std::uint32_t max_findings = 100;

 private:
  std::string config_;
  bool devicenet_ = false;
  std::map<std::string, std::shared_ptr<const FileSettings>> read_;  // by path of the file
};

// "error", "warning" ... for options; empty where the word is none of them.
std::optional<Severity> severity_of(std::string_view word);
std::optional<Actor> actor_of(std::string_view word);

// "12", "3-9", "3-", "-9" (from 1): first and last, both in the range. Empty where the word is none of these.
std::optional<std::pair<std::uint64_t, std::uint64_t>> parse_range(std::string_view word);

// "a,b" and repeated options to one list.
std::vector<std::string> split_list(const std::vector<std::string>& words);

}  // namespace servotrace::replay
