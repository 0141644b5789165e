// SPDX-License-Identifier: MIT
// DeviceNet link layer: message layouts, with bytes typed from its descriptions.
#include "decoder/devicenet/layouts.hpp"

#include <gtest/gtest.h>

#include "decoder/core/slot.hpp"
#include "decoder/devicenet/objects.hpp"
#include "tests/support/bytes.hpp"

namespace servotrace::devicenet {
namespace {

using test::hex;

TEST(DuplicateMacIdCheck, PortVendorAndSerial) {
  // Byte 0: bit 7 response, bits 6-0 port; vendor 44 (2Ch); serial 12345678h.
  const auto request = hex("00 2C 00 78 56 34 12");
  EXPECT_EQ(read(slot(kMacCheck, "response"), request), 0);
  EXPECT_EQ(read(slot(kMacCheck, "physical_port"), request), 0);
  EXPECT_EQ(read(slot(kMacCheck, "vendor_id"), request), 44);
  EXPECT_EQ(read(slot(kMacCheck, "serial_number"), request), 0x12345678);
  const auto answer = hex("83 2C 01 78 56 34 92");
  EXPECT_EQ(read(slot(kMacCheck, "response"), answer), 1);
  EXPECT_EQ(read(slot(kMacCheck, "physical_port"), answer), 3);
  EXPECT_EQ(read(slot(kMacCheck, "vendor_id"), answer), 0x012C);
  EXPECT_EQ(read(slot(kMacCheck, "serial_number"), answer), 0x92345678);
}

TEST(ExplicitMessages, HeaderAndService) {
  // Fragment bit, XID 1, MAC ID 5; Get_Attribute_Single.
  const auto bytes = hex("C5 0E");
  EXPECT_EQ(read(slot(kService, "fragmented"), bytes), 1);
  EXPECT_EQ(read(slot(kService, "xid"), bytes), 1);
  EXPECT_EQ(read(slot(kService, "master"), bytes), 5);
  EXPECT_EQ(read(slot(kService, "service"), bytes), 0x0E);
  EXPECT_EQ(read(slot(kService, "response"), bytes), 0);
  EXPECT_EQ(read(slot(kService, "response"), hex("05 8E")), 1);
  EXPECT_EQ(read(slot(kService, "service"), hex("05 8E")), 0x0E);
}

TEST(ExplicitMessages, BodyFormats) {
  EXPECT_EQ(read(slot(kRequest88, "class"), hex("01 0E 05 02")), 0x05);
  EXPECT_EQ(read(slot(kRequest88, "instance"), hex("01 0E 05 02")), 2);
  EXPECT_EQ(read(slot(kRequest816, "class"), hex("01 0E 05 34 12")), 0x05);
  EXPECT_EQ(read(slot(kRequest816, "instance"), hex("01 0E 05 34 12")), 0x1234);
  EXPECT_EQ(read(slot(kRequest1616, "class"), hex("01 0E 05 01 34 12")), 0x0105);
  EXPECT_EQ(read(slot(kRequest1616, "instance"), hex("01 0E 05 01 34 12")), 0x1234);
  EXPECT_EQ(read(slot(kRequest168, "class"), hex("01 0E 05 01 34")), 0x0105);
  EXPECT_EQ(read(slot(kRequest168, "instance"), hex("01 0E 05 01 34")), 0x34);
}

TEST(ExplicitMessages, ErrorResponse) {
  const auto bytes = hex("01 94 16 FF");
  EXPECT_EQ(read(slot(kError, "service"), bytes), 0x14);
  EXPECT_EQ(read(slot(kError, "response"), bytes), 1);
  EXPECT_EQ(read(slot(kError, "general_status"), bytes), 0x16);
  EXPECT_EQ(read(slot(kError, "additional_status"), bytes), 0xFF);
  EXPECT_EQ(find_value(kGeneralStatusNames, 0x16)->name, "object does not exist");
  EXPECT_EQ(find_value(kGeneralStatusNames, 0x0E)->name, "attribute not settable");
}

TEST(AllocateAndRelease, ChoiceBits) {
  const struct {
    std::string_view key;
    std::uint8_t choice;
  } kBits[] = {{"choice_explicit", 0x01},        {"choice_poll", 0x02},
               {"choice_bit_strobe", 0x04},      {"choice_multicast_poll", 0x08},
               {"choice_change_of_state", 0x10}, {"choice_cyclic", 0x20},
               {"choice_ack_suppression", 0x40}, {"choice_reserved", 0x80}};
  for (const auto& bit : kBits) {
    auto request = hex("07 4B 03 01 00 07");
    request[4] = bit.choice;
    for (const auto& other : kBits) {
      EXPECT_EQ(read(slot_of(*kAllocate.find(other.key)), request), bit.key == other.key ? 1 : 0) << other.key;
      EXPECT_EQ(read(slot_of(*kRelease.find(other.key)), Bytes(request).first(5)), bit.key == other.key ? 1 : 0);
    }
    EXPECT_EQ(read(slot(kAllocate, "allocator"), request), 7);
    EXPECT_EQ(read(slot(kAllocate, "class"), request), 3);
    EXPECT_EQ(read(slot(kAllocate, "service"), request), 0x4B);
  }
  EXPECT_EQ(read(slot(kAllocated, "body_format"), hex("07 CB 03")), 3);
}

TEST(Fragmentation, TypeAndCount) {
  EXPECT_EQ(read(slot(kFragment, "type"), hex("00")), 0);
  EXPECT_EQ(read(slot(kFragment, "type"), hex("41")), 1);
  EXPECT_EQ(read(slot(kFragment, "count"), hex("41")), 1);
  EXPECT_EQ(read(slot(kFragment, "type"), hex("BF")), 2);
  EXPECT_EQ(read(slot(kFragment, "count"), hex("BF")), 63);
  EXPECT_EQ(read(slot(kFragmentAck, "type"), hex("C5 01")), 3);
  EXPECT_EQ(read(slot(kFragmentAck, "count"), hex("C5 01")), 5);
  EXPECT_EQ(read(slot(kFragmentAck, "ack_status"), hex("C5 01")), 1);
}

TEST(UnconnectedMessages, OpenAndClose) {
  // To node 3Fh, body format 0, group 3, source message ID 2.
  const auto request = hex("3F 4B 00 32");
  EXPECT_EQ(read(slot(kOpenRequest, "master"), request), 63);
  EXPECT_EQ(read(slot(kOpenRequest, "service"), request), 0x4B);
  EXPECT_EQ(read(slot(kOpenRequest, "body_format"), request), 0);
  EXPECT_EQ(read(slot(kOpenRequest, "group_select"), request), 3);
  EXPECT_EQ(read(slot(kOpenRequest, "source_message_id"), request), 2);
  const auto response = hex("01 CB 02 14 34 12");
  EXPECT_EQ(read(slot(kOpenResponse, "body_format"), response), 2);
  EXPECT_EQ(read(slot(kOpenResponse, "source_message_id"), response), 4);
  EXPECT_EQ(read(slot(kOpenResponse, "destination_message_id"), response), 1);
  EXPECT_EQ(read(slot(kOpenResponse, "connection_instance"), response), 0x1234);
  EXPECT_EQ(read(slot(kCloseRequest, "connection_instance"), hex("3F 4C 34 12")), 0x1234);
}

TEST(UnconnectedMessages, HeartbeatAndShutdown) {
  // Heartbeat: identity instance 1, operational, flags, consistency value. Shutdown: class, instance, code.
  const auto heartbeat = hex("3F 4D 01 00 03 85 34 12");
  EXPECT_EQ(read(slot(kHeartbeat, "service"), heartbeat), 0x4D);
  EXPECT_EQ(read(slot(kHeartbeat, "heartbeat_instance"), heartbeat), 1);
  EXPECT_EQ(read(slot(kHeartbeat, "device_state"), heartbeat), 3);
  EXPECT_EQ(read(slot(kHeartbeat, "device_fault"), heartbeat), 1);
  EXPECT_EQ(read(slot(kHeartbeat, "user_fault"), heartbeat), 0);
  EXPECT_EQ(read(slot(kHeartbeat, "system_fault"), heartbeat), 1);
  EXPECT_EQ(read(slot(kHeartbeat, "event"), heartbeat), 0);
  EXPECT_EQ(read(slot(kHeartbeat, "heartbeat_reserved"), heartbeat), 8);
  EXPECT_EQ(read(slot(kHeartbeat, "consistency"), heartbeat), 0x1234);
  const auto shutdown = hex("3F 4E 03 00 01 00 02 01");
  EXPECT_EQ(read(slot(kShutdown, "service"), shutdown), 0x4E);
  EXPECT_EQ(read(slot(kShutdown, "shutdown_class"), shutdown), 3);
  EXPECT_EQ(read(slot(kShutdown, "shutdown_instance"), shutdown), 1);
  EXPECT_EQ(read(slot(kShutdown, "shutdown_code"), shutdown), 0x0102);
}

TEST(ExplicitMessages, PathSegments) {
  EXPECT_EQ(read(slot(kPathClass8, "class"), hex("20 05")), 5);
  EXPECT_EQ(read(slot(kPathClass16, "class"), hex("21 00 05 01")), 0x0105);
  EXPECT_EQ(read(slot(kPathInstance8, "instance"), hex("24 02")), 2);
  EXPECT_EQ(read(slot(kPathInstance16, "instance"), hex("25 00 34 12")), 0x1234);
  EXPECT_EQ(read(slot(kPathAttribute, "attribute"), hex("30 09")), 9);
}

TEST(Objects, EveryGeneralStatusAndPositionClassHasItsWords) {
  const std::pair<std::uint8_t, std::string_view> codes[] = {
      {0x00, "success"},
      {0x02, "resource unavailable"},
      {0x03, "invalid parameter value"},
      {0x04, "path segment error"},
      {0x05, "path destination unknown"},
      {0x08, "service not supported"},
      {0x09, "invalid attribute value"},
      {0x0B, "already in requested mode or state"},
      {0x0C, "object state conflict"},
      {0x0D, "object already exists"},
      {0x0E, "attribute not settable"},
      {0x0F, "privilege violation"},
      {0x10, "device state conflict"},
      {0x11, "reply data too large"},
      {0x13, "not enough data"},
      {0x14, "attribute not supported"},
      {0x15, "too much data"},
      {0x16, "object does not exist"},
      {0x18, "no stored attribute data"},
      {0x19, "store operation failure"},
      {0x1F, "vendor specific"},
      {0x20, "invalid parameter"},
      {0x28, "invalid member ID"},
      {0x29, "member not settable"},
      {0x2A, "Group 2 only server general failure"},
  };
  for (const auto& [code, words] : codes) {
    const ValueName* const row = find_value(kGeneralStatusNames, code);
    ASSERT_NE(row, nullptr) << int{code};
    EXPECT_EQ(row->name, words);
  }
  const std::pair<std::uint16_t, std::string_view> classes[] = {{0x24, "Position Controller Supervisor"},
                                                                {0x25, "Position Controller"},
                                                                {0x26, "Block Sequencer"},
                                                                {0x27, "Command Block"}};
  for (const auto& [id, words] : classes) {
    EXPECT_EQ(find_class(standard_objects(), id)->name, words);
    EXPECT_EQ(find_value(kClassNames, id)->name, words);
  }
}

TEST(Vendors, BothNumbersOfTheNs310) {
  EXPECT_NE(find_value(kVendorNames, 44), nullptr);
  EXPECT_NE(find_value(kVendorNames, 0x44), nullptr);
}

TEST(ConnectionObject, Attributes) {
  const ObjectClass* connection = find_class(standard_objects(), 5);
  ASSERT_NE(connection, nullptr);
  const Attribute* rate = connection->find(9);
  ASSERT_NE(rate, nullptr);
  EXPECT_EQ(rate->unit, Unit::kMillisecond);
  EXPECT_EQ(size_of(rate->type), 2);
  const Attribute* state = connection->find(1);
  ASSERT_NE(state, nullptr);
  EXPECT_EQ(find_value(state->values, 3)->name, "established");
  EXPECT_EQ(find_value(state->values, 5)->name, "deferred delete");
  EXPECT_EQ(connection->find(7)->key, "produced_size");
  EXPECT_EQ(connection->find(8)->key, "consumed_size");
  const Layout* layout = connection->layout_of(*rate);
  ASSERT_NE(layout, nullptr);
  EXPECT_EQ(read(slot_of(layout->fields[0]), hex("C8 00")), 200);
}

TEST(IdentityObject, ProductNameIsAShortString) {
  const ObjectClass* identity = find_class(standard_objects(), 1);
  const Layout* layout = identity->layout_of(*identity->find(7));
  ASSERT_NE(layout, nullptr);
  const auto bytes = hex("03 41 42 43");
  EXPECT_EQ(read(slot_of(layout->fields[0]), bytes), 3);
  EXPECT_EQ(bytes_of(layout->fields[1], bytes).size(), 3U);
}

}  // namespace
}  // namespace servotrace::devicenet
