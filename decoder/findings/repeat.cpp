// SPDX-License-Identifier: MIT
#include "decoder/findings/repeat.hpp"

#include <algorithm>

namespace servotrace {

Findings::Findings(std::uint32_t max_per_owner) : max_per_owner_(std::max<std::uint32_t>(max_per_owner, 1)) {}

OwnerId Findings::owner(const NodeRef& node) {
  for (std::size_t i = 0; i < owners_.size(); ++i) {
    if (owners_[i].node == node) return static_cast<OwnerId>(i);
  }
  owners_.push_back(Owner{.node = node, .drive_basis = {}, .open = {}, .states = {}});
  return static_cast<OwnerId>(owners_.size() - 1);
}

void Findings::set_node(OwnerId owner, const NodeRef& node) { owners_[static_cast<std::size_t>(owner)].node = node; }

Findings::RuleState& Findings::state(Owner& owner, const Report& report) {
  const bool once = rule_row(report.rule).repeat == Repeat::kOnceNode;  // then once a variant, else one state a rule
  for (RuleState& state : owner.states) {
    if (state.rule == report.rule && (!once || state.variant == report.variant)) return state;
  }
  // A hostile capture must not grow this without bound: variants past the limit share the last state.
  if (owner.states.size() >= kMaxStates) return owner.states.back();
  owner.states.push_back(RuleState{.rule = report.rule, .variant = report.variant});
  return owner.states.back();
}

std::uint64_t Findings::last_frame(OwnerId owner, RuleId rule) const {
  std::uint64_t latest = 0;
  for (const RuleState& state : owners_[static_cast<std::size_t>(owner)].states) {
    if (state.rule == rule) latest = std::max(latest, state.last_frame);
  }
  return latest;
}

void Findings::close(OwnerId owner, RuleId rule) {
  const auto index = static_cast<std::size_t>(rule);
  owners_[static_cast<std::size_t>(owner)].open[index / 64] &= ~(std::uint64_t{1} << (index % 64));
}

void Findings::amend(OwnerId owner, RuleId rule, const std::array<std::int64_t, kMaxArguments>& arguments,
                     const Cause& cause) {
  for (const RuleState& entry : owners_[static_cast<std::size_t>(owner)].states) {
    if (entry.rule != rule || entry.finding == kNotKept) continue;
    findings_[entry.finding].arguments = arguments;
    findings_[entry.finding].cause = cause;
    return;
  }
}

bool Findings::raise(const RawFrame& frame, const Report& report) {
  const Rule& row = rule_row(report.rule);
  Owner& owner = owners_[static_cast<std::size_t>(report.owner)];
  RuleState& rule_state = state(owner, report);
  const bool assumed = row.lowered_when_assumed && report.basis.kind == BasisKind::kAssumed;
  const bool once = row.repeat == Repeat::kOnceNode || assumed;
  const bool extends = once ? rule_state.raised > 0
                            : row.repeat == Repeat::kEpisode && is_open(report.owner, report.rule) &&
                                  rule_state.variant == report.variant;
  rule_state.last_frame = frame.number;
  rule_state.variant = report.variant;
  const auto index = static_cast<std::size_t>(report.rule);
  owner.open[index / 64] |= std::uint64_t{1} << (index % 64);
  if (extends) {
    if (rule_state.finding != kNotKept) {
      Finding& finding = findings_[rule_state.finding];
      ++finding.count;
      finding.last_frame = frame.number;
      finding.last_time_ns = frame.time_ns;
    }
    return false;
  }
  ++rule_state.raised;
  ++total_[index];
  std::uint64_t raised = 0;  // in all variants
  for (const RuleState& entry : owner.states) raised += entry.rule == report.rule ? entry.raised : 0;
  if (raised > max_per_owner_) {
    rule_state.finding = kNotKept;
    return false;
  }
  Severity severity = row.severity;
  if (report.as_note) severity = Severity::kNote;
  if (report.as_warning) severity = Severity::kWarning;
  if (report.as_error) severity = Severity::kError;
  if (assumed) severity = lowered(severity);
  const bool of_drive = report.basis.kind == BasisKind::kNone && !row.id.starts_with("DN");
  rule_state.finding = static_cast<std::uint32_t>(findings_.size());
  findings_.push_back(Finding{.rule = report.rule,
                              .severity = severity,
                              .actor = report.actor.value_or(row.actor),
                              .frame = frame.number,
                              .last_frame = frame.number,
                              .count = 1,
                              .time_ns = frame.time_ns,
                              .last_time_ns = frame.time_ns,
                              .node = owner.node,
                              .where = report.where,
                              .related = report.related,
                              .arguments = report.arguments,
                              .cause = report.cause,
                              .basis = of_drive ? owner.drive_basis : report.basis});
  return true;
}

}  // namespace servotrace
