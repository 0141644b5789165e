// SPDX-License-Identifier: MIT
// Reads the JSON Lines results of `check` back.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "decoder/core/result.hpp"
#include "replay/results.hpp"

namespace servotrace::replay {

struct Results {
  std::vector<CaptureRecord> captures;
  int status = 0;  // worst of the `end` lines
};

// Adds to `results`. `origin` names the text in messages (file:line). A file without an `end` line was cut off.
Result<void> parse_results(std::string_view text, const std::string& origin, Results& results);

}  // namespace servotrace::replay
