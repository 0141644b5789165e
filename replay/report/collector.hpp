// SPDX-License-Identifier: MIT
// Gathers the series, state tracks and messages of the report while a capture is replayed with dissections. Memory is
// bounded by nodes and fields, not by frames.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "decoder/link/raw_frame.hpp"
#include "decoder/pipeline/dissection.hpp"
#include "decoder/pipeline/settings.hpp"
#include "replay/report/accesses.hpp"
#include "replay/report/model.hpp"

namespace servotrace::report {

// What to look at more closely: known from a first pass over the capture.
struct Watch {
  std::uint64_t frame = 0;  // of the fault
  TimeNs time_ns = 0;
  NodeRef node;
  TimeNs begin_ns = 0;  // window of the close-up
  TimeNs end_ns = 0;
  bool wants_code = false;  // an alarm whose code was not known when it rose
};

class Collector {
 public:
  // `evidence`: frames whose sentence is wanted.
  Collector(const Settings& settings, const std::vector<Watch>& watches, std::set<std::uint64_t> evidence);

  void add(const RawFrame& frame, const Dissection& dissection);
  // Moves what was gathered into the model; faults' parts into the fault of the same index as its watch.
  void finish(Model& model);

 private:
  struct Snapshot {
    std::uint64_t frame = 0;
    std::vector<std::pair<const Layout*, std::vector<std::uint8_t>>> parts;
    bool same_bytes(const Snapshot& other) const { return parts == other.parts; }
  };
  struct Node {
    NodeRef node;
    std::map<const Field*, std::size_t> tracks;
    std::map<const Field*, std::size_t> signals;
    // By direction: the latest message, the last one that differed from it, and one being put together.
    std::array<Snapshot, 3> latest;
    std::array<Snapshot, 3> before;
  };
  struct CloseUp {
    Watch watch;
    std::map<std::pair<std::size_t, const Field*>, std::size_t> index;
    std::vector<Signal> signals;
    std::vector<MessagePair> messages;
    bool taken = false;
    std::int64_t code = 0;  // read out of the drive after the fault
    std::uint64_t code_frame = 0;
    std::string code_text;
  };
  struct Load {
    BusLoad load;
    TimeNs window_ns = 0;  // where the present window begins
    std::uint64_t window_bits = 0;
  };
  struct Cycle {
    BusRef bus;
    std::string_view title;
    TimeNs last_ns = 0;
    bool has_last = false;
    std::vector<DurationNs> first;  // until the scale is chosen
    Histogram histogram;
  };

  std::size_t node_index(const NodeRef& node);
  void add_field(Node& node, std::size_t index, const RawFrame& frame, const Segment& segment, const Field& field,
                 Bytes bytes);
  void add_snapshots(const RawFrame& frame, const Dissection& dissection);
  void add_cycle(const RawFrame& frame, const Dissection& dissection);
  void add_times(const Dissection& dissection);
  void add_load(const RawFrame& frame, const Dissection& dissection);
  Cycle* cycle_of(const BusRef& bus, std::string_view title);
  static void add_interval(Cycle& cycle, DurationNs interval);
  void take_messages(CloseUp& close_up);
  static void look_for_code(CloseUp& close_up, const RawFrame& frame, const Dissection& dissection);
  static void scale(Cycle& cycle);

  const Settings& settings_;
  std::set<std::uint64_t> evidence_wanted_;
  std::vector<Node> nodes_;
  std::unordered_map<std::uint64_t, std::size_t> node_by_key_;
  std::vector<StateTrack> tracks_;
  std::vector<Signal> signals_;
  std::vector<CloseUp> close_ups_;
  std::vector<Cycle> cycles_;
  std::vector<Load> loads_;
  AccessLog accesses_;
  std::map<std::uint64_t, std::string> evidence_;
};

}  // namespace servotrace::report
