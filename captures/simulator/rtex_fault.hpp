// SPDX-License-Identifier: MIT
// Faults put into a simulated ring: what the master, a drive, the cable or the recorder does wrong, and when.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "captures/simulator/rtex_block.hpp"
#include "captures/simulator/table_reader.hpp"

namespace servotrace::simulator::ring {

enum class FaultKind : std::uint8_t {
  kCounterStuck,   // the master does not count Update_Counter up
  kCounterSkip,    // the master counts it up by `value` instead of 1
  kCounterEarly,   // ratio 2: the master counts it up inside an updating cycle
  kCounterSet,     // the master sends `value` and counts on from there
  kCommandField,   // a field of the command block is `value`
  kResponseField,  // a field of the response block is `value`
  kCommandByte,    // byte `byte` of the command block is `value`
  kResponseByte,
  kCrcError,    // the drive does not understand the command (6-11)
  kSilent,      // the response block stays zero
  kFrozen,      // the response block stays what it was, but the counter moves on in the command
  kHoldEcho,    // the drive does not take commands
  kLate,        // the command record comes `value` microseconds late
  kStall,       // the master sends nothing for the cycles
  kInitialise,  // the master initialises the ring again, from NOP on
  kDrop,        // the recorder loses the record
  kCut,         // the recorder keeps `value` bytes of the record only
  kRepeat,      // the recorder writes the record twice
  kStamp,       // the recorder stamps the record `value` microseconds early
  kHeaderByte   // byte `byte` of the record header is `value`
};

enum class Records : std::uint8_t { kCommand, kResponse, kBoth };

struct Fault {
  FaultKind kind = FaultKind::kCounterStuck;
  int axis = -1;                 // MAC-ID; -1: every axis
  std::int64_t first_cycle = 0;  // communication cycle
  std::int64_t cycles = 1;       // communication cycles it lasts
  bool relative = false;         // first_cycle counts from the start of the step it belongs to
  Records records = Records::kBoth;
  Slot field;
  unsigned byte = 0;
  std::int64_t value = 0;

  bool acts(std::int64_t cycle) const { return cycle >= first_cycle && cycle - first_cycle < cycles; }
  bool acts(std::int64_t cycle, int mac_id) const { return acts(cycle) && (axis < 0 || axis == mac_id); }
};

// Reads a fault table. `cycles_per_second` turns times into cycles. `in_step`: the times count from the step's start.
Fault read_fault(const toml::table& table, Problems& problems, std::int64_t cycles_per_second, bool in_step);

}  // namespace servotrace::simulator::ring
