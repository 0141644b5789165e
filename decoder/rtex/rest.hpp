// SPDX-License-Identifier: MIT
// A ring at rest: its records repeat with a period, no axis moves, and nothing but monitor commands comes and goes.
// Where the state the blocks of a period are judged by is the same before it and behind it, but for frames and times,
// the next one is judged as it was: a record is then compared with the one a period ago as a whole. When something
// changes, the latest period is judged block by block, and what it counted counts for all before it.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "decoder/core/bytes.hpp"
#include "decoder/core/durations.hpp"
#include "decoder/core/small_vector.hpp"
#include "decoder/core/time.hpp"
#include "decoder/link/rtex_record.hpp"
#include "decoder/rtex/ring.hpp"

namespace servotrace::rtex {

// What the next blocks of a node are judged by, of what a period at rest may change; without frames and times.
struct NodeImage {
  std::array<ChannelState, 2> channels;
  CounterState counter;
  InhibitWatch inhibit;
  OffWatch off;
  Following following;
  EmergencyInput emergency;
  std::uint32_t same_responses = 0;
  bool counter_moved_since_response = false, identical_response = false;
  bool operator==(const NodeImage&) const = default;
};

struct Rest {
  static constexpr unsigned kPeriodStep = 8;  // cycles: whole periods of Update_Counter
  static constexpr unsigned kMaxPeriod = 64;
  static constexpr std::size_t kHeaderWords = kRecord.size / 8;
  static constexpr std::size_t kMaxBytes = kMaxBlocks * kBlockSize;
  static constexpr unsigned kStamps = 2 * kMaxPeriod;  // more than what is judged again

  struct Stamp {
    std::uint64_t frame = 0;
    TimeNs time_ns = 0;
  };
  using Image = std::array<std::uint8_t, kMaxBytes>;
  struct Direction {
    std::array<Image, kMaxPeriod> images = {};            // the blocks of a record, by cycle
    std::array<std::uint64_t, kHeaderWords> header = {};  // of the record before
    std::array<Stamp, kStamps> stamps = {};               // of the latest records at rest, by cycle
    std::uint64_t records = 0;                            // at rest; before that: collected
  };
  Direction command, response;
  std::size_t bytes = 0;  // of the blocks of a record
  std::uint8_t node_count = 0;
  std::uint32_t wide_nodes = 0;
  bool still = false;  // of the period: but for the Update_Counters every record is the one before

  // Before it is reached
  unsigned period = kPeriodStep;  // cycles, the one that is tried
  std::uint64_t same = 0;         // cycles in a row that were those of a period ago
  bool cycle_same = false;        // the cycle at hand, until now
  bool marked = false;            // `nodes` is the state behind the first `mark` cycles
  std::uint64_t mark = 0;
  TimeNs mark_ns = 0;
  std::array<NodeImage, kMaxNodes> nodes;

  bool reached = false;
  std::int64_t first_cycle = 0;  // of the ring, the first at rest
  unsigned first_image = 0;      // of the period
  unsigned phase = 0;            // of the cycle at hand, in the period
  TimeNs last_ns = 0;            // of the record before
  DurationNs longest_ns = 0;     // from record to record: every wait within a period ends before its limit

  // How long the drives took: the same for all that began and ended at the same places of the period.
  struct Measured {
    unsigned phase = 0;
    unsigned cycles = 0;  // since the command
    Durations times;
  };
  static constexpr std::size_t kMaxMeasured = 32;
  SmallVector<Measured, kMaxMeasured> measured;  // by phase
  std::size_t next_measured = 0;
  bool judging_again = false;
  unsigned again_phase = 0;  // of the cycle judged again; from `period` on: it was measured in the round before

  // Records that even the ring's own rules passed as before, taken in at a glance; what those rules would have counted
  // is added when one does not.
  bool glancing = false;
  DurationNs least_ns = 0, most_ns = 0;  // intervals of commands that RX111 and RX112 pass
  std::int64_t timing_period = 0;        // cycles after which TMG_CNT is due
  std::uint64_t glanced_commands = 0, glanced_responses = 0;

  static bool is_image(const Image& image, Bytes blocks) {
    if (blocks.size() > 4 * kBlockSize) return std::equal(blocks.begin(), blocks.end(), image.begin());
    std::uint64_t differs = 0;  // of a few blocks a call would take longer
    for (std::size_t at = 0; at < blocks.size(); at += 8) differs |= load_le64(blocks, at) ^ load_le64(image, at);
    return differs == 0;
  }
  // Whether a record is the one of a period ago, and in time.
  [[gnu::always_inline]] bool repeats(const Direction& direction, const RawFrame& frame, Bytes blocks) const {
    const DurationNs interval = elapsed_ns(last_ns, frame.time_ns);
    return interval >= 0 && interval <= longest_ns && blocks.size() == bytes &&
           is_image(direction.images[(first_image + phase) % kMaxPeriod], blocks);
  }
  [[gnu::always_inline]] void take(Direction& direction, const RawFrame& frame) {
    direction.stamps[direction.records++ % kStamps] = {frame.number, frame.time_ns};
    last_ns = frame.time_ns;
    if (&direction == &command) return;
    if (!measured.empty()) measure(frame.time_ns);
    if (++phase < period) return;
    phase = 0;
    next_measured = 0;
  }
  void measure(TimeNs now_ns);
};

}  // namespace servotrace::rtex
