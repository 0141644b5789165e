// SPDX-License-Identifier: MIT
// DeviceNet link layer: the 11-bit identifier, groups 1 to 4 and the predefined master/slave connection set.
#include <gtest/gtest.h>

#include "decoder/devicenet/can_id.hpp"

namespace servotrace::devicenet {
namespace {

struct Expected {
  std::uint32_t identifier;
  int group, message_id, mac_id;
  MessageKind kind;
  int source, destination;
  Direction direction;
};

// Node 5 and node 63 (3Fh), typed from the table: 300+n, 340+n ... 780+s, 7EC to 7EF.
constexpr Expected kExpected[] = {
    {0x000, 1, 0, 0, MessageKind::kGroup1, 0, -1, Direction::kNone},
    {0x2FF, 1, 11, 63, MessageKind::kGroup1, 63, -1, Direction::kNone},
    {0x305, 1, 12, 5, MessageKind::kMulticastPollResponse, 5, -1, Direction::kResponse},
    {0x345, 1, 13, 5, MessageKind::kChangeOfState, 5, -1, Direction::kResponse},
    {0x385, 1, 14, 5, MessageKind::kBitStrobeResponse, 5, -1, Direction::kResponse},
    {0x3C5, 1, 15, 5, MessageKind::kPollResponse, 5, -1, Direction::kResponse},
    {0x3FF, 1, 15, 63, MessageKind::kPollResponse, 63, -1, Direction::kResponse},
    {0x428, 2, 0, 5, MessageKind::kBitStrobeCommand, 5, -1, Direction::kCommand},
    {0x429, 2, 1, 5, MessageKind::kMulticastPollCommand, -1, -1, Direction::kCommand},
    {0x42A, 2, 2, 5, MessageKind::kChangeOfStateAck, -1, 5, Direction::kCommand},
    {0x42B, 2, 3, 5, MessageKind::kExplicitResponse, 5, -1, Direction::kResponse},
    {0x42C, 2, 4, 5, MessageKind::kExplicitRequest, -1, 5, Direction::kCommand},
    {0x42D, 2, 5, 5, MessageKind::kPollCommand, -1, 5, Direction::kCommand},
    {0x42E, 2, 6, 5, MessageKind::kUnconnectedRequest, -1, 5, Direction::kCommand},
    {0x42F, 2, 7, 5, MessageKind::kMacCheck, 5, -1, Direction::kNone},
    {0x5FD, 2, 5, 63, MessageKind::kPollCommand, -1, 63, Direction::kCommand},
    {0x605, 3, 0, 5, MessageKind::kGroup3, 5, -1, Direction::kNone},
    {0x705, 3, 4, 5, MessageKind::kGroup3, 5, -1, Direction::kNone},
    {0x745, 3, 5, 5, MessageKind::kUcmmResponse, 5, -1, Direction::kResponse},
    {0x785, 3, 6, 5, MessageKind::kUcmmRequest, 5, -1, Direction::kCommand},
    {0x7BF, 3, 6, 63, MessageKind::kUcmmRequest, 63, -1, Direction::kCommand},
    {0x7C0, 4, 0x00, -1, MessageKind::kGroup4, -1, -1, Direction::kNone},
    {0x7EB, 4, 0x2B, -1, MessageKind::kGroup4, -1, -1, Direction::kNone},
    {0x7EC, 4, 0x2C, -1, MessageKind::kFaultedResponse, -1, -1, Direction::kResponse},
    {0x7ED, 4, 0x2D, -1, MessageKind::kFaultedRequest, -1, -1, Direction::kCommand},
    {0x7EE, 4, 0x2E, -1, MessageKind::kOwnershipResponse, -1, -1, Direction::kResponse},
    {0x7EF, 4, 0x2F, -1, MessageKind::kOwnershipRequest, -1, -1, Direction::kCommand},
    {0x7F0, 0, 0, -1, MessageKind::kInvalid, -1, -1, Direction::kNone},
    {0x7FF, 0, 0, -1, MessageKind::kInvalid, -1, -1, Direction::kNone},
};

TEST(Identifiers, GroupsAndPredefinedSet) {
  for (const Expected& row : kExpected) {
    SCOPED_TRACE(row.identifier);
    const Identifier id = identify(row.identifier);
    EXPECT_EQ(id.group, row.group);
    EXPECT_EQ(id.message_id, row.message_id);
    EXPECT_EQ(id.mac_id, row.mac_id);
    EXPECT_EQ(id.kind(), row.kind);
    EXPECT_EQ(id.source(), row.source);
    EXPECT_EQ(id.destination(), row.destination);
    EXPECT_EQ(id.row->direction, row.direction);
    EXPECT_FALSE(id.row->name.empty());
  }
}

TEST(Identifiers, EveryIdentifierHasARow) {
  int invalid = 0;
  for (std::uint32_t value = 0; value < 0x800; ++value) {
    const Identifier id = identify(value);
    ASSERT_NE(id.row, nullptr);
    if (id.kind() == MessageKind::kInvalid) ++invalid;
  }
  EXPECT_EQ(invalid, 16);  // 7F0h-7FFh and no other
}

}  // namespace
}  // namespace servotrace::devicenet
