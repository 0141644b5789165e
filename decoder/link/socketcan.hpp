// SPDX-License-Identifier: MIT
// CAN frames in captures: SocketCAN (227), and Linux cooked captures of CAN (113, 276).
#pragma once

#include <cstdint>

#include "decoder/link/raw_frame.hpp"
#include "decoder/pipeline/rules.hpp"

namespace servotrace::can {

// A classic CAN frame. `data` views the frame pushed.
struct Frame {
  std::uint32_t identifier = 0;  // 11 or 29 bits; of an error frame its class bits
  bool extended = false;
  bool remote = false;
  bool error = false;
  Bytes data;                         // 0..8 bytes; a remote frame has none
  std::uint32_t data_offset = 0;      // of data in the capture frame
  std::uint32_t interface_index = 0;  // of link type 276, which separates buses; else 0
};

struct Place {
  bool found = false;  // the record is one of a CAN interface
  bool malformed = false;
  capture::Malformed why = capture::Malformed::kCanLength;
  std::uint32_t header_offset = 0;
  Frame frame;  // where found and not malformed
};

// A truncated record yields found and malformed: the caller knows that it is cut.
Place find_frame(const RawFrame& frame);

// False where find_frame() finds nothing, whatever the bytes are.
constexpr bool may_hold_can(LinkType type) {
  return type == LinkType::kCanSocketcan || type == LinkType::kLinuxSll || type == LinkType::kLinuxSll2;
}

}  // namespace servotrace::can
