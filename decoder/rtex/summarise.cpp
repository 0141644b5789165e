// SPDX-License-Identifier: MIT
// What a ring's session knows, for people.
#include <string>

#include "decoder/rtex/engine.hpp"

namespace servotrace::rtex {
namespace {

std::string in_us(DurationNs cycle_ns) {
  const std::int64_t whole = cycle_ns / kMicrosecondNs;
  const std::int64_t rest = cycle_ns % kMicrosecondNs;
  if (rest == 0) return std::to_string(whole);
  const std::string digits = std::to_string(rest);
  return std::to_string(whole) + "." + std::string(3 - digits.size(), '0') + digits;
}

std::string parameter_key(std::uint16_t index) {
  const unsigned number = index & 0xFFU;
  return "Pr" + std::to_string(index >> 8U) + (number < 10 ? ".0" : ".") + std::to_string(number);
}

std::string fact_key(const FactRow& row) {
  const std::string key = parameter_key(row.index);
  return row.bit < 0 ? key : key + " bit " + std::to_string(row.bit);
}

void summarise_node(const Ring& ring, const Node& node, BusSummary& summary) {
  NodeSummary& entry = summary.nodes.emplace_back();
  entry.node = node.ref;
  if (node.settings != nullptr) entry.name = node.settings->name;
  entry.profile = "minas-a5n";
  entry.recognised = node.settings != nullptr ? "configured" : "RTEX record";
  entry.facts.push_back({"data_size", node.wide ? "32" : "16", {BasisKind::kCapture, ring.last_command.frame}});
  for (std::size_t i = 0; i < kFactCount; ++i) {
    const Known& known = node.known[static_cast<Fact>(i)];
    if (known.certain()) entry.facts.push_back({fact_key(kFacts[i]), std::to_string(known.value), known.basis});
  }
  for (std::size_t i = 0; i < kSystemIdCount; ++i) {
    const SystemString& string = node.strings[i];
    if (string.frame == 0) continue;
    entry.facts.push_back(
        {std::string(kSystemIds[i].field.key), std::string(string.view()), {BasisKind::kCapture, string.frame}});
  }
  for (std::size_t i = 0; i < node.echo_times.size(); ++i) {
    const std::string name(kNonCyclicNames[i + 1].name);
    append_statistic(summary.statistics, name + " echo", node.ref, node.echo_times[i]);
    append_statistic(summary.statistics, name + " completed", node.ref, node.done_times[i]);
  }
}

}  // namespace

void Engine::summarise(BusSummary& summary) const {
  summary.recognised = "record header";
  summary.sampled = ring_.sampled;
  if (ring_.cycle_ns)
    summary.facts.push_back({"communication_cycle_us", in_us(ring_.cycle_ns.value), ring_.cycle_ns.basis});
  if (ring_.ratio)
    summary.facts.push_back({"command_update_ratio", std::to_string(ring_.ratio.value), ring_.ratio.basis});
  if (ring_.full_sync)
    summary.facts.push_back({"sync", ring_.full_sync.value == 1 ? "full" : "semi", ring_.full_sync.basis});
  if (ring_.lag_decided && ring_.lag >= 0)
    summary.facts.push_back({"echo_lag", std::to_string(ring_.lag), {BasisKind::kCapture, ring_.lag_frame}});
  const NodeRef whole{.bus = ring_.bus, .protocol = Protocol::kRtex};
  append_statistic(summary.statistics, "cycle", whole, ring_.cycle_times);
  append_statistic(summary.statistics, "cycle jitter", whole, ring_.cycle_deviations);
  for (const auto& node : ring_.nodes) {
    if (node != nullptr) summarise_node(ring_, *node, summary);
  }
}

}  // namespace servotrace::rtex
