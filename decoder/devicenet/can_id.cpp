// SPDX-License-Identifier: MIT
#include "decoder/devicenet/can_id.hpp"

#include <array>

namespace servotrace::devicenet {
namespace {

using Kind = MessageKind;

constexpr MessageRow kMessages[] = {
    {1, 0xC, Kind::kMulticastPollResponse, MacRole::kSource, Direction::kResponse, Channel::kNone,
     "Multicast poll response"},
    {1, 0xD, Kind::kChangeOfState, MacRole::kSource, Direction::kResponse, Channel::kNone, "Change-of-state or cyclic"},
    {1, 0xE, Kind::kBitStrobeResponse, MacRole::kSource, Direction::kResponse, Channel::kNone, "Bit-strobe response"},
    {1, 0xF, Kind::kPollResponse, MacRole::kSource, Direction::kResponse, Channel::kPoll, "Poll response"},
    {2, 0, Kind::kBitStrobeCommand, MacRole::kSource, Direction::kCommand, Channel::kNone, "Bit-strobe command"},
    {2, 1, Kind::kMulticastPollCommand, MacRole::kGroup, Direction::kCommand, Channel::kNone, "Multicast poll command"},
    {2, 2, Kind::kChangeOfStateAck, MacRole::kDestination, Direction::kCommand, Channel::kNone,
     "Change-of-state or cyclic acknowledge"},
    {2, 3, Kind::kExplicitResponse, MacRole::kSource, Direction::kResponse, Channel::kExplicit, "Explicit response"},
    {2, 4, Kind::kExplicitRequest, MacRole::kDestination, Direction::kCommand, Channel::kExplicit, "Explicit request"},
    {2, 5, Kind::kPollCommand, MacRole::kDestination, Direction::kCommand, Channel::kPoll, "Poll command"},
    {2, 6, Kind::kUnconnectedRequest, MacRole::kDestination, Direction::kCommand, Channel::kUnconnected,
     "Unconnected explicit request"},
    {2, 7, Kind::kMacCheck, MacRole::kChecked, Direction::kNone, Channel::kNone, "Duplicate MAC ID check"},
    {3, 5, Kind::kUcmmResponse, MacRole::kSource, Direction::kResponse, Channel::kUnconnected,
     "Unconnected explicit response"},
    {3, 6, Kind::kUcmmRequest, MacRole::kSource, Direction::kCommand, Channel::kUnconnected,
     "Unconnected explicit request"},
    {4, 0x2C, Kind::kFaultedResponse, MacRole::kNone, Direction::kResponse, Channel::kNone,
     "Communication-faulted response"},
    {4, 0x2D, Kind::kFaultedRequest, MacRole::kNone, Direction::kCommand, Channel::kNone,
     "Communication-faulted request"},
    {4, 0x2E, Kind::kOwnershipResponse, MacRole::kNone, Direction::kResponse, Channel::kNone,
     "Offline ownership response"},
    {4, 0x2F, Kind::kOwnershipRequest, MacRole::kNone, Direction::kCommand, Channel::kNone,
     "Offline ownership request"},
};

// What the identifiers of no row are: one row a group.
constexpr MessageRow kOthers[] = {
    {0, 0, Kind::kInvalid, MacRole::kNone, Direction::kNone, Channel::kNone, "Invalid identifier"},
    {1, 0, Kind::kGroup1, MacRole::kSource, Direction::kNone, Channel::kNone, "Group 1 message"},
    {2, 0, Kind::kInvalid, MacRole::kNone, Direction::kNone, Channel::kNone, "Group 2 message"},
    {3, 0, Kind::kGroup3, MacRole::kSource, Direction::kNone, Channel::kNone, "Group 3 message"},
    {4, 0, Kind::kGroup4, MacRole::kNone, Direction::kNone, Channel::kNone, "Group 4 message"},
};

constexpr std::size_t place(unsigned group, unsigned message_id) { return (group - 1U) * 64U + message_id; }

// (group, message ID) to its row.
constexpr auto kRows = [] {
  std::array<const MessageRow*, 4 * 64> rows{};
  for (unsigned group = 1; group <= 4; ++group) {
    for (unsigned id = 0; id < 64; ++id) rows[place(group, id)] = &kOthers[group];
  }
  for (const MessageRow& row : kMessages) rows[place(row.group, row.message_id)] = &row;
  return rows;
}();

constexpr Identifier make_identifier(std::uint16_t value) {
  Identifier id;
  id.value = value;
  id.row = &kOthers[0];
  if (id.value < 0x400) {
    id.group = 1;
    id.message_id = static_cast<std::uint8_t>(id.value >> 6U & 0xFU);
    id.mac_id = static_cast<std::int16_t>(id.value & 0x3FU);
  } else if (id.value < 0x600) {
    id.group = 2;
    id.message_id = static_cast<std::uint8_t>(id.value & 0x7U);
    id.mac_id = static_cast<std::int16_t>(id.value >> 3U & 0x3FU);
  } else if (id.value < 0x7C0) {
    id.group = 3;
    id.message_id = static_cast<std::uint8_t>(id.value >> 6U & 0x7U);
    id.mac_id = static_cast<std::int16_t>(id.value & 0x3FU);
  } else if (id.value < 0x7F0) {
    id.group = 4;
    id.message_id = static_cast<std::uint8_t>(id.value & 0x3FU);
  } else {
    return id;
  }
  id.row = kRows[place(id.group, id.message_id)];
  return id;
}

// Of every 11-bit identifier: taken apart by the compiler, one load a frame.
constexpr auto kIdentifiers = [] {
  std::array<Identifier, 0x800> all{};
  std::uint16_t value = 0;
  for (Identifier& identifier : all) identifier = make_identifier(value++);
  return all;
}();

}  // namespace

Identifier identify(std::uint32_t can_identifier) { return kIdentifiers[can_identifier & 0x7FFU]; }

}  // namespace servotrace::devicenet
