// SPDX-License-Identifier: MIT
// --output FORMAT[=FILE]: formats and where they go. A file appears whole or not at all.
#pragma once

#include <string>
#include <vector>

#include "decoder/core/result.hpp"
#include "replay/output/output.hpp"

namespace servotrace::replay {

class Targets {
 public:
  // No words: `fallback` on standard output. Two formats on standard output, an unknown format or a file that cannot be
  // made is an error.
  static Result<Targets> open(const std::vector<std::string>& words, std::string_view fallback,
                              const OutputOptions& options);

  bool wants_evidence() const;
  void begin();
  void capture(const CaptureRecord& capture);
  void end(const RunTotals& totals);
  // Only now files appear under their names. The first error; the others are still finished.
  Result<void> finish();

 private:
  struct Target {
    std::unique_ptr<Out> out;
    std::unique_ptr<Output> output;
  };
  std::vector<Target> targets_;
};

// "text, jsonl, ...".
std::string format_names();

}  // namespace servotrace::replay
