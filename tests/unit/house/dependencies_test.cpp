// SPDX-License-Identifier: MIT
// Holds the lines between the folders: who may include whom. The rules are the architecture's; a new crossing is a
// change of the architecture, not of this list.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

#include "tests/support/paths.hpp"

namespace servotrace {
namespace {

namespace fs = std::filesystem;

struct Include {
  std::string file;    // relative to the project
  std::string target;  // as written
  bool quoted = false;
};

std::vector<Include> includes_below(const std::string& folder) {
  static const std::regex kInclude(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
  std::vector<Include> result;
  for (const auto& entry : fs::recursive_directory_iterator(test::source_dir() / folder)) {
    const std::string extension = entry.path().extension().string();
    if (!entry.is_regular_file() || (extension != ".cpp" && extension != ".hpp" && extension != ".h")) continue;
    std::ifstream in(entry.path());
    for (std::string line; std::getline(in, line);) {
      std::smatch match;
      if (!std::regex_search(line, match, kInclude)) continue;
      result.push_back({fs::relative(entry.path(), test::source_dir()).generic_string(), match[2], match[1] == "\""});
    }
  }
  return result;
}

bool starts_with_any(const std::string& text, const std::vector<std::string>& prefixes) {
  for (const std::string& prefix : prefixes) {
    if (text.rfind(prefix, 0) == 0) return true;
  }
  return false;
}

void expect_only(const std::string& folder, const std::vector<std::string>& allowed) {
  const auto all = includes_below(folder);
  for (const Include& include : all) {
    if (!include.quoted) continue;
    EXPECT_TRUE(starts_with_any(include.target, allowed)) << include.file << " includes " << include.target;
  }
}

TEST(Dependencies, DecoderSeesOnlyItself) { expect_only("decoder", {"decoder/"}); }

TEST(Dependencies, DecoderUsesTheStandardLibraryAndFmtOnlyInRender) {
  static const std::regex kStandard("[a-z_0-9]+");
  bool seen_fmt = false;
  for (const Include& include : includes_below("decoder")) {
    if (include.quoted) continue;
    const bool may_fmt = starts_with_any(include.file, {"decoder/render/", "decoder/docs/"});
    const bool fmt = include.target.rfind("fmt/", 0) == 0;
    seen_fmt |= fmt;
    EXPECT_TRUE(std::regex_match(include.target, kStandard) || (may_fmt && fmt))
        << include.file << " includes " << include.target;
  }
  EXPECT_TRUE(seen_fmt) << "the scan found no include of fmt at all, so it does not work";
}

TEST(Dependencies, SimulatorSeesOnlyDecoder) { expect_only("captures/simulator", {"decoder/", "captures/simulator/"}); }
TEST(Dependencies, SettingsSeeOnlyDecoder) { expect_only("replay/settings", {"decoder/", "replay/settings/"}); }
TEST(Dependencies, ReplaySeesNoDissector) { expect_only("replay", {"decoder/", "replay/", "captures/simulator/"}); }
TEST(Dependencies, DissectorSeesDecoderAndSettings) {
  expect_only("dissector", {"decoder/", "dissector/", "replay/settings/"});
}

TEST(Dependencies, OnlyOneHeaderIncludesWireshark) {
  for (const Include& include : includes_below("dissector")) {
    if (include.file == "dissector/ws.hpp") continue;
    EXPECT_FALSE(
        starts_with_any(include.target, {"epan/", "wireshark/", "wiretap/", "wsutil/", "ws_", "config.h", "glib"}))
        << include.file << " includes " << include.target << "; dissector/ws.hpp is the place";
  }
}

TEST(Dependencies, DecoderStagesDoNotCallUpward) {
  // core < link < findings; a protocol never includes the other one, nor a profile a protocol's session.
  for (const Include& include : includes_below("decoder/core")) {
    EXPECT_FALSE(include.quoted && !starts_with_any(include.target, {"decoder/core/"}))
        << include.file << " includes " << include.target;
  }
  for (const Include& include : includes_below("decoder/rtex")) {
    EXPECT_FALSE(starts_with_any(include.target, {"decoder/devicenet/", "decoder/profiles/", "decoder/render/"}))
        << include.file << " includes " << include.target;
  }
  for (const Include& include : includes_below("decoder/devicenet")) {
    EXPECT_FALSE(starts_with_any(include.target, {"decoder/rtex/", "decoder/render/"}))
        << include.file << " includes " << include.target;
  }
}

}  // namespace
}  // namespace servotrace
