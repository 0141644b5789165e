// SPDX-License-Identifier: MIT
// Whether the traffic of a CAN bus shows that it is DeviceNet. An 11-bit identifier has no magic number, so only
// frames that answer each other count.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "decoder/core/time.hpp"
#include "decoder/devicenet/can_id.hpp"
#include "decoder/link/socketcan.hpp"

namespace servotrace::devicenet {

enum class EvidenceKind : std::uint8_t { kNone, kMacChecks, kAllocation, kExplicitPair, kPollPairs };

std::string_view name_of(EvidenceKind kind);

class Evidence {
 public:
  // A frame of the bus. Returns the kind of evidence that this frame completes, else kNone.
  EvidenceKind push(const Identifier& id, const can::Frame& frame, TimeNs time_ns);
  // Records were lost: no pair may reach across.
  void gap();

 private:
  // What the last poll frame of one direction was, if it may have been a fragment that another one follows.
  struct Parts {
    bool open = false;
    std::uint8_t count = 0;
    // True where `data` goes on with the message of the frame before.
    bool continued_by(Bytes data);
  };
  struct Node {
    bool checked = false;  // a Duplicate MAC ID request was seen
    TimeNs checked_ns = 0;
    std::uint16_t vendor_id = 0;
    std::uint32_t serial_number = 0;
    bool requested = false;  // an explicit request is open
    bool allocation = false;
    std::uint8_t header = 0;
    std::uint8_t service = 0;
    bool polled = false;
    std::uint8_t poll_pairs = 0;  // in a row
    Parts command;
    Parts response;
  };
  std::array<Node, kMacIds> nodes_ = {};
};

}  // namespace servotrace::devicenet
