// SPDX-License-Identifier: MIT
// What happened: verdict, comparison, timeline and the order of events.
#include <algorithm>

#include "decoder/findings/catalogue.hpp"
#include "decoder/render/message.hpp"
#include "decoder/render/value.hpp"
#include "replay/report/analysis.hpp"
#include "replay/report/page.hpp"
#include "replay/report/pictures.hpp"

namespace servotrace::report {

void Page::verdict() {
  constexpr std::string_view kClasses[] = {"nothing", "clean", "violations", "fault"};
  heading(2, "Verdict", "verdict");
  add("<div class=\"verdict {}\"><p class=\"headline\">{}</p>\n",
      kClasses[static_cast<std::size_t>(model_.verdict.kind)], e(model_.verdict.headline));
  for (const std::string& sentence : model_.verdict.sentences) add("<p>{}</p>\n", e(sentence));
  add("</div>\n");
}

void Page::comparison() {
  if (!model_.comparison) return;
  const Comparison& other = *model_.comparison;
  heading(2, "Where the captures part", "against");
  add("<p>This capture beside <strong>{}</strong>, of which the verdict is: {}</p>\n", e(other.file),
      e(other.headline));
  if (other.partings.empty() && other.settings.empty() && other.rules.empty()) {
    add("<p>States, settings and findings agree.</p>\n");
    return;
  }
  if (!other.partings.empty()) {
    const Parting& first = other.partings.front();
    add("<p>They part first at {}: {} is \"{}\" here and \"{}\" there, {:.6f} s after the start.</p>\n",
        e(node_name(first.node)), e(first.field->label), e(first.here), e(first.there),
        static_cast<double>(first.after_ns) / 1e9);
    begin_table({{"after the start", true},
                 {"who"},
                 {"state"},
                 {"here"},
                 {"frame here", true},
                 {"there"},
                 {"frame there", true}});
    const auto frame = [](std::uint64_t number) { return number == 0 ? std::string() : std::to_string(number); };
    for (const Parting& row : other.partings) {
      add("<tr><td class=\"number\">{:.6f} s</td><td>{}</td><td>{}</td><td>{}</td><td class=\"number\">{}</td>"
          "<td>{}</td><td class=\"number\">{}</td></tr>\n",
          static_cast<double>(row.after_ns) / 1e9, e(node_name(row.node)), e(row.field->label), e(row.here),
          frame(row.here_frame), e(row.there), frame(row.there_frame));
    }
    end_table();
    if (other.more_partings != 0) add("<p>{} more states differ.</p>\n", other.more_partings);
  }
  if (!other.settings.empty()) {
    heading(3, "Settings and parameters that differ");
    begin_table({{"who"}, {"setting"}, {"here"}, {"there"}});
    for (const Comparison::Setting& row : other.settings) {
      add("<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n", e(row.node), e(row.key),
          row.here.empty() ? "not shown" : e(row.here), row.there.empty() ? "not shown" : e(row.there));
    }
    end_table();
  }
  if (!other.rules.empty()) {
    heading(3, "Findings that differ");
    begin_table({{"rule"}, {""}, {"here", true}, {"there", true}});
    for (const Comparison::RuleCount& row : other.rules) {
      add("<tr><td>{}</td><td>{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td></tr>\n",
          rule_row(row.rule).id, e(rule_row(row.rule).title), row.here, row.there);
    }
    end_table();
  }
}

void Page::timelines() {
  heading(2, "First-out timeline", "timeline");
  figure(timeline(model_, settings_, buses_, model_.capture.first_ns, model_.capture.last_ns),
         "Bars: the state is on, or the mode it names. Marks: \xE2\x96\xB2 error, \xE2\x97\x86 warning, \xE2\x97\x8F "
         "note; a line below a mark is how long it lasted. Time counts from the first frame.");
  story();
}

// The order of events as text: states that tell something, and findings.
void Page::story() {
  struct Line {
    std::uint64_t frame;
    TimeNs time_ns;
    const Event* event;
    const Finding* finding;
  };
  std::vector<Line> lines;
  std::uint64_t more = 0;
  for (const StateTrack& track : model_.tracks) {
    for (const Event& event : track.changes) lines.push_back({event.frame, event.time_ns, &event, nullptr});
    more += track.total - track.changes.size();
  }
  for (const Finding& finding : model_.findings) lines.push_back({finding.frame, finding.time_ns, nullptr, &finding});
  std::stable_sort(lines.begin(), lines.end(), [](const Line& left, const Line& right) {
    return left.frame != right.frame ? left.frame < right.frame : (left.event != nullptr && right.event == nullptr);
  });
  const Finding* const first = model_.verdict.first ? &model_.findings[*model_.verdict.first] : nullptr;
  const auto write = [&](const Line& line) {
    if (line.finding != nullptr) {
      add("<tr{}><td class=\"number\">{}</td><td class=\"number\">{}</td><td class=\"who\">{}</td><td>{} {} "
          "{}</td></tr>\n",
          line.finding == first ? " class=\"fault-row\"" : "", at_time(model_, line.time_ns), line.frame,
          e(name_of_finding(*line.finding)), severity(line.finding->severity), rule_link(line.finding->rule),
          e(message(*line.finding)));
      return;
    }
    const Event& event = *line.event;
    add("<tr><td class=\"number\">{}</td><td class=\"number\">{}</td><td class=\"who\">{}</td><td>{}: {} \xE2\x86\x92 "
        "{}{}</td></tr>\n",
        at_time(model_, line.time_ns), line.frame, e(node_name(event.node)), e(event.field->label),
        e(value_text(*event.field, event.before)), e(value_text(*event.field, event.after)),
        event.joined != 0 ? fmt::format(", and {} close behind", plural(event.joined, "more change")) : "");
  };
  const auto table = [&](const std::vector<const Line*>& shown) {
    begin_table({{"time", true}, {"frame", true}, {"who"}, {"what"}});
    for (const Line* line : shown) write(*line);
    end_table();
  };
  // Around the first fault: the last 24 telling lines before it and 12 after; without one the first 36.
  std::vector<const Line*> telling;
  std::size_t at = 0;
  for (const Line& line : lines) {
    if (line.finding == nullptr && importance(*line.event->field) > 2) continue;
    if (first != nullptr && line.finding == first) at = telling.size();
    telling.push_back(&line);
  }
  const std::size_t begin = at > 24 ? at - 24 : 0;
  const std::size_t end = std::min(telling.size(), begin + 36);
  heading(3, "What happened, in order");
  if (telling.empty()) {
    add("<p>No servo, alarm, limit or progress state changed, and nothing was found.</p>\n");
  } else {
    table({telling.begin() + static_cast<std::ptrdiff_t>(begin), telling.begin() + static_cast<std::ptrdiff_t>(end)});
  }
  constexpr std::size_t kMost = 2000;
  if (lines.size() == end - begin) return;
  add("<details class=\"long\"><summary>Every change of state and every finding ({})</summary>\n", lines.size() + more);
  std::vector<const Line*> all;
  // Where there are too many, those around the first fault.
  const auto fault = std::find_if(lines.begin(), lines.end(),
                                  [first](const Line& line) { return first != nullptr && line.finding == first; });
  const auto until = static_cast<std::size_t>(fault == lines.end() ? 0 : fault - lines.begin());
  const std::size_t from = lines.size() > kMost && until > kMost * 3 / 4 ? until - kMost * 3 / 4 : 0;
  for (std::size_t i = from; i < lines.size() && all.size() < kMost; ++i) all.push_back(&lines[i]);
  table(all);
  if (more + lines.size() > all.size()) add("<p>{} not listed.</p>", more + lines.size() - all.size());
  add("</details>\n");
}

}  // namespace servotrace::report
