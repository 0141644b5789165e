// SPDX-License-Identifier: MIT
// Gathers the series, state tracks and messages of the report while a capture is replayed with dissections. Memory is
// bounded by nodes and fields, not by frames.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "decoder/link/raw_frame.hpp"
#include "decoder/pipeline/dissection.hpp"
#include "decoder/pipeline/settings.hpp"
#include "replay/report/accesses.hpp"
#include "replay/report/bus_times.hpp"
#include "replay/report/model.hpp"
#include "replay/report/repeats.hpp"

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
  Collector(const Settings& settings, const std::vector<Watch>& watches, std::vector<WantedFrame> evidence);

  // False where the frame may come as one that repeats (Dissection::repeats).
  bool wants_all(const RawFrame& frame) const;
  void add(const RawFrame& frame, const Dissection& dissection);
  // Moves what was gathered into the model; faults' parts into the fault of the same index as its watch.
  void finish(Model& model);

 private:
  struct Snapshot {
    std::uint64_t frame = 0;
    std::vector<std::pair<const Layout*, std::vector<std::uint8_t>>> parts;
    bool same_bytes(const Snapshot& other) const { return parts == other.parts; }
  };
  // The latest message of a kind, and the last one that differed from it.
  struct Told {
    Snapshot latest;
    Snapshot before;
  };
  using Parts = std::vector<const Layout*>;  // the layouts of its parts
  // A field of a layout, and where its history is kept.
  struct Kept {
    const Field* field = nullptr;
    Slot slot;
    std::size_t index = 0;  // into tracks_ or signals_
    bool is_state = false;
  };
  struct Place {
    const Layout* layout = nullptr;
    std::vector<Kept> states;
    std::vector<Kept> signals;
    // The bytes of the states read last, of a short message, and the changes of the node until then: the same bytes
    // again change nothing where nothing else has changed.
    std::uint64_t state_bytes = 0;  // a mask
    std::uint64_t image = 0;
    std::size_t size = 0;  // of the message; 0: none
    std::uint64_t changes = 0;
  };
  struct Node {
    NodeRef node;
    std::map<const Field*, std::size_t> tracks;
    std::map<const Field*, std::size_t> signals;
    std::vector<Place> places;   // by layout, in the order of their first message
    std::size_t next_place = 0;  // likely the next one: messages come in turn
    std::uint64_t changes = 0;   // of its tracks
    // The command position last sent, for its distance from the actual one.
    std::int64_t commanded = 0;
    TimeNs commanded_ns = 0;
    bool has_commanded = false;
    // By direction: the messages of each kind, and the kind that came last.
    std::array<std::map<Parts, Told>, 3> told;
    std::array<const Told*, 3> last = {};
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
    // True where it needs the frame taken apart.
    bool looks_at(const RawFrame& frame) const;
  };
  std::size_t node_index(const NodeRef& node);
  Place& place_of(Node& node, const RawFrame& frame, const Layout& layout, Bytes bytes);
  void add_segment(Node& node, std::size_t index, const RawFrame& frame, const Segment& segment, Bytes bytes);
  void add_states(Node& node, const RawFrame& frame, Place& place, Bytes bytes);
  void add_signal(Node& node, std::size_t index, const RawFrame& frame, const Layout& layout, const Kept& kept,
                  std::int64_t value);
  void add_close_up(const RawFrame& frame, const Node& node, std::size_t index, const Layout& layout,
                    const Field& field, std::int64_t value);
  void add_snapshots(const RawFrame& frame, const Dissection& dissection);
  void take_messages(CloseUp& close_up);
  static void look_for_code(CloseUp& close_up, const RawFrame& frame, const Dissection& dissection);

  static constexpr std::size_t kMaxNodes = 512;
  static bool is_number(const Field& field) {
    return field.kind == Kind::kUnsigned || field.kind == Kind::kSigned || field.kind == Kind::kBool;
  }

  const Settings& settings_;
  std::deque<Node> nodes_;  // stays where it is: `last` points into it
  std::unordered_map<std::uint64_t, std::size_t> node_by_key_;
  std::uint64_t last_key_ = 0;  // of the node asked for last; the messages of a node stand together
  std::optional<std::size_t> last_node_;
  std::vector<StateTrack> tracks_;
  std::vector<Signal> signals_;
  std::vector<CloseUp> close_ups_;
  std::vector<CloseUp*> open_;  // those whose window holds the present frame
  BusTimes times_;
  Repeats repeats_{signals_};
  AccessLog accesses_;
  FrameLog evidence_;
};

}  // namespace servotrace::report
