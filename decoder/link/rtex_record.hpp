// SPDX-License-Identifier: MIT
// The RTEX record (servotrace RTEX capture format 1) in its four carriers: exported PDU, Ethernet, UDP, user link type.
#pragma once

#include <cstdint>

#include "decoder/core/layout_check.hpp"
#include "decoder/core/slot.hpp"
#include "decoder/link/raw_frame.hpp"
#include "decoder/pipeline/rules.hpp"
#include "decoder/pipeline/settings.hpp"

namespace servotrace::rtex {

inline constexpr std::string_view kRecordSection = "servotrace RTEX capture format 1";
inline constexpr std::size_t kMaxBlocks = 32;        // 16-byte blocks of the ASIC's memories (SX-DSV02203 4-1)
inline constexpr std::size_t kBlockSize = 16;        // bytes
inline constexpr std::uint32_t kMagic = 0x58455452;  // "RTEX", little-endian

inline constexpr ValueName kDirectionNames[] = {{0, "command"}, {1, "response"}};
inline constexpr Field kRecordFields[] = {
    {.key = "magic", .label = "Magic", .first_bit = at(0), .width = 32, .kind = Kind::kText, .section = kRecordSection},
    {.key = "version", .label = "Version", .first_bit = at(4), .width = 8, .section = kRecordSection},
    {.key = "header_length",
     .label = "Header length",
     .first_bit = at(5),
     .width = 8,
     .unit = Unit::kByte,
     .section = kRecordSection},
    {.key = "direction",
     .label = "Direction",
     .first_bit = at(6, 0),
     .width = 1,
     .values = kDirectionNames,
     .section = kRecordSection},
    {.key = "sequence_valid",
     .label = "Sequence valid",
     .first_bit = at(6, 1),
     .width = 1,
     .kind = Kind::kBool,
     .section = kRecordSection},
    {.key = "cycle_valid",
     .label = "Cycle valid",
     .first_bit = at(6, 2),
     .width = 1,
     .kind = Kind::kBool,
     .section = kRecordSection},
    {.key = "sampled",
     .label = "Sampled",
     .first_bit = at(6, 3),
     .width = 1,
     .kind = Kind::kBool,
     .section = kRecordSection,
     .explanation = "the recorder polled and did not take every cycle"},
    {.key = "flags_reserved",
     .label = "Reserved",
     .first_bit = at(6, 4),
     .width = 4,
     .base = Base::kHex,
     .section = kRecordSection},
    {.key = "ring", .label = "Ring", .first_bit = at(7), .width = 8, .section = kRecordSection},
    {.key = "sequence",
     .label = "Sequence",
     .first_bit = at(8),
     .width = 32,
     .section = kRecordSection,
     .explanation = "communication cycle counter, the same for a cycle's command and response"},
    {.key = "cycle_ns",
     .label = "Communication cycle",
     .first_bit = at(12),
     .width = 32,
     .unit = Unit::kNanosecond,
     .section = kRecordSection},
    {.key = "wide_nodes",
     .label = "32-byte nodes",
     .first_bit = at(16),
     .width = 32,
     .base = Base::kHex,
     .section = kRecordSection,
     .explanation = "bit i: the node in connection order i uses 32-byte mode"},
    {.key = "node_count", .label = "Nodes", .first_bit = at(20), .width = 8, .section = kRecordSection},
    {.key = "header_reserved",
     .label = "Reserved",
     .first_bit = at(21),
     .width = 24,
     .base = Base::kHex,
     .section = kRecordSection},
};
inline constexpr Layout kRecord{.protocol = "rtex",
                                .key = "record",
                                .title = "RTEX record header",
                                .size = 24,
                                .fields = kRecordFields,
                                .section = kRecordSection};
static_assert(well_formed(kRecord));

enum class Carrier : std::uint8_t { kNone, kExportedPdu, kEthernet, kUdp, kUserLink };

// Where a record lies in a frame, and whether it is one.
struct RecordPlace {
  Carrier carrier = Carrier::kNone;  // kNone: no record in this frame, the rest means nothing
  std::uint32_t offset = 0;          // of the record's first byte in the frame
  std::uint32_t length = 0;          // header and blocks as the header says; bytes available where it is malformed
  std::uint32_t available = 0;       // bytes from offset to the end of the frame
  bool malformed = false;
  capture::Malformed why = capture::Malformed::kVersion;  // where malformed
};

// Finds the record of a frame. A truncated frame may yield a place with malformed set: the caller knows that it is cut.
RecordPlace find_record(const RawFrame& frame, const RtexSettings& settings);

// The length a record's header asks for, in bytes; 0 where its counts are impossible. Precondition: fits(kRecord,
// record).
std::uint32_t record_length(Bytes record);

}  // namespace servotrace::rtex
