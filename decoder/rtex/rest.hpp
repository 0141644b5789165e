// SPDX-License-Identifier: MIT
// A ring at rest: every block of it is quiet, so its records repeat with the period of the Update_Counters, 4 or 8
// cycles. A record is then compared with the one a period ago as a whole, and the nodes are brought up to date only
// when something changes.
#pragma once

#include <array>
#include <cstdint>

#include "decoder/core/bytes.hpp"
#include "decoder/core/time.hpp"
#include "decoder/link/rtex_record.hpp"

namespace servotrace::rtex {

struct Rest {
  static constexpr unsigned kMaxPeriod = 8;  // cycles
  static constexpr std::size_t kHeaderWords = kRecord.size / 8;
  static constexpr std::size_t kMaxWords = kMaxBlocks * kBlockSize / 8;
  static constexpr unsigned kFrames = 32;  // more than what is brought up to date one by one

  struct Direction {
    std::array<std::array<std::uint64_t, kMaxWords>, kMaxPeriod> images = {};  // the blocks of a record, by cycle
    std::array<std::uint64_t, kHeaderWords> header = {};                       // of the record before
    std::array<std::uint64_t, kFrames> frames = {};                            // of the latest records at rest
    std::uint64_t records = 0;                                                 // at rest; before that: collected
  };
  Direction command, response;
  std::size_t words = 0;  // of the blocks
  unsigned period = 0;    // cycles
  bool reached = false;
  std::int64_t first_cycle = 0;  // of the ring, the first at rest

  // Records that even the ring's own rules passed as before, taken in at a glance; what those rules would have counted
  // is added when one does not.
  bool glancing = false;
  DurationNs least_ns = 0, most_ns = 0;  // intervals of commands that RX111 and RX112 pass
  std::int64_t timing_period = 0;        // cycles after which TMG_CNT is due
  std::uint64_t glanced_commands = 0, glanced_responses = 0;
};

}  // namespace servotrace::rtex
