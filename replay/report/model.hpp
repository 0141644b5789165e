// SPDX-License-Identifier: MIT
// The model behind the report: what happened, as numbers and references to frames. Every page of the report (HTML,
// Markdown, JSON) is drawn from it and nothing else.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "decoder/core/layout.hpp"
#include "decoder/findings/finding.hpp"
#include "decoder/pipeline/dissection.hpp"
#include "decoder/pipeline/summary.hpp"
#include "replay/report/accesses.hpp"
#include "replay/report/frame_log.hpp"
#include "replay/report/series.hpp"

namespace servotrace::report {

// A state of a node changed: a field of role kState.
struct Event {
  TimeNs time_ns = 0;
  std::uint64_t frame = 0;
  NodeRef node;
  const Layout* layout = nullptr;
  const Field* field = nullptr;
  std::int64_t before = 0;
  std::int64_t after = 0;
  std::uint32_t joined = 0;  // more changes of this state, too close together to be told apart
  bool close_up = false;     // in the window of a fault: never joined with others
};

// The history of one state field of one node. Where it changes too often to keep everything, changes that lie close
// together are joined, so that the whole capture is covered; those around faults are kept one by one.
struct StateTrack {
  NodeRef node;
  const Layout* layout = nullptr;
  const Field* field = nullptr;
  TimeNs first_ns = 0;  // first seen
  std::int64_t first_value = 0;
  std::int64_t value = 0;  // latest
  std::vector<Event> changes;
  std::uint64_t total = 0;    // changes, with the joined ones
  DurationNs spacing_ns = 0;  // joined below this; 0: every change is kept

  void add(const Event& event);
};

// One field of a message beside its value in an earlier message of the same kind.
struct FieldRow {
  std::string filter;
  std::string label;
  std::string before;  // empty: not in that message
  std::string after;
  bool differs = false;
};

// The last message of one direction at a fault, beside the last different one.
struct MessagePair {
  Direction direction = Direction::kNone;
  std::uint64_t before_frame = 0;  // 0: none
  std::uint64_t after_frame = 0;
  std::vector<FieldRow> rows;
};

// A likely cause of a fault: a line of the symptom table (symptoms.hpp), or a violation that merely precedes it.
struct Candidate {
  std::string text;
  std::string section;
  bool supported = false;              // the capture shows the evidence; else only possible
  std::optional<std::size_t> finding;  // the evidence: index into Model::findings, or
  std::optional<std::size_t> access;   // into Model::accesses
};

// What the manual's tables say of an alarm or error code, in our words.
struct Advice {
  std::string name;  // "86.2 RTEX Update_Counter error"
  std::string causes;
  std::string remedies;
  std::string section;
  bool likeliest = false;  // of several that share the number seen, the one the evidence points at
};

struct Fault {
  std::size_t finding = 0;  // index into Model::findings: what was reported
  std::uint64_t frame = 0;  // where it began: an alarm may have risen before its code was read
  TimeNs time_ns = 0;
  std::vector<std::size_t> preceding;  // violations before it at the same node or bus, latest last
  std::vector<Candidate> causes;       // ranked, the likeliest first
  std::vector<Advice> advice;          // what the manual says of the code, the likeliest first
  std::vector<std::size_t> followers;  // indexes into Model::faults: what this one led to
  std::vector<MessagePair> messages;
  std::vector<Signal> signals;  // around it, at full resolution
  // The alarm's code, where the finding did not know it and the drive was asked for it afterwards; frame 0: it was not.
  std::int64_t code = 0;
  std::uint64_t code_frame = 0;
  std::string code_text;
  TimeNs window_begin_ns = 0;
  TimeNs window_end_ns = 0;
};

struct Histogram {
  BusRef bus;
  std::string title;
  std::int64_t bin_ns = 0;    // width of a bin
  std::int64_t first_ns = 0;  // start of the first bin
  std::vector<std::uint64_t> counts;
  std::uint64_t below = 0;
  std::uint64_t above = 0;
  std::uint64_t samples = 0;
};

struct RuleTotal {
  RuleId rule{};
  std::uint64_t checked = 0;
  std::uint64_t findings = 0;
};

enum class VerdictKind : std::uint8_t { kNothingChecked, kClean, kViolations, kFault };

struct Verdict {
  VerdictKind kind = VerdictKind::kNothingChecked;
  std::optional<std::size_t> first;    // what failed first, or the gravest violation: index into Model::findings
  std::optional<Candidate> cause;      // the likeliest cause the capture supports
  std::string headline;                // one sentence
  std::vector<std::string> sentences;  // what the evidence says, what it cannot say
};

// How loaded a CAN bus was: bits of its frames without stuffing, in windows of kLoadWindowNs.
struct BusLoad {
  BusRef bus;
  std::uint64_t bits = 0;
  std::uint64_t peak_bits = 0;  // of the fullest window
};
inline constexpr DurationNs kLoadWindowNs = 100 * kMillisecondNs;

struct Capture {
  std::string file;
  std::string format;
  std::uint64_t frames = 0;
  std::uint64_t checked_frames = 0;
  std::uint64_t untracked_frames = 0;
  TimeNs first_ns = 0;
  TimeNs last_ns = 0;
  bool has_time = false;
  std::string broken;  // why reading ended early; empty: it did not
};

// A state that took another turn in the other capture.
struct Parting {
  NodeRef node;
  const Field* field = nullptr;
  std::string here;  // the value where they part; "stays ..." where it changes in the other capture only
  std::string there;
  std::uint64_t here_frame = 0;  // 0: from the start, or it does not change
  std::uint64_t there_frame = 0;
  DurationNs after_ns = 0;  // since the start of the other capture, or of this one where only this one changes
};

// report --against: this capture beside another one.
struct Comparison {
  struct Setting {
    std::string node;  // empty: of a bus
    std::string key;
    std::string here;  // empty: this capture does not show it
    std::string there;
  };
  struct RuleCount {
    RuleId rule{};
    std::uint64_t here = 0;
    std::uint64_t there = 0;
  };
  std::string file;               // of the other capture
  std::string headline;           // its verdict
  std::vector<Parting> partings;  // telling states first, each kind in the order of time
  std::uint64_t more_partings = 0;
  std::vector<Setting> settings;
  std::vector<RuleCount> rules;
};

struct Model {
  Capture capture;
  Verdict verdict;
  std::vector<Finding> findings;  // by frame, rule, node; suppressed ones left out
  Summary summary;
  std::vector<StateTrack> tracks;
  std::vector<Signal> signals;
  std::vector<Fault> faults;  // in the order of time, at most kMaxFaults
  std::uint64_t more_faults = 0;
  std::vector<Histogram> histograms;
  std::vector<BusLoad> loads;
  std::vector<Access> accesses;  // in the order of the file
  std::uint64_t more_accesses = 0;
  std::vector<RuleTotal> rules;
  std::vector<std::string> cannot_show;
  ShownFrames evidence;                      // the frames findings name
  std::vector<std::string> interface_names;  // by interface id
  std::optional<Comparison> comparison;
};

inline constexpr std::size_t kMaxFaults = 12;
inline constexpr std::size_t kMaxChanges = 2000;  // a track

}  // namespace servotrace::report
