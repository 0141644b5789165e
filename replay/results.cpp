// SPDX-License-Identifier: MIT
#include "replay/results.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "decoder/render/message.hpp"
#include "decoder/render/node.hpp"
#include "decoder/render/value.hpp"
#include "replay/exit_status.hpp"

namespace servotrace::replay {

void Counts::add(Severity severity, std::uint64_t number) {
  if (severity == Severity::kError) errors += number;
  if (severity == Severity::kWarning) warnings += number;
  if (severity == Severity::kNote) notes += number;
}

void Counts::add(const Counts& other) {
  errors += other.errors;
  warnings += other.warnings;
  notes += other.notes;
}

void Counts::remove(Severity severity) {
  std::uint64_t& number = severity == Severity::kError ? errors : severity == Severity::kWarning ? warnings : notes;
  if (number != 0) --number;
}

std::uint64_t Counts::at_least(Severity severity) const {
  if (severity == Severity::kError) return errors;
  if (severity == Severity::kWarning) return errors + warnings;
  return all();
}

std::string NodeName::text() const {
  if (!mac_id) return bus;
  std::string words = fmt::format("{} {}", protocol == "rtex" ? "axis" : "node", *mac_id);
  if (!name.empty()) words += fmt::format(" ({})", name);
  // Most findings are of the one main channel: only the other is worth a word.
  if (channel == "sub") words += " sub channel";
  return words;
}

std::string CaptureRecord::who(const NodeName& node) const {
  const bool several = std::count_if(nodes.begin(), nodes.end(),
                                     [](const NodeRecord& entry) { return !entry.node.mac_id.has_value(); }) > 1;
  if (!several || !node.mac_id) return node.text();
  return fmt::format("{} {}", node.bus, node.text());
}

void RunTotals::add(const CaptureRecord& capture) {
  counts.add(capture.counts);
  status = worse_status(status, capture.status);
  ++captures;
  frames += capture.frames;
  checked_frames += capture.checked_frames;
  suppressed += capture.suppressed;
  baselined += capture.baselined;
}

std::string_view RunTotals::verdict() const {
  if (counts.all() != 0) return "findings";
  return status == kExitNothing || checked_frames == 0 ? "nothing-checked" : "clean";
}

std::string plural(std::uint64_t number, std::string_view word) {
  return fmt::format("{} {}{}", number, word, number == 1 ? "" : "s");
}

NodeName node_name(const NodeRef& node, const BusNames& buses, const Settings& settings) {
  NodeName name;
  name.bus = buses.name(node.bus);
  if (name.bus.empty()) return name;
  name.protocol = servotrace::name_of(node.protocol);
  if (node.mac_id != kNoMacId) name.mac_id = node.mac_id;
  name.name = configured_name(settings, node);
  name.channel = servotrace::name_of(node.channel);
  return name;
}

CaptureRecord describe(const CaptureResult& result, const Settings& settings) {
  CaptureRecord record;
  record.file = result.name;
  record.format = result.format;
  for (const InterfaceInfo& entry : result.interfaces)
    record.link_types.push_back(static_cast<std::uint16_t>(entry.link_type));
  std::sort(record.link_types.begin(), record.link_types.end());
  record.link_types.erase(std::unique(record.link_types.begin(), record.link_types.end()), record.link_types.end());
  record.frames = result.frames;
  record.checked_frames = result.summary.checked_frames;
  record.first_time_ns = result.first_time_ns;
  record.last_time_ns = result.last_time_ns;
  if (result.error) record.error = result.error->text();
  for (const BusSummary& bus : result.summary.buses) {
    NodeRecord& whole = record.nodes.emplace_back();
    whole.node = node_name({.bus = bus.bus, .protocol = bus.protocol}, result.buses, settings);
    whole.recognised = bus.recognised;
    whole.settings = bus.facts;
    whole.frames = bus.frames;
    whole.sampled = bus.sampled;
    for (const NodeSummary& node : bus.nodes) {
      NodeRecord& entry = record.nodes.emplace_back();
      entry.node = node_name(node.node, result.buses, settings);
      entry.profile = node.profile;
      entry.recognised = node.recognised;
      entry.settings = node.facts;
    }
    for (const Statistic& statistic : bus.statistics) {
      record.statistics.push_back({node_name(statistic.node, result.buses, settings), statistic});
      // A statistic of the whole bus may come without its reference.
      if (record.statistics.back().node.bus.empty()) record.statistics.back().node.bus = whole.node.bus;
    }
  }
  return record;
}

FindingRecord make_record(const Finding& finding, const CaptureResult& result, const Settings& settings) {
  FindingRecord record;
  record.rule = finding.rule;
  record.severity = finding.severity;
  record.actor = finding.actor;
  record.node = node_name(finding.node, result.buses, settings);
  record.frame = finding.frame;
  record.last_frame = finding.last_frame;
  record.count = finding.count;
  record.time_ns = finding.time_ns;
  record.message = message(finding);
  for (const std::uint64_t frame : finding.related) {
    if (frame != 0) record.related.push_back(frame);
  }
  std::sort(record.related.begin(), record.related.end());
  record.cause = finding.cause;
  record.basis = finding.basis;
  if (const FramePlace* const place = result.place(finding.frame)) record.place = *place;
  return record;
}

}  // namespace servotrace::replay
