// SPDX-License-Identifier: MIT
// Checking what an interface carries, until Ctrl-C.
#pragma once

#include <string>

#include "replay/console.hpp"
#include "replay/judge.hpp"

namespace servotrace::replay {

// A capture judged, and what its suppressions did.
struct Checked {
  CaptureRecord record;
  RuleFilter filter;
  bool stopped = false;
};

// Says findings on standard error as they happen; the results are those of all that was seen.
Result<Checked> check_live(const std::string& interface, const FileSettings& settings, const Selection& selection,
                           Style style);

}  // namespace servotrace::replay
