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
  EXPECT_EQ(field_value(bench.dissection(), "bit_strobe", "outputs"), INT64_MIN);
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

TEST(BodyFormats, CipPath) {
  Bench bench;
  bench.start(5).frame(0x42E, "01 4B 03 01 01 01").frame(0x42B, "01 CB 04");
  bench.frame(0x42C, "01 0E 02 20 05 24 02");  // no attribute in the path: one behind it
  EXPECT_EQ(derived_text(bench.dissection(), "object_name"), "Connection");
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
  EXPECT_EQ(summary.buses[0].nodes[0].recognised, "identity");
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
    bench.frame(0x42F, "00 2C 00 01 02 03 04").frame(0x42F, "00 2C 00 01 02 03 05");
    EXPECT_EQ(frames(bench), 0U) << "another serial number";
    bench.frame(0x42F, "00 2C 00 01 02 03 05");
    EXPECT_EQ(frames(bench), 1U);
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

// What the frames in front of the evidence showed is known, but nothing is reported of them.
TEST(Evidence, CountsFromTheFrameThatCompletesIt) {
  Bench bench{Settings{}};
  bench.frame(0x7F3, "").frame(0x42E, "01 4B 03 01 03 01").frame(0x42B, "01 CB 00");
  bench.frame(0x42C, "02 0E 01 01 01");
  EXPECT_EQ(bench.findings(), std::vector<std::string>{"DN211@4"});
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
  EXPECT_EQ(bench.dissection().segments[0].node.mac_id, 5);
  bench.frame(0x705, "05 8E 2C 00");
  EXPECT_EQ(field_value(bench.dissection(), "identity", "vendor_id"), 44);
  bench.frame(0x782, "05 4C 07 00").frame(0x745, "02 CC");  // closed
  bench.frame(0x6C2, "05 0E 01 01 01");
  EXPECT_EQ(field_value(bench.dissection(), "explicit", "attribute"), -1);
  EXPECT_THAT(bench.findings(), IsEmpty());
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
