// SPDX-License-Identifier: MIT
// `servotrace convert`: what a capture says is the same in every carrier; logs become pcapng. And --join.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/bytes.hpp"
#include "tests/support/program.hpp"

namespace servotrace::test {
namespace {

using nlohmann::json;

class Convert : public ::testing::Test {
 protected:
  // Every frame of `file` as decode shows it, without what the carrier decides.
  std::vector<json> frames(const std::string& file) const {
    std::vector<json> list;
    std::istringstream stream(program.run({"decode", file, "--format", "jsonl"}).out);
    for (std::string line; std::getline(stream, line);) {
      json frame = json::parse(line);
      frame.erase("file");
      for (json& segment : frame["segments"]) segment.erase("offset");
      list.push_back(std::move(frame));
    }
    return list;
  }
  Program program;
};

TEST_F(Convert, CarriersSayTheSame) {
  program.simulate("rtex_clean", "clean");
  const std::vector<json> before = frames("clean.pcapng");
  ASSERT_FALSE(before.empty());
  for (const std::string carrier : {"keep", "pdu", "ethernet", "udp", "user"}) {
    const Outcome outcome = program.run({"convert", "clean.pcapng", "-o", "out.pcapng", "--carrier", carrier});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(frames("out.pcapng"), before) << carrier;
  }
}

TEST_F(Convert, BackAndForthIsTheSameFile) {
  program.simulate("rtex_clean", "clean");
  ASSERT_EQ(program.run({"convert", "clean.pcapng", "-o", "1.pcapng", "--carrier", "pdu"}).status, 0);
  ASSERT_EQ(program.run({"convert", "1.pcapng", "-o", "2.pcapng", "--carrier", "ethernet"}).status, 0);
  ASSERT_EQ(program.run({"convert", "2.pcapng", "-o", "3.pcapng", "--carrier", "pdu"}).status, 0);
  EXPECT_EQ(program.read("1.pcapng"), program.read("3.pcapng"));
}

TEST_F(Convert, LogBecomesPcapng) {
  program.write("bus.log", "(1700000000.000000) can0 405#0102\n(1700000000.100000) can0 3C5#0A\n");
  ASSERT_EQ(program.run({"convert", "bus.log", "-o", "bus.pcapng"}).status, 0);
  const Outcome info = program.run({"info", "bus.pcapng", "--devicenet"});
  EXPECT_EQ(info.status, 0) << info.err;
  EXPECT_THAT(info.out, ::testing::HasSubstr("can0, link type 227"));
  EXPECT_THAT(info.out, ::testing::HasSubstr("frames: 2 (2 of a known bus)"));
}

// A big-endian pcap of a Linux cooked capture (113, 276) holds CAN identifiers big-endian; the pcapng that is written
// is little-endian. The Duplicate MAC ID requests of node 5 (42Fh) stay what they are.
TEST_F(Convert, CookedCanOfABigEndianMachine) {
  const auto file = [](std::string_view link_type, std::string_view cooked) {
    std::string text;
    const auto add = [&](std::string_view typed) {
      for (const std::uint8_t byte : hex(typed)) text += static_cast<char>(byte);
    };
    add("A1B2C3D4 0002 0004 00000000 00000000 0000FFFF");
    add(link_type);
    const std::string_view can = "0000042F 07000000 00 2C00 78563412";
    const auto length = static_cast<std::uint8_t>(hex(cooked).size() + hex(can).size());
    for (const std::string_view second : {"6553F100", "6553F101"}) {
      add(second);
      add("00000000 000000");
      text += static_cast<char>(length);
      add("000000");
      text += static_cast<char>(length);
      add(cooked);
      add(can);
    }
    return text;
  };
  program.write("113.pcap", file("00000071", "0000 0118 0000 0000000000000000 000C"));
  program.write("276.pcap", file("00000114", "000C 0000 00000003 0118 00 00 0000000000000000"));
  for (const std::string name : {"113.pcap", "276.pcap"}) {
    const std::vector<json> before = frames(name);
    ASSERT_EQ(before.size(), 1U) << "the second request is the evidence";
    EXPECT_THAT(program.run({"decode", name}).out, ::testing::HasSubstr("CAN identifier: 42Fh")) << name;
    for (const std::string command : {"convert", "annotate"}) {
      const Outcome outcome = program.run({command, name, "-o", "out.pcapng"});
      ASSERT_EQ(outcome.status, 0) << outcome.err;
      EXPECT_EQ(frames("out.pcapng"), before) << command << " " << name;
      EXPECT_THAT(program.run({"decode", "out.pcapng"}).out, ::testing::HasSubstr("CAN identifier: 42Fh")) << name;
    }
  }
}

TEST_F(Convert, JoinedFilesAreOneRecording) {
  program.simulate("rtex_clean", "a");
  program.simulate("cp102_time_backwards", "b");
  const Outcome apart = program.run({"check", "a.pcapng", "b.pcapng", "--output", "jsonl"});
  const Outcome joined = program.run({"check", "a.pcapng", "b.pcapng", "--join", "--output", "jsonl"});
  const auto captures = [](const std::string& text) {
    std::uint64_t frames = 0;
    std::uint64_t number = 0;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) {
      const json object = json::parse(line);
      if (object["type"] != "capture") continue;
      frames += object["frames"].get<std::uint64_t>();
      ++number;
    }
    return std::pair(number, frames);
  };
  EXPECT_EQ(captures(apart.out).first, 2U);
  EXPECT_EQ(captures(joined.out).first, 1U);
  EXPECT_EQ(captures(apart.out).second, captures(joined.out).second);
  EXPECT_EQ(program.run({"check", "a.pcapng", "-", "--join"}).status, 2);
}

}  // namespace
}  // namespace servotrace::test
