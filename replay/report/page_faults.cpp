// SPDX-License-Identifier: MIT
// Each fault: what was reported, what preceded it, and why.
#include <algorithm>

#include "decoder/findings/catalogue.hpp"
#include "decoder/render/message.hpp"
#include "decoder/render/value.hpp"
#include "replay/report/analysis.hpp"
#include "replay/report/page.hpp"
#include "replay/report/pages.hpp"
#include "replay/report/pictures.hpp"

namespace servotrace::report {

void Page::faults() {
  if (model_.faults.empty()) return;
  heading(2, "Faults", "faults");
  std::size_t number = 0;
  for (const Fault& entry : model_.faults) fault(entry, ++number);
  if (model_.more_faults != 0)
    add("<p>{} listed under the violations only.</p>\n",
        model_.more_faults == 1 ? "1 more fault is" : fmt::format("{} more faults are", model_.more_faults));
}

void Page::fault(const Fault& fault, std::size_t number) {
  const Finding& finding = model_.findings[fault.finding];
  const Rule& row = rule_row(finding.rule);
  heading(3, fmt::format("{}. {}: {}", number, capitalised(name_of_finding(finding)), fault_text(model_, fault)));
  add("<p>{} {} at {}, frame {}: {}. {}</p>\n", severity(finding.severity), rule_link(finding.rule),
      at_time(model_, fault.time_ns), fault.frame, e(row.title), e(row.why));
  if (fault.frame != finding.frame)
    add("<p>Reported {} later, in frame {}: the drive is asked for the code.</p>\n",
        duration_text(elapsed_ns(fault.time_ns, finding.time_ns)), finding.frame);
  if (fault.code_frame != 0) add("<p>Alarm code read in frame {}: {}.</p>\n", fault.code_frame, e(fault.code_text));
  if (fault.frame != finding.frame) evidence(fault.frame, finding.node);
  evidence(finding.frame, finding.node);
  advice(fault);
  causes(fault);
  before(fault);
  heading(4, "The window before it");
  figure(timeline(model_, settings_, buses_, fault.window_begin_ns, fault.window_end_ns),
         "States and findings around this fault.");
  figure(curves(model_, fault), "Signals of this node around the fault; dashed lines are findings.");
  at_rest(fault);
  messages(fault);
}

// Signals that did not move are a sentence, no curve.
void Page::at_rest(const Fault& fault) {
  std::string text;
  for (const Signal& signal : fault.signals) {
    if (!signal.series.is_constant() || signal.series.bins().empty()) continue;
    const std::string_view unit = symbol(signal.field->unit);
    text += fmt::format("{}{} {}{}{}", text.empty() ? "" : ", ", signal.label,
                        number_text(*signal.field, signal.series.bins().front().last), unit.empty() ? "" : " ", unit);
  }
  if (!text.empty()) add("<p class=\"facts\">Did not move: {}.</p>\n", e(text));
}

void Page::advice(const Fault& fault) {
  const Rule& row = rule_row(model_.findings[fault.finding].rule);
  heading(4, "What the drive or network reported, and what helps");
  begin_table({{"alarm or error"}, {"causes"}, {"remedies"}, {"section"}});
  if (fault.advice.empty()) {
    add("<tr><td>{}</td><td>{}</td><td>{}</td><td class=\"section\">{}</td></tr>\n", e(row.title), e(row.why),
        e(row.fix), e(row.section));
  }
  for (const Advice& entry : fault.advice) {
    add("<tr><td><strong>{}</strong>{}</td><td>{}</td><td>{}</td><td class=\"section\">{}</td></tr>\n", e(entry.name),
        entry.likeliest && fault.advice.size() > 1 ? "<br><span class=\"chip yes\">by the evidence</span>" : "",
        entry.causes.empty() ? "the manual names none" : e(entry.causes),
        entry.remedies.empty() ? e(row.fix) : e(entry.remedies), e(entry.section));
  }
  end_table();
}

void Page::causes(const Fault& fault) {
  if (fault.causes.empty()) return;
  heading(4, "Causes, the likeliest first");
  add("<ol class=\"causes\">\n");
  for (const Candidate& cause : fault.causes) {
    add("<li><span class=\"chip {}\">{}</span> {} <span class=\"facts\">({})</span>", cause.supported ? "yes" : "maybe",
        evidence_word(cause), e(cause.text), e(cause.section));
    if (cause.finding && *cause.finding != fault.finding) {
      const Finding& shown = model_.findings[*cause.finding];
      add("<br>{} at {}, frame {}, {} before: {}", rule_link(shown.rule), e(name_of_finding(shown)), shown.frame,
          duration_text(elapsed_ns(shown.time_ns, fault.time_ns)), e(message(shown)));
      if (shown.count > 1) add(" ({} times up to frame {})", shown.count, shown.last_frame);
    }
    if (cause.access) {
      const Access& access = model_.accesses[*cause.access];
      add("<br>{}, frame {}, {} before: {} \xE2\x86\x92 {}", e(access.what), access.frame,
          duration_text(elapsed_ns(access.time_ns, fault.time_ns)), e(access.before), e(access.value));
    }
    add("</li>\n");
  }
  add("</ol>\n");
}

void Page::before(const Fault& fault) {
  if (fault.preceding.empty()) return;
  heading(4, "Violations that precede it");
  begin_table({{"frame", true}, {"before it", true}, {"rule"}, {"who"}, {"what"}});
  for (const std::size_t index : fault.preceding) {
    const Finding& entry = model_.findings[index];
    add("<tr><td class=\"number\">{}</td><td class=\"number\">{}</td><td>{}</td><td "
        "class=\"who\">{}</td><td>{}{}</td></tr>\n",
        entry.frame, duration_text(elapsed_ns(entry.time_ns, fault.time_ns)), rule_link(entry.rule),
        e(name_of_finding(entry)), e(message(entry)),
        entry.count > 1 ? fmt::format(" ({} times up to frame {})", entry.count, entry.last_frame) : "");
  }
  end_table();
}

void Page::messages(const Fault& fault) {
  if (fault.messages.empty()) return;
  heading(4, "Last command and response");
  add("<p class=\"facts\">Each beside the last different one of its kind before it. Fields that changed are marked and "
      "stand first.</p>\n<div class=\"pair\">\n");
  for (const MessagePair& pair : fault.messages) message_pair(pair);
  add("</div>\n");
}

void Page::message_pair(const MessagePair& pair) {
  const std::string_view direction = pair.direction == Direction::kCommand ? "Command" : "Response";
  const std::string after = fmt::format("frame {}", pair.after_frame);
  if (pair.before_frame == 0) {
    add("<div>");
    begin_table({{direction}, {after}});
    for (const FieldRow& row : pair.rows)
      add("<tr><td><span title=\"{}\">{}</span></td><td>{}</td></tr>\n", e(row.filter), e(row.label), e(row.after));
    end_table();
    add("<p class=\"facts\">No different one of its kind came before it.</p></div>\n");
    return;
  }
  const std::string before = fmt::format("frame {}", pair.before_frame);
  const auto rows = [&](bool differing) {
    begin_table({{direction}, {before}, {after}});
    for (const FieldRow& row : pair.rows) {
      if (row.differs != differing) continue;
      add("<tr><td><span title=\"{}\">{}</span></td><td>{}</td><td{}>{}</td></tr>\n", e(row.filter), e(row.label),
          e(row.before), differing ? " class=\"differs\"" : "", e(row.after));
    }
    end_table();
  };
  const auto changed = static_cast<std::size_t>(
      std::count_if(pair.rows.begin(), pair.rows.end(), [](const FieldRow& row) { return row.differs; }));
  add("<div>");
  if (changed != 0) rows(true);
  if (changed < pair.rows.size()) {
    add("<details{}><summary>{}: {} that did not change</summary>\n", changed == 0 ? " open" : "", direction,
        plural(pair.rows.size() - changed, "field"));
    rows(false);
    add("</details>\n");
  }
  add("</div>\n");
}

}  // namespace servotrace::report
