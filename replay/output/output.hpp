// SPDX-License-Identifier: MIT
// Output formats: each takes captures one by one, in order, and the totals at the end.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "replay/console.hpp"
#include "replay/results.hpp"

namespace servotrace::replay {

struct OutputOptions {
  Style style;           // text only
  bool details = false;  // text: rule statistics of clean captures, too
};

class Output {
 public:
  explicit Output(Out& out) : out_(out) {}
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;
  virtual ~Output() = default;

  // Whether FindingRecord::evidence is of use: it costs a second look at the capture.
  virtual bool wants_evidence() const { return false; }
  virtual void begin() {}
  virtual void capture(const CaptureRecord& capture) = 0;
  virtual void end(const RunTotals& totals) = 0;

 protected:
  Out& out() { return out_; }

 private:
  Out& out_;
};

struct OutputFormat {
  std::string_view name;
  std::string_view summary;
  std::unique_ptr<Output> (*make)(Out& out, const OutputOptions& options) = nullptr;
};
// In the order of the help.
std::span<const OutputFormat> output_formats();

std::unique_ptr<Output> make_text(Out& out, const OutputOptions& options);
std::unique_ptr<Output> make_jsonl(Out& out, const OutputOptions& options);

}  // namespace servotrace::replay
