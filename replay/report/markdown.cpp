// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "decoder/findings/catalogue.hpp"
#include "decoder/render/message.hpp"
#include "decoder/render/node.hpp"
#include "decoder/render/value.hpp"
#include "replay/report/analysis.hpp"
#include "replay/report/pages.hpp"

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

void write(std::string& out, const Built& built, const Settings& settings) {
  const Model& model = built.model;
  const auto add = [&out]<class... Arguments>(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(out), format, std::forward<Arguments>(arguments)...);
  };
  add("# servotrace report: {}\n\n{} frames, {} of them on known buses ({}).\n\n## Verdict\n\n**{}**\n",
      escaped(model.capture.file), model.capture.frames, model.capture.checked_frames, escaped(model.capture.format),
      escaped(model.verdict.headline));
  for (const std::string& sentence : model.verdict.sentences) add("\n{}\n", escaped(sentence));
  if (!model.faults.empty()) {
    add("\n## Faults\n");
    std::size_t number = 0;
    for (const Fault& fault : model.faults) {
      const Finding& finding = model.findings[fault.finding];
      add("\n### {}. {}: {}\n\n{} at {}, frame {}: {}.\n", ++number, escaped(who(finding, settings, built.buses)),
          escaped(rule_row(finding.rule).title), rule_row(finding.rule).id, at_time(model, finding.time_ns),
          finding.frame, escaped(message(finding)));
      if (!fault.causes.empty()) add("\nCauses, the likeliest first:\n\n");
      for (const Candidate& cause : fault.causes) {
        add("1. {}: {} ({})", evidence_word(cause), escaped(cause.text), escaped(cause.section));
        if (cause.finding) {
          const Finding& shown = model.findings[*cause.finding];
          add("; {} at frame {}: {}", rule_row(shown.rule).id, shown.frame, escaped(message(shown)));
        }
        add("\n");
      }
    }
  }
  add("\n## Axes and nodes\n\n| node | profile | recognised | known settings |\n|---|---|---|---|\n");
  for (const BusSummary& bus : model.summary.buses) {
    for (const NodeSummary& node : bus.nodes) {
      std::string facts;
      for (const Fact& fact : node.facts)
        facts += fmt::format("{}{} = {}", facts.empty() ? "" : ", ", fact.key, fact.value);
      add("| {}, {} | {} | {} | {} |\n", escaped(node_text(node.node, configured_name(settings, node.node))),
          escaped(built.buses.name(bus.bus)), escaped(node.profile), escaped(node.recognised), escaped(facts));
    }
  }
  add("\n## Findings\n\n");
  if (model.findings.empty()) add("None.\n");
  if (!model.findings.empty()) add("| frame | time | severity | rule | who | |\n|---|---|---|---|---|---|\n");
  for (const Finding& finding : model.findings) {
    add("| {} | {} | {} | {} | {} | {}{} |\n", finding.frame, at_time(model, finding.time_ns),
        name_of(finding.severity), rule_row(finding.rule).id, escaped(who(finding, settings, built.buses)),
        escaped(message(finding)),
        finding.count > 1 ? fmt::format("; {} times up to frame {}", finding.count, finding.last_frame) : "");
  }
  add("\n## What this capture cannot show\n\n");
  for (const std::string& text : model.cannot_show) add("- {}\n", escaped(text));
}

}  // namespace

std::string markdown(std::span<const Built> captures, const Settings& settings) {
  std::string out;
  for (const Built& built : captures) {
    if (!out.empty()) out += "\n";
    write(out, built, settings);
  }
  return out;
}

}  // namespace servotrace::report
