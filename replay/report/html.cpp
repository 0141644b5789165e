// SPDX-License-Identifier: MIT
// The HTML file: head and foot, the overview of several captures, and the parts every section uses.
#include <fmt/format.h>

#include <array>
#include <filesystem>

#include "decoder/findings/catalogue.hpp"
#include "decoder/render/node.hpp"
#include "decoder/render/value.hpp"
#include "replay/report/analysis.hpp"
#include "replay/report/page.hpp"
#include "replay/report/pages.hpp"
#include "replay/report/style.hpp"

namespace servotrace::report {
namespace {

std::string capture_facts(const Model& model) {
  std::string text = fmt::format("{}, {} of them on known buses; {}", plural(model.capture.frames, "frame"),
                                 model.capture.checked_frames, model.capture.format);
  if (model.capture.has_time)
    text += fmt::format("; {} to {}", time_text(model.capture.first_ns), time_text(model.capture.last_ns));
  return text;
}

std::string file_name(const Model& model) { return std::filesystem::path(model.capture.file).filename().string(); }

std::array<std::uint64_t, 3> by_severity(const Model& model) {
  std::array<std::uint64_t, 3> counts{};
  for (const Finding& finding : model.findings) ++counts[static_cast<std::size_t>(finding.severity)];
  return counts;
}

std::string overview(std::span<const Built> captures) {
  std::string out =
      "<h2 id=\"overview\">Overview</h2>\n<div class=\"wide\"><table><thead><tr><th scope=\"col\">capture</th><th "
      "scope=\"col\">"
      "verdict</th><th scope=\"col\" class=\"number\">errors</th><th scope=\"col\" class=\"number\">warnings</th>"
      "<th scope=\"col\" class=\"number\">notes</th></tr></thead>"
      "<tbody>\n";
  for (std::size_t i = 0; i < captures.size(); ++i) {
    const Model& model = captures[i].model;
    const auto counts = by_severity(model);
    out += fmt::format(
        "<tr><td><a href=\"#c{}\">{}</a></td><td>{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td><td "
        "class=\"number\">{}</td></tr>\n",
        i + 1, escape_html(model.capture.file), escape_html(model.verdict.headline), counts[2], counts[1], counts[0]);
  }
  return out + "</tbody></table></div>\n";
}

}  // namespace

void Page::heading(unsigned level, std::string_view text, std::string_view id) {
  const unsigned shown = prefix_.empty() ? level : level + 1;  // of several captures: below the name of its file
  if (id.empty()) {
    add("<h{0}>{1}</h{0}>\n", shown, e(text));
  } else {
    add("<h{0} id=\"{2}{3}\">{1}</h{0}>\n", shown, e(text), prefix_, id);
  }
}

void Page::begin_table(std::initializer_list<Column> columns) {
  // A table that may be wider than the window is moved by the keyboard, too.
  constexpr std::size_t kMayBeWide = 4;  // columns
  if (columns.size() >= kMayBeWide) {
    std::string names;
    for (const Column& column : columns) names += fmt::format("{}{}", names.empty() ? "" : ", ", column.name);
    add("<div class=\"wide\" tabindex=\"0\" role=\"group\" aria-label=\"Table: {}\"><table><thead><tr>", e(names));
  } else {
    add("<div class=\"wide\"><table><thead><tr>");
  }
  for (const Column& column : columns) {
    const std::string_view number = column.number ? " class=\"number\"" : "";
    if (column.name.empty()) {
      add("<td{}></td>", number);
    } else {
      add("<th scope=\"col\"{}>{}</th>", number, e(column.name));
    }
  }
  add("</tr></thead><tbody>\n");
}

void Page::figure(std::string_view svg, std::string_view caption) {
  if (svg.empty()) return;
  add("<figure>\n{}<figcaption>{}</figcaption></figure>\n", svg, e(caption));
}

std::string Page::severity(Severity value) {
  return fmt::format("<span class=\"severity {0}\">{0}</span>", servotrace::name_of(value));
}

std::string Page::rule_link(RuleId id) const {
  return fmt::format("<a class=\"rule\" href=\"#{}{}\">{}</a>", prefix_, rule_row(id).id, rule_row(id).id);
}

std::string Page::node_name(const NodeRef& node) const {
  const std::string text = node_text(node, configured_name(settings_, node));
  const std::string_view bus = buses_.name(node.bus);
  if (text.empty()) return bus.empty() ? "capture" : std::string(bus);
  return buses_.size() > 1 ? fmt::format("{}, {}", text, bus) : text;
}

std::string Page::name_of_finding(const Finding& finding) const { return who(finding, settings_, buses_); }

void Page::evidence(std::uint64_t frame, const NodeRef& node) {
  const auto found = model_.evidence.find(frame_key(frame, node));
  if (found == model_.evidence.end()) return;
  add("<p class=\"evidence\"><b>{}</b> {}</p>\n", frame,
      e(found->second.sentence.empty() ? "(nothing recognised)" : found->second.sentence));
}

std::string Page::head() {
  const auto counts = by_severity(model_);
  std::size_t nodes = 0;
  for (const BusSummary& bus : model_.summary.buses) nodes += bus.nodes.size();
  add("<p class=\"facts\">{}</p>\n<dl class=\"figures\">", e(capture_facts(model_)));
  const auto number = [&](std::string_view name, std::string_view value, std::string_view css_class) {
    add("<div{}><dt>{}</dt><dd>{}</dd></div>", css_class.empty() ? "" : fmt::format(" class=\"{}\"", css_class), name,
        value);
  };
  number("errors", std::to_string(counts[2]), counts[2] != 0 ? "error" : "");
  number("warnings", std::to_string(counts[1]), counts[1] != 0 ? "warning" : "");
  number("notes", std::to_string(counts[0]), "");
  number("axes and nodes", std::to_string(nodes), "");
  if (model_.capture.has_time)
    number("recorded", duration_text(elapsed_ns(model_.capture.first_ns, model_.capture.last_ns)), "");
  add("</dl>\n<nav aria-label=\"Contents{}\"><ul>", prefix_.empty() ? "" : fmt::format(" of {}", e(file_name(model_))));
  constexpr std::pair<std::string_view, std::string_view> kSections[] = {
      {"verdict", "Verdict"},       {"against", "Comparison"},
      {"timeline", "Timeline"},     {"faults", "Faults"},
      {"nodes", "Axes and nodes"},  {"network", "The network"},
      {"violations", "Violations"}, {"limits", "What this capture cannot show"}};
  for (const auto& [id, name] : kSections) {
    if (id == "faults" && model_.faults.empty()) continue;
    if (id == "against" && !model_.comparison) continue;
    if (model_.verdict.kind == VerdictKind::kNothingChecked && id != "verdict" && id != "limits") continue;
    add("<li><a href=\"#{}{}\">{}</a></li>", prefix_, id, name);
  }
  add("</ul></nav>\n");
  return std::exchange(out_, {});
}

std::string Page::body() {
  verdict();
  if (model_.verdict.kind != VerdictKind::kNothingChecked) {
    comparison();
    timelines();
    faults();
    nodes();
    network();
    violations();
  }
  limits();
  return std::exchange(out_, {});
}

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
  const bool one = captures.size() == 1;
  const std::string title = one ? file_name(captures.front().model) : fmt::format("{} captures", captures.size());
  std::string out = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\">\n<meta name=\"color-scheme\" content=\"light dark\">\n"
      "<title>{0} - servotrace report</title>\n<style>{1}</style>\n</head>\n<body>\n<a class=\"skip\" "
      "href=\"#main\">To the {2}</a>\n<header>\n<p class=\"eyebrow\">servotrace post-mortem report</p>\n"
      "<h1>{0}</h1>\n",
      escape_html(title), kStyle, one ? "verdict" : "overview");
  Page only(captures.front(), settings, "");
  if (one) out += only.head();
  out += "</header>\n<main id=\"main\">\n";
  if (one) {
    out += only.body();
  } else {
    out += overview(captures);
  }
  for (std::size_t i = 0; !one && i < captures.size(); ++i) {
    Page page(captures[i], settings, fmt::format("c{}-", i + 1));
    out += fmt::format("<section id=\"c{}\">\n<h2 class=\"capture\">{}</h2>\n", i + 1,
                       escape_html(file_name(captures[i].model)));
    out += page.head() + page.body() + "</section>\n";
  }
  out +=
      "</main>\n<footer>Made by servotrace. Frames are numbered as Wireshark numbers them; times count from the first "
      "frame of the capture.</footer>\n</body>\n</html>\n";
  return out;
}

}  // namespace servotrace::report
