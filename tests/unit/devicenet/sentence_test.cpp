// SPDX-License-Identifier: MIT
// What the Info column and the evidence lines say of a DeviceNet frame.
#include "decoder/render/sentence.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/devicenet/bench.hpp"

namespace servotrace::devicenet {
namespace {

using test::Bench;

TEST(Sentences, OfExplicitMessages) {
  Bench bench;
  bench.start(5).frame(0x42E, "01 4B 03 01 03 01");
  EXPECT_EQ(sentence(bench.dissection()),
            "node 5 Unconnected explicit request: Allocate_Master/Slave_Connection_Set DeviceNet, Explicit, Poll");
  bench.frame(0x42B, "01 94 0C 01");
  EXPECT_EQ(sentence(bench.dissection()),
            "node 5 Explicit response: Allocate_Master/Slave_Connection_Set DeviceNet, refused: object state conflict "
            "(owned by another master)");
  bench.frame(0x42E, "01 4B 03 01 03 01").frame(0x42B, "01 CB 00");
  bench.frame(0x42C, "01 0E 05 02 09").frame(0x42B, "01 8E C8 00");
  EXPECT_EQ(sentence(bench.dissection()),
            "node 5 Explicit response: Get_Attribute_Single Connection Expected packet rate = 200 ms");
  bench.frame(0x42C, "01 0E 03 01 02").frame(0x42B, "01 94 14 FF");
  EXPECT_EQ(sentence(bench.dissection()),
            "node 5 Explicit response: Get_Attribute_Single DeviceNet Baud rate, refused: attribute not supported");
  bench.frame(0x42C, "01 0E 25 01 06");  // a position controller without a profile
  EXPECT_EQ(sentence(bench.dissection()),
            "node 5 Explicit request: Get_Attribute_Single Position Controller, attribute 6");
  bench.frame(0x42C, "01 32 64 01 93 05");
  EXPECT_EQ(sentence(bench.dissection()),
            "node 5 Explicit request: service 32h (vendor specific), class 64h, instance 1");
}

// The value of a drive's own attribute, with its unit.
TEST(Sentences, OfADrivesAttributes) {
  Bench bench{Bench::with_profile(5, "yaskawa-ns310")};
  bench.start(5).allocate(5).frame(0x42C, "01 0E 64 01 0D").frame(0x42B, "01 8E 58 02 00 00");
  EXPECT_EQ(sentence(bench.dissection()),
            "node 5 Explicit response: Get_Attribute_Single Control Parameter Object Home Fast Speed for Homing = 600 "
            "x1000 steps/min");
}

// A drive that nothing names: its bytes say nothing but whether they are 0.
TEST(Sentences, OfPollsWithoutAProfile) {
  Bench bench;
  bench.start(5).allocate(5).frame(0x42D, "00 00");
  EXPECT_EQ(sentence(bench.dissection()), "node 5 Poll command: all bits 0");
  bench.frame(0x3C5, "00 01");
  EXPECT_EQ(sentence(bench.dissection()), "node 5 Poll response");
}

// SocketCAN error classes: 40h bus-off, 08h and 80h protocol violation and bus error.
TEST(Sentences, OfWhatIsNoDevicenetMessage) {
  Bench bench;
  bench.frame(0x20000040, "00 00 00 00 00 00 00 00");
  EXPECT_THAT(sentence(bench.dissection()), testing::StartsWith("CAN error frame: Bus-off"));
  EXPECT_EQ(test::derived_value(bench.dissection(), "scanner_code"), 91);
  bench.frame(0x20000088, "00 00 04 00 00 00 00 00");
  EXPECT_THAT(sentence(bench.dissection()), testing::StartsWith("CAN error frame: Protocol violation, Bus error"));
  EXPECT_THAT(sentence(bench.dissection()), testing::HasSubstr("bit stuffing error"));
  bench.frame(0x98FEF100, "01");
  EXPECT_EQ(sentence(bench.dissection()), "Frame with a 29-bit identifier");
  bench.frame(0x4000042C, "");
  EXPECT_EQ(sentence(bench.dissection()), "Remote frame");
  bench.frame(0x7F5, "");
  EXPECT_EQ(sentence(bench.dissection()), "Invalid identifier");
}

}  // namespace
}  // namespace servotrace::devicenet
