// SPDX-License-Identifier: MIT
// Baseline: today's findings accepted, new ones not. Findings are counted by rule, bus, node and channel, never by
// frame: another recording of the same machine must match.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "decoder/core/result.hpp"
#include "replay/capture/whole_file.hpp"
#include "replay/judge.hpp"
#include "replay/results.hpp"

namespace servotrace::replay {

class Baseline {
 public:
  static Result<Baseline> read(const std::filesystem::path& path);
  // `origin` names the text in messages.
  static Result<Baseline> parse(std::string_view text, const std::string& origin);

  // True where the baseline has room for one more finding like this one; takes the room.
  bool accepts(const FindingRecord& finding);
  // Counts a finding for text().
  void add(const FindingRecord& finding) { ++counts_[key(finding)].found; }
  // A baseline of what was added, as a file holds it.
  std::string text() const;
  // A line for every entry with room left: the baseline can shrink.
  std::vector<std::string> leftovers() const;

  // Rule, bus, protocol, MAC ID (-1: none), channel.
  using Key = std::tuple<std::string, std::string, std::string, int, std::string>;
  static Key key(const FindingRecord& finding);

 private:
  struct Count {
    std::uint64_t accepted = 0;
    std::uint64_t found = 0;
  };
  std::map<Key, Count> counts_;
};

// --baseline and --write-baseline of a run.
class BaselineKeeper {
 public:
  // Reads the one, makes sure that the other can be written. Empty names: none.
  Result<void> open(const std::string& read_from, const std::string& write_to);
  // Takes out of the capture what is accepted; everything is where a baseline is written.
  // Of what is left, at most `most` findings a rule and node stay in the list; the counts hold them all.
  void apply(CaptureRecord& capture, const Selection& selection, std::uint32_t most);
  // Writes the new one; says on standard error where the old one can shrink.
  Result<void> finish();

 private:
  std::string read_from_;
  Baseline baseline_;
  Baseline written_;
  std::unique_ptr<WholeFile> file_;
};

}  // namespace servotrace::replay
