// SPDX-License-Identifier: MIT
// What the sessions know at this moment, for `info`, the node lines of the results and the report. Made on demand.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "decoder/core/durations.hpp"
#include "decoder/findings/finding.hpp"

namespace servotrace {

// One learnt or configured setting: key as in servotrace.toml ("communication_cycle_us", "Pr7.23", "epr_ms").
struct Fact {
  std::string key;
  std::string value;
  Basis basis;
};

struct NodeSummary {
  NodeRef node;
  std::string name;        // from the settings, or empty
  std::string profile;     // "minas-a5n", "yaskawa-ns310", "nsk-esb", "generic"; empty: not recognised
  std::string recognised;  // how: "configured", "identity (frame 12)", "guessed by I/O sizes", ...
  std::vector<Fact> facts;
};

// True where the rules of a drive were applied to a DeviceNet node of this profile, recognised in this way: a drive
// that is only guessed is decoded, not judged.
inline bool is_judged_as_drive(std::string_view profile, std::string_view recognised) {
  return !profile.empty() && profile != "generic" && !recognised.starts_with("guessed");
}

// Latencies and intervals: counts, sums and bounds of a quantity in nanoseconds.
struct Statistic {
  std::string key;  // "cycle", "poll response", "parameter write"
  std::uint64_t count = 0;
  std::int64_t minimum_ns = 0;
  std::int64_t maximum_ns = 0;
  double mean_ns = 0;
  std::int64_t percentile_99_ns = 0;
  NodeRef node;
};

// What was measured, where anything was.
inline void append_statistic(std::vector<Statistic>& to, std::string key, const NodeRef& node,
                             const Durations& measured) {
  if (measured.count() == 0) return;
  to.push_back(Statistic{.key = std::move(key),
                         .count = measured.count(),
                         .minimum_ns = measured.minimum_ns(),
                         .maximum_ns = measured.maximum_ns(),
                         .mean_ns = measured.mean_ns(),
                         .percentile_99_ns = measured.percentile_ns(99),
                         .node = node});
}

struct BusSummary {
  BusRef bus;
  Protocol protocol = Protocol::kNone;  // kNone: CAN without evidence of DeviceNet
  std::string recognised;               // "record header", "configured", "evidence: ..."
  std::uint64_t frames = 0;
  bool sampled = false;
  std::vector<Fact> facts;
  std::vector<NodeSummary> nodes;
  std::vector<Statistic> statistics;
};

struct Summary {
  std::vector<BusSummary> buses;
  std::uint64_t frames = 0;            // pushed
  std::uint64_t checked_frames = 0;    // of a known bus
  std::uint64_t untracked_frames = 0;  // of interfaces or buses above the limit, not looked at
};

}  // namespace servotrace
