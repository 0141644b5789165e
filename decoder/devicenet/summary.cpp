// SPDX-License-Identifier: MIT
// What is known of a bus and its nodes, for people.
#include <cmath>
#include <string>

#include "decoder/devicenet/bus.hpp"

namespace servotrace::devicenet {
namespace {

std::string recognised_text(const Node& node) {
  switch (node.recognised) {
    case Recognised::kConfigured:
      return "configured";
    case Recognised::kIdentity:
      return "identity (frame " + std::to_string(node.recognised_frame) + ")";
    case Recognised::kGuessed:
      return "guessed by I/O sizes";
    case Recognised::kNone:
      break;
  }
  return {};
}

std::string choice_text(std::int64_t choice) {
  std::string text;
  for (const ValueName& bit : kChoiceNames) {
    if ((choice >> bit.value & 1) == 0) continue;
    if (!text.empty()) text += ", ";
    text += bit.name;
  }
  return text.empty() ? "none" : text;
}

void add_fact(NodeSummary& summary, std::string_view key, std::string value, std::uint64_t frame) {
  summary.facts.push_back({.key = std::string(key), .value = std::move(value), .basis = {BasisKind::kCapture, frame}});
}

void add_fact(NodeSummary& summary, std::string_view key, const std::optional<Learnt>& learnt) {
  if (learnt) add_fact(summary, key, std::to_string(learnt->value), learnt->frame);
}

// Bus load in percent, stuff bits not counted. The bit rate is known only where a node's DeviceNet object was read:
// else the load at each of the three there are.
void add_bus_load(BusSummary& summary, std::int64_t rate, std::uint64_t bits, DurationNs span_ns) {
  static constexpr std::int64_t kKilobits[] = {125, 250, 500};
  if (span_ns <= 0) return;
  for (std::int64_t i = 0; i < 3; ++i) {
    if (rate >= 0 && i != rate) continue;
    const double used_ms = static_cast<double>(bits) / static_cast<double>(kKilobits[i]);
    const auto tenths = static_cast<std::int64_t>(std::llround(used_ms * 1e9 / static_cast<double>(span_ns)));
    std::string key = "bus_load_percent";
    if (rate < 0) key += "_at_" + std::to_string(kKilobits[i]) + "k";
    summary.facts.push_back(
        {.key = std::move(key), .value = std::to_string(tenths / 10) + "." + std::to_string(tenths % 10), .basis = {}});
  }
}

}  // namespace

void Bus::summarise(BusSummary& summary) const {
  if (!devicenet_) return;
  if (configured_) {
    summary.recognised = "configured";
  } else {
    summary.recognised = "evidence: ";
    summary.recognised += name_of(evidence_kind_);
  }
  std::int64_t rate = -1;
  for (const auto& entry : nodes_) {
    if (!entry) continue;
    const Node& node = *entry;
    if (node.baud_rate && node.baud_rate->value <= 2) rate = node.baud_rate->value;
    NodeSummary& row = summary.nodes.emplace_back();
    row.node = node.ref;
    if (const DevicenetNodeSettings* settings = settings_.node(node.ref.mac_id)) {
      row.name = settings->name;
      row.profile = settings->profile;
    }
    if (node.profile != nullptr) row.profile = node.profile->key;
    row.recognised = recognised_text(node);
    if (node.has_pair) {
      add_fact(row, "vendor_id", std::to_string(node.vendor_id), node.check_frame);
      add_fact(row, "serial_number", std::to_string(node.serial_number), node.check_frame);
    }
    for (const auto& other : nodes_) {
      if (!other || other->master != node.ref.mac_id) continue;
      add_fact(row, "role", "master", other->choice ? other->choice->frame : 0);
      break;
    }
    if (node.master != kNoMacId)
      add_fact(row, "master", std::to_string(node.master), node.choice ? node.choice->frame : 0);
    if (node.choice) add_fact(row, "allocation", choice_text(node.choice->value), node.choice->frame);
    if (node.poll.state != PollState::kUnknown) {
      add_fact(row, "poll_connection", std::string(kPollMachine.name_of(node.poll.state)), node.poll.polled_frame);
    }
    add_fact(row, "epr_ms", node.poll.packet_rate_ms);
    add_fact(row, "explicit_epr_ms", node.explicit_rate_ms);
    add_fact(row, "consumed_size", node.poll.command_size);
    add_fact(row, "produced_size", node.poll.response_size);
    add_fact(row, "identity_vendor", node.identity_vendor);
    add_fact(row, "identity_product", node.identity_product);
    append_statistic(summary.statistics, "poll interval", node.ref, node.poll.interval);
    append_statistic(summary.statistics, "poll jitter", node.ref, node.poll.interval_change);
    append_statistic(summary.statistics, "poll response", node.ref, node.poll.answer);
    append_statistic(summary.statistics, "explicit response", node.ref, node.explicit_answer);
    if (node.session) node.session->summarise(row, summary.statistics);
  }
  add_bus_load(summary, rate, bits_, elapsed_ns(begin_ns_, last_ns_));
}

}  // namespace servotrace::devicenet
