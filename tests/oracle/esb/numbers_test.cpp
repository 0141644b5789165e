// SPDX-License-Identifier: MIT
// The command list of ESB 5.4 and Table 4-12: values typed from the manual's tables.
#include <gtest/gtest.h>

#include "decoder/core/slot.hpp"
#include "decoder/profiles/nsk_esb/alarms.hpp"
#include "decoder/profiles/nsk_esb/number_layouts.hpp"
#include "tests/support/bytes.hpp"

namespace servotrace::esb {
namespace {

using test::hex;

struct Row {
  int number;
  const char* mnemonic;
  int decimals;
  std::int64_t lowest;
  std::int64_t highest;
  const char* initial;
};

TEST(EsbOracle, Section541Parameters) {
  const Row rows[] = {
      {1, "PG", 3, 10, 1000, "0.100"},
      {2, "VG", 1, 1, 2550, "1.0"},
      {4, "VI", 2, 10, 6300, "1.00"},
      {7, "LG", 0, 0, 100, "50"},
      {28, "FF", 4, 0, 10000, "0.0000"},
      {40, "CO", 0, 1, 99999999, "50 000"},
      {44, "VO", 0, 1, 5461, "2730"},
      {46, "OR", 0, 204800, 819200, "409 600"},
      {120, "MV", 4, 1, 30000, "1.0000"},
      {121, "MA", 2, 1, 128000, "1.00"},
      {126, "HZ", 4, 1, 2000, "0.0100"},
      {131, "OV", 0, 0, 200, "100"},
      {143, "HO", 0, -802816, 802816, "0"},
      {160, "PA", 0, 24, 1048, "700"},
      {220, "LO", 3, 0, 50000, "0"},
      {267, "NA", 0, 1, 99999999, "100"},
      {272, "ZBE", 0, -99999999, 99999999, "0"},
  };
  for (const Row& row : rows) {
    const Number* number = find_number(row.number);
    ASSERT_NE(number, nullptr) << row.number;
    EXPECT_EQ(number->mnemonic, row.mnemonic);
    EXPECT_EQ(number->decimals, row.decimals) << row.mnemonic;
    EXPECT_EQ(number->initial, row.initial) << row.mnemonic;
    EXPECT_TRUE(number->allows(row.lowest)) << row.mnemonic;
    EXPECT_TRUE(number->allows(row.highest)) << row.mnemonic;
    EXPECT_FALSE(number->allows(row.highest + 1)) << row.mnemonic;
    EXPECT_FALSE(number->allows(row.lowest - 1)) << row.mnemonic;
  }
}

TEST(EsbOracle, Section541ReservedNumbers) {
  const std::pair<int, int> reserved[] = {
      {11, 19},   {30, 39},   {47, 49},   {51, 61},   {63, 79},   {83, 99},   {105, 119}, {128, 130},
      {132, 139}, {144, 159}, {165, 179}, {183, 189}, {193, 199}, {201, 219}, {222, 239}, {242, 259},
      {273, 279}, {286, 299}, {303, 319}, {322, 329}, {331, 339}, {413, 419}, {421, 439}, {441, 459},
      {504, 519}, {612, 619}, {621, 639}, {642, 659}, {664, 679}, {801, 819}, {821, 839}, {851, 859}};
  for (const auto& [first, last] : reserved) {
    EXPECT_NE(find_number(first - 1), nullptr) << first;
    for (int number = first; number <= last; ++number) EXPECT_EQ(find_number(number), nullptr) << number;
  }
}

TEST(EsbOracle, Section543And545OperationAndProgramCommands) {
  const char* mnemonics[] = {"AD",    "AD/PL", "AD/MI", "AD/EX", "AR", "AR/PL",
                             "AR/MI", "AR/EX", "ID",    "ID/EX", "IR", "IR/EX"};
  for (int i = 0; i < 12; ++i) {
    EXPECT_EQ(find_number(400 + i)->mnemonic, mnemonics[i]);
    EXPECT_EQ(find_number(600 + i)->mnemonic, mnemonics[i]);
  }
  EXPECT_EQ(find_number(412)->mnemonic, "SP");
  EXPECT_EQ(find_number(420)->mnemonic, "HS");
  EXPECT_EQ(find_number(620)->mnemonic, "HS");
  EXPECT_EQ(find_number(640)->mnemonic, "JP");
  EXPECT_EQ(find_number(641)->mnemonic, "TI");
  EXPECT_TRUE(find_number(641)->allows(3));
  EXPECT_FALSE(find_number(641)->allows(0));
  EXPECT_TRUE(find_number(660)->allows(0));
  EXPECT_FALSE(find_number(660)->allows(1));
  EXPECT_TRUE(find_number(660)->allows(99));
}

// Figures 5-5 and 5-6: 450 is VG45.0, 400 is PG0.400.
TEST(EsbOracle, Section547DecimalPlaces) {
  const Layout* vg = data_layout(2);
  ASSERT_NE(vg, nullptr);
  EXPECT_EQ(vg->key, "parameter");
  EXPECT_EQ(vg->fields[0].key, "vg");
  EXPECT_EQ(read(slot_of(vg->fields[0]), hex("C2 01 00 00")), 450);
  EXPECT_EQ(vg->fields[0].scale, (Ratio{1, 10}));
  EXPECT_EQ(data_layout(1)->fields[0].scale, (Ratio{1, 1000}));
  EXPECT_EQ(data_layout(848)->fields[0].scale, (Ratio{1, 100}));  // 0.01 degree
  EXPECT_EQ(data_layout(321), nullptr);
}

TEST(EsbOracle, Section546AlarmWord) {
  struct Bit {
    const char* label;
    const char* bytes;
  };
  for (const Bit& bit : {Bit{"F0", "01 00 00 00"}, Bit{"F7", "80 00 00 00"}, Bit{"C2", "00 04 00 00"},
                         Bit{"A5", "00 00 20 00"}, Bit{"P0", "00 00 00 01"}, Bit{"P3", "00 00 00 08"}}) {
    for (const Field& field : kAlarmWord.fields) {
      EXPECT_EQ(read(slot_of(field), hex(bit.bytes)), field.label.starts_with(bit.label) ? 1 : 0) << bit.label;
    }
  }
}

// The names of Table 4-12 beside the bits of Table 5-10.
TEST(EsbOracle, Section546AlarmWordInWords) {
  EXPECT_EQ(kAlarmWord.fields[1].label, "F1 Excess position error");
  EXPECT_EQ(kAlarmWord.fields[20].label, "A4 Velocity error over");
  EXPECT_EQ(kAlarmWord.fields[27].label, "P3 Control AC line under voltage");
  EXPECT_EQ(kAlarmWord.fields[6].label, "F6");  // no alarm of this name
}

// Range, unit, decimal place and initial value as Tables 5-3 to 5-9 print them.
TEST(EsbOracle, Section54FactsInWords) {
  const auto facts = [](int number) { return data_layout(number)->fields[0].explanation; };
  EXPECT_EQ(facts(2), "Velocity gain; 0.1 to 255.0; decimal places: 1; initial: 1.0");
  EXPECT_EQ(facts(4), "Velocity integrator frequency; 0.10 to 63.00 Hz; decimal places: 2; initial: 1.00");
  EXPECT_EQ(facts(42), "In-position stability counter; 0 or 0.3 to 100.0 x 100 ms; decimal places: 1; initial: 0.0");
  EXPECT_EQ(facts(44), "Velocity error over limit; 1 to 5461 x 3/5461 s^-1; initial: 2730");
  EXPECT_EQ(facts(281), "Excessive position error, alarm type; 1, 2, 3; initial: 2");
  EXPECT_EQ(facts(400), "Absolute positioning, degree (short cut); 0 to 35999 x 1/100 deg");
  EXPECT_EQ(facts(850), "Torque and thermal; 0.0 to 100.0 %; decimal places: 1");
}

TEST(EsbOracle, Section546InputOutputMonitors) {
  const auto labels = [](const Layout& layout, unsigned bit) { return layout.fields[bit].label; };
  EXPECT_EQ(labels(kIo0, 0), "HOME");
  EXPECT_EQ(labels(kIo0, 8), "HLS");
  EXPECT_EQ(labels(kIo0, 11), "SVON");
  EXPECT_EQ(labels(kIo1, 10), "EMST");
  EXPECT_EQ(labels(kIo2, 12), "PRG5");
  EXPECT_EQ(labels(kIo2, 6), "RUN");
  EXPECT_EQ(labels(kIo2, 5), "STP");
  EXPECT_EQ(labels(kIo3, 12), "JOG");
  EXPECT_EQ(labels(kIo3, 6), "ORD");
  EXPECT_EQ(labels(kIo3, 0), "HCMP");
  EXPECT_EQ(labels(kIo4, 16), "EMST");
  EXPECT_EQ(labels(kIo4, 8), "JOG");
  EXPECT_EQ(labels(kIo4, 0), "SPD");
  EXPECT_EQ(labels(kIo5, 16), "PRG5");
  EXPECT_EQ(labels(kIo5, 10), "RUN");
  EXPECT_EQ(labels(kIo5, 0), "NEARB");
}

std::string_view code_of(std::uint64_t set, int nth) {
  for (std::size_t i = 0; i < kAlarms.size(); ++i) {
    if ((set >> i & 1U) != 0 && nth-- == 0) return kAlarms[i].code;
  }
  return "";
}
int size_of_set(std::uint64_t set) { return __builtin_popcountll(set); }

TEST(EsbOracle, Table412Patterns) {
  const auto unknown = [](std::uint16_t) { return static_cast<const std::int32_t*>(nullptr); };
  // DRDY 0, OVER 1, BRK 0: velocity error over (serious) alone.
  EXPECT_EQ(size_of_set(alarms_that_fit(false, true, false, true, unknown)), 1);
  EXPECT_EQ(code_of(alarms_that_fit(false, true, false, true, unknown), 0), "A4");
  // 1, 0, 0: emergency stop; 1, 1, 0: brake error.
  EXPECT_EQ(code_of(alarms_that_fit(true, false, false, true, unknown), 0), "F4");
  EXPECT_EQ(code_of(alarms_that_fit(true, true, false, true, unknown), 0), "A8");
  // 0, 1, 1: excess position error with EP3.
  EXPECT_EQ(code_of(alarms_that_fit(false, true, true, true, unknown), 0), "F1");
  // 0, 0, 1 with EP known to be 2: F1 no longer fits.
  const std::int32_t two = 2;
  const auto ep2 = [&two](std::uint16_t number) { return number == 281 ? &two : nullptr; };
  const std::uint64_t set = alarms_that_fit(false, false, true, true, ep2);
  EXPECT_EQ(code_of(set, 0), "F2");
  EXPECT_EQ(size_of_set(set), 3);  // F2, F3, C2
  // 0, 0, 0: E0 E2 E8 F0 C3 A0 A1 A3 P0 P1 P2 P3 (E7 and C4 are never reported over DeviceNet).
  EXPECT_EQ(size_of_set(alarms_that_fit(false, false, false, true, unknown)), 12);
}

}  // namespace
}  // namespace servotrace::esb
