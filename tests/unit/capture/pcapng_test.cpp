// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "tests/support/bytes.hpp"
#include "tests/unit/capture/support.hpp"

namespace servotrace::test {
namespace {

const Buffer kPacket = hex("01 02 03 04 05");

TEST(Pcapng, AllThreePacketBlocksInBothByteOrders) {
  for (const ByteOrder order : {ByteOrder::kLittle, ByteOrder::kBig}) {
    Maker maker(order);
    maker.section().interface(227, 4).interface(252);
    maker.enhanced(1, 1'700'000'002'501'431, kPacket, 6);
    maker.simple(hex("0A 0B 0C 0D"), 9);
    maker.obsolete(1, 3, 1'700'000'003'000'000, kPacket, 5);
    const ReadCapture capture = read_both(maker.bytes());
    ASSERT_EQ(capture.error, "");
    ASSERT_EQ(capture.frames.size(), 3U);
    const RawFrame& enhanced = capture.frames[0].raw;
    EXPECT_EQ(enhanced.time_ns, 1'700'000'002'501'431'000);
    EXPECT_EQ(enhanced.link_type, LinkType::kWiresharkUpperPdu);
    EXPECT_EQ(enhanced.interface_id, 1U);
    EXPECT_EQ(enhanced.original_length, 6U);
    EXPECT_EQ(enhanced.time_resolution_ns, 1000U);
    EXPECT_EQ(enhanced.file_order, order);
    EXPECT_EQ(capture.frames[0].bytes, kPacket);
    const Bytes all = maker.bytes();
    EXPECT_EQ(all[capture.frames[0].byte_offset], 0x01);
    const RawFrame& simple = capture.frames[1].raw;
    EXPECT_FALSE(simple.has_time);
    EXPECT_EQ(simple.link_type, LinkType::kCanSocketcan);
    EXPECT_EQ(simple.interface_id, 0U);
    EXPECT_EQ(simple.original_length, 9U);
    EXPECT_EQ(capture.frames[1].bytes, hex("0A 0B 0C 0D")) << "cut to the interface's snap length";
    EXPECT_EQ(capture.frames[2].raw.number, 3U);
    EXPECT_EQ(capture.frames[2].raw.time_ns, 1'700'000'003'000'000'000);
    ASSERT_EQ(capture.dropped.size(), 1U);
    EXPECT_EQ(capture.dropped[0].interface_id, 1U);
    EXPECT_EQ(capture.dropped[0].count, 3U);
    EXPECT_EQ(capture.dropped[0].after_frame, 2U);
  }
}

TEST(Pcapng, SectionsOfBothByteOrdersKeepInterfacesApart) {
  Maker little;
  little.section().interface(227).enhanced(0, 1, kPacket, 5);
  Maker big(ByteOrder::kBig);
  big.section().interface(1).interface(147).enhanced(1, 2, kPacket, 5);
  Maker empty;
  empty.section();
  Buffer all = little.bytes();
  for (const Buffer* part : {&empty.bytes(), &big.bytes(), &little.bytes()})
    all.insert(all.end(), part->begin(), part->end());
  const ReadCapture capture = read_both(all);
  ASSERT_EQ(capture.error, "");
  ASSERT_EQ(capture.frames.size(), 3U);
  EXPECT_EQ(capture.interfaces.size(), 4U);
  EXPECT_EQ(capture.frames[1].raw.interface_id, 2U);
  EXPECT_EQ(capture.frames[1].raw.link_type, LinkType::kUser0);
  EXPECT_EQ(capture.frames[1].raw.file_order, ByteOrder::kBig);
  EXPECT_EQ(capture.frames[1].raw.time_ns, 2000);
  EXPECT_EQ(capture.frames[2].raw.interface_id, 3U);
  EXPECT_EQ(capture.frames[2].raw.number, 3U);
}

struct Resolution {
  std::uint8_t value;
  std::uint64_t ticks;
  std::int64_t time_ns;
  std::uint32_t resolution_ns;
};

TEST(Pcapng, TimeResolutions) {
  constexpr std::uint8_t kBinary = 0x80;
  const Resolution cases[] = {
      {0, 5, 5'000'000'000, 1'000'000'000},
      {3, 1'700'000'000'123, 1'700'000'000'123'000'000, 1'000'000},
      {6, 7, 7'000, 1'000},
      {9, 1'700'000'000'123'456'789, 1'700'000'000'123'456'789, 1},
      {12, 1'999, 1, 1},
      {19, 12'345'678'901'234'567'890U, 1'234'567'890, 1},
      {kBinary | 0, 3, 3'000'000'000, 1'000'000'000},
      {kBinary | 10, (5U << 10U) + 512, 5'500'000'000, 976'562},
      {kBinary | 32, (std::uint64_t{1'700'000'000} << 32U) + 0x4000'0000, 1'700'000'000'250'000'000, 1},
      {kBinary | 63, std::uint64_t{3} << 62U, 1'500'000'000, 1},
      {9, 0xFFFF'FFFF'FFFF'FFFF, INT64_MAX, 1},
      {0, 0xFFFF'FFFF'FFFF'FFFF, INT64_MAX, 1'000'000'000},
  };
  for (const Resolution& test : cases) {
    Maker maker;
    maker.section().interface(227, 0, Maker().option(9, Bytes(&test.value, 1)).u32(0).bytes());
    maker.enhanced(0, test.ticks, kPacket, 5);
    const ReadCapture capture = read_both(maker.bytes());
    ASSERT_EQ(capture.frames.size(), 1U) << capture.error;
    EXPECT_EQ(capture.frames[0].raw.time_ns, test.time_ns) << int{test.value};
    EXPECT_EQ(capture.frames[0].raw.time_resolution_ns, test.resolution_ns) << int{test.value};
    EXPECT_EQ(capture.interfaces[0].time_resolution_ns, test.resolution_ns) << int{test.value};
  }
  for (const std::uint8_t refused : {std::uint8_t{20}, std::uint8_t{kBinary | 64}}) {
    Maker maker;
    maker.section().interface(227, 0, Maker().option(9, Bytes(&refused, 1)).bytes());
    EXPECT_NE(read_both(maker.bytes()).error.find("if_tsresol"), std::string::npos);
  }
}

TEST(Pcapng, TimeOffsetAndName) {
  Maker options(ByteOrder::kBig);
  options.option(2, bytes_of("can-left"));
  options.option(14, Maker(ByteOrder::kBig).u64(static_cast<std::uint64_t>(-3)).bytes());
  options.option(99, bytes_of("unknown options are passed over"));
  Maker maker(ByteOrder::kBig);
  maker.section().interface(227, 0, options.bytes()).enhanced(0, 5'000'001, kPacket, 5);
  maker.enhanced(0, 1'000'000, kPacket, 5);
  const ReadCapture capture = read_both(maker.bytes());
  ASSERT_EQ(capture.frames.size(), 2U) << capture.error;
  EXPECT_EQ(capture.interfaces[0].name, "can-left");
  EXPECT_EQ(capture.frames[0].raw.time_ns, 2'000'001'000);
  EXPECT_EQ(capture.frames[1].raw.time_ns, -2'000'000'000);
}

TEST(Pcapng, DropCountsAreDifferences) {
  const auto statistics = [](std::uint64_t interface_drops, std::uint64_t system_drops) {
    return Maker()
        .u32(0)
        .u64(0)
        .option(5, Maker().u64(interface_drops).bytes())
        .option(7, Maker().u64(system_drops).bytes())
        .u32(0)
        .bytes();
  };
  Maker maker;
  maker.section().interface(227);
  maker.enhanced(0, 1, kPacket, 5);
  maker.enhanced(0, 2, kPacket, 5, Maker().option(4, Maker().u64(4).bytes()).u32(0).bytes());
  maker.block(5, statistics(4, 0));  // the four again
  maker.block(5, statistics(6, 1));  // three more
  maker.block(5, statistics(6, 1));
  const ReadCapture capture = read_both(maker.bytes());
  ASSERT_EQ(capture.error, "");
  ASSERT_EQ(capture.dropped.size(), 2U);
  EXPECT_EQ(capture.dropped[0].count, 4U);
  EXPECT_EQ(capture.dropped[0].after_frame, 1U);
  EXPECT_EQ(capture.dropped[1].count, 3U);
  EXPECT_EQ(capture.dropped[1].after_frame, 2U);
}

TEST(Pcapng, UnknownBlocksArePassedOver) {
  Maker maker;
  maker.section().block(0x80000001, hex("AA")).interface(227).block(4, hex("00 00 00 00")).enhanced(0, 1, kPacket, 5);
  const ReadCapture capture = read_both(maker.bytes());
  EXPECT_EQ(capture.error, "");
  EXPECT_EQ(capture.frames.size(), 1U);
}

TEST(Pcapng, EveryCutGivesTheWholeBlocksBeforeIt) {
  Maker maker;
  maker.section();
  const std::size_t first = maker.bytes().size();
  maker.interface(227);
  std::vector<std::size_t> frame_ends;
  std::vector<std::size_t> borders = {first, maker.bytes().size()};
  for (int i = 0; i < 3; ++i) {
    maker.enhanced(0, 1, kPacket, 5);
    frame_ends.push_back(maker.bytes().size());
    borders.push_back(maker.bytes().size());
  }
  for (std::size_t length = 0; length <= maker.bytes().size(); ++length) {
    const ReadCapture capture = read_stream(Bytes(maker.bytes()).first(length), 1000);
    if (length < first) {
      EXPECT_NE(capture.error, "") << length;
      continue;
    }
    EXPECT_EQ(capture.error, "") << length;
    const auto whole =
        std::count_if(frame_ends.begin(), frame_ends.end(), [&](std::size_t end) { return end <= length; });
    EXPECT_EQ(capture.frames.size(), static_cast<std::size_t>(whole)) << length;
    EXPECT_EQ(capture.truncation.has_value(), std::find(borders.begin(), borders.end(), length) == borders.end())
        << length;
  }
}

// Each is broken at one place; the frames before it hold.
TEST(Pcapng, BrokenFilesAreErrorsWithTheirPlace) {
  const auto start = [] {
    Maker maker;
    maker.section().interface(227).enhanced(0, 1, kPacket, 5);  // 28, 20 and 40 bytes
    return maker;
  };
  struct Case {
    Buffer bytes;
    std::string error;
  };
  const Case cases[] = {
      {start().u32(6).u32(13).u32(0).bytes(), "-: byte 92: a pcapng block of 13 bytes"},
      {start().u32(6).u32(8).u32(0).bytes(), "-: byte 92: a pcapng block of 8 bytes"},
      {start().u32(6).u32(0x7FFFFFFC).u32(0).bytes(), "-: byte 92: a pcapng block of 2147483644 bytes"},
      {start().u32(9).u32(16).u32(0).u32(20).bytes(),
       "-: byte 100: a pcapng block of 16 bytes ends with the length 20"},
      {start().enhanced(1, 1, kPacket, 5).bytes(), "-: byte 88: a record of interface 1"},
      {start().block(6, Maker().u32(0).u64(0).u32(9).u32(9).raw(kPacket).bytes()).bytes(),
       "-: byte 88: a record of 9 bytes in a block that has room for 8"},
      {start().block(6, hex("00 00 00 00")).bytes(), "-: byte 88: a pcapng packet block that is too short"},
      {start().block(3, {}).bytes(), "-: byte 88: a pcapng packet block that is too short"},
      {start().block(1, hex("E3 00 00 00")).bytes(), "-: byte 88: a pcapng interface description that is too short"},
      {start().interface(227, 0, Maker().u16(2).u16(100).u32(0).bytes()).bytes(),
       "-: byte 88: an interface description with an option longer than its block"},
      {start().u32(0x0A0D0D0A).u32(28).u32(0x11111111).raw(Buffer(16)).bytes(),
       "-: byte 96: a pcapng section without its byte-order magic"},
      {start().block(0x0A0D0D0A, Maker().u32(0x1A2B3C4D).u16(2).u16(0).u64(0).bytes()).bytes(),
       "-: byte 88: pcapng version 2 is not known"},
      {start().block(5, Maker().u32(7).u64(0).bytes()).bytes(), "-: byte 88: a record of interface 7"},
  };
  for (const Case& test : cases) {
    const ReadCapture capture = read_both(test.bytes);
    EXPECT_EQ(capture.frames.size(), 1U) << test.error;
    EXPECT_EQ(capture.error.substr(0, test.error.size()), test.error);
  }
}

TEST(Pcapng, ASimplePacketNeedsAnInterface) {
  Maker maker;
  maker.section().simple(kPacket, 5);
  EXPECT_NE(read_both(maker.bytes()).error, "");
}

TEST(Pcapng, TooManyInterfacesAreRefused) {
  Maker maker;
  maker.section();
  for (int i = 0; i < 65'537; ++i) maker.interface(227);
  const ReadCapture capture = read_stream(maker.bytes(), 1 << 16);
  EXPECT_EQ(capture.interfaces.size(), 65'536U);
  EXPECT_NE(capture.error.find("more than 65536 interfaces"), std::string::npos);
}

}  // namespace
}  // namespace servotrace::test
