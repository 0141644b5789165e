// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "tests/support/bytes.hpp"
#include "tests/unit/capture/support.hpp"

namespace servotrace::test {
namespace {

constexpr std::uint32_t kMicro = 0xA1B2C3D4;
constexpr std::uint32_t kNano = 0xA1B23C4D;

TEST(Pcap, BothByteOrdersAndBothResolutions) {
  const Buffer packet = hex("01 02 03 04 05");
  for (const ByteOrder order : {ByteOrder::kLittle, ByteOrder::kBig}) {
    for (const std::uint32_t magic : {kMicro, kNano}) {
      Maker maker(order);
      maker.pcap_header(magic, 227).pcap_record(1700000002, 501431, packet, 5).pcap_record(1700000003, 7, packet, 9);
      const ReadCapture capture = read_both(maker.bytes());
      ASSERT_EQ(capture.error, "");
      ASSERT_EQ(capture.frames.size(), 2U);
      const std::int64_t unit = magic == kMicro ? 1000 : 1;
      const RawFrame& first = capture.frames[0].raw;
      EXPECT_EQ(first.number, 1U);
      EXPECT_EQ(first.time_ns, 1700000002'000000000 + 501431 * unit);
      EXPECT_EQ(first.link_type, LinkType::kCanSocketcan);
      EXPECT_EQ(capture.frames[0].bytes, packet);
      EXPECT_EQ(first.original_length, 5U);
      EXPECT_EQ(first.file_order, order);
      EXPECT_EQ(first.time_resolution_ns, static_cast<std::uint32_t>(unit));
      EXPECT_EQ(capture.frames[0].byte_offset, 24U + 16U);
      EXPECT_EQ(capture.frames[1].raw.number, 2U);
      EXPECT_EQ(capture.frames[1].raw.original_length, 9U);
      EXPECT_EQ(capture.frames[1].byte_offset, 24U + 16U + 5U + 16U);
      EXPECT_FALSE(capture.truncation);
      EXPECT_EQ(capture.format, "pcap");
      ASSERT_EQ(capture.interfaces.size(), 1U);
    }
  }
}

TEST(Pcap, PatchedRecordHeaderIsEightBytesLonger) {
  Maker maker;
  maker.pcap_header(0xA1B2CD34, 1).u32(5).u32(6).u32(3).u32(3).u32(0).u32(0).raw(hex("AA BB CC"));
  const ReadCapture capture = read_both(maker.bytes());
  ASSERT_EQ(capture.frames.size(), 1U);
  EXPECT_EQ(capture.frames[0].bytes, hex("AA BB CC"));
}

TEST(Pcap, OldVersionsHaveTheLengthsTheOtherWayRound) {
  Maker maker;
  maker.u32(kMicro).u16(2).u16(2).u32(0).u32(0).u32(65535).u32(1).u32(5).u32(6).u32(9).u32(3).raw(hex("AA BB CC"));
  const ReadCapture capture = read_both(maker.bytes());
  ASSERT_EQ(capture.error, "");
  ASSERT_EQ(capture.frames.size(), 1U);
  EXPECT_EQ(capture.frames[0].raw.original_length, 9U);
}

TEST(Pcap, TheLinkTypeIsTheLowerPartOfItsField) {
  Maker maker;
  maker.pcap_header(kMicro, 0x14000001).pcap_record(1, 2, hex("00"), 1);
  EXPECT_EQ(read_both(maker.bytes()).frames.at(0).raw.link_type, LinkType::kEthernet);
}

TEST(Pcap, EveryCutGivesTheWholeRecordsBeforeIt) {
  Maker maker;
  maker.pcap_header(kMicro, 227);
  std::vector<std::size_t> borders = {maker.bytes().size()};
  for (int i = 0; i < 3; ++i) {
    maker.pcap_record(10, 20, hex("01 02 03 04 05 06 07"), 7);
    borders.push_back(maker.bytes().size());
  }
  for (std::size_t length = 0; length <= maker.bytes().size(); ++length) {
    const ReadCapture capture = read_stream(Bytes(maker.bytes()).first(length), 1000);
    if (length < 24) {
      EXPECT_NE(capture.error, "") << length;
      continue;
    }
    std::size_t whole = 0;
    while (whole + 1 < borders.size() && borders[whole + 1] <= length) ++whole;
    EXPECT_EQ(capture.error, "") << length;
    EXPECT_EQ(capture.frames.size(), whole) << length;
    EXPECT_EQ(capture.truncation.has_value(), borders[whole] != length) << length;
    if (capture.truncation) {
      EXPECT_EQ(capture.truncation->captured, length - borders[whole]);
      EXPECT_EQ(capture.truncation->expected, length - borders[whole] < 16 ? 16U : 23U);
    }
  }
}

TEST(Pcap, ImpossibleLengthsAreAnErrorWithTheirPlace) {
  Maker maker;
  maker.pcap_header(kMicro, 227).pcap_record(1, 2, hex("00"), 1).u32(0).u32(0).u32(0x7FFFFFFF).u32(5);
  const ReadCapture capture = read_both(maker.bytes());
  EXPECT_EQ(capture.frames.size(), 1U);
  EXPECT_EQ(capture.error.substr(0, 36), "-: byte 41: a record of 2147483647 b");
}

TEST(Pcap, UnknownVersion) {
  Maker maker;
  maker.u32(kMicro).u16(3).u16(0).u32(0).u32(0).u32(65535).u32(1);
  EXPECT_EQ(read_both(maker.bytes()).error, "-: byte 4: pcap version 3.0 is not known");
}

}  // namespace
}  // namespace servotrace::test
