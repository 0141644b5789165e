// SPDX-License-Identifier: MIT
// A capture checked as the command line does it, for comparisons: rule, frame, severity and node of each finding.
#pragma once

#include <compare>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "replay/settings/settings.hpp"

namespace servotrace::test {

struct Seen {
  std::uint64_t frame = 0;
  std::string rule;
  std::string severity;
  std::string node;  // "axis 3 (X)", "ring0", "can" for any CAN bus, "capture"
  auto operator<=>(const Seen&) const = default;
};

std::string to_string(const Seen& seen);

// What Wireshark is to show: everything but the rules that need the whole file. Sorted.
std::vector<Seen> check_capture(const std::filesystem::path& capture, const replay::FileSettings& settings = {});

}  // namespace servotrace::test
