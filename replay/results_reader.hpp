// SPDX-License-Identifier: MIT
// Reads the JSON Lines results of `check` back.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "decoder/core/result.hpp"
#include "replay/results.hpp"

namespace servotrace::replay {

// Takes the lines of one file, in their order; holds the capture it is at and no more.
class ResultsReader {
 public:
  enum class Line : std::uint8_t { kCapture, kEnd, kMore };

  // `origin` names the file in messages (file:line); `line`: lines of it that were passed over.
  explicit ResultsReader(std::string origin, std::uint64_t line = 0) : origin_(std::move(origin)), line_(line) {}

  // kCapture: capture() is a new one. kMore: it knows more. kEnd: the file is whole up to here.
  Result<Line> take(std::string_view text);
  const CaptureRecord& capture() const { return capture_; }
  CaptureRecord&& release() { return std::move(capture_); }
  // A file without an `end` line was cut off.
  Result<void> finish() const;
  // Worst of the `end` lines.
  int status() const { return status_; }

 private:
  Error wrong(std::string what) const;

  std::string origin_;
  std::uint64_t line_;
  CaptureRecord capture_;
  bool has_capture_ = false;
  bool ended_ = false;
  int status_ = 0;
};

}  // namespace servotrace::replay
