// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "decoder/findings/catalogue.hpp"
#include "decoder/render/message.hpp"
#include "decoder/render/node.hpp"
#include "decoder/render/value.hpp"
#include "replay/report/analysis.hpp"
#include "replay/report/pages.hpp"
#include "replay/report/pictures.hpp"
#include "replay/report/svg.hpp"

namespace servotrace::report {
namespace {

// Light, dark and print; the picture classes of svg.hpp.
constexpr std::string_view kStyle = R"css(
:root{--ink:#1b1f24;--soft:#57606a;--line:#d0d7de;--paper:#fff;--panel:#f6f8fa;--accent:#0550ae;--bar:#6a8caf;--bad:#b42318;--warn:#8a5a00;--note:#42657a;--good:#1a6b34;--mark:#fff1c2}
@media (prefers-color-scheme:dark){:root{--ink:#e6edf3;--soft:#9aa7b4;--line:#3a434d;--paper:#12161b;--panel:#1b2128;--accent:#79b8ff;--bar:#5f87b3;--bad:#ff8a7a;--warn:#e8b64c;--note:#8fb8d0;--good:#6fd08c;--mark:#4a3d12}}
*{box-sizing:border-box}
body{font:16px/1.5 system-ui,"Segoe UI",Roboto,sans-serif;color:var(--ink);background:var(--paper);margin:0 auto;max-width:1180px;padding:24px 32px 64px}
h1{font-size:1.6rem;margin:0 0 4px}h2{font-size:1.25rem;margin:40px 0 10px;border-bottom:1px solid var(--line);padding-bottom:4px}h3{font-size:1.05rem;margin:26px 0 6px}h4{font-size:.95rem;margin:16px 0 4px}
a{color:var(--accent)}p{margin:6px 0}
.facts{color:var(--soft);margin:0 0 12px}
.verdict{border-left:6px solid var(--good);background:var(--panel);padding:14px 18px;border-radius:4px}
.verdict.fault{border-color:var(--bad)}.verdict.violations{border-color:var(--warn)}.verdict.nothing{border-color:var(--soft)}
.verdict .headline{font-size:1.15rem;font-weight:600}
table{border-collapse:collapse;width:100%;margin:8px 0;font-size:.9rem}th,td{border-bottom:1px solid var(--line);padding:4px 8px;text-align:left;vertical-align:top}th{color:var(--soft);font-weight:600}td.number,th.number{text-align:right;font-variant-numeric:tabular-nums}
.wide{overflow-x:auto}
td.differs{background:var(--mark);font-weight:600}
code,.evidence{font-family:ui-monospace,"DejaVu Sans Mono",Consolas,monospace;font-size:.85rem}
.evidence{margin:2px 0 2px 16px;overflow-wrap:anywhere}
.severity{font-weight:600;white-space:nowrap}.severity.error{color:var(--bad)}.severity.warning{color:var(--warn)}.severity.note{color:var(--note)}
details{margin:6px 0}summary{cursor:pointer}
svg{width:100%;height:auto;display:block;margin:8px 0;background:var(--paper)}
svg text{font:12px system-ui,sans-serif;fill:var(--ink)}svg .tick{fill:var(--soft);font-size:11px}svg .state{fill:var(--soft);font-size:10.5px}svg .lane-name{font-weight:600}
svg .grid{stroke:var(--line);stroke-width:.6}svg .lane{stroke:var(--line);stroke-width:1}
svg .bar{fill:var(--bar)}svg .bar.bad{fill:var(--bad)}
svg .error{fill:var(--bad)}svg .warning{fill:var(--warn)}svg .note{fill:var(--note)}
svg .first-fault{stroke:var(--bad);stroke-width:1.6;stroke-dasharray:5 3}svg .first-fault-text{fill:var(--bad);font-weight:600}
svg .violation-line{stroke:var(--warn);stroke-width:1;stroke-dasharray:2 3}
svg .curve{fill:none;stroke:var(--accent);stroke-width:1.4}
nav ul{columns:2;padding-left:20px;margin:6px 0}
footer{margin-top:48px;color:var(--soft);font-size:.85rem;border-top:1px solid var(--line);padding-top:8px}
@media print{:root{--ink:#000;--soft:#444;--line:#bbb;--paper:#fff;--panel:#f4f4f4;--accent:#003a8c;--bar:#6a8caf;--bad:#a01010;--warn:#7a4d00;--note:#345;--mark:#ffe9a8}body{max-width:none;padding:0;font-size:11pt}h2,h3{break-after:avoid}svg,tr,.verdict{break-inside:avoid}details>*{display:block}nav{display:none}}
)css";

class Page {
 public:
  Page(const Built& built, const Settings& settings, std::string prefix)
      : model_(built.model), buses_(built.buses), settings_(settings), prefix_(std::move(prefix)) {}

  std::string body() {
    verdict();
    if (model_.verdict.kind == VerdictKind::kNothingChecked) {
      limits();
      return std::move(out_);
    }
    timelines();
    faults();
    nodes();
    network();
    violations();
    limits();
    return std::move(out_);
  }

 private:
  void add(std::string_view text) { out_ += text; }
  template <class... Arguments>
  void add(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(out_), format, std::forward<Arguments>(arguments)...);
  }
  static std::string e(std::string_view text) { return escape_html(text); }
  void heading(std::string_view id, std::string_view text) { add("<h2 id=\"{}{}\">{}</h2>\n", prefix_, id, e(text)); }
  static std::string severity(Severity value) {
    return fmt::format("<span class=\"severity {0}\">{0}</span>", name_of(value));
  }
  std::string rule_link(RuleId id) const {
    return fmt::format("<a href=\"#{}{}\">{}</a>", prefix_, rule_row(id).id, rule_row(id).id);
  }
  void evidence(std::uint64_t frame) {
    const auto found = model_.evidence.find(frame);
    if (found == model_.evidence.end()) return;
    add("<p class=\"evidence\">{}: {}</p>\n", frame, e(found->second.empty() ? "(nothing recognised)" : found->second));
  }

  void verdict() {
    constexpr std::string_view kClasses[] = {"nothing", "clean", "violations", "fault"};
    heading("verdict", "Verdict");
    add("<div class=\"verdict {}\"><p class=\"headline\">{}</p>\n",
        kClasses[static_cast<std::size_t>(model_.verdict.kind)], e(model_.verdict.headline));
    for (const std::string& sentence : model_.verdict.sentences) add("<p>{}</p>\n", e(sentence));
    add("</div>\n");
  }

  void timelines() {
    heading("timeline", "Timeline");
    add("<p>Bars: the state is on. Triangle: error, diamond: warning, circle: note. Time counts from the first "
        "frame.</p>\n");
    add(timeline(model_, settings_, buses_, model_.capture.first_ns, model_.capture.last_ns));
    if (!model_.faults.empty()) {
      const Fault& first = model_.faults.front();
      const TimeNs begin = std::max(first.window_begin_ns, model_.capture.first_ns);
      const TimeNs end = std::min(first.window_end_ns, model_.capture.last_ns);
      // A close-up of nearly everything would show the same picture again.
      if (elapsed_ns(begin, end) < elapsed_ns(model_.capture.first_ns, model_.capture.last_ns) / 2) {
        add("<h3>Before the first fault</h3>\n");
        add(timeline(model_, settings_, buses_, begin, end));
      }
    }
    add("<details><summary>Every change of state</summary><div "
        "class=\"wide\"><table><tr><th>time</th><th>frame</th><th>who</th><th>state</th><th>from</th><th>to</th></"
        "tr>\n");
    std::vector<const Event*> events;
    std::uint64_t more = 0;
    for (const StateTrack& track : model_.tracks) {
      for (const Event& event : track.changes) events.push_back(&event);
      more += track.dropped;
    }
    std::stable_sort(events.begin(), events.end(),
                     [](const Event* left, const Event* right) { return left->frame < right->frame; });
    constexpr std::size_t kMost = 3000;
    if (events.size() > kMost) more += events.size() - kMost;
    for (std::size_t i = 0; i < events.size() && i < kMost; ++i) {
      const Event& event = *events[i];
      add("<tr><td>{}</td><td class=\"number\">{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
          at_time(model_, event.time_ns), event.frame, e(node_name(event.node)), e(event.field->label),
          e(value_text(*event.field, event.before)), e(value_text(*event.field, event.after)));
    }
    add("</table></div>");
    if (more != 0) add("<p>{} more changes are not listed.</p>", more);
    add("</details>\n");
  }

  std::string node_name(const NodeRef& node) const {
    const std::string text = node_text(node, configured_name(settings_, node));
    const std::string_view bus = buses_.name(node.bus);
    if (text.empty()) return bus.empty() ? "capture" : std::string(bus);
    return buses_.size() > 1 ? fmt::format("{}, {}", text, bus) : text;
  }

  void faults() {
    if (model_.faults.empty()) return;
    heading("faults", "Faults");
    std::size_t number = 0;
    for (const Fault& fault : model_.faults) {
      const Finding& finding = model_.findings[fault.finding];
      const Rule& row = rule_row(finding.rule);
      add("<h3>{}. {}: {}</h3>\n", ++number, e(who(finding, settings_, buses_)), e(row.title));
      add("<p>{} {} at {}, frame {}: {}.</p><p>{}</p><p>What to do: {}</p>\n", severity(finding.severity),
          rule_link(finding.rule), at_time(model_, finding.time_ns), finding.frame, e(message(finding)), e(row.why),
          e(row.fix));
      if (fault.code_frame != 0) add("<p>Alarm code read in frame {}: {}.</p>\n", fault.code_frame, e(fault.code_text));
      evidence(finding.frame);
      if (!fault.causes.empty()) {
        add("<h4>Causes, the likeliest first</h4>\n<ol>\n");
        for (const Candidate& cause : fault.causes) {
          add("<li><strong>{}</strong>: {} <span class=\"facts\">({})</span>", evidence_word(cause), e(cause.text),
              e(cause.section));
          if (cause.finding) {
            const Finding& shown = model_.findings[*cause.finding];
            add("<br>{} at {}, frame {}, {} before: {}", rule_link(shown.rule), e(who(shown, settings_, buses_)),
                shown.frame, duration_text(elapsed_ns(shown.time_ns, finding.time_ns)), e(message(shown)));
          }
          add("</li>\n");
        }
        add("</ol>\n");
      }
      if (!fault.preceding.empty()) {
        add("<h4>What was found before it</h4>\n<table><tr><th>frame</th><th>before the "
            "fault</th><th>rule</th><th>who</th><th></th></tr>\n");
        for (const std::size_t index : fault.preceding) {
          const Finding& before = model_.findings[index];
          add("<tr><td class=\"number\">{}</td><td class=\"number\">{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
              before.frame, duration_text(elapsed_ns(before.time_ns, finding.time_ns)), rule_link(before.rule),
              e(who(before, settings_, buses_)), e(message(before)));
        }
        add("</table>\n");
      }
      const std::string picture = curves(model_, fault);
      if (!picture.empty()) add("<h4>Signals around it</h4>\n{}", picture);
      for (const MessagePair& pair : fault.messages) message_pair(pair);
    }
    if (model_.more_faults != 0)
      add("<p>{} more faults are listed under the violations only.</p>\n", model_.more_faults);
  }

  void message_pair(const MessagePair& pair) {
    add("<h4>Last {}</h4>\n<div class=\"wide\"><table><tr><th>field</th><th></th><th>{}</th><th>frame {}</th></tr>\n",
        pair.direction == Direction::kCommand ? "command" : "response",
        pair.before_frame != 0 ? fmt::format("frame {}", pair.before_frame) : "", pair.after_frame);
    for (const FieldRow& row : pair.rows) {
      add("<tr><td><code>{}</code></td><td>{}</td><td>{}</td><td{}>{}{}</td></tr>\n", e(row.filter), e(row.label),
          e(row.before), row.differs ? " class=\"differs\"" : "", e(row.after), row.differs ? " (changed)" : "");
    }
    add("</table></div>\n");
  }

  void nodes() {
    heading("nodes", "Axes and nodes");
    for (const BusSummary& bus : model_.summary.buses) {
      for (const NodeSummary& node : bus.nodes) {
        NodeRef reference = node.node;
        add("<h3>{}</h3>\n<table>\n", e(node_name(reference)));
        const auto row = [&](std::string_view key, std::string_view value, std::string_view how) {
          if (!value.empty()) add("<tr><th>{}</th><td>{}</td><td>{}</td></tr>\n", e(key), e(value), e(how));
        };
        row("profile", node.profile, node.recognised);
        for (const Fact& fact : node.facts) row(fact.key, fact.value, basis_text(fact.basis));
        add("</table>\n");
        statistics(bus, &reference);
      }
    }
  }

  void statistics(const BusSummary& bus, const NodeRef* node) {
    std::string rows;
    for (const Statistic& statistic : bus.statistics) {
      const bool of_bus = statistic.node.mac_id == kNoMacId;
      if (node == nullptr ? !of_bus : of_bus || statistic.node.mac_id != node->mac_id) continue;
      if (statistic.count == 0) continue;
      rows += fmt::format(
          "<tr><td>{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td><td "
          "class=\"number\">{}</td><td class=\"number\">{}</td></tr>\n",
          e(statistic.key), statistic.count, duration_text(statistic.minimum_ns),
          duration_text(static_cast<DurationNs>(statistic.mean_ns)), duration_text(statistic.percentile_99_ns),
          duration_text(statistic.maximum_ns));
    }
    if (rows.empty()) return;
    add("<table><tr><th>latency or interval</th><th class=\"number\">count</th><th class=\"number\">minimum</th><th "
        "class=\"number\">mean</th><th class=\"number\">99 %</th><th class=\"number\">maximum</th></tr>\n{}</table>\n",
        rows);
  }

  void network() {
    heading("network", "The network");
    for (const BusSummary& bus : model_.summary.buses) {
      const std::string_view name = buses_.name(bus.bus);
      add("<h3>{}</h3>\n<p class=\"facts\">{} frames; {}; {}</p>\n", e(name), bus.frames,
          bus.protocol == Protocol::kRtex        ? "RTEX"
          : bus.protocol == Protocol::kDevicenet ? "DeviceNet"
                                                 : "CAN, not recognised as DeviceNet",
          e(bus.recognised));
      if (!bus.facts.empty()) {
        add("<table>\n");
        for (const Fact& fact : bus.facts)
          add("<tr><th>{}</th><td>{}</td><td>{}</td></tr>\n", e(fact.key), e(fact.value), e(basis_text(fact.basis)));
        add("</table>\n");
      }
      statistics(bus, nullptr);
      for (const Histogram& entry : model_.histograms) {
        if (entry.bus == bus.bus) add(histogram(entry, name));
      }
    }
  }

  void violations() {
    heading("violations", "Violations by rule");
    std::map<std::string_view, std::vector<const Finding*>> by_rule;
    for (const Finding& finding : model_.findings) by_rule[rule_row(finding.rule).id].push_back(&finding);
    std::uint64_t checked = 0;
    for (const RuleTotal& total : model_.rules) checked += total.checked != 0 ? 1 : 0;
    add("<p>{} findings of {} rules; {} rules had an opportunity and {} of them found nothing.</p>\n",
        model_.findings.size(), by_rule.size(), checked, checked - std::min<std::uint64_t>(checked, by_rule.size()));
    for (const auto& [id, findings] : by_rule) {
      const Rule& row = rule_row(findings.front()->rule);
      add("<h3 id=\"{}{}\">{} {}</h3>\n<p><strong>{}</strong> ({}, {}; {}). {}</p><p>What to do: {}</p>\n", prefix_, id,
          id, e(row.slug), e(row.title), name_of(row.severity), name_of(row.actor), e(row.section), e(row.why),
          e(row.fix));
      add("<details open><summary>{} findings</summary>\n", findings.size());
      constexpr std::size_t kMost = 100;
      for (std::size_t i = 0; i < findings.size() && i < kMost; ++i) {
        const Finding& finding = *findings[i];
        add("<p>{} frame {} ({}), {}: {}", severity(finding.severity), finding.frame, at_time(model_, finding.time_ns),
            e(who(finding, settings_, buses_)), e(message(finding)));
        if (finding.count > 1) add("; {} times up to frame {}", finding.count, finding.last_frame);
        if (finding.cause.frame != 0)
          add("; answers {} of frame {}", rule_link(finding.cause.rule), finding.cause.frame);
        const std::string basis = basis_text(finding.basis);
        if (!basis.empty()) add("; setting {}", e(basis));
        add("</p>\n");
        for (const std::uint64_t related : finding.related) {
          if (related != 0 && related != finding.frame) evidence(related);
        }
        evidence(finding.frame);
      }
      if (findings.size() > kMost) add("<p>{} more are not listed.</p>\n", findings.size() - kMost);
      add("</details>\n");
    }
  }

  void limits() {
    heading("limits", "What this capture cannot show");
    add("<ul>\n");
    for (const std::string& text : model_.cannot_show) add("<li>{}</li>\n", e(text));
    add("</ul>\n");
  }

  const Model& model_;
  const replay::BusNames& buses_;
  const Settings& settings_;
  std::string prefix_;  // of ids, where several captures share the page
  std::string out_;
};

std::string capture_facts(const Model& model) {
  std::string text = fmt::format("{} frames, {} of them on known buses; {}", model.capture.frames,
                                 model.capture.checked_frames, model.capture.format);
  if (model.capture.has_time) {
    text += fmt::format("; {} to {} ({:.3f} s)", time_text(model.capture.first_ns), time_text(model.capture.last_ns),
                        static_cast<double>(elapsed_ns(model.capture.first_ns, model.capture.last_ns)) / 1e9);
  }
  return text;
}

}  // namespace

std::string_view evidence_word(const Candidate& candidate) {
  return candidate.supported ? "supported by the capture" : "only possible";
}

std::string basis_text(const Basis& basis) {
  switch (basis.kind) {
    case BasisKind::kNone:
      return {};
    case BasisKind::kConfigured:
      return "configured";
    case BasisKind::kCapture:
      return basis.frame == 0 ? "shown by the capture" : fmt::format("shown by frame {}", basis.frame);
    case BasisKind::kAssumed:
      return "assumed";
  }
  return {};
}

std::string html(std::span<const Built> captures, const Settings& settings) {
  const std::string title = captures.size() == 1
                                ? fmt::format("servotrace report: {}", captures.front().model.capture.file)
                                : "servotrace report";
  std::string out = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light "
      "dark\">\n<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n<header>\n<h1>{}</h1>\n",
      escape_html(title), kStyle, escape_html(title));
  if (captures.size() == 1) {
    out += fmt::format("<p class=\"facts\">{}</p>\n<nav aria-label=\"Contents\"><ul>",
                       escape_html(capture_facts(captures.front().model)));
    constexpr std::pair<std::string_view, std::string_view> kSections[] = {{"verdict", "Verdict"},
                                                                           {"timeline", "Timeline"},
                                                                           {"faults", "Faults"},
                                                                           {"nodes", "Axes and nodes"},
                                                                           {"network", "The network"},
                                                                           {"violations", "Violations by rule"},
                                                                           {"limits", "What this capture cannot show"}};
    for (const auto& [id, name] : kSections) {
      if (id == "faults" && captures.front().model.faults.empty()) continue;
      if (captures.front().model.verdict.kind == VerdictKind::kNothingChecked && id != "verdict" && id != "limits")
        continue;
      out += fmt::format("<li><a href=\"#{}\">{}</a></li>", id, name);
    }
    out += "</ul></nav>\n";
  }
  out += "</header>\n<main>\n";
  if (captures.size() > 1) {
    out += "<h2>Overview</h2>\n<table><tr><th>capture</th><th>verdict</th><th class=\"number\">findings</th></tr>\n";
    for (std::size_t i = 0; i < captures.size(); ++i) {
      const Model& model = captures[i].model;
      out += fmt::format("<tr><td><a href=\"#c{}\">{}</a></td><td>{}</td><td class=\"number\">{}</td></tr>\n", i + 1,
                         escape_html(model.capture.file), escape_html(model.verdict.headline), model.findings.size());
    }
    out += "</table>\n";
  }
  for (std::size_t i = 0; i < captures.size(); ++i) {
    if (captures.size() > 1) {
      out += fmt::format("<section id=\"c{}\"><h1>{}</h1><p class=\"facts\">{}</p>\n", i + 1,
                         escape_html(captures[i].model.capture.file), escape_html(capture_facts(captures[i].model)));
    }
    out += Page(captures[i], settings, captures.size() > 1 ? fmt::format("c{}-", i + 1) : "").body();
    if (captures.size() > 1) out += "</section>\n";
  }
  out +=
      "</main>\n<footer>Made by servotrace. Frames are numbered as Wireshark numbers "
      "them.</footer>\n</body>\n</html>\n";
  return out;
}

}  // namespace servotrace::report
