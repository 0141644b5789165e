// SPDX-License-Identifier: MIT
// A classic CAN frame as it is on the wire: how long it takes there, and how a capture file holds it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "decoder/core/bytes.hpp"

namespace servotrace::simulator {

struct CanFrame {
  std::uint32_t identifier = 0;  // 11 bits, 29 where extended; of an error frame its class bits
  bool extended = false;
  bool remote = false;
  bool error = false;
  std::uint8_t length = 0;  // 0..8
  std::array<std::uint8_t, 8> data = {};

  Bytes payload() const { return Bytes(data).first(remote ? 0 : length); }
};

// Bytes beyond the eighth are left out.
CanFrame can_frame(std::uint32_t identifier, Bytes payload);

// Bits from start of frame to the end of the intermission (stuff bits included). An error frame: flag, delimiter and
// intermission.
unsigned wire_bits(const CanFrame& frame);

// The 16 bytes of link type 227 (SocketCAN): identifier and flags big-endian, length, data padded with zeros.
std::vector<std::uint8_t> socketcan_bytes(const CanFrame& frame);

}  // namespace servotrace::simulator
