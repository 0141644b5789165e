// SPDX-License-Identifier: MIT
// Appendix B, the tables of chapter 4 and the explicit messages of 5.6: values typed from the manual.
#include <gtest/gtest.h>

#include "decoder/core/slot.hpp"
#include "decoder/profiles/yaskawa_ns310/profile.hpp"
#include "tests/support/bytes.hpp"

namespace servotrace::ns310 {
namespace {

using devicenet::Access;
using devicenet::Attribute;
using devicenet::DataType;
using devicenet::Effective;
using devicenet::find_class;
using devicenet::ObjectClass;
using test::hex;

const ObjectClass& object(unsigned id) { return *find_class(objects::kClasses, id); }

struct Row {
  unsigned number;
  DataType type;
  Access access;
  const char* default_text = "";
  std::int64_t minimum = 0;  // both 0: the manual prints no range, or two that contradict each other
  std::int64_t maximum = 0;
};

// `further`: rows beside the manual's, each the same attribute in another size.
void expect_rows(unsigned class_id, std::span<const Row> rows, std::size_t further = 0) {
  const ObjectClass& row = object(class_id);
  EXPECT_EQ(row.attributes.size(), rows.size() + further) << row.name;
  for (const Row& expected : rows) {
    SCOPED_TRACE(std::string(row.name) + " " + std::to_string(expected.number));
    const Attribute* found = row.find(expected.number);
    ASSERT_NE(found, nullptr);
    EXPECT_EQ(found->type, expected.type);
    EXPECT_EQ(found->access, expected.access);
    EXPECT_EQ(found->default_text, expected.default_text);
    EXPECT_EQ(found->range.minimum, expected.minimum);
    EXPECT_EQ(found->range.maximum, expected.maximum);
  }
}

constexpr auto kGet = Access::kGet;
constexpr auto kSet = Access::kSet;
constexpr auto kBoth = Access::kGetSet;
constexpr auto kUsint = DataType::kUsint;
constexpr auto kUint = DataType::kUint;
constexpr auto kDint = DataType::kDint;
constexpr auto kBool = DataType::kBool;
constexpr std::int64_t kPositive = 2'147'483'647;

TEST(Ns310Oracle, AppendixB1IdentityAndB3Devicenet) {
  const Row identity[] = {{1, kUint, kGet},
                          {2, kUint, kGet},
                          {3, kUsint, kGet},
                          {4, DataType::kWord, kGet},
                          {5, DataType::kWord, kGet},
                          {6, DataType::kUdint, kGet},
                          {7, DataType::kShortString, kGet}};
  expect_rows(0x01, identity);
  EXPECT_TRUE(object(0x01).has_service(0x05));
  EXPECT_FALSE(object(0x01).has_service(0x10));
  const Row devicenet[] = {{1, kUsint, kGet, "", 0, 63},
                           {2, kUsint, kGet, "", 0, 2},
                           {3, kBool, kGet},
                           {4, kUsint, kGet},
                           {5, DataType::kWord, kGet}};
  expect_rows(0x03, devicenet);
  EXPECT_TRUE(object(0x03).has_service(0x4B));
  EXPECT_TRUE(object(0x03).has_service(0x4C));
}

TEST(Ns310Oracle, AppendixB5Connection) {
  const ObjectClass& row = object(0x05);
  EXPECT_EQ(row.first_instance, 1);
  EXPECT_EQ(row.last_instance, 2);
  for (const unsigned number : {4U, 5U, 6U, 9U}) EXPECT_EQ(row.find(number)->access, kBoth) << number;
  for (const unsigned number : {1U, 2U, 3U, 7U, 8U, 12U, 13U, 14U, 15U, 16U}) {
    EXPECT_EQ(row.find(number)->access, kGet) << number;
  }
  for (const unsigned number : {10U, 11U, 17U}) EXPECT_EQ(row.find(number), nullptr) << number;
}

TEST(Ns310Oracle, AppendixB6Supervisor) {
  const Row rows[] = {
      {1, kUsint, kGet},
      {2, DataType::kBytes, kGet},
      {3, kUsint, kGet},
      {5, kBool, kGet},
      {6, kUsint, kSet},
      {7, kUsint, kSet},
      {11, kBool, kSet, "0", 0, 1},
      {12, kBool, kBoth, "", 0, 1},
      {16, kBool, kGet},
      {17, kDint, kGet},
  };
  expect_rows(0x24, rows);
  EXPECT_EQ(object(0x24).find(11)->effective, Effective::kAfterReset);  // Table 4.5
}

TEST(Ns310Oracle, AppendixB7PositionController) {
  const Row rows[] = {
      {1, kUsint, kGet},
      {2, DataType::kBytes, kGet},
      {3, kUsint, kBoth, "", 0, 1},
      {6, kDint, kBoth, "", -99'999'999, 99'999'999},
      {7, kDint, kBoth, "400000", 1, kPositive},
      {8, kDint, kBoth, "", 1, kPositive},
      {9, kDint, kBoth, "", 1, kPositive},
      {10, kBool, kBoth, "", 0, 1},
      {11, kBool, kBoth, "", 0, 1},
      {12, kBool, kGet},
      {13, kDint, kBoth, "", -99'999'999, 99'999'999},
      {14, kDint, kGet},
      {15, kDint, kGet},
      {16, kDint, kGet},
      {17, kBool, kBoth, "", 0, 1},
      {18, kUsint, kBoth, "0"},  // 0, 1, 2, 240 to 245: a list
      {19, kDint, kBoth, "25", 4, 1000},
      {20, kBool, kBoth, "", 0, 1},
      {21, kBool, kBoth, "", 0, 1},
      {22, kDint, kSet, "", 0, kPositive},  // a continuous speed of 0 stops
      {23, kBool, kBoth, "", 0, 1},
      {24, kBool, kBoth, "0", 0, 1},
      {26, kDint, kBoth, "800", 0, 800},
      {27, kDint, kBoth, "-800", -800, 0},
      {30, DataType::kInt, kBoth, "40", 1, 2000},
      {38, kUsint, kSet, "5", 0, 255},
      {45, kDint, kBoth, "262144", 256, 8'388'352},
      {47, kBool, kBoth, "", 0, 1},
      {49, kUsint, kBoth, "0", 0, 2},
      {50, kBool, kBoth, "", 0, 1},  // Get in B.7, Get/Set in 5.4.7
      {51, kBool, kBoth, "", 0, 1},
      {52, kUsint, kBoth, "0", 0, 1},  // BOOL in B.7, USINT in 5.4.8: one byte
      {53, kUsint, kBoth, "", 1, 2},   // 5.4.8 only
      {54, kDint, kBoth, "99999999"},
      {55, kDint, kBoth, "-99999999"},
      {56, kBool, kGet},
      {57, kBool, kGet},
      {231, kBool, kBoth, "0", 0, 1},
      {232, kBool, kBoth, "0", 0, 1},
      {241, kUsint, kBoth, "0", 0, 1},
      {242, kBool, kBoth, "0", 0, 1},
      {243, kBool, kBoth, "0", 0, 1},
      {244, kBool, kGet},
      {253, kBool, kBoth, "0", 0, 1},
      {254, kDint, kBoth, "10000", 1, kPositive},
      {255, kDint, kBoth, "5000", 1, kPositive},
  };
  expect_rows(0x25, rows);
  EXPECT_EQ(object(0x25).find(24)->effective, Effective::kAfterReset);  // Table 4.7
  EXPECT_EQ(object(0x25).find(49)->effective, Effective::kAtOnce);
  EXPECT_EQ(object(0x25).find(6)->unit, Unit::kStep);
  EXPECT_EQ(object(0x25).find(7)->unit, Unit::kStepPerSecond);
  EXPECT_EQ(object(0x25).find(8)->unit, Unit::kStepPerSecond2);
  EXPECT_EQ(object(0x25).find(26)->unit, Unit::kPercent);
  for (const int profile : {0, 1, 2, 240, 241, 242, 243, 244, 245}) {
    EXPECT_NE(find_value(object(0x25).find(18)->values, profile), nullptr) << profile;
  }
  EXPECT_EQ(find_value(object(0x25).find(18)->values, 3), nullptr);
}

TEST(Ns310Oracle, AppendixB8SequencerAndB9Blocks) {
  const Row sequencer[] = {{1, kUsint, kBoth, "", 1, 255},
                           {2, kBool, kBoth, "", 0, 1},
                           {3, kUsint, kGet},
                           {4, kBool, kGet},
                           {5, kUsint, kGet}};
  expect_rows(0x26, sequencer);
  EXPECT_EQ(object(0x27).first_instance, 1);
  EXPECT_EQ(object(0x27).last_instance, 255);
  for (const int code : {0x01, 0x02, 0x0E, 0x10}) {
    const auto service = static_cast<std::uint8_t>(code);
    EXPECT_TRUE(object(0x27).has_service(service));
    EXPECT_EQ(object(0x26).has_service(service), service >= 0x0E);
  }
}

TEST(Ns310Oracle, AppendixB10ControlParameter) {
  const Row rows[] = {
      {11, kUint, kBoth, "1", 0, 1},
      {12, kDint, kBoth, "", 1, 240'000},
      {13, kDint, kBoth, "600", 1, 240'000},
      {14, kDint, kBoth, "300", 1, 240'000},
      {15, kDint, kBoth, "0", 0, 99'999'999},
      {17, kDint, kBoth, "0", -99'999'999, 99'999'999},  // Get in B.10, a parameter in Table 4.6
      {30, kDint, kBoth, "1"},
      {31, kDint, kBoth, "1"},
      {32, kBool, kBoth, "0", 0, 1},
      {33, kDint, kBoth, "360000", 1, 1'500'000},
      {34, kDint, kBoth, "0", 0, 32'767},
      {35, kBool, kBoth, "0", 0, 1},
      {36, kDint, kBoth, "99999999"},
      {37, kDint, kBoth, "-99999999"},
      {38, kUint, kBoth, "0", 0, 3},
      {39, kUsint, kBoth, "", 0, 3},
      {40, kUsint, kBoth, "0", 0, 2},
      {41, kUsint, kBoth, "0", 0, 3},
      {42, kUsint, kBoth, "0"},
      {51, kDint, kBoth, "24000", 1, 240'000},
      {52, kUint, kBoth, "100", 1, 10'000},
      {53, kDint, kBoth, "100", 1, 10'000},
      {54, kDint, kBoth, "24000", 1, 240'000},
      {55, kUint, kBoth, "100", 1, 10'000},
      {56, kUsint, kBoth, "0", 0, 3},
      {58, kUsint, kBoth, "0", 0, 3},
      {60, kDint, kBoth, "24000", 1, 240'000},
      {61, kUint, kBoth, "100", 1, 10'000},
      {62, kUint, kBoth, "100", 1, 10'000},
      {63, kDint, kBoth, "24000", 1, 240'000},
      {64, kUint, kBoth, "100", 1, 10'000},
      {65, kUsint, kBoth, "0", 0, 3},
      {70, kUint, kBoth, "2", 2, 1'000},
      {71, kDint, kBoth, "24000", 1, 240'000},
      {72, kUint, kBoth, "25", 4, 4'000},
      {73, kDint, kBoth, "24000", 1, 240'000},
      {90, kUint, kBoth, "5", 0, 10'000},  // 0 to 255 in Table 4.12, 1 to 10,000 in B.10
      {91, kUint, kBoth, "0"},             // 0 to 100,000 does not fit a UINT: a second row takes 4 bytes
  };
  expect_rows(0x64, rows, 1);
  for (const unsigned number : {30U, 31U}) {
    EXPECT_EQ(object(0x64).find(number)->effective, Effective::kAfterReset) << number;  // Table 4.4
  }
  EXPECT_EQ(object(0x64).find(52)->unit, Unit::kMillisecond);
}

// B.11: the ends of its blocks and rows of every unit; the default as printed.
TEST(Ns310Oracle, AppendixB11ServopackParameter) {
  const ObjectClass& row = object(0x66);
  EXPECT_EQ(row.attributes.size(), 89U);
  for (const Attribute& attribute : row.attributes) {
    EXPECT_EQ(devicenet::size_of(attribute.type), 2) << attribute.number;
    EXPECT_EQ(attribute.access, kBoth) << attribute.number;
  }
  const std::pair<int, int> gaps[] = {{0, 9},     {16, 49},   {86, 99},   {109, 119}, {129, 139},
                                      {150, 160}, {164, 164}, {179, 189}, {192, 255}};
  for (const auto& [first, last] : gaps) {
    for (int number = first; number <= last; ++number) {
      EXPECT_EQ(row.find(static_cast<unsigned>(number)), nullptr) << number;
    }
  }
  struct Printed {
    unsigned number;
    const char* default_text;
    std::int64_t minimum;
    std::int64_t maximum;
  };
  const Printed printed[] = {
      {13, "0002h", 0, 0},     {50, "40", 1, 2000},        {51, "2000", 15, 51'200}, {52, "40", 1, 2000},
      {53, "0", 0, 10'000},    {57, "0", 0, 450},          {62, "200", 0, 800},      {64, "0", 0, 3000},
      {76, "1000", 1, 2000},   {101, "16384", 16, 16'384}, {102, "4", 1, 65'535},    {106, "16384", 513, 65'535},
      {120, "600", 150, 3000}, {124, "500", 0, 10'000},    {142, "800", 0, 800},     {149, "2000", 50, 2000},
      {163, "10", 0, 100},     {165, "1024", 1, 32'767},   {168, "50", 10, 100},     {169, "20", 20, 1000},
      {171, "6543h", 0, 0},    {174, "3211h", 0, 0},       {190, "0", 0, 0}};
  for (const Printed& expected : printed) {
    const Attribute* found = row.find(expected.number);
    ASSERT_NE(found, nullptr) << expected.number;
    EXPECT_EQ(found->default_text, expected.default_text) << expected.number;
    EXPECT_EQ(found->range.minimum, expected.minimum) << expected.number;
    EXPECT_EQ(found->range.maximum, expected.maximum) << expected.number;
  }
}

// What 4.3 says of values that two objects share, in both directions.
TEST(Ns310Oracle, Section43OneValueSeenTwice) {
  struct Twin {
    unsigned class_id;
    unsigned attribute;
    const char* other;
  };
  const Twin twins[] = {
      {0x25, 7, "64h/51"},   {0x64, 51, "25h/7"},   {0x25, 8, "64h/52"},   {0x64, 52, "25h/8"},   {0x25, 9, "64h/53"},
      {0x64, 53, "25h/9"},   {0x25, 19, "64h/72"},  {0x64, 72, "25h/19"},  {0x25, 26, "66h/142"}, {0x66, 142, "25h/26"},
      {0x25, 27, "66h/143"}, {0x66, 143, "25h/27"}, {0x25, 30, "66h/52"},  {0x66, 52, "25h/30"},  {0x25, 38, "64h/90"},
      {0x64, 90, "25h/38"},  {0x25, 45, "66h/165"}, {0x66, 165, "25h/45"}, {0x25, 49, "64h/40"},  {0x64, 40, "25h/49"},
      {0x25, 52, "64h/38"},  {0x64, 38, "25h/52"},  {0x25, 54, "64h/36"},  {0x64, 36, "25h/54"},  {0x25, 55, "64h/37"},
      {0x64, 37, "25h/55"},  {0x25, 231, "64h/39"}, {0x64, 39, "25h/231"}, {0x25, 241, "64h/42"}, {0x64, 42, "25h/241"},
      {0x25, 242, "64h/41"}, {0x64, 41, "25h/242"}, {0x25, 243, "64h/41"}, {0x64, 41, "25h/243"}, {0x25, 253, "64h/11"},
      {0x64, 11, "25h/253"}, {0x25, 254, "64h/13"}, {0x64, 13, "25h/254"}, {0x25, 255, "64h/14"}, {0x64, 14, "25h/255"},
      {0x25, 18, "64h/56"},  {0x64, 56, "25h/18"},  {0x64, 58, "25h/18"},  {0x64, 65, "25h/18"}};
  for (const Twin& twin : twins) {
    const ObjectClass& row = object(twin.class_id);
    const Layout* layout = row.layout_of(*row.find(twin.attribute));
    EXPECT_NE(layout->fields[0].explanation.find(twin.other), std::string_view::npos)
        << std::hex << twin.class_id << "h/" << std::dec << twin.attribute << ": " << layout->fields[0].explanation;
  }
}

// What `decode --explain` prints of an attribute.
TEST(Ns310Oracle, Table44FactsInWords) {
  const ObjectClass& row = object(0x64);
  EXPECT_EQ(
      row.layout_of(*row.find(30))->fields[0].explanation,
      "DINT, Get/Set; default: 1; effective after a Reset or power-up; Pn810. The ratio to 64h/31 must be 0.01 to "
      "100.");
}

// 5.6.2: the response to a read of the acceleration carries 1234h.
TEST(Ns310Oracle, Section562ReadingAcceleration1234h) {
  const ObjectClass& row = object(0x25);
  const Layout* layout = row.layout_of(*row.find(8));
  ASSERT_NE(layout, nullptr);
  EXPECT_EQ(read(slot_of(layout->fields[0]), hex("34 12 00 00")), 0x1234);
  EXPECT_EQ(layout->fields[0].unit, Unit::kStepPerSecond2);
}

// Table 4.38: what a profile type is in 64h/56, 65 and 58 is held by the unit tests; its names by this.
TEST(Ns310Oracle, Tables410To413Names) {
  EXPECT_EQ(find_value(object(0x64).find(56)->values, 3)->name, "asymmetric");
  EXPECT_EQ(find_value(object(0x64).find(58)->values, 3)->name, "moving average");
  EXPECT_EQ(find_value(object(0x25).find(49)->values, 1)->name, "hard stop");
  EXPECT_EQ(find_value(object(0x26).find(5)->values, 2)->name, "command time-out");
}

}  // namespace
}  // namespace servotrace::ns310
