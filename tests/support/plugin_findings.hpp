// SPDX-License-Identifier: MIT
// What the plugin shows of a capture, against what the command line finds.
#pragma once

#include "tests/support/check.hpp"
#include "tests/support/tshark.hpp"

namespace servotrace::test {

// Findings as tshark prints them; `arguments` hold the capture and preferences. Sorted.
std::vector<Seen> seen_by(const Tshark& tshark, std::vector<std::string> arguments);

// With one pass and with two.
void expect_parity(const Tshark& tshark, const std::filesystem::path& capture,
                   const replay::FileSettings& settings = {}, const std::vector<std::string>& preferences = {});

}  // namespace servotrace::test
