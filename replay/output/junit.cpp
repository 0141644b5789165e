// SPDX-License-Identifier: MIT
// JUnit XML: a suite a capture, a test case a rule; skipped where the capture gave it no opportunity.
#include <fmt/format.h>

#include <iterator>

#include "decoder/render/json.hpp"
#include "replay/output/output.hpp"

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
    std::string cases;
    Numbers numbers;
    if (!capture.error.empty()) {
      ++numbers.tests;
      ++numbers.errors;
      fmt::format_to(std::back_inserter(cases),
                     "    <testcase classname=\"{}\" name=\"capture\" time=\"0\">\n"
                     "      <error message=\"{}\" type=\"unreadable\"/>\n    </testcase>\n",
                     escaped(capture.file), escaped(capture.error));
    }
    for (const RuleRecord& rule : capture.rules) append_case(cases, capture, rule, numbers);
    fmt::format_to(std::back_inserter(suites_),
                   "  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"{}\" time=\"0\">\n{}"
                   "  </testsuite>\n",
                   escaped(capture.file), numbers.tests, numbers.failures, numbers.errors, numbers.skipped, cases);
    all_.tests += numbers.tests;
    all_.failures += numbers.failures;
    all_.errors += numbers.errors;
    all_.skipped += numbers.skipped;
  }

  void end(const RunTotals&) override {
    out().write(
        fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"servotrace\" tests=\"{}\" "
                    "failures=\"{}\" errors=\"{}\" time=\"0\">\n",
                    all_.tests, all_.failures, all_.errors));
    out().write(suites_);
    out().write("</testsuites>\n");
  }

 private:
  struct Numbers {
    std::uint64_t tests = 0;
    std::uint64_t failures = 0;
    std::uint64_t errors = 0;
    std::uint64_t skipped = 0;
  };

  void append_case(std::string& cases, const CaptureRecord& capture, const RuleRecord& rule, Numbers& numbers) {
    const Rule& row = rule_row(rule.rule);
    const auto to = std::back_inserter(cases);
    ++numbers.tests;
    fmt::format_to(to, "    <testcase classname=\"{}\" name=\"{} {}\" time=\"0\"", escaped(capture.file), row.id,
                   row.slug);
    if (rule.findings == 0 && rule.checked == 0) {
      ++numbers.skipped;
      cases += ">\n      <skipped/>\n    </testcase>\n";
      return;
    }
    std::string lines;
    const FindingRecord* worst = nullptr;
    for (const FindingRecord& finding : capture.findings) {
      if (finding.rule != rule.rule) continue;
      if (worst == nullptr || finding.severity > worst->severity) worst = &finding;
      const std::string who = capture.who(finding.node);
      fmt::format_to(std::back_inserter(lines), "frame {}: {}: {}{}{}\n", finding.frame, name_of(finding.severity), who,
                     who.empty() ? "" : ": ", finding.message);
    }
    if (worst == nullptr) {
      cases += "/>\n";
      return;
    }
    const bool fails = fail_on_ && worst->severity >= *fail_on_;
    if (fails) {
      ++numbers.failures;
      fmt::format_to(to, ">\n      <failure message=\"{}: {}\" type=\"{}\">{}</failure>\n    </testcase>\n",
                     fmt::format("{} finding{}", rule.findings, rule.findings == 1 ? "" : "s"), escaped(row.title),
                     name_of(worst->severity), escaped(lines));
    } else {
      fmt::format_to(to, ">\n      <system-out>{}</system-out>\n    </testcase>\n", escaped(lines));
    }
  }

  std::optional<Severity> fail_on_;
  std::string suites_;
  Numbers all_;
};

}  // namespace

std::unique_ptr<Output> make_junit(Out& out, const OutputOptions& options) {
  return std::make_unique<Junit>(out, options);
}

}  // namespace servotrace::replay
