// SPDX-License-Identifier: MIT
// `servotrace convert --map`: a controller's own log becomes the records it was made of, whatever its shape; a wrong
// map or row is refused with its place.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>

#include "replay/capture/source.hpp"
#include "tests/support/program.hpp"

namespace servotrace::test {
namespace {

using ::testing::HasSubstr;

constexpr std::size_t kTags = 12;    // of an exported PDU
constexpr std::size_t kHeader = 24;  // of a record

// A record of a capture: header and blocks.
struct Recorded {
  TimeNs time_ns = 0;
  std::vector<std::uint8_t> bytes;
  bool response() const { return (bytes[6] & 1U) != 0; }
  std::uint32_t sequence() const {
    return std::uint32_t{bytes[8]} | std::uint32_t{bytes[9]} << 8U | std::uint32_t{bytes[10]} << 16U;
  }
  std::size_t blocks() const { return (bytes.size() - kHeader) / 16; }
  std::vector<std::uint8_t> block(std::size_t i) const {
    const auto from = bytes.begin() + static_cast<std::ptrdiff_t>(kHeader + 16 * i);
    return {from, from + 16};
  }
  bool operator==(const Recorded&) const = default;
};

std::vector<Recorded> records_of(const std::filesystem::path& capture) {
  auto source = replay::open_capture(capture);
  EXPECT_TRUE(source) << source.error().text();
  std::vector<Recorded> list;
  RawFrame frame;
  while (source && (*source)->next(frame) == replay::Source::Step::kFrame)
    list.push_back({frame.time_ns, {frame.bytes.begin() + kTags, frame.bytes.end()}});
  return list;
}

std::string hex(const std::vector<std::uint8_t>& bytes, std::string_view between = "") {
  std::string text;
  for (const std::uint8_t byte : bytes) text += fmt::format("{}{:02X}", text.empty() ? "" : between, byte);
  return text;
}

// 32-bit words, most significant byte first.
std::string words(const std::vector<std::uint8_t>& bytes) {
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 4)
    text += fmt::format("{}0x{:02X}{:02X}{:02X}{:02X}", i == 0 ? "" : " ", bytes[i + 3], bytes[i + 2], bytes[i + 1],
                        bytes[i]);
  return text;
}

constexpr const char* kNodes = "[[node]]\nmac_id = 1\n[[node]]\nmac_id = 2\n";

class Log : public ::testing::Test {
 protected:
  void SetUp() override {
    program.simulate("rtex_clean", "made");
    made = records_of(program.folder() / "made.pcapng");
    ASSERT_GT(made.size(), 100U);
    ASSERT_EQ(made[0].blocks(), 2U);
  }

  Outcome convert(const std::string& map) {
    program.write("map.toml", map);
    return program.run({"convert", "log.txt", "-o", "log.pcapng", "--map", "map.toml"});
  }
  // The converted records are those the log was written from.
  void expect_the_same(const std::string& map) {
    const Outcome outcome = convert(map);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const std::vector<Recorded> read = records_of(program.folder() / "log.pcapng");
    ASSERT_EQ(read.size(), made.size());
    for (std::size_t i = 0; i < made.size(); ++i) {
      ASSERT_EQ(hex(read[i].bytes), hex(made[i].bytes)) << i;
      ASSERT_EQ(read[i].time_ns, made[i].time_ns) << i;
    }
    EXPECT_EQ(program.run({"check", "log.pcapng"}).status, 0);
  }
  // One line a record and axis.
  std::string lines(const std::function<std::string(const Recorded&, std::size_t)>& line) const {
    std::string text;
    for (const Recorded& record : made) {
      for (std::size_t i = 0; i < record.blocks(); ++i) text += line(record, i) + '\n';
    }
    return text;
  }
  static std::string seconds(TimeNs time_ns) {
    return fmt::format("{}.{:09}", time_ns / kSecondNs, time_ns % kSecondNs);
  }

  Program program;
  std::vector<Recorded> made;
};

TEST_F(Log, OneRowAnAxisWithAHexadecimalBlock) {
  program.write("log.txt", "t;cycle;dir;axis;data\n" + lines([](const Recorded& record, std::size_t i) {
                             return fmt::format("{};{};{};{};{}", seconds(record.time_ns), record.sequence(),
                                                record.response() ? "RX" : "TX", i + 1, hex(record.block(i)));
                           }));
  expect_the_same(std::string("time = \"t\"\nsequence = \"cycle\"\naxis = \"axis\"\nsampled = false\n"
                              "communication_cycle_us = 500\n"
                              "direction = {column = \"dir\", command = \"TX\", response = \"RX\"}\n"
                              "command = {block = \"data\"}\nresponse = {block = \"data\"}\n") +
                  kNodes);
}

TEST_F(Log, TextWithSingleBytesAndNoHeaderLine) {
  program.write("log.txt", "started\n" + lines([](const Recorded& record, std::size_t i) {
                             return fmt::format("{} RTEX n={} {} ax={} {}", seconds(record.time_ns), record.sequence(),
                                                record.response() ? "<" : ">", i + 1, hex(record.block(i), " "));
                           }) + "other words\n");
  expect_the_same(std::string("separator = \"blank\"\nheader = false\nskip_lines = 1\nlines_with = \"RTEX\"\n"
                              "time = 1\nsequence = {column = 3, after = \"n=\"}\n"
                              "axis = {column = 5, after = \"ax=\"}\nsampled = false\ncommunication_cycle_us = 500\n"
                              "direction = {column = 4, command = \">\", response = \"<\"}\n"
                              "command = {bytes = 6}\nresponse = {bytes = 6}\n") +
                  kNodes);
}

TEST_F(Log, OneRowACycleWithBigEndianWords) {
  std::string text = "us,cycle,tx1,tx2,rx1,rx2\n";
  for (std::size_t i = 0; i + 1 < made.size(); i += 2) {
    const Recorded& command = made[i];
    Recorded& response = made[i + 1];
    ASSERT_FALSE(command.response() || !response.response());
    response.time_ns = command.time_ns;
    text += fmt::format("{}.{:03},{},{},{},{},{}\n", command.time_ns / 1000, command.time_ns % 1000, command.sequence(),
                        words(command.block(0)), words(command.block(1)), words(response.block(0)),
                        words(response.block(1)));
  }
  program.write("log.txt", text);
  expect_the_same(
      "time = {column = \"us\", unit = \"us\"}\nsequence = \"cycle\"\nsampled = false\nendian = \"big\"\n"
      "word_bytes = 4\ncommunication_cycle_us = 500\n"
      "[[node]]\nmac_id = 1\ncommand = {block = \"tx1\"}\nresponse = {block = \"rx1\"}\n"
      "[[node]]\nmac_id = 2\ncommand = {block = \"tx2\"}\nresponse = {block = \"rx2\"}\n");
}

// -1000 command units are FFFFFC18h (SX-DSV02203 4-1); 21h is a reset in CP (6-1).
TEST_F(Log, NamedFields) {
  program.write("log.txt",
                "t,code,pos,on,status_pos,ready\n0.001,33,-1000,1,-998,1\n0.002,0x22,0xFFFFFC18,on,-999,true\n");
  const Outcome outcome = convert(
      "time = \"t\"\n"
      "[[node]]\nmac_id = 3\n"
      "command = {fields = {command_code = \"code\", command_position = \"pos\", servo_on = \"on\", "
      "update_counter = {value = 2}}}\n"
      "response = {fields = {actual_position = \"status_pos\", servo_ready = \"ready\"}}\n");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::vector<Recorded> read = records_of(program.folder() / "log.pcapng");
  ASSERT_EQ(read.size(), 4U);
  EXPECT_EQ(hex(read[0].block(0)),
            "43218000"
            "18FCFFFF"
            "00000000"
            "00000000");
  EXPECT_EQ(hex(read[1].block(0)),
            "83004000"
            "1AFCFFFF"
            "00000000"
            "00000000");
  EXPECT_EQ(hex(read[2].block(0)),
            "43228000"
            "18FCFFFF"
            "00000000"
            "00000000");
  EXPECT_EQ(hex(read[3].block(0)),
            "83004000"
            "19FCFFFF"
            "00000000"
            "00000000");
  EXPECT_EQ(read[2].time_ns, 2'000'000);
  EXPECT_EQ(read[0].bytes[6], 0x08);  // sampled, no cycle number
}

TEST_F(Log, HexadecimalFieldsInMemoryOrder) {
  program.write("log.txt", "t,code,pos\n0.001,21,18FCFFFF\n");
  ASSERT_EQ(convert("time = \"t\"\nnumber = \"hex\"\nendian = \"little\"\n[[node]]\nmac_id = 3\n"
                    "command = {fields = {command_code = \"code\", command_position = \"pos\"}}\n")
                .status,
            0);
  EXPECT_EQ(hex(records_of(program.folder() / "log.pcapng").at(0).block(0)),
            "03210000"
            "18FCFFFF"
            "00000000"
            "00000000");
}

TEST_F(Log, DatesClocksAndMidnight) {
  const std::string node = "[[node]]\nmac_id = 1\ncommand = {block = \"b\"}\n";
  const std::string block(32, '0');
  program.write("log.txt", "t,b\n2026-01-05T08:00:00.25," + block + "\n");
  ASSERT_EQ(convert("time = {column = \"t\", unit = \"date\"}\n" + node).status, 0);
  EXPECT_EQ(records_of(program.folder() / "log.pcapng").at(0).time_ns, 1'767'600'000'250'000'000);
  program.write("log.txt", "t,b\n23:59:59.5," + block + "\n00:00:00.5," + block + "\n");
  ASSERT_EQ(convert("time = {column = \"t\", unit = \"clock\"}\n" + node).status, 0);
  const std::vector<Recorded> read = records_of(program.folder() / "log.pcapng");
  EXPECT_EQ(read.at(1).time_ns - read.at(0).time_ns, kSecondNs);
}

TEST_F(Log, SampledIsSaidAndKeepsRulesSilent) {
  program.simulate("rx202_update_counter_skip", "made");
  made = records_of(program.folder() / "made.pcapng");
  const auto log = [&](bool sampled) {
    program.write("log.txt", "t,cycle,dir,axis,data\n" + lines([](const Recorded& record, std::size_t i) {
                               return fmt::format("{},{},{},{},{}", seconds(record.time_ns), record.sequence(),
                                                  record.response() ? "RX" : "TX", i + 1, hex(record.block(i)));
                             }));
    const std::string nodes = made[0].blocks() == 2 ? kNodes : "[[node]]\nmac_id = 1\n";
    const Outcome outcome =
        convert(std::string("time = \"t\"\nsequence = \"cycle\"\naxis = \"axis\"\ncommunication_cycle_us = 500\n") +
                (sampled ? "" : "sampled = false\n") +
                "direction = {column = \"dir\", command = \"TX\", response = \"RX\"}\n"
                "command = {block = \"data\"}\nresponse = {block = \"data\"}\n" +
                nodes);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return program.run({"check", "log.pcapng"});
  };
  const Outcome every_cycle = log(false);
  EXPECT_EQ(every_cycle.status, 1);
  EXPECT_THAT(every_cycle.out, HasSubstr("RX202"));
  EXPECT_THAT(every_cycle.out, ::testing::Not(HasSubstr("sampled")));
  const Outcome polled = log(true);
  EXPECT_EQ(polled.status, 0) << polled.out;
  EXPECT_THAT(polled.out, HasSubstr("log.pcapng: ring0 is sampled"));
  EXPECT_THAT(program.run({"info", "log.pcapng"}).out, HasSubstr("sampled (rules that need every cycle are silent)"));
}

// Times in whole milliseconds must not be taken for jitter: the capture says how coarse they are.
TEST_F(Log, CoarseTimesStayCoarse) {
  program.write("log.txt", "ms,cycle,dir,axis,data\n" + lines([](const Recorded& record, std::size_t i) {
                             return fmt::format("{},{},{},{},{}", record.time_ns / kMillisecondNs, record.sequence(),
                                                record.response() ? "RX" : "TX", i + 1, hex(record.block(i)));
                           }));
  ASSERT_EQ(convert(std::string("time = {column = \"ms\", unit = \"ms\"}\nsequence = \"cycle\"\naxis = \"axis\"\n"
                                "sampled = false\ncommunication_cycle_us = 500\n"
                                "direction = {column = \"dir\", command = \"TX\", response = \"RX\"}\n"
                                "command = {block = \"data\"}\nresponse = {block = \"data\"}\n") +
                    kNodes)
                .status,
            0);
  EXPECT_THAT(program.run({"info", "log.pcapng"}).out, HasSubstr("time resolution 1 ms"));
  EXPECT_EQ(program.run({"check", "log.pcapng"}).status, 0);
}

TEST_F(Log, ACycleWithoutTheRowOfAnAxisIsLeftOut) {
  std::string text = "t,cycle,axis,data\n";
  const std::string block(32, '0');
  for (int cycle = 0; cycle < 3; ++cycle) {
    text += fmt::format("0.00{},{},1,{}\n", cycle, cycle, block);
    if (cycle != 1) text += fmt::format("0.00{},{},2,{}\n", cycle, cycle, block);
  }
  program.write("log.txt", text);
  const Outcome outcome = convert(
      std::string("time = \"t\"\nsequence = \"cycle\"\naxis = \"axis\"\ncommand = {block = \"data\"}\n") + kNodes);
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.err, HasSubstr("1 records left out: the rows of some axes are missing in their cycles"));
  EXPECT_EQ(records_of(program.folder() / "log.pcapng").size(), 2U);
}

TEST_F(Log, MapInTheSettings) {
  program.write("servotrace.toml",
                "[rtex]\n[rtex.log]\ntime = \"t\"\n[[rtex.log.node]]\nmac_id = 1\ncommand = {block = \"b\"}\n");
  program.write("log.txt", "t,b\n0.5," + std::string(32, '0') + "\n");
  const Outcome outcome = program.run({"convert", "log.txt", "-o", "log.pcapng", "--carrier", "udp"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(program.run({"info", "log.pcapng"}).out, HasSubstr("link type 228"));
}

TEST_F(Log, WrongMapsAreRefusedWithTheirPlace) {
  program.write("log.txt", "t,b\n0.5," + std::string(32, '0') + "\n");
  const std::string time = "time = \"t\"\n";
  const std::string node = "[[node]]\nmac_id = 1\ncommand = {block = \"b\"}\n";
  const struct {
    std::string map;
    const char* message;
  } kCases[] = {
      {node, "needs 'time'"},
      {time, "no axis is named"},
      {time + "tme = 3\n" + node, "map.toml:2:1: unknown key 'tme'"},
      {time + "[[node]]\nmac_id = 32\ncommand = {block = \"b\"}\n", "map.toml:3:10: 'mac_id' = 32: must be 0 to 31"},
      {time + "[[node]]\nmac_id = 1\n", "axis 1 has neither 'command' nor 'response'"},
      {time + node + node, "axis 1 is given twice"},
      {time + "[[node]]\nmac_id = 1\ncommand = {block = \"b\", bytes = 2}\n",
       "needs one of 'block', 'bytes' and 'fields'"},
      {time + "[[node]]\nmac_id = 1\ncommand = {bytes = [1, 2, 3]}\n", "'bytes' names 3 columns: must be 16 or 32"},
      {time + "[[node]]\nmac_id = 1\ncommand = {fields = {speed = \"b\"}}\n", "a command has no field 'speed'"},
      {time + "[[node]]\nmac_id = 1\ncommand = {fields = {servo_on = \"b\"}}\n", "the fields need 'cyclic_command'"},
      {time + "sampled = false\n[[node]]\nmac_id = 1\ncommand = {fields = {command_code = \"b\"}}\n",
       "so 'sampled' must be true"},
      {"time = {column = \"t\", unit = \"h\"}\n" + node, "'unit' = \"h\": must be"},
      {"time = 0\n" + node, "map.toml:1:8: 'time' = 0: must be 1 to 1000"},
      {"time = true\n" + node, "'time' must be a column"},
      {time + "axis = {column = \"t\", unit = \"s\"}\n" + node, "unknown key 'unit'"},
      {time + "direction = {column = \"t\", command = \"x\"}\n" + node, "needs 'response'"},
      {time + "direction = {column = \"t\", command = \"x\", response = \"x\"}\n" + node, "are the same word"},
      {time + "separator = \"ab\"\n" + node, "must be one character"},
      {time + "word_bytes = 3\n" + node, "must be 1, 2 or 4"},
      {time + "communication_cycle_us = 600\n" + node, "must be 83.333, 166.667, 500 or 1000"},
      {"time = \n", "map.toml:1"},
      {"time = \"x\"\n" + node, "log.txt:1: no column 'x'; the header line has: t, b"},
      {"header = false\n" + time + node, "the map names column 't', but 'header' is false"},
      {time + "[[node]]\nmac_id = 1\ncommand = {fields = {command_code = {value = 33}, sub_index = \"b\"}}\n",
       "'sub_index' belongs to 32-byte blocks"},
  };
  for (const auto& entry : kCases) {
    const Outcome outcome = convert(entry.map);
    EXPECT_EQ(outcome.status, 2) << entry.map;
    EXPECT_THAT(outcome.err, HasSubstr(entry.message)) << entry.map;
  }
}

// Many a program ends its log without an end of line.
TEST_F(Log, ALastLineWithoutItsEndIsReadWhereItIsWhole) {
  std::string text = "t;cycle;dir;axis;data\n" + lines([](const Recorded& record, std::size_t i) {
                       return fmt::format("{};{};{};{};{}", seconds(record.time_ns), record.sequence(),
                                          record.response() ? "RX" : "TX", i + 1, hex(record.block(i)));
                     });
  const std::string map = std::string(
                              "time = \"t\"\nsequence = \"cycle\"\naxis = \"axis\"\nsampled = false\n"
                              "communication_cycle_us = 500\n"
                              "direction = {column = \"dir\", command = \"TX\", response = \"RX\"}\n"
                              "command = {block = \"data\"}\nresponse = {block = \"data\"}\n") +
                          kNodes;
  text.pop_back();
  program.write("log.txt", text);
  expect_the_same(map);
  // One digit less: the row is left out, and that is said.
  text.pop_back();
  program.write("log.txt", text);
  const Outcome cut = convert(map);
  EXPECT_EQ(cut.status, 2);
  EXPECT_THAT(cut.err, HasSubstr("log.txt: ends inside a record; log.pcapng is not written (--partial: "));
  // Numbers of any width: "12" may have been "127".
  program.write("log.txt", "t,c\n1,16\n2,127\n3,12");
  const Outcome numbers = convert("time = \"t\"\n[[node]]\nmac_id = 1\ncommand = {fields = {command_code = \"c\"}}\n");
  EXPECT_THAT(numbers.err, HasSubstr("ends inside a record"));
}

TEST_F(Log, WrongRowsAreRefusedWithTheirLine) {
  const std::string block(32, '0');
  const std::string map =
      "time = \"t\"\nsequence = \"n\"\naxis = \"a\"\ncommand = {block = \"b\"}\n"
      "direction = {column = \"d\", command = \"x\", response = \"y\"}\n[[node]]\nmac_id = 1\n";
  const struct {
    std::string row;
    const char* message;
  } kCases[] = {
      {"soon,1,1,x," + block, "log.txt:2: 'soon' is no time of the map's unit"},
      {"1,one,1,x," + block, "log.txt:2: 'one' is no cycle number"},
      {"1,1,7,x," + block, "log.txt:2: the map has no axis '7'"},
      {"1,1,1,z," + block, "log.txt:2: the direction 'z' is neither 'x' nor 'y'"},
      {"1,1,1,x,00", "log.txt:2: '00' is no block of 16 hexadecimal bytes"},
      {"1,1,1,x," + block + "00", "is no block of 16 hexadecimal bytes"},
      {"1,1,1,x,G0" + block.substr(2), "is no block of 16 hexadecimal bytes"},
  };
  for (const auto& entry : kCases) {
    program.write("log.txt", "t,n,a,d,b\n" + entry.row + "\n");
    const Outcome outcome = convert(map);
    EXPECT_EQ(outcome.status, 2) << entry.row;
    EXPECT_THAT(outcome.err, HasSubstr(entry.message)) << entry.row;
  }
  program.write("log.txt", "t,c\n1,300\n");
  EXPECT_THAT(convert("time = \"t\"\n[[node]]\nmac_id = 1\ncommand = {fields = {command_code = \"c\"}}\n").err,
              HasSubstr("log.txt:2: command_code: 300 does not fit its 7 bits"));
}

}  // namespace
}  // namespace servotrace::test
