// SPDX-License-Identifier: MIT
// RawFrame: one record of a capture, as a reader or Wireshark hands it over.
#pragma once

#include <cstdint>

#include "decoder/core/bytes.hpp"
#include "decoder/core/time.hpp"

namespace servotrace {

// Link types by their number in capture files (https://www.tcpdump.org/linktypes.html). Others are kept as numbers.
enum class LinkType : std::uint16_t {
  kNull = 0,
  kEthernet = 1,
  kRawIp = 101,
  kLoop = 108,
  kLinuxSll = 113,
  kUser0 = 147,
  kUser15 = 162,
  kCanSocketcan = 227,
  kIpv4 = 228,
  kIpv6 = 229,
  kWiresharkUpperPdu = 252,
  kLinuxSll2 = 276,
};

// Valid during Pipeline::push only: nothing of the decoder keeps `bytes`.
struct RawFrame {
  std::uint64_t number = 0;  // from 1, as Wireshark numbers the frames of the file
  TimeNs time_ns = 0;
  LinkType link_type = LinkType::kEthernet;
  std::uint32_t interface_id = 0;             // dense, from 0, over all sections of the capture, in order of appearance
  Bytes bytes;                                // what was captured
  std::uint32_t original_length = 0;          // what was on the wire; above bytes.size(): the record is truncated
  ByteOrder file_order = ByteOrder::kLittle;  // of the section: link types 113 and 276 hold CAN identifiers in it
  std::uint32_t time_resolution_ns = 1;       // of the interface's timestamps, at least 1
  bool has_time = true;                       // a simple packet block has none
};

}  // namespace servotrace
