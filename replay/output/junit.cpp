// SPDX-License-Identifier: MIT
// JUnit XML: a suite a capture, a test case a rule; skipped where the capture gave it no opportunity.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <vector>

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
    Suite& suite = suites_.emplace_back();
    suite.file = escaped(capture.file);
    suite.error = escaped(capture.error);
    if (!capture.error.empty()) ++errors_;
    for (const RuleRecord& rule : capture.rules) add_case(suite, capture, rule);
    tests_ += suite.tests();
    failures_ += suite.failures;
  }

  void end(const RunTotals&) override {
    out().write(
        fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"servotrace\" tests=\"{}\" "
                    "failures=\"{}\" errors=\"{}\" time=\"0\">\n",
                    tests_, failures_, errors_));
    for (const Suite& suite : suites_) write(suite);
    out().write("</testsuites>\n");
  }

 private:
  enum class Kind : std::uint8_t { kSkipped, kPassed, kTold };
  struct Case {
    RuleId rule{};
    Kind kind = Kind::kSkipped;
  };
  // The counts stand in front of the cases, so a suite is kept; a case that has nothing to tell takes four bytes of it.
  struct Suite {
    std::string file;
    std::string error;
    std::vector<Case> cases;
    std::vector<std::string> told;  // what stands inside the cases of kTold, in their order
    std::uint64_t failures = 0;

    std::uint64_t tests() const { return cases.size() + (error.empty() ? 0 : 1); }
    std::uint64_t skipped() const {
      return static_cast<std::uint64_t>(
          std::count_if(cases.begin(), cases.end(), [](const Case& entry) { return entry.kind == Kind::kSkipped; }));
    }
  };

  void add_case(Suite& suite, const CaptureRecord& capture, const RuleRecord& rule) {
    if (rule.findings == 0) {
      suite.cases.push_back({rule.rule, rule.checked == 0 ? Kind::kSkipped : Kind::kPassed});
      return;
    }
    const Rule& row = rule_row(rule.rule);
    std::string lines;
    const FindingRecord* worst = nullptr;
    for (const FindingRecord& finding : capture.findings) {
      if (finding.rule != rule.rule) continue;
      if (worst == nullptr || finding.severity > worst->severity) worst = &finding;
      const std::string who = capture.who(finding.node);
      fmt::format_to(std::back_inserter(lines), "frame {}: {}: {}{}{}\n", finding.frame, name_of(finding.severity), who,
                     who.empty() ? "" : ": ", finding.message);
    }
    const bool fails = worst != nullptr && fail_on_ && worst->severity >= *fail_on_;
    suite.cases.push_back({rule.rule, worst == nullptr ? Kind::kPassed : Kind::kTold});
    if (worst == nullptr) return;
    if (fails) ++suite.failures;
    suite.told.push_back(fails ? fmt::format("      <failure message=\"{}: {}\" type=\"{}\">{}</failure>\n",
                                             plural(rule.findings, "finding"), escaped(row.title),
                                             name_of(worst->severity), escaped(lines))
                               : fmt::format("      <system-out>{}</system-out>\n", escaped(lines)));
  }

  void write(const Suite& suite) {
    std::string text =
        fmt::format("  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"{}\" time=\"0\">\n",
                    suite.file, suite.tests(), suite.failures, suite.error.empty() ? 0 : 1, suite.skipped());
    const auto to = std::back_inserter(text);
    if (!suite.error.empty()) {
      fmt::format_to(to,
                     "    <testcase classname=\"{}\" name=\"capture\" time=\"0\">\n"
                     "      <error message=\"{}\" type=\"unreadable\"/>\n    </testcase>\n",
                     suite.file, suite.error);
    }
    auto told = suite.told.begin();
    for (const Case& entry : suite.cases) {
      const Rule& row = rule_row(entry.rule);
      fmt::format_to(to, "    <testcase classname=\"{}\" name=\"{} {}\" time=\"0\"", suite.file, row.id, row.slug);
      if (entry.kind == Kind::kPassed) {
        text += "/>\n";
      } else {
        fmt::format_to(
            to, ">\n{}    </testcase>\n",
            entry.kind == Kind::kSkipped ? std::string_view("      <skipped/>\n") : std::string_view(*told++));
      }
    }
    text += "  </testsuite>\n";
    out().write(text);
  }

  std::optional<Severity> fail_on_;
  std::vector<Suite> suites_;
  std::uint64_t tests_ = 0;
  std::uint64_t failures_ = 0;
  std::uint64_t errors_ = 0;
};

}  // namespace

std::unique_ptr<Output> make_junit(Out& out, const OutputOptions& options) {
  return std::make_unique<Junit>(out, options);
}

}  // namespace servotrace::replay
