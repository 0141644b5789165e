// SPDX-License-Identifier: MIT
// What a DeviceNet frame becomes: ends, links, values, reassembly, recognition of buses and drives.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/devicenet/bench.hpp"

namespace servotrace::devicenet {
namespace {

using test::Bench;
using test::derived_text;
using test::derived_value;
using test::field_value;
using testing::IsEmpty;

TEST(Ends, OfGroup2AndPolls) {
  Bench bench;
  bench.start(5).frame(0x42E, "07 4B 03 01 03 07");
  EXPECT_EQ(derived_value(bench.dissection(), "source"), 7);
  EXPECT_EQ(derived_value(bench.dissection(), "destination"), 5);
  EXPECT_EQ(field_value(bench.dissection(), "explicit", "choice_poll"), 1);
  EXPECT_EQ(field_value(bench.dissection(), "explicit", "allocator"), 7);
  EXPECT_EQ(bench.dissection().direction, Direction::kCommand);
  bench.frame(0x42B, "07 CB 00");
  EXPECT_EQ(derived_value(bench.dissection(), "source"), 5);
  EXPECT_EQ(derived_value(bench.dissection(), "destination"), 7);
  EXPECT_EQ(bench.dissection().links[0].kind, LinkKind::kRequestIn);
  EXPECT_EQ(bench.dissection().links[0].frame, 4U);
  EXPECT_EQ(derived_value(bench.dissection(), "response_time_ns"), kMillisecondNs);
  bench.frame(0x42D, "01");
  EXPECT_EQ(derived_value(bench.dissection(), "source"), 7);
  EXPECT_EQ(derived_value(bench.dissection(), "destination"), 5);
  EXPECT_EQ(derived_value(bench.dissection(), "group"), 2);
  EXPECT_EQ(derived_value(bench.dissection(), "message_id"), 5);
  EXPECT_EQ(derived_value(bench.dissection(), "identifier"), 0x42D);
  EXPECT_EQ(derived_text(bench.dissection(), "message"), "Poll command");
  bench.frame(0x3C5, "02");
  EXPECT_EQ(derived_value(bench.dissection(), "source"), 5);
  EXPECT_EQ(derived_value(bench.dissection(), "destination"), 7);
  EXPECT_EQ(field_value(bench.dissection(), "io", "data"), 0);  // a bytes row reads as 0, but it is there
  EXPECT_EQ(derived_value(bench.dissection(), "poll_state"), 4);
  bench.frame(0x438, "00 00 00 00 00 00 00 80");  // bit-strobe of master 7
  EXPECT_EQ(derived_value(bench.dissection(), "source"), 7);
  EXPECT_EQ(field_value(bench.dissection(), "bit_strobe", "output_63"), 1);
}

TEST(Values, OfAttributes) {
  Bench bench;
  bench.start(5).allocate(5).frame(0x42C, "01 0E 05 02 09");
  EXPECT_EQ(derived_text(bench.dissection(), "service_name"), "Get_Attribute_Single");
  EXPECT_EQ(derived_text(bench.dissection(), "object_name"), "Connection");
  EXPECT_EQ(derived_text(bench.dissection(), "attribute_name"), "Expected packet rate");
  EXPECT_EQ(field_value(bench.dissection(), "explicit", "attribute"), 9);
  bench.frame(0x42B, "01 8E C8 00");
  EXPECT_EQ(field_value(bench.dissection(), "connection", "expected_packet_rate"), 200);
  bench.frame(0x42C, "01 10 05 02 09 2C 01");
  EXPECT_EQ(field_value(bench.dissection(), "connection", "expected_packet_rate"), 300);
  bench.frame(0x42B, "01 94 0E FF");
  EXPECT_EQ(field_value(bench.dissection(), "explicit", "general_status"), 0x0E);
}

TEST(BodyFormats, AsTheAllocationAnswered) {
  Bench bench;
  bench.start(5).frame(0x42E, "01 4B 03 01 01 01").frame(0x42B, "01 CB 02");
  bench.frame(0x42C, "01 0E 05 00 02 00 09");
  EXPECT_EQ(field_value(bench.dissection(), "explicit", "class"), 5);
  EXPECT_EQ(field_value(bench.dissection(), "explicit", "instance"), 2);
  EXPECT_EQ(field_value(bench.dissection(), "explicit", "attribute"), 9);
  bench.frame(0x42B, "01 8E C8 00");
  EXPECT_EQ(field_value(bench.dissection(), "connection", "expected_packet_rate"), 200);
  EXPECT_THAT(bench.findings(), IsEmpty());
}

TEST(BodyFormats, EveryNumberedFormat) {
  const std::pair<const char*, const char*> formats[] = {{"01 CB 00", "01 0E 05 02 09"},
                                                         {"01 CB 01", "01 0E 05 02 00 09"},
                                                         {"01 CB 02", "01 0E 05 00 02 00 09"},
                                                         {"01 CB 03", "01 0E 05 00 02 09"}};
  for (const auto& [allocated, request] : formats) {
    Bench bench;
    bench.start(5).frame(0x42E, "01 4B 03 01 01 01").frame(0x42B, allocated).frame(0x42C, request);
    EXPECT_EQ(field_value(bench.dissection(), "explicit", "class"), 5) << request;
    EXPECT_EQ(field_value(bench.dissection(), "explicit", "instance"), 2) << request;
    EXPECT_EQ(field_value(bench.dissection(), "explicit", "attribute"), 9) << request;
    bench.frame(0x42B, "01 8E C8 00");
    EXPECT_EQ(field_value(bench.dissection(), "connection", "expected_packet_rate"), 200) << request;
  }
}

TEST(BodyFormats, CipPath) {
  Bench bench;
  bench.start(5).frame(0x42E, "01 4B 03 01 01 01").frame(0x42B, "01 CB 04");
  bench.frame(0x42C, "01 01 02 20 05 24 02");
  EXPECT_EQ(derived_text(bench.dissection(), "object_name"), "Connection");
  EXPECT_EQ(field_value(bench.dissection(), "explicit", "class"), 5);
  EXPECT_EQ(field_value(bench.dissection(), "explicit", "instance"), 2);
  bench.frame(0x42B, "01 94 08 FF");
  // 9 bytes with an attribute segment: fragmented.
  bench.frame(0x42C, "81 00 0E 03 20 05 24 02").frame(0x42B, "81 C0 00").frame(0x42C, "81 81 30 09");
  EXPECT_EQ(derived_text(bench.dissection(), "attribute_name"), "Expected packet rate");
  EXPECT_EQ(field_value(bench.dissection(), "explicit", "attribute"), 9);
  bench.frame(0x42B, "81 C1 00").frame(0x42B, "01 8E C8 00");
  EXPECT_EQ(field_value(bench.dissection(), "connection", "expected_packet_rate"), 200);
}

// Nothing of a message stays without a name.
TEST(Values, OfClassesResetsAndWhatIsTooMuch) {
  Bench bench;
  bench.start(5).allocate(5).frame(0x42C, "01 0E 03 00 01");
  EXPECT_EQ(derived_text(bench.dissection(), "attribute_name"), "Class revision");
  bench.frame(0x42B, "01 8E 02 00");
  EXPECT_EQ(field_value(bench.dissection(), "class", "revision"), 2);
  bench.frame(0x42C, "01 0E 01 01 01 00");  // a byte behind the attribute of a Get
  EXPECT_EQ(field_value(bench.dissection(), "explicit", "surplus"), 0);
  bench.frame(0x42B, "01 8E 34 12 FF");  // and behind the value
  EXPECT_EQ(field_value(bench.dissection(), "identity", "vendor_id"), 0x1234);
  EXPECT_EQ(field_value(bench.dissection(), "explicit", "surplus"), 0);
  bench.frame(0x42C, "01 05 01 01 01");
  EXPECT_EQ(field_value(bench.dissection(), "explicit", "reset_type"), 1);
}

TEST(Values, OfSeveralParts) {
  Bench bench;
  bench.start(5).allocate(5).frame(0x42C, "01 0E 03 01 05").frame(0x42B, "01 8E 03 01");
  EXPECT_EQ(field_value(bench.dissection(), "devicenet", "allocated_explicit"), 1);
  EXPECT_EQ(field_value(bench.dissection(), "devicenet", "allocated_poll"), 1);
  EXPECT_EQ(field_value(bench.dissection(), "devicenet", "allocated_bit_strobe"), 0);
  EXPECT_EQ(field_value(bench.dissection(), "devicenet", "owner"), 1);
  bench.frame(0x42C, "01 0E 05 01 03").frame(0x42B, "01 8E 83");
  EXPECT_EQ(field_value(bench.dissection(), "connection", "transport_class"), 3);
  EXPECT_EQ(field_value(bench.dissection(), "connection", "transport_direction"), 1);
  bench.frame(0x42C, "01 0E 01 01 05").frame(0x42B, "01 8E 05 01");
  EXPECT_EQ(field_value(bench.dissection(), "identity", "owned"), 1);
  EXPECT_EQ(field_value(bench.dissection(), "identity", "configured"), 1);
  EXPECT_EQ(field_value(bench.dissection(), "identity", "minor_recoverable"), 1);
}

TEST(Errors, OfAnAllocationInWordsWithTheScannersCode) {
  const std::pair<const char*, const char*> answers[] = {
      {"01 94 0C 01", "owned by another master"},
      {"01 94 09 02", "bad choice"},
      {"01 94 02 02", "choice not supported"},
      {"01 94 0B 02", "already allocated, or not allocated on release"}};
  for (const auto& [answer, words] : answers) {
    Bench bench;
    bench.start(5).frame(0x42E, "01 4B 03 01 03 01").frame(0x42B, answer);
    EXPECT_EQ(derived_text(bench.dissection(), "allocation_error"), words);
    EXPECT_EQ(derived_value(bench.dissection(), "scanner_code"), 83);
  }
}

TEST(Errors, EachScannerCode) {
  Bench bench{Bench::with_profile(5, "yaskawa-ns310")};
  bench.start(5).allocate(5).poll(5, "00 00 20 20 00 00 00 00", "00 00 00 20 00 00 00 00");
  bench.frame(0x42D, "00 00 20 20 00 00 00", 10);
  EXPECT_EQ(derived_value(bench.dissection(), "scanner_code"), 77);
  bench.frame(0x42D, "00 00 20 20 00 00 00 00", 10);
  EXPECT_EQ(derived_value(bench.dissection(), "scanner_code"), 72);
  bench.frame(0x3C5, "");
  EXPECT_EQ(derived_value(bench.dissection(), "scanner_code"), 86);
  bench.frame(0x42F, "00 34 12 09 09 09 09");
  EXPECT_EQ(derived_value(bench.dissection(), "scanner_code"), 70);
}

TEST(Reassembly, ARetransmissionIsMarked) {
  Bench bench;
  bench.start(5).allocate(5).frame(0x42C, "01 0E 01 01 07").frame(0x42B, "81 00 8E 0A 4A 55 53 50");
  EXPECT_EQ(derived_value(bench.dissection(), "retransmission"), -1);
  bench.frame(0x42B, "81 00 8E 0A 4A 55 53 50", 900);
  EXPECT_EQ(derived_value(bench.dissection(), "retransmission"), 1);
  bench.frame(0x42C, "81 C0 00").frame(0x42B, "81 81 2D 4E 53 33 31 30");
  EXPECT_EQ(derived_value(bench.dissection(), "retransmission"), -1);
}

// How the drive was recognised stands in the finding: the settings, or the frame of the Identity read.
TEST(Recognition, AFindingSaysHow) {
  Bench configured{Bench::with_profile(5, "yaskawa-ns310")};
  configured.start(5).allocate(5).frame(0x42C, "01 10 25 01 08 64");
  EXPECT_EQ(configured.last().basis.kind, BasisKind::kConfigured);
  Bench read;
  read.start(5).allocate(5).frame(0x42C, "01 0E 01 01 01").frame(0x42B, "01 8E 2C 00");
  read.frame(0x42C, "01 0E 01 01 03").frame(0x42B, "01 8E 51").frame(0x42C, "01 10 25 01 08 64");
  EXPECT_THAT(read.findings(), testing::ElementsAre("DN404@10"));
  EXPECT_EQ(read.last().basis.kind, BasisKind::kCapture);
  EXPECT_EQ(read.last().basis.frame, 9U);
  // A rule of the drive itself: Start_Trajectory while the servo is off (YS104).
  read.poll(5, "00 00 20 20 00 00 00 00", "00 00 00 20 00 00 00 00");
  read.frame(0x42D, "81 00 21 20 F4 01 00 00", 10);
  EXPECT_EQ(rule_row(read.last().rule).id.substr(0, 2), "YS");
  EXPECT_EQ(read.last().basis.frame, 9U);
}

// Vendor, device type, product code, revision, status, serial number, product name: 18 bytes in three fragments.
TEST(Values, OfTheWholeIdentity) {
  Bench bench;
  bench.start(5).allocate(5).frame(0x42C, "01 01 01 01");
  bench.frame(0x42B, "81 00 81 2C 00 10 00 51").frame(0x42C, "81 C0 00");
  bench.frame(0x42B, "81 41 00 01 02 00 00 78").frame(0x42C, "81 C1 00");
  bench.frame(0x42B, "81 82 56 34 12 02 4E 53");
  EXPECT_EQ(field_value(bench.dissection(), "identity", "vendor_id"), 44);
  EXPECT_EQ(field_value(bench.dissection(), "identity", "device_type"), 16);
  EXPECT_EQ(field_value(bench.dissection(), "identity", "product_code"), 0x51);
  EXPECT_EQ(field_value(bench.dissection(), "identity", "major_revision"), 1);
  EXPECT_EQ(field_value(bench.dissection(), "identity", "minor_revision"), 2);
  EXPECT_EQ(field_value(bench.dissection(), "identity", "owned"), 0);
  EXPECT_EQ(field_value(bench.dissection(), "identity", "serial_number"), 0x12345678);
  EXPECT_EQ(field_value(bench.dissection(), "identity", "length"), 2);
  bench.frame(0x42C, "81 C2 00");
  EXPECT_THAT(bench.findings(), IsEmpty());
}

// Change of state: 340h + n, acknowledged on 402h + 8n; the master's on 405h + 8n, acknowledged on 3C0h + n.
TEST(OtherIo, ChangeOfState) {
  Bench bench;
  bench.start(5).allocate(5, 0x11);
  bench.frame(0x345, "01 02");
  EXPECT_EQ(derived_text(bench.dissection(), "message"), "Change-of-state or cyclic");
  EXPECT_EQ(derived_value(bench.dissection(), "source"), 5);
  EXPECT_EQ(derived_value(bench.dissection(), "destination"), 1);
  EXPECT_EQ(field_value(bench.dissection(), "io", "data"), 0);
  EXPECT_EQ(derived_value(bench.dissection(), "fragment_or_data"), -1);
  bench.frame(0x42A, "");
  EXPECT_EQ(derived_value(bench.dissection(), "source"), 1);
  EXPECT_EQ(derived_value(bench.dissection(), "destination"), 5);
  EXPECT_EQ(derived_value(bench.dissection(), "idle"), -1);  // an acknowledge is empty
  bench.frame(0x345, "");
  EXPECT_EQ(derived_value(bench.dissection(), "idle"), 1);
  bench.frame(0x42D, "05");
  EXPECT_EQ(derived_text(bench.dissection(), "message"), "Change-of-state or cyclic command");
  bench.frame(0x3C5, "");
  EXPECT_EQ(derived_text(bench.dissection(), "message"), "Change-of-state or cyclic acknowledge");
  EXPECT_THAT(bench.findings(), IsEmpty());
}

TEST(OtherIo, FragmentsAsTheConnectionSizeSays) {
  Bench bench;
  bench.start(5).allocate(5, 0x11);
  bench.frame(0x345, "00 01 02 03 04 05 06 07");
  EXPECT_EQ(derived_value(bench.dissection(), "fragment_or_data"), 1);
  bench.frame(0x345, "81 08").frame(0x42C, "01 0E 05 04 07").frame(0x42B, "01 8E 0A 00");
  bench.frame(0x345, "00 01 02 03 04 05 06 07").frame(0x345, "81 08 09 0A");
  EXPECT_EQ(bench.dissection().reassembled.size(), 10U);
  EXPECT_EQ(field_value(bench.dissection(), "fragment", "count"), 1);
  EXPECT_EQ(derived_value(bench.dissection(), "fragment_or_data"), -1);
  EXPECT_THAT(bench.findings(), IsEmpty());
  bench.frame(0x345, "00 01 02 03 04 05 06 07").frame(0x345, "82 08 09 0A");
  EXPECT_THAT(bench.findings(), testing::ElementsAre("DN301@13"));
}

TEST(OtherIo, BitStrobeAndMulticastPoll) {
  Bench bench;
  bench.start(5).allocate(5, 0x0D).frame(0x408, "20 00 00 00 00 00 00 00");
  EXPECT_EQ(derived_value(bench.dissection(), "source"), 1);
  EXPECT_EQ(field_value(bench.dissection(), "bit_strobe", "output_5"), 1);
  bench.frame(0x385, "01");
  EXPECT_EQ(derived_value(bench.dissection(), "source"), 5);
  EXPECT_EQ(derived_value(bench.dissection(), "destination"), 1);
  bench.frame(0x385, "");
  EXPECT_EQ(derived_value(bench.dissection(), "idle"), 1);
  bench.frame(0x411, "01 02");  // multicast group 2
  EXPECT_EQ(derived_value(bench.dissection(), "multicast_group"), 2);
  EXPECT_EQ(derived_value(bench.dissection(), "source"), -1);
  bench.frame(0x305, "01 02");
  EXPECT_EQ(derived_value(bench.dissection(), "source"), 5);
  EXPECT_EQ(field_value(bench.dissection(), "io", "data"), 0);
  EXPECT_THAT(bench.findings(), IsEmpty());
}

TEST(Ucmm, HeartbeatAndShutdown) {
  Bench bench;
  bench.frame(0x745, "05 4D 01 00 03 00 34 12");
  EXPECT_EQ(derived_text(bench.dissection(), "service_name"), "Device_Heartbeat");
  EXPECT_EQ(field_value(bench.dissection(), "unconnected", "heartbeat_instance"), 1);
  EXPECT_EQ(field_value(bench.dissection(), "unconnected", "device_state"), 3);
  EXPECT_EQ(field_value(bench.dissection(), "unconnected", "consistency"), 0x1234);
  EXPECT_THAT(bench.findings(), IsEmpty());
  bench.frame(0x745, "05 4E 03 00 01 00 02 00");
  EXPECT_EQ(field_value(bench.dissection(), "unconnected", "shutdown_class"), 3);
  EXPECT_EQ(field_value(bench.dissection(), "unconnected", "shutdown_instance"), 1);
  EXPECT_EQ(field_value(bench.dissection(), "unconnected", "shutdown_code"), 2);
}

TEST(Reassembly, ProductNameRecognisesTheDrive) {
  Bench bench;
  bench.start(5).allocate(5).frame(0x42C, "01 0E 01 01 07").frame(0x42B, "81 00 8E 0A 4A 55 53 50");
  bench.frame(0x42C, "81 C0 00");
  EXPECT_EQ(field_value(bench.dissection(), "fragment", "ack_status"), 0);
  bench.frame(0x42B, "81 81 2D 4E 53 33 31 30");
  ASSERT_EQ(bench.dissection().reassembled.size(), 13U);
  EXPECT_EQ(field_value(bench.dissection(), "identity", "length"), 10);
  bench.frame(0x42C, "81 C1 00");
  const Summary summary = bench.summary();
  ASSERT_EQ(summary.buses.size(), 1U);
  ASSERT_EQ(summary.buses[0].nodes.size(), 1U);
  EXPECT_EQ(summary.buses[0].nodes[0].profile, "yaskawa-ns310");
  EXPECT_EQ(summary.buses[0].nodes[0].recognised, "identity (frame 9)");
  EXPECT_THAT(bench.findings(), IsEmpty());
}

TEST(Recognition, VendorAndProductCode) {
  for (const char* vendor : {"01 8E 2C 00", "01 8E 44 00"}) {
    Bench bench;
    bench.start(5).allocate(5).frame(0x42C, "01 0E 01 01 01").frame(0x42B, vendor);
    EXPECT_EQ(bench.summary().buses[0].nodes[0].profile, "");
    bench.frame(0x42C, "01 0E 01 01 03").frame(0x42B, "01 8E 51");
    EXPECT_EQ(bench.summary().buses[0].nodes[0].profile, "yaskawa-ns310");
  }
}

TEST(Recognition, OfAnotherVendorIsNone) {
  Bench bench;
  bench.start(5).allocate(5).frame(0x42C, "01 0E 01 01 01").frame(0x42B, "01 8E 34 12");
  bench.frame(0x42C, "01 0E 01 01 03").frame(0x42B, "01 8E 51 00");
  EXPECT_EQ(bench.summary().buses[0].nodes[0].profile, "");
}

TEST(Recognition, AnEsbIsGuessedByItsFragments) {
  Bench bench;
  bench.start(5).allocate(5);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(bench.summary().buses[0].nodes[0].profile, "");
    bench.frame(0x42D, "00 01 02 03 04 05 06 07", 10);
    EXPECT_EQ(derived_value(bench.dissection(), "fragment_or_data"), 1);
    bench.frame(0x42D, "81 08 09 0A").frame(0x3C5, "00 01 02 03 04 05 06 07").frame(0x3C5, "81 08 09 0A");
  }
  EXPECT_EQ(bench.summary().buses[0].nodes[0].profile, "nsk-esb");
  EXPECT_EQ(bench.summary().buses[0].nodes[0].recognised, "guessed by I/O sizes");
  bench.frame(0x42D, "00 01 02 03 04 05 06 07", 10);
  EXPECT_EQ(derived_value(bench.dissection(), "fragment_or_data"), -1);
  for (const Segment& segment : bench.dissection().segments) EXPECT_TRUE(segment.guessed);
  bench.frame(0x42D, "81 08 09 0A");
  // What it is only guessed to be is no ground for a finding.
  bench.frame(0x42D, "81 08 09 0A", 10).frame(0x42D, "00 01", 10).frame(0x7C0, "", 3000);
  EXPECT_THAT(bench.findings(), testing::Not(testing::Contains(testing::StartsWith("DN30"))));
}

TEST(Evidence, EachKindAlone) {
  const auto frames = [](Bench& bench) { return bench.pipeline().checked_frames(); };
  {
    Bench bench{Settings{}};
    bench.frame(0x42F, "00 00 00 00 00 00 00").frame(0x42F, "00 00 00 00 00 00 00");
    EXPECT_EQ(frames(bench), 0U) << "no vendor has the number 0";
    bench.frame(0x42F, "00 2C 00 01 02 03 04").frame(0x42F, "00 2C 00 01 02 03 05");
    EXPECT_EQ(frames(bench), 0U) << "another serial number";
    bench.frame(0x42F, "00 2C 00 01 02 03 05", 1000);
    EXPECT_EQ(frames(bench), 1U);
  }
  {
    // The same seven bytes again and again, as other protocols send them: no check is repeated so soon or so late.
    Bench bench{Settings{}};
    for (int i = 0; i < 40; ++i) bench.frame(0x42F, "00 2C 00 01 02 03 04", 100);
    for (int i = 0; i < 5; ++i) bench.frame(0x42F, "00 2C 00 01 02 03 04", 5000);
    EXPECT_EQ(frames(bench), 0U);
  }
  {
    Bench bench{Settings{}};
    bench.frame(0x42E, "01 4B 03 01 03 01").frame(0x42B, "02 CB 00");
    EXPECT_EQ(frames(bench), 0U) << "the answer is for another master";
    bench.frame(0x42E, "01 4B 03 01 03 01").frame(0x42B, "01 CB 00").frame(0x42D, "");
    EXPECT_EQ(frames(bench), 2U);
    EXPECT_EQ(bench.summary().buses[0].recognised, "evidence: an allocation and its answer");
  }
  {
    Bench bench{Settings{}};
    bench.frame(0x42C, "01 0E 01 01 01").frame(0x42B, "01 90 00 00");
    EXPECT_EQ(frames(bench), 0U) << "another service";
    bench.frame(0x42C, "01 0E 01 01 01").frame(0x42B, "01 8E 00 00");
    EXPECT_EQ(frames(bench), 1U);
  }
  {
    Bench bench{Settings{}};
    bench.poll(5, "", "01").poll(5, "", "01").frame(0x42D, "").poll(5, "", "01");
    EXPECT_EQ(frames(bench), 0U) << "not three in a row";
    bench.poll(5, "", "01").poll(5, "", "01");
    EXPECT_EQ(frames(bench), 1U);
  }
  {
    Bench bench{Settings{}};
    for (int i = 0; i < 100; ++i) bench.frame(0x100 + static_cast<unsigned>(i), "01 02 03 04 05 06 07 08");
    EXPECT_EQ(frames(bench), 0U) << "ordinary CAN";
    EXPECT_TRUE(bench.dissection().segments.empty());
  }
}

// Other protocols use identifiers of the predefined set, too: CANopen (process data, SDO, heartbeats of nodes 5, 7 and
// 45h, 48h), diagnostics of a car, and J1939.
TEST(Evidence, NoneInOtherProtocols) {
  Bench bench{Settings{}};
  for (int i = 0; i < 50; ++i) {
    bench.frame(0x080, "").frame(0x185, "11 22 33 44").frame(0x205, "01 00").frame(0x285, "55 66").frame(0x305, "02");
    bench.frame(0x385, "01 02 03 04 05 06 07 08").frame(0x405, "09 0A 0B 0C").frame(0x407, "0D 0E 0F 10 11 12 13 14");
    bench.frame(0x605, "40 41 60 00 00 00 00 00").frame(0x585, "4B 41 60 00 37 06 00 00");
    bench.frame(0x705, "05").frame(0x707, "05").frame(0x745, "05").frame(0x748, "05");
    bench.frame(0x7DF, "02 01 0C 00 00 00 00 00").frame(0x7E8, "04 41 0C 1A F8 00 00 00");
    bench.frame(0x98FEF100, "FF FF FF 12 34 56 78 9A");
  }
  EXPECT_EQ(bench.pipeline().checked_frames(), 0U);
  EXPECT_TRUE(bench.all().empty());
}

// What the frames in front of the evidence showed is known, but nothing is reported of them.
TEST(Evidence, CountsFromTheFrameThatCompletesIt) {
  Bench bench{Settings{}};
  bench.frame(0x7F3, "").frame(0x42E, "01 4B 03 01 03 01").frame(0x42B, "01 CB 00");
  bench.frame(0x42C, "02 0E 01 01 01");
  EXPECT_EQ(bench.findings(), std::vector<std::string>{"DN211@4"});
}

// Each kind of message of a node is a series of its own: what stands between, of any node, does not matter.
TEST(Links, NameTheFrameBeforeOfTheSameKind) {
  Bench bench;
  const auto previous = [&bench](std::uint32_t identifier, std::string_view bytes) {
    bench.frame(identifier, bytes);
    std::vector<std::pair<std::uint64_t, DurationNs>> links;
    for (const Link& link : bench.dissection().links) {
      if (link.kind == LinkKind::kPreviousOfNode) links.emplace_back(link.frame, link.after_ns);
    }
    EXPECT_LE(links.size(), 1U);
    return links.empty() ? std::pair<std::uint64_t, DurationNs>{} : links[0];
  };
  bench.start(5).start(6).allocate(5);
  const struct {
    std::uint32_t identifier;
    std::string_view bytes;
  } kinds[] = {
      {0x42C, "01 0E 01 01 01"},  // explicit request: the first of its port, allocation has one of its own
      {0x42D, "01"},              // poll command
      {0x3C5, "02"},              // poll response
      {0x345, "03"},              // change of state
      {0x42A, "04"},              // its acknowledgement
      {0x385, "05"},              // bit-strobe response
      {0x305, "06"},              // multicast poll response
  };
  const std::uint64_t first = bench.number() + 1;
  for (const auto& kind : kinds) EXPECT_EQ(previous(kind.identifier, kind.bytes).first, 0U) << kind.identifier;
  for (int n = 0; n < 300; ++n) bench.frame(0x435, "01");  // polls of node 6
  const std::uint64_t last = bench.number();
  for (std::size_t i = 0; i < std::size(kinds); ++i)
    EXPECT_EQ(previous(kinds[i].identifier, kinds[i].bytes).first, first + i) << kinds[i].identifier;
  for (std::size_t i = 0; i < std::size(kinds); ++i)
    EXPECT_EQ(previous(kinds[i].identifier, kinds[i].bytes),
              std::pair(last + 1 + i, DurationNs{std::size(kinds)} * kMillisecondNs));
  // A Duplicate MAC ID check is no step of a series.
  EXPECT_EQ(previous(0x42F, "00 2C 00 01 00 00 00").first, 0U);
}

TEST(Ucmm, ADynamicConnectionIsFollowed) {
  Bench bench;
  bench.frame(0x7C0, "").frame(0x782, "05 4B 00 33", 2000);  // client 2 opens at server 5, group 3, its message ID 3
  EXPECT_EQ(derived_value(bench.dissection(), "source"), 2);
  EXPECT_EQ(derived_value(bench.dissection(), "destination"), 5);
  EXPECT_EQ(derived_text(bench.dissection(), "service_name"), "Open_Explicit_Messaging_Connection");
  bench.frame(0x745, "02 CB 00 04 07 00");  // the server's message ID 4, instance 7
  EXPECT_EQ(bench.dissection().links[0].frame, 2U);
  bench.frame(0x6C2, "05 0E 01 01 01");
  EXPECT_EQ(field_value(bench.dissection(), "explicit", "attribute"), 1);
  EXPECT_TRUE(bench.dissection().links.empty());  // the first of its kind
  EXPECT_EQ(bench.dissection().segments[0].node.mac_id, 5);
  EXPECT_EQ(derived_value(bench.dissection(), "source"), 2);
  EXPECT_EQ(derived_value(bench.dissection(), "destination"), 5);
  bench.frame(0x705, "02 8E 2C 00");  // its identifier holds the sender, its header the other end
  EXPECT_EQ(field_value(bench.dissection(), "identity", "vendor_id"), 44);
  EXPECT_EQ(derived_value(bench.dissection(), "destination"), 2);
  EXPECT_EQ(bench.dissection().links[0].frame, 4U);
  // A product name in fragments: acknowledged from the other side, whose header again holds the other MAC ID.
  bench.frame(0x6C2, "45 0E 01 01 07");
  EXPECT_EQ(bench.dissection().links[0].kind, LinkKind::kPreviousOfNode);
  EXPECT_EQ(bench.dissection().links[0].frame, 4U);
  bench.frame(0x705, "C2 00 8E 0A 4A 55 53 50").frame(0x6C2, "C5 C0 00");
  bench.frame(0x705, "C2 81 2D 4E 53 33 31 30");
  EXPECT_EQ(field_value(bench.dissection(), "identity", "length"), 10);
  bench.frame(0x6C2, "C5 C1 00");
  bench.frame(0x782, "05 4C 07 00").frame(0x745, "02 CC");  // closed
  bench.frame(0x6C2, "05 0E 01 01 01");
  EXPECT_EQ(field_value(bench.dissection(), "explicit", "attribute"), -1);
  EXPECT_THAT(bench.findings(), IsEmpty());
}

// Opened in group 2: both message IDs are the server's, here 1 and 5, which the predefined set uses for polls.
TEST(Ucmm, AConnectionOfGroup2IsFollowed) {
  Bench bench;
  bench.frame(0x7C0, "").frame(0x782, "05 4B 00 1F", 2000);  // client 2 asks server 5 for group 2
  bench.frame(0x745, "02 CB 00 51 09 00");  // destination message ID 5, source message ID 1; instance 9
  bench.frame(0x42D, "02 0E 01 01 01");
  EXPECT_EQ(derived_text(bench.dissection(), "message"), "Explicit request (opened connection)");
  EXPECT_EQ(field_value(bench.dissection(), "explicit", "attribute"), 1);
  EXPECT_EQ(derived_value(bench.dissection(), "source"), 2);
  EXPECT_EQ(derived_value(bench.dissection(), "destination"), 5);
  bench.frame(0x429, "02 8E 2C 00");
  EXPECT_EQ(field_value(bench.dissection(), "identity", "vendor_id"), 44);
  EXPECT_EQ(bench.dissection().links[0].frame, 4U);
  bench.frame(0x782, "05 4C 09 00").frame(0x745, "02 CC");  // closed: a poll command again
  bench.frame(0x42D, "02 0E 01 01 01");
  EXPECT_EQ(derived_text(bench.dissection(), "message"), "Poll command");
  EXPECT_THAT(bench.findings(), IsEmpty());
}

// A connection path is shown by its segments, whatever is none of them as bytes.
TEST(Objects, ConnectionPathsBySegment) {
  Bench bench;
  bench.frame(0x42C, "01 0E 05 02 0E").frame(0x42B, "01 8E 20 04 24 64 30 03");
  EXPECT_EQ(field_value(bench.dissection(), "explicit", "class"), 4);
  EXPECT_EQ(field_value(bench.dissection(), "explicit", "instance"), 0x64);
  EXPECT_EQ(field_value(bench.dissection(), "explicit", "attribute"), 3);
  bench.frame(0x42C, "01 0E 05 02 10").frame(0x42B, "01 8E 20 04 66 01");
  ASSERT_EQ(bench.dissection().segments.size(), 3U);
  EXPECT_EQ(bench.dissection().segments[2].layout->title, "Consumed connection path");
  EXPECT_EQ(bench.dissection().segments[2].length, 2U);
}

TEST(Objects, AServiceOfTheVendor) {
  Bench bench;
  bench.frame(0x42C, "01 32 64 01 93 05");
  EXPECT_EQ(derived_text(bench.dissection(), "service_name"), "service 32h (vendor specific)");
  EXPECT_EQ(bench.dissection().segments.back().layout->key, "explicit");
  EXPECT_EQ(bench.dissection().segments.back().layout->fields[0].key, "vendor_data");
  bench.frame(0x42C, "01 50 64 01 93");
  EXPECT_EQ(derived_text(bench.dissection(), "service_name"), "service 50h (object specific)");
  EXPECT_EQ(bench.dissection().segments.back().layout->fields[0].key, "object_data");
}

TEST(BitStrobe, OneBitANode) {
  Bench bench;
  bench.frame(0x408, "21 00 00 00 00 00 00 80");  // master 1: outputs of nodes 0, 5 and 63
  for (const auto& [key, bit] :
       {std::pair{"output_0", 1}, {"output_1", 0}, {"output_5", 1}, {"output_62", 0}, {"output_63", 1}}) {
    EXPECT_EQ(field_value(bench.dissection(), "bit_strobe", key), bit) << key;
  }
}

TEST(Ucmm, HeartbeatFlags) {
  Bench bench;
  bench.frame(0x745, "05 4D 01 00 03 0A 34 12");
  EXPECT_EQ(field_value(bench.dissection(), "unconnected", "device_state"), 3);
  EXPECT_EQ(field_value(bench.dissection(), "unconnected", "event"), 1);
  EXPECT_EQ(field_value(bench.dissection(), "unconnected", "system_fault"), 0);
  EXPECT_EQ(field_value(bench.dissection(), "unconnected", "user_fault"), 1);
  EXPECT_EQ(field_value(bench.dissection(), "unconnected", "device_fault"), 0);
}

TEST(Group4, OwnershipAndFaultedMessages) {
  Bench bench;
  bench.frame(0x7EF, "01 4B 34 12 78 56 34 12");
  EXPECT_EQ(field_value(bench.dissection(), "ownership", "client"), 1);
  EXPECT_EQ(field_value(bench.dissection(), "ownership", "vendor_id"), 0x1234);
  EXPECT_EQ(field_value(bench.dissection(), "ownership", "serial_number"), 0x12345678);
  bench.frame(0x7ED, "7F 4C");
  EXPECT_EQ(field_value(bench.dissection(), "faulted", "match"), 1);
  EXPECT_EQ(field_value(bench.dissection(), "faulted", "value"), 63);
  EXPECT_EQ(field_value(bench.dissection(), "faulted", "service"), 0x4C);
}

TEST(Buses, StayApart) {
  Pipeline pipeline{Bench::assumed()};
  std::uint64_t number = 0;
  const auto push = [&](std::uint32_t interface_id, std::uint32_t id, std::string_view data) {
    const auto bytes = test::can_record(id, servotrace::test::hex(data));
    ++number;
    pipeline.push({.number = number,
                   .time_ns = static_cast<TimeNs>(number) * 100 * kMillisecondNs,
                   .link_type = LinkType::kCanSocketcan,
                   .interface_id = interface_id,
                   .bytes = bytes,
                   .original_length = static_cast<std::uint32_t>(bytes.size())});
  };
  for (int i = 0; i < 20; ++i) {
    push(0, 0x42F, "00 2C 00 01 02 03 04");
    push(1, 0x42F, "00 2C 00 09 02 03 04");  // the same MAC ID on another bus is no duplicate
  }
  EXPECT_THAT(test::words(pipeline.findings().all()), IsEmpty());
}

TEST(Statistics, OfPolls) {
  Bench bench;
  bench.start(5).allocate(5);
  for (int i = 0; i < 10; ++i) bench.poll(5, "", "01", 19);
  const Summary summary = bench.summary();
  ASSERT_FALSE(summary.buses[0].statistics.empty());
  const Statistic& interval = summary.buses[0].statistics[0];
  EXPECT_EQ(interval.key, "poll interval");
  EXPECT_EQ(interval.count, 9U);
  EXPECT_EQ(interval.minimum_ns, 20 * kMillisecondNs);
}

}  // namespace
}  // namespace servotrace::devicenet
