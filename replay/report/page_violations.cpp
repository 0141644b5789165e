// SPDX-License-Identifier: MIT
// Violations by rule with their evidence, and what the capture cannot show.
#include <algorithm>
#include <map>

#include "decoder/findings/catalogue.hpp"
#include "decoder/render/message.hpp"
#include "replay/report/analysis.hpp"
#include "replay/report/page.hpp"
#include "replay/report/pages.hpp"

namespace servotrace::report {

void Page::violations() {
  heading(2, "Violations by rule", "violations");
  std::map<std::string_view, std::vector<const Finding*>> by_rule;
  for (const Finding& finding : model_.findings) by_rule[rule_row(finding.rule).id].push_back(&finding);
  std::uint64_t checked = 0;
  for (const RuleTotal& total : model_.rules) checked += total.checked != 0 ? 1 : 0;
  add("<p>{} of {} rules had an opportunity in this capture.</p>\n", checked, model_.rules.size());
  if (by_rule.empty()) {
    add("<p>None was broken.</p>\n");
    return;
  }
  begin_table({{"rule"}, {"what"}, {"severity"}, {"findings", true}, {"first frame", true}});
  for (const auto& [id, findings] : by_rule) {
    const Finding& first = *findings.front();
    const auto worst =
        std::max_element(findings.begin(), findings.end(),
                         [](const Finding* left, const Finding* right) { return left->severity < right->severity; });
    add("<tr><td>{}</td><td>{}</td><td>{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td></tr>\n",
        rule_link(first.rule), e(rule_row(first.rule).title), severity((*worst)->severity), findings.size(),
        first.frame);
  }
  end_table();
  for (const auto& [id, findings] : by_rule) rule(findings);
}

void Page::rule(const std::vector<const Finding*>& findings) {
  const Rule& row = rule_row(findings.front()->rule);
  heading(3, fmt::format("{} {}", row.id, row.slug), row.id);
  add("<p><strong>{}</strong> ({}, {}; {}). {}</p>\n<p>What to do: {}</p>\n", e(row.title), name_of(row.severity),
      name_of(findings.front()->actor), e(row.section), e(row.why), e(row.fix));
  constexpr std::size_t kOpen = 5;    // shown at once
  constexpr std::size_t kMost = 100;  // in the file
  for (std::size_t i = 0; i < findings.size() && i < kMost; ++i) {
    if (i == kOpen)
      add("<details class=\"long\"><summary>{} of {}</summary>\n", plural(findings.size() - kOpen, "more finding"),
          row.id);
    const Finding& finding = *findings[i];
    add("<div class=\"finding\"><p>{} frame {} ({}), {}: {}", severity(finding.severity), finding.frame,
        at_time(model_, finding.time_ns), e(name_of_finding(finding)), e(message(finding)));
    if (finding.count > 1) add("; {} times up to frame {}", finding.count, finding.last_frame);
    if (finding.cause.frame != 0) add("; answers {} of frame {}", rule_row(finding.cause.rule).id, finding.cause.frame);
    const std::string basis = basis_text(finding.basis);
    if (!basis.empty()) add("; setting {}", e(basis));
    add("</p>\n");
    for (const std::uint64_t related : finding.related) {
      if (related != 0 && related != finding.frame) evidence(related, finding.node);
    }
    evidence(finding.frame, finding.node);
    in_full(finding);
    add("</div>\n");
  }
  if (findings.size() > kOpen) add("</details>\n");
  if (findings.size() > kMost) add("<p>{} more are in report.json.</p>\n", findings.size() - kMost);
}

// The frames of a finding field by field, the bytes it points at marked.
void Page::in_full(const Finding& finding) {
  std::vector<std::uint64_t> frames;
  for (const std::uint64_t frame : {finding.related[0], finding.related[1], finding.frame}) {
    const auto found = model_.evidence.find(frame_key(frame, finding.node));
    if (frame != 0 && found != model_.evidence.end() && !found->second.bytes.empty()) frames.push_back(frame);
  }
  std::sort(frames.begin(), frames.end());
  frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
  if (frames.empty()) return;
  add("<details class=\"long\"><summary>{} in full</summary>\n<div class=\"pair\">\n",
      frames.size() == 1 ? "The frame" : "The frames");
  for (const std::uint64_t frame : frames) {
    const ShownFrame& shown = model_.evidence.at(frame_key(frame, finding.node));
    add("<div><p class=\"evidence\"><b>frame {}</b> {}</p>\n", frame, e(shown.bytes));
    if (!shown.fields.empty()) begin_table({{"field"}, {"value"}});
    for (const ShownField& field : shown.fields)
      add("<tr><td>{}</td><td{}>{}</td></tr>\n", e(field.label), field.marked ? " class=\"differs\"" : "",
          e(field.value));
    if (!shown.fields.empty()) end_table();
    add("</div>\n");
  }
  add("</div></details>\n");
}

void Page::limits() {
  heading(2, "What this capture cannot show", "limits");
  add("<ul>\n");
  for (const std::string& text : model_.cannot_show) add("<li>{}</li>\n", e(text));
  add("</ul>\n");
}

}  // namespace servotrace::report
