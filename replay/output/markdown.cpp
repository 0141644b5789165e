// SPDX-License-Identifier: MIT
// Markdown for a job summary: the verdict, the rules, the captures.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>

#include "replay/output/output.hpp"

namespace servotrace::replay {
namespace {

constexpr std::size_t kMostCaptures = 200;  // rows; summaries are cut at a megabyte

std::string cell(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '|' || c == '<' || c == '*' || c == '_' || c == '`' || c == '[' || c == '\\') out += '\\';
    out += c == '\n' || c == '\r' ? ' ' : c;
  }
  return out;
}

class Markdown : public Output {
 public:
  using Output::Output;

  void capture(const CaptureRecord& capture) override {
    for (const FindingRecord& finding : capture.findings) {
      Row& row = rows_[finding.rule];
      row.severity = std::max(row.severity, finding.severity);
      row.nodes.insert(fmt::format("{}\n{}\n{}", capture.file, finding.node.bus, finding.node.mac_id.value_or(-1)));
      if (row.first.empty()) {
        const std::string who = capture.who(finding.node);
        row.first =
            fmt::format("{}:{} {}{}{}", capture.file, finding.frame, who, who.empty() ? "" : ": ", finding.message);
      }
    }
    for (const RuleRecord& rule : capture.rules) {
      if (rule.findings != 0) rows_[rule.rule].findings += rule.findings;
    }
    captures_.push_back(fmt::format("| {} | {} | {} | {} | {} | {} |\n", cell(capture.file), capture.frames,
                                    capture.counts.errors, capture.counts.warnings, capture.counts.notes,
                                    cell(capture.error)));
    clean_.push_back(capture.counts.all() == 0 && capture.error.empty());
  }

  void end(const RunTotals& totals) override {
    std::string text = fmt::format("## servotrace: {}\n\n{}, {}, {} in {} of {}.\n", totals.verdict(),
                                   plural(totals.counts.errors, "error"), plural(totals.counts.warnings, "warning"),
                                   plural(totals.counts.notes, "note"), plural(totals.checked_frames, "checked frame"),
                                   plural(totals.captures, "capture"));
    const auto to = std::back_inserter(text);
    if (!rows_.empty()) {
      text += "\n| rule | severity | findings | nodes | what | first |\n|---|---|---:|---:|---|---|\n";
      std::vector<std::pair<RuleId, const Row*>> sorted;
      for (const auto& [rule, row] : rows_) sorted.emplace_back(rule, &row);
      std::stable_sort(sorted.begin(), sorted.end(), [](const auto& left, const auto& right) {
        return left.second->severity > right.second->severity;
      });
      for (const auto& [rule, row] : sorted) {
        fmt::format_to(to, "| {} | {} | {} | {} | {} | {} |\n", rule_row(rule).id, name_of(row->severity),
                       row->findings, row->nodes.size(), cell(rule_row(rule).title), cell(row->first));
      }
    }
    std::string list;
    std::size_t listed = 0;
    std::size_t left_out = 0;
    for (std::size_t i = 0; i < captures_.size(); ++i) {
      if (clean_[i]) continue;
      if (listed == kMostCaptures) {
        ++left_out;
        continue;
      }
      list += captures_[i];
      ++listed;
    }
    if (!list.empty()) {
      text += "\n| capture | frames | errors | warnings | notes | unreadable |\n|---|---:|---:|---:|---:|---|\n" + list;
    }
    if (left_out != 0) fmt::format_to(to, "\n{} more captures with findings are not listed.\n", left_out);
    out().write(text);
  }

 private:
  struct Row {
    Severity severity = Severity::kNote;
    std::uint64_t findings = 0;
    std::set<std::string> nodes;
    std::string first;
  };
  std::map<RuleId, Row> rows_;
  std::vector<std::string> captures_;
  std::vector<bool> clean_;
};

}  // namespace

std::unique_ptr<Output> make_markdown(Out& out, const OutputOptions&) { return std::make_unique<Markdown>(out); }

}  // namespace servotrace::replay
