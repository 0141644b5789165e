// SPDX-License-Identifier: MIT
// Text for people: one line a finding, its evidence below, a table of rules and a verdict at the end.
#include <algorithm>
#include <iterator>
#include <map>
#include <set>

#include "decoder/render/value.hpp"
#include "replay/exit_status.hpp"
#include "replay/output/output.hpp"
#include "replay/statistic_text.hpp"

namespace servotrace::replay {
namespace {

class Text : public Output {
 public:
  Text(Out& out, const OutputOptions& options)
      : Output(out), style_(options.style), wants_statistics_(options.statistics) {}

  bool wants_evidence() const override { return true; }

  void capture(const CaptureRecord& capture) override {
    for (const FindingRecord& finding : capture.findings) write(capture, finding);
    for (const RuleRecord& rule : capture.rules) add(capture, rule);
    for (const NodeRecord& node : capture.nodes) {
      if (node.node.mac_id && node.node.protocol == "devicenet" && !is_judged_as_drive(node.profile, node.recognised))
        ++unjudged_;
      if (node.sampled) sampled_.insert(fmt::format("{}: {}", capture.file, node.node.bus));
    }
    if (wants_statistics_) write_statistics(capture);
  }

  void end(const RunTotals& totals) override {
    write_table();
    for (const std::string& bus : sampled_) {
      out().write(bus +
                  " is sampled: the recorder did not take every cycle; rules that need every cycle were silent\n");
    }
    write_verdict(totals);
  }

 private:
  struct Row {
    Severity severity = Severity::kNote;
    std::uint64_t findings = 0;
    std::set<std::string> nodes;
    std::string first;  // file:frame
  };

  std::string_view colour(Severity severity) const {
    if (severity == Severity::kError) return style_.red();
    return severity == Severity::kWarning ? style_.yellow() : style_.cyan();
  }

  void write(const CaptureRecord& capture, const FindingRecord& finding) {
    Row& row = rows_[finding.rule];
    row.severity = std::max(row.severity, finding.severity);
    row.nodes.insert(fmt::format("{}\n{}\n{}", capture.file, finding.node.bus,
                                 finding.node.mac_id ? fmt::format("{}", *finding.node.mac_id) : ""));
    if (row.first.empty()) row.first = fmt::format("{}:{}", capture.file, finding.frame);

    std::string text;
    const auto to = std::back_inserter(text);
    const std::string who = capture.who(finding.node);
    fmt::format_to(to, "{}{}:{}:{} {}{}[{}]{} {}{}{}", style_.bold(), capture.file, finding.frame, style_.reset(),
                   colour(finding.severity), name_of(finding.severity), finding.row().id, style_.reset(), who,
                   who.empty() ? "" : ": ", finding.message);
    if (finding.count > 1) {
      fmt::format_to(to, " ({} times, last in frame {})", finding.count, finding.last_frame);
    }
    text += '\n';
    for (const EvidenceLine& line : finding.evidence) {
      const TimeNs since = elapsed_ns(capture.first_time_ns.value_or(line.time_ns), line.time_ns);
      fmt::format_to(to, "  {}{} {:>8}  {:>14}  {}{}\n", style_.dim(), line.frame == finding.frame ? '>' : ' ',
                     line.frame, seconds_text(since), line.text, style_.reset());
    }
    if (finding.cause.frame != 0) {
      fmt::format_to(to, "  = follows from {} in frame {}\n", rule_row(finding.cause.rule).id, finding.cause.frame);
    }
    if (finding.basis.kind == BasisKind::kConfigured) text += "  = by the settings\n";
    if (finding.basis.kind == BasisKind::kCapture) {
      fmt::format_to(to, "  = by what frame {} shows\n", finding.basis.frame);
    }
    if (finding.basis.kind == BasisKind::kAssumed) text += "  = by an assumption: nothing in the capture decides it\n";
    out().write(text);
  }

  // What was looked at and measured, where all is well too.
  void write_statistics(const CaptureRecord& capture) {
    std::string text = fmt::format("{}{}: {}{}\n", style_.bold(), capture.file,
                                   plural(capture.checked_frames, "checked frame"), style_.reset());
    const auto to = std::back_inserter(text);
    for (const NodeRecord& node : capture.nodes) {
      for (const Fact& fact : node.settings) {
        if (node.node.mac_id || !fact.key.starts_with("bus_load")) continue;
        fmt::format_to(to, "  {} {} = {}\n", node.node.bus, fact.key, fact.value);
      }
    }
    if (!capture.statistics.empty()) fmt::format_to(to, "  measured ({}):\n", kStatisticColumns);
    for (const StatisticRecord& statistic : capture.statistics) {
      fmt::format_to(to, "    {}\n", statistic_text(capture, statistic));
    }
    text += "  rules (times looked at, findings):\n";
    std::size_t idle = 0;
    for (const RuleRecord& rule : capture.rules) {
      if (rule.checked == 0 && rule.findings == 0) {
        ++idle;
        continue;
      }
      const Rule& row = rule_row(rule.rule);
      fmt::format_to(to, "    {:<6} {:>9} {:>6}  {}\n", row.id, rule.checked, rule.findings, row.title);
    }
    fmt::format_to(to, "    {} without an opportunity\n", plural(idle, "rule"));
    out().write(text);
  }

  void add(const CaptureRecord&, const RuleRecord& rule) {
    if (rule.findings != 0) rows_[rule.rule].findings += rule.findings;
  }

  void write_table() {
    if (rows_.empty()) return;
    std::size_t widest = 11;
    for (const auto& [rule, row] : rows_) widest = std::max(widest, row.first.size());
    std::string text = fmt::format("\n{}{:<6} {:<8} {:>8} {:>6}  {:<{}}  {}{}\n", style_.bold(), "rule", "severity",
                                   "findings", "nodes", "first frame", widest, "title", style_.reset());
    for (const auto& [rule, row] : rows_) {
      const Rule& entry = rule_row(rule);
      fmt::format_to(std::back_inserter(text), "{:<6} {}{:<8}{} {:>8} {:>6}  {:<{}}  {}\n", entry.id,
                     colour(row.severity), name_of(row.severity), style_.reset(), row.findings, row.nodes.size(),
                     row.first, widest, entry.title);
    }
    out().write(text + "\n");
  }

  void write_verdict(const RunTotals& totals) {
    const std::string_view verdict = totals.verdict();
    std::string text;
    if (verdict == "findings") {
      text = fmt::format("{}findings{}: {}, {}, {}", colour(worst(totals.counts)), style_.reset(),
                         plural(totals.counts.errors, "error"), plural(totals.counts.warnings, "warning"),
                         plural(totals.counts.notes, "note"));
    } else if (verdict == "clean") {
      text = fmt::format("{}clean{}: no findings", style_.green(), style_.reset());
    } else {
      text = fmt::format("{}nothing checked{}: no frame of a known bus", style_.yellow(), style_.reset());
    }
    text +=
        fmt::format(" in {} of {}", plural(totals.checked_frames, "checked frame"), plural(totals.captures, "capture"));
    if (totals.suppressed != 0) text += fmt::format(", {} suppressed", totals.suppressed);
    if (totals.baselined != 0) text += fmt::format(", {} accepted by the baseline", totals.baselined);
    if (unjudged_ != 0)
      text += fmt::format(
          "; no rule of a drive was applied to {} whose drive is not known for certain (see servotrace info)",
          plural(unjudged_, "node"));
    if (totals.status == kExitFailed) text += "; not everything could be read";
    out().write(text + "\n");
  }

  static Severity worst(const Counts& counts) {
    if (counts.errors != 0) return Severity::kError;
    return counts.warnings != 0 ? Severity::kWarning : Severity::kNote;
  }

  Style style_;
  bool wants_statistics_;
  std::map<RuleId, Row> rows_;
  std::set<std::string> sampled_;  // buses
  std::uint64_t unjudged_ = 0;     // DeviceNet nodes whose drive is unknown or guessed
};

}  // namespace

std::unique_ptr<Output> make_text(Out& out, const OutputOptions& options) {
  return std::make_unique<Text>(out, options);
}

}  // namespace servotrace::replay
