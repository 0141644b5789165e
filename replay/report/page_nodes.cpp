// SPDX-License-Identifier: MIT
// Each axis and node: identity, settings, modes, homing, parameters, alarms, latencies.
#include <algorithm>

#include "decoder/render/node.hpp"
#include "decoder/render/value.hpp"
#include "replay/report/analysis.hpp"
#include "replay/report/page.hpp"
#include "replay/report/pages.hpp"
#include "replay/report/pictures.hpp"

namespace servotrace::report {
namespace {

bool same_node(const NodeRef& left, const NodeRef& right) {
  return left.bus == right.bus && left.mac_id == right.mac_id;
}

}  // namespace

void Page::nodes() {
  heading(2, "Axes and nodes", "nodes");
  for (const BusSummary& bus : model_.summary.buses) {
    for (const NodeSummary& entry : bus.nodes) node(bus, entry);
  }
}

void Page::node(const BusSummary& bus, const NodeSummary& node) {
  heading(3, capitalised(node_name(node.node)));
  add("<div class=\"wide\"><table><thead><tr><th scope=\"col\">identity and settings</th><th "
      "scope=\"col\">value</th><th scope=\"col\">known from</th></tr></thead><tbody>\n");
  const auto row = [&](std::string_view key, std::string_view value, std::string_view how) {
    constexpr std::size_t kShort = 24;  // "shown by frame 1234567" stays on its line
    if (!value.empty())
      add("<tr><th scope=\"row\">{}</th><td>{}</td><td{}>{}</td></tr>\n", e(key), e(value),
          how.size() <= kShort ? " class=\"section\"" : "", e(how));
  };
  row("profile", node.profile, node.recognised);
  if (node.node.protocol == Protocol::kRtex) row("place in the ring", std::to_string(node.node.place + 1), "");
  for (const Access& access : model_.accesses) {
    if (access.kind == AccessKind::kIdentity && same_node(access.node, node.node))
      row(access.what, access.value, fmt::format("read, frame {}", access.frame));
  }
  for (const Fact& fact : node.facts) row(fact.key, fact.value, basis_text(fact.basis));
  add("</tbody></table></div>\n");
  modes(node.node);
  states(node.node);
  accesses(node.node);
  statistics(bus, &node.node);
}

// What the node was asked to be, one period after the other.
void Page::modes(const NodeRef& node) {
  constexpr std::size_t kMost = 40;
  for (const StateTrack& track : model_.tracks) {
    const bool is_mode = track.field->key == "cyclic_command" || track.field->key == "command_code" ||
                         track.field->key == "executing_block_number";
    if (!same_node(track.node, node) || !is_mode || track.changes.empty()) continue;
    heading(4, fmt::format("{} over time", track.field->label));
    begin_table({{"from", true}, {"to", true}, {"frame", true}, {"value"}});
    TimeNs since = track.first_ns;
    std::int64_t value = track.first_value;
    std::uint64_t frame = 0;
    const auto line = [&](TimeNs until) {
      add("<tr><td class=\"number\">{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td><td>{}</td></tr>\n",
          at_time(model_, since), at_time(model_, until), frame == 0 ? std::string() : std::to_string(frame),
          e(value_text(*track.field, value)));
    };
    for (std::size_t i = 0; i < track.changes.size() && i < kMost; ++i) {
      line(track.changes[i].time_ns);
      since = track.changes[i].time_ns;
      value = track.changes[i].after;
      frame = track.changes[i].frame;
    }
    if (track.changes.size() <= kMost) line(model_.capture.last_ns);
    end_table();
    if (track.changes.size() > kMost) add("<p>{} not listed.</p>\n", track.total - kMost);
  }
}

// States that tell something: servo, homing, limits, alarms; how they stood at the end and how often they changed.
void Page::states(const NodeRef& node) {
  std::vector<const StateTrack*> shown;
  for (const StateTrack& track : model_.tracks) {
    if (same_node(track.node, node) && track.field->kind == Kind::kBool &&
        (importance(*track.field) <= 2 || !track.changes.empty()))
      shown.push_back(&track);
  }
  if (shown.empty()) return;
  std::stable_sort(shown.begin(), shown.end(), [](const StateTrack* left, const StateTrack* right) {
    return importance(*left->field) < importance(*right->field);
  });
  add("<details><summary>States: servo, homing, limits, alarms ({})</summary>\n", shown.size());
  begin_table({{"state"}, {"at first"}, {"at the end"}, {"changes", true}, {"first change"}, {"last change"}});
  const auto event = [&](const Event& change) {
    return fmt::format("{}, frame {}", at_time(model_, change.time_ns), change.frame);
  };
  for (const StateTrack* track : shown) {
    const bool changed = !track->changes.empty();
    add("<tr><td>{}</td><td>{}</td><td>{}</td><td class=\"number\">{}</td><td>{}</td><td>{}</td></tr>\n",
        e(track->field->label), e(value_text(*track->field, track->first_value)),
        e(value_text(*track->field, track->value)), track->total, changed ? event(track->changes.front()) : "",
        changed ? event(track->changes.back()) : "");
  }
  end_table();
  add("</details>\n");
}

void Page::accesses(const NodeRef& node) {
  access_table(node, "Parameters read and written", {AccessKind::kRead, AccessKind::kWrite});
  access_table(node, "Programs written and read", {AccessKind::kProgram});
  access_table(node, "Alarms read", {AccessKind::kAlarm});
}

void Page::access_table(const NodeRef& node, std::string_view title, std::initializer_list<AccessKind> kinds) {
  std::vector<const Access*> shown;
  for (const Access& access : model_.accesses) {
    if (same_node(access.node, node) && std::find(kinds.begin(), kinds.end(), access.kind) != kinds.end())
      shown.push_back(&access);
  }
  if (shown.empty()) return;
  constexpr std::size_t kMost = 500;
  const bool fold = shown.size() > 25;
  heading(4, title);
  if (fold) add("<details><summary>{}</summary>\n", plural(shown.size(), "transaction"));
  begin_table({{"time", true}, {"frame", true}, {"kind"}, {"what"}, {"before"}, {"value"}});
  for (std::size_t i = 0; i < shown.size() && i < kMost; ++i) {
    const Access& access = *shown[i];
    add("<tr><td class=\"number\">{}</td><td class=\"number\">{}</td><td>{}</td><td>{}</td><td>{}</td>"
        "<td{}>{}{}</td></tr>\n",
        at_time(model_, access.time_ns), access.frame, name_of(access.kind), e(access.what), e(access.before),
        access.changes() ? " class=\"differs\"" : "", access.refused ? "refused: " : "", e(access.value));
  }
  end_table();
  if (shown.size() > kMost) add("<p>{} more are in report.json.</p>\n", shown.size() - kMost);
  if (fold) add("</details>\n");
}

void Page::statistics(const BusSummary& bus, const NodeRef* node) {
  std::vector<const Statistic*> shown;
  for (const Statistic& statistic : bus.statistics) {
    const bool of_bus = statistic.node.mac_id == kNoMacId;
    if (node == nullptr ? !of_bus : of_bus || statistic.node.mac_id != node->mac_id) continue;
    if (statistic.count != 0) shown.push_back(&statistic);
  }
  if (shown.empty()) return;
  if (node != nullptr) heading(4, "Handshakes and answers: how long they took");
  begin_table({{"latency or interval"},
               {"count", true},
               {"minimum", true},
               {"mean", true},
               {"99 % within", true},
               {"maximum", true}});
  for (const Statistic* statistic : shown) {
    add("<tr><td>{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td><td class=\"number\">{}</td>"
        "<td class=\"number\">{}</td><td class=\"number\">{}</td></tr>\n",
        e(statistic->key), statistic->count, duration_text(statistic->minimum_ns),
        duration_text(static_cast<DurationNs>(statistic->mean_ns)), duration_text(statistic->percentile_99_ns),
        duration_text(statistic->maximum_ns));
  }
  end_table();
}

}  // namespace servotrace::report
