// SPDX-License-Identifier: MIT
// GitHub workflow annotations, worst first: only the first ten of a kind are shown there.
#include <fmt/format.h>

#include <algorithm>

#include "replay/output/output.hpp"

namespace servotrace::replay {
namespace {

std::string escaped(std::string_view text, bool is_property) {
  std::string out;
  for (const char c : text) {
    if (c == '%') {
      out += "%25";
    } else if (c == '\r') {
      out += "%0D";
    } else if (c == '\n') {
      out += "%0A";
    } else if (is_property && c == ':') {
      out += "%3A";
    } else if (is_property && c == ',') {
      out += "%2C";
    } else {
      out += c;
    }
  }
  return out;
}

class Github : public Output {
 public:
  using Output::Output;

  void capture(const CaptureRecord& capture) override {
    if (!capture.error.empty()) {
      lines_.push_back({Severity::kError, fmt::format("::error file={},title=unreadable capture::{}\n",
                                                      escaped(capture.file, true), escaped(capture.error, false))});
    }
    for (const FindingRecord& finding : capture.findings) {
      const std::string who = capture.who(finding.node);
      const std::string_view command = finding.severity == Severity::kNote ? "notice" : name_of(finding.severity);
      lines_.push_back({finding.severity,
                        fmt::format("::{} file={},line={},title={} {}::{}{}{}\n", command, escaped(capture.file, true),
                                    finding.frame, finding.row().id, finding.row().slug, escaped(who, false),
                                    who.empty() ? "" : ": ", escaped(finding.message, false))});
    }
  }

  void end(const RunTotals&) override {
    std::stable_sort(lines_.begin(), lines_.end(),
                     [](const Line& left, const Line& right) { return left.severity > right.severity; });
    for (const Line& line : lines_) out().write(line.text);
  }

 private:
  struct Line {
    Severity severity;
    std::string text;
  };
  std::vector<Line> lines_;
};

}  // namespace

std::unique_ptr<Output> make_github(Out& out, const OutputOptions&) { return std::make_unique<Github>(out); }

}  // namespace servotrace::replay
