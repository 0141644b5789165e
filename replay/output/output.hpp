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
  Style style;                                         // text only
  std::optional<Severity> fail_on = Severity::kError;  // JUnit: from where on a finding is a failure; empty: never
  bool statistics = false;                             // text: what was looked at and measured, of every capture
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
std::unique_ptr<Output> make_json(Out& out, const OutputOptions& options);
std::unique_ptr<Output> make_sarif(Out& out, const OutputOptions& options);
std::unique_ptr<Output> make_sarif_github(Out& out, const OutputOptions& options);
std::unique_ptr<Output> make_junit(Out& out, const OutputOptions& options);
std::unique_ptr<Output> make_github(Out& out, const OutputOptions& options);
std::unique_ptr<Output> make_markdown(Out& out, const OutputOptions& options);

}  // namespace servotrace::replay
