// SPDX-License-Identifier: MIT
// The results of checking, as every output format needs them: text made, names resolved. Made from a capture that was
// run, or read back from JSON Lines (merge).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "decoder/findings/catalogue.hpp"
#include "decoder/findings/finding.hpp"
#include "decoder/pipeline/settings.hpp"
#include "replay/run.hpp"

namespace servotrace::replay {

struct Counts {
  std::uint64_t errors = 0;
  std::uint64_t warnings = 0;
  std::uint64_t notes = 0;

  void add(Severity severity, std::uint64_t number = 1);
  void add(const Counts& other);
  void remove(Severity severity);
  std::uint64_t all() const { return errors + warnings + notes; }
  // Findings of this severity or worse.
  std::uint64_t at_least(Severity severity) const;
};

struct NodeName {
  std::string bus;            // empty: of the whole capture
  std::string protocol;       // "rtex", "devicenet"; empty: none
  std::optional<int> mac_id;  // empty: of a whole ring, bus or capture
  std::string name;           // as the settings call it
  std::string channel;        // "main", "sub", ...

  bool operator==(const NodeName&) const = default;
  // "axis 3 (X)", "node 5, explicit channel", the bus where it is no node, empty for the capture.
  std::string text() const;
};

// What a frame says, beside a finding.
struct EvidenceLine {
  std::uint64_t frame = 0;
  TimeNs time_ns = 0;
  std::string text;
};

struct FindingRecord {
  RuleId rule{};
  Severity severity = Severity::kNote;
  Actor actor = Actor::kMaster;
  NodeName node;
  std::uint64_t frame = 0;
  std::uint64_t last_frame = 0;
  std::uint64_t count = 1;
  TimeNs time_ns = 0;
  std::string message;
  std::vector<std::uint64_t> related;
  Cause cause;
  Basis basis;
  FramePlace place;  // length 0: not known
  std::vector<EvidenceLine> evidence;

  const Rule& row() const { return rule_row(rule); }
};

// A node, or a whole bus (no mac_id), and what was learnt of it.
struct NodeRecord {
  NodeName node;
  std::string profile;
  std::string recognised;
  std::vector<Fact> settings;
  std::uint64_t frames = 0;  // of a bus
  bool sampled = false;      // of a bus
};

struct StatisticRecord {
  NodeName node;
  Statistic values;
};

struct RuleRecord {
  RuleId rule{};
  std::uint64_t checked = 0;
  std::uint64_t findings = 0;  // those above --max-findings included
};

struct CaptureRecord {
  std::string file;
  std::string format;
  std::vector<std::uint16_t> link_types;  // sorted, each once
  std::uint64_t frames = 0;
  std::uint64_t checked_frames = 0;
  std::optional<TimeNs> first_time_ns;
  std::optional<TimeNs> last_time_ns;
  std::string error;  // why it could not be read (further); empty: it could
  std::vector<NodeRecord> nodes;
  std::vector<StatisticRecord> statistics;
  std::vector<FindingRecord> findings;  // by frame, rule, node
  std::vector<RuleRecord> rules;        // those looked for, in the order of the catalogue
  Counts counts;                        // findings above --max-findings included
  std::uint64_t suppressed = 0;
  std::uint64_t baselined = 0;
  int status = 0;  // exit status of this capture alone

  // The node's text, with the bus in front where the capture has several.
  std::string who(const NodeName& node) const;
};

struct RunTotals {
  Counts counts;
  int status = 0;
  std::uint64_t captures = 0;
  std::uint64_t frames = 0;
  std::uint64_t checked_frames = 0;
  std::uint64_t suppressed = 0;
  std::uint64_t baselined = 0;

  void add(const CaptureRecord& capture);
  // "clean", "findings", "nothing-checked".
  std::string_view verdict() const;
};

// "1 error", "2 errors".
std::string plural(std::uint64_t number, std::string_view word);

NodeName node_name(const NodeRef& node, const BusNames& buses, const Settings& settings);

// Everything but findings, rules, counts and status.
CaptureRecord describe(const CaptureResult& result, const Settings& settings);

FindingRecord make_record(const Finding& finding, const CaptureResult& result, const Settings& settings);

}  // namespace servotrace::replay
