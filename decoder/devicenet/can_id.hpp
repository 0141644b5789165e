// SPDX-License-Identifier: MIT
// The 11-bit CAN identifier of a DeviceNet frame: message group, message ID, and whose MAC ID it holds.
#pragma once

#include <cstdint>
#include <string_view>

#include "decoder/findings/finding.hpp"
#include "decoder/pipeline/dissection.hpp"

namespace servotrace::devicenet {

inline constexpr std::string_view kLinkSection = "DeviceNet link layer";
// What neither the drive manuals nor the link-layer facts say.
inline constexpr std::string_view kGeneralSection = "CIP in general (ODVA Vol. 1 and 3), not in the manuals";
inline constexpr std::uint8_t kMacIds = 64;  // MAC IDs 0..63

enum class MessageKind : std::uint8_t {
  kInvalid,  // 7F0h-7FFh
  kMulticastPollResponse,
  kChangeOfState,  // change-of-state or cyclic data of a slave
  kBitStrobeResponse,
  kPollResponse,  // or a slave's change-of-state or cyclic acknowledge
  kGroup1,        // any other of group 1: dynamic connections
  kBitStrobeCommand,
  kMulticastPollCommand,
  kChangeOfStateAck,
  kExplicitResponse,  // or an unconnected response
  kExplicitRequest,
  kPollCommand,         // or a master's change-of-state or cyclic data
  kUnconnectedRequest,  // Group-2-only unconnected explicit request
  kMacCheck,
  kGroup3,  // dynamic connections
  kUcmmResponse,
  kUcmmRequest,
  kGroup4,
  kFaultedResponse,
  kFaultedRequest,
  kOwnershipResponse,
  kOwnershipRequest,
};

// What the MAC ID inside an identifier stands for.
enum class MacRole : std::uint8_t { kNone, kSource, kDestination, kGroup, kChecked };

struct MessageRow {
  std::uint8_t group = 0;  // 1..4
  std::uint8_t message_id = 0;
  MessageKind kind = MessageKind::kInvalid;
  MacRole role = MacRole::kNone;
  Direction direction = Direction::kNone;
  Channel channel = Channel::kNone;
  std::string_view name;
};

struct Identifier {
  std::uint16_t value = 0;  // 0..7FFh
  std::uint8_t group = 0;   // 1..4; 0: invalid
  std::uint8_t message_id = 0;
  std::int16_t mac_id = kNoMacId;   // as the identifier holds it; group 4 holds none
  const MessageRow* row = nullptr;  // never nullptr

  MessageKind kind() const { return row->kind; }
  // The node that sends or receives by this identifier alone; the other end is known from the allocation only.
  std::int16_t source() const {
    return row->role == MacRole::kSource || row->role == MacRole::kChecked ? mac_id : kNoMacId;
  }
  std::int16_t destination() const { return row->role == MacRole::kDestination ? mac_id : kNoMacId; }
};

// Takes the low 11 bits.
Identifier identify(std::uint32_t can_identifier);

// The identifiers of node `mac_id` in the predefined set (0..63).
constexpr std::uint16_t poll_response_id(unsigned mac_id) { return static_cast<std::uint16_t>(0x3C0U + mac_id); }
constexpr std::uint16_t group2_id(unsigned mac_id, unsigned message_id) {
  return static_cast<std::uint16_t>(0x400U + mac_id * 8U + message_id);
}

}  // namespace servotrace::devicenet
