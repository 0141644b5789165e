// SPDX-License-Identifier: MIT
// JUnit XML: a suite a capture, a test case a rule; skipped where the capture gave it no opportunity.
#include <fmt/format.h>

#include <iterator>

#include "decoder/render/json.hpp"
#include "replay/output/output.hpp"
#include "replay/output/spool.hpp"

namespace servotrace::replay {
namespace {

// XML 1.0 has no way to write most control characters: they become U+FFFD.
std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\n':
        out += "&#10;";
        break;
      case '\t':
        out += "&#9;";
        break;
      default:
        if (static_cast<unsigned char>(c) < 0x20) {
          out += "\xEF\xBF\xBD";
        } else {
          out += c;
        }
    }
  }
  return valid_utf8(out);
}

class Junit : public Output {
 public:
  Junit(Out& out, const OutputOptions& options) : Output(out), fail_on_(options.fail_on) {}

  void capture(const CaptureRecord& capture) override {
    const std::string file = escaped(capture.file);
    Counts counts;
    std::string cases;
    if (!capture.error.empty()) {
      ++counts.tests;
      ++errors_;
      cases = fmt::format(
          "    <testcase classname=\"{}\" name=\"capture\" time=\"0\">\n"
          "      <error message=\"{}\" type=\"unreadable\"/>\n    </testcase>\n",
          file, escaped(capture.error));
    }
    for (const RuleRecord& rule : capture.rules) add_case(cases, counts, capture, file, rule);
    suites_.write(
        fmt::format("  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"{}\" time=\"0\">\n",
                    file, counts.tests, counts.failures, capture.error.empty() ? 0 : 1, counts.skipped));
    suites_.write(cases);
    suites_.write("  </testsuite>\n");
    tests_ += counts.tests;
    failures_ += counts.failures;
  }

  void end(const RunTotals&) override {
    out().write(
        fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"servotrace\" tests=\"{}\" "
                    "failures=\"{}\" errors=\"{}\" time=\"0\">\n",
                    tests_, failures_, errors_));
    suites_.copy_to(out());
    out().write("</testsuites>\n");
  }

 private:
  // Of a suite.
  struct Counts {
    std::uint64_t tests = 0;
    std::uint64_t failures = 0;
    std::uint64_t skipped = 0;
  };

  void add_case(std::string& text, Counts& counts, const CaptureRecord& capture, const std::string& file,
                const RuleRecord& rule) const {
    const Rule& row = rule_row(rule.rule);
    const auto to = std::back_inserter(text);
    ++counts.tests;
    fmt::format_to(to, "    <testcase classname=\"{}\" name=\"{} {}\" time=\"0\"", file, row.id, row.slug);
    if (rule.findings == 0 && rule.checked == 0) {
      ++counts.skipped;
      text += ">\n      <skipped/>\n    </testcase>\n";
      return;
    }
    std::string lines;
    const FindingRecord* worst = nullptr;
    for (const FindingRecord& finding : capture.findings) {
      if (rule.findings == 0) break;
      if (finding.rule != rule.rule) continue;
      if (worst == nullptr || finding.severity > worst->severity) worst = &finding;
      const std::string who = capture.who(finding.node);
      fmt::format_to(std::back_inserter(lines), "frame {}: {}: {}{}{}\n", finding.frame, name_of(finding.severity), who,
                     who.empty() ? "" : ": ", finding.message);
    }
    if (worst == nullptr) {
      text += "/>\n";
    } else if (fail_on_ && worst->severity >= *fail_on_) {
      ++counts.failures;
      fmt::format_to(to, ">\n      <failure message=\"{}: {}\" type=\"{}\">{}</failure>\n    </testcase>\n",
                     plural(rule.findings, "finding"), escaped(row.title), name_of(worst->severity), escaped(lines));
    } else {
      fmt::format_to(to, ">\n      <system-out>{}</system-out>\n    </testcase>\n", escaped(lines));
    }
  }

  std::optional<Severity> fail_on_;
  Spool suites_;  // the counts of all stand in front of them
  std::uint64_t tests_ = 0;
  std::uint64_t failures_ = 0;
  std::uint64_t errors_ = 0;
};

}  // namespace

std::unique_ptr<Output> make_junit(Out& out, const OutputOptions& options) {
  return std::make_unique<Junit>(out, options);
}

}  // namespace servotrace::replay
