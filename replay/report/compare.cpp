// SPDX-License-Identifier: MIT
#include "replay/report/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "decoder/findings/catalogue.hpp"
#include "decoder/render/node.hpp"
#include "decoder/render/value.hpp"
#include "replay/report/pictures.hpp"

namespace servotrace::report {
namespace {

constexpr std::size_t kMaxPartings = 40;

bool same_node(const NodeRef& left, const NodeRef& right) {
  return left.bus.kind == right.bus.kind && left.bus.number == right.bus.number && left.mac_id == right.mac_id;
}

// Value number `index` of a track, counted from its first; false: it ends before.
struct Step {
  bool exists = false;
  std::int64_t value = 0;
  std::uint64_t frame = 0;  // 0: from the start
  TimeNs time_ns = 0;
};
Step step(const StateTrack* track, std::size_t index) {
  if (track == nullptr || index > track->changes.size()) return {};
  if (index == 0) return {true, track->first_value, 0, track->first_ns};
  const Event& event = track->changes[index - 1];
  return {true, event.after, event.frame, event.time_ns};
}

std::string words(const StateTrack& track, const Step& at, std::size_t index) {
  if (at.exists) return value_text(*track.field, at.value);
  return fmt::format("stays {}", value_text(*track.field, step(&track, index - 1).value));
}

void part_states(const Model& here, const Model& there, Comparison& result) {
  for (const StateTrack& track : here.tracks) {
    const auto other = std::find_if(there.tracks.begin(), there.tracks.end(), [&](const StateTrack& entry) {
      return entry.field == track.field && same_node(entry.node, track.node);
    });
    if (other == there.tracks.end()) continue;
    const std::size_t most = std::max(track.changes.size(), other->changes.size());
    for (std::size_t i = 0; i <= most; ++i) {
      const Step left = step(&track, i);
      const Step right = step(&*other, i);
      if (left.exists == right.exists && left.value == right.value) continue;
      Parting parting;
      parting.node = track.node;
      parting.field = track.field;
      parting.here = words(track, left, i);
      parting.there = words(*other, right, i);
      parting.here_frame = left.frame;
      parting.there_frame = right.frame;
      parting.after_ns = right.exists ? elapsed_ns(there.capture.first_ns, right.time_ns)
                                      : elapsed_ns(here.capture.first_ns, left.time_ns);
      result.partings.push_back(std::move(parting));
      break;
    }
  }
  std::stable_sort(result.partings.begin(), result.partings.end(), [](const Parting& left, const Parting& right) {
    const bool left_minor = importance(*left.field) > 2;
    const bool right_minor = importance(*right.field) > 2;
    if (left_minor != right_minor) return right_minor;
    return left.after_ns < right.after_ns;
  });
  if (result.partings.size() > kMaxPartings) {
    result.more_partings = result.partings.size() - kMaxPartings;
    result.partings.resize(kMaxPartings);
  }
}

// Settings as the captures show them: what the sessions learnt, and the last value of every parameter.
using Settings = std::map<std::pair<std::string, std::string>, std::string>;
Settings settings_of(const Model& model) {
  Settings list;
  for (const BusSummary& bus : model.summary.buses) {
    for (const Fact& fact : bus.facts) list[{std::string{}, fact.key}] = fact.value;
    for (const NodeSummary& node : bus.nodes) {
      for (const Fact& fact : node.facts) list[{node_text(node.node, node.name), fact.key}] = fact.value;
    }
  }
  for (const Access& access : model.accesses) {
    if (access.refused ||
        (access.kind != AccessKind::kRead && access.kind != AccessKind::kWrite && access.kind != AccessKind::kIdentity))
      continue;
    list[{node_text(access.node), access.what}] = access.value;
  }
  return list;
}

void part_settings(const Model& here, const Model& there, Comparison& result) {
  const Settings left = settings_of(here);
  Settings all = left;
  const Settings right = settings_of(there);
  all.insert(right.begin(), right.end());
  for (const auto& [key, unused] : all) {
    const auto a = left.find(key);
    const auto b = right.find(key);
    const std::string here_text = a == left.end() ? "" : a->second;
    const std::string there_text = b == right.end() ? "" : b->second;
    if (here_text != there_text) result.settings.push_back({key.first, key.second, here_text, there_text});
  }
}

void part_rules(const Model& here, const Model& there, Comparison& result) {
  std::map<std::string_view, std::pair<std::uint64_t, std::uint64_t>> counts;
  for (const Finding& finding : here.findings) ++counts[rule_row(finding.rule).id].first;
  for (const Finding& finding : there.findings) ++counts[rule_row(finding.rule).id].second;
  for (const auto& [id, pair] : counts) {
    if (pair.first != pair.second)
      result.rules.push_back({static_cast<RuleId>(find_rule(id)), pair.first, pair.second});
  }
}

}  // namespace

Comparison compare(const Model& here, const Model& there) {
  Comparison result;
  result.file = there.capture.file;
  result.headline = there.verdict.headline;
  part_states(here, there, result);
  part_settings(here, there, result);
  part_rules(here, there, result);
  return result;
}

}  // namespace servotrace::report
