// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "decoder/findings/catalogue.hpp"
#include "decoder/render/message.hpp"
#include "decoder/render/node.hpp"
#include "decoder/render/value.hpp"
#include "replay/report/analysis.hpp"
#include "replay/report/pages.hpp"
#include "replay/report/pictures.hpp"

namespace servotrace::report {
namespace {

// Text of a capture (names, strings of devices) must not become markup.
std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '\n' || c == '\r') {
      result += ' ';
      continue;
    }
    if (c == '|' || c == '*' || c == '_' || c == '`' || c == '<' || c == '[' || c == '\\' || c == '#') result += '\\';
    result += c;
  }
  return result;
}

// The sections of the HTML report, without pictures.
class Writer {
 public:
  Writer(std::string& out, const Built& built, const Settings& settings)
      : out_(out), model_(built.model), buses_(built.buses), settings_(settings) {}

  void write() {
    add("# servotrace report: {}\n\n{}, {} of them on known buses ({}).\n\n## Verdict\n\n**{}**\n",
        escaped(model_.capture.file), plural(model_.capture.frames, "frame"), model_.capture.checked_frames,
        escaped(model_.capture.format), escaped(model_.verdict.headline));
    for (const std::string& sentence : model_.verdict.sentences) add("\n{}\n", escaped(sentence));
    if (model_.verdict.kind != VerdictKind::kNothingChecked) {
      comparison();
      story();
      faults();
      nodes();
      network();
      violations();
    }
    add("\n## What this capture cannot show\n\n");
    for (const std::string& text : model_.cannot_show) add("- {}\n", escaped(text));
  }

 private:
  template <class... Arguments>
  void add(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(out_), format, std::forward<Arguments>(arguments)...);
  }
  std::string name(const NodeRef& node) const { return escaped(node_text(node, configured_name(settings_, node))); }
  std::string name(const Finding& finding) const { return escaped(who(finding, settings_, buses_)); }

  void comparison() {
    if (!model_.comparison) return;
    const Comparison& other = *model_.comparison;
    add("\n## Where the captures part\n\nBeside {}, of which the verdict is: {}\n", escaped(other.file),
        escaped(other.headline));
    if (!other.partings.empty()) add("\n| after the start | who | state | here | there |\n|---|---|---|---|---|\n");
    for (const Parting& row : other.partings) {
      add("| {:.6f} s | {} | {} | {} | {} |\n", static_cast<double>(row.after_ns) / 1e9, name(row.node),
          escaped(row.field->label), escaped(row.here), escaped(row.there));
    }
    if (!other.settings.empty()) add("\n| who | setting | here | there |\n|---|---|---|---|\n");
    for (const Comparison::Setting& row : other.settings)
      add("| {} | {} | {} | {} |\n", escaped(row.node), escaped(row.key), escaped(row.here), escaped(row.there));
    if (!other.rules.empty()) add("\n| rule | findings here | there |\n|---|---|---|\n");
    for (const Comparison::RuleCount& row : other.rules)
      add("| {} | {} | {} |\n", rule_row(row.rule).id, row.here, row.there);
  }

  void story() {
    constexpr std::size_t kMost = 60;
    std::vector<const Event*> events;
    for (const StateTrack& track : model_.tracks) {
      if (importance(*track.field) > 1) continue;
      for (const Event& event : track.changes) events.push_back(&event);
    }
    std::stable_sort(events.begin(), events.end(),
                     [](const Event* left, const Event* right) { return left->frame < right->frame; });
    if (events.empty()) return;
    add("\n## Timeline\n\n| time | frame | who | what |\n|---|---|---|---|\n");
    for (std::size_t i = 0; i < events.size() && i < kMost; ++i) {
      const Event& event = *events[i];
      add("| {} | {} | {} | {}: {} to {} |\n", at_time(model_, event.time_ns), event.frame, name(event.node),
          escaped(event.field->label), escaped(value_text(*event.field, event.before)),
          escaped(value_text(*event.field, event.after)));
    }
    if (events.size() > kMost) add("\n{} more changes are in the HTML report.\n", events.size() - kMost);
  }

  void faults() {
    if (model_.faults.empty()) return;
    add("\n## Faults\n");
    std::size_t number = 0;
    for (const Fault& fault : model_.faults) {
      const Finding& finding = model_.findings[fault.finding];
      add("\n### {}. {}: {}\n\n{} at {}, frame {}: {}.\n", ++number, capitalised(name(finding)),
          escaped(fault_text(model_, fault)), rule_row(finding.rule).id, at_time(model_, fault.time_ns), fault.frame,
          escaped(message(finding)));
      for (const Advice& entry : fault.advice) {
        add("\n- {}{} ({})\n", escaped(entry.name),
            entry.likeliest && fault.advice.size() > 1 ? ", by the evidence" : "", escaped(entry.section));
        if (!entry.causes.empty()) add("  - causes: {}\n", escaped(entry.causes));
        if (!entry.remedies.empty()) add("  - remedies: {}\n", escaped(entry.remedies));
      }
      if (!fault.causes.empty()) add("\nCauses, the likeliest first:\n\n");
      for (const Candidate& cause : fault.causes) {
        add("1. {}: {} ({})", evidence_word(cause), escaped(cause.text), escaped(cause.section));
        if (cause.finding) {
          const Finding& shown = model_.findings[*cause.finding];
          add("; {} at frame {}: {}", rule_row(shown.rule).id, shown.frame, escaped(message(shown)));
        }
        if (cause.access) {
          const Access& access = model_.accesses[*cause.access];
          add("; frame {}: {}, {} to {}", access.frame, escaped(access.what), escaped(access.before),
              escaped(access.value));
        }
        add("\n");
      }
    }
  }

  void nodes() {
    add("\n## Axes and nodes\n\n| node | profile | recognised | known settings |\n|---|---|---|---|\n");
    for (const BusSummary& bus : model_.summary.buses) {
      for (const NodeSummary& node : bus.nodes) {
        std::string facts;
        for (const Fact& fact : node.facts)
          facts += fmt::format("{}{} = {}", facts.empty() ? "" : ", ", fact.key, fact.value);
        add("| {}, {} | {} | {} | {} |\n", name(node.node), escaped(buses_.name(bus.bus)), escaped(node.profile),
            escaped(node.recognised), escaped(facts));
      }
    }
    if (model_.accesses.empty()) return;
    constexpr std::size_t kMost = 100;
    add("\n| frame | node | | what | before | value |\n|---|---|---|---|---|---|\n");
    for (std::size_t i = 0; i < model_.accesses.size() && i < kMost; ++i) {
      const Access& access = model_.accesses[i];
      add("| {} | {} | {} | {} | {} | {}{} |\n", access.frame, name(access.node), name_of(access.kind),
          escaped(access.what), escaped(access.before), access.refused ? "refused: " : "", escaped(access.value));
    }
    if (model_.accesses.size() > kMost) add("\n{} more are in report.json.\n", model_.accesses.size() - kMost);
  }

  void network() {
    add("\n## The network\n\n| bus | node | interval or latency | count | minimum | mean | 99 % within | maximum "
        "|\n|---|---|---|---|---|---|---|---|\n");
    for (const BusSummary& bus : model_.summary.buses) {
      for (const Statistic& row : bus.statistics) {
        if (row.count == 0) continue;
        add("| {} | {} | {} | {} | {} | {} | {} | {} |\n", escaped(buses_.name(bus.bus)), name(row.node),
            escaped(row.key), row.count, duration_text(row.minimum_ns),
            duration_text(static_cast<DurationNs>(row.mean_ns)), duration_text(row.percentile_99_ns),
            duration_text(row.maximum_ns));
      }
    }
  }

  void violations() {
    add("\n## Violations\n\n");
    if (model_.findings.empty()) add("None.\n");
    if (!model_.findings.empty()) add("| frame | time | severity | rule | who | |\n|---|---|---|---|---|---|\n");
    for (const Finding& finding : model_.findings) {
      add("| {} | {} | {} | {} | {} | {}{} |\n", finding.frame, at_time(model_, finding.time_ns),
          name_of(finding.severity), rule_row(finding.rule).id, name(finding), escaped(message(finding)),
          finding.count > 1 ? fmt::format("; {} times up to frame {}", finding.count, finding.last_frame) : "");
    }
  }

  std::string& out_;
  const Model& model_;
  const replay::BusNames& buses_;
  const Settings& settings_;
};

}  // namespace

std::string markdown(std::span<const Built> captures, const Settings& settings) {
  std::string out;
  if (captures.size() > 1) {
    out += "# Overview\n\n| capture | verdict | findings |\n|---|---|---|\n";
    for (const Built& built : captures) {
      out += fmt::format("| {} | {} | {} |\n", escaped(built.model.capture.file), escaped(built.model.verdict.headline),
                         built.model.findings.size());
    }
  }
  for (const Built& built : captures) {
    if (!out.empty()) out += "\n";
    Writer(out, built, settings).write();
  }
  return out;
}

}  // namespace servotrace::report
