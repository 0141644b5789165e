// SPDX-License-Identifier: MIT
// The input and output of ESB chapter 4 and the examples of 5.4.7: bytes typed from the manual.
#include <gtest/gtest.h>

#include "decoder/core/slot.hpp"
#include "decoder/profiles/nsk_esb/layouts.hpp"
#include "tests/support/bytes.hpp"

namespace servotrace::esb {
namespace {

using test::hex;

struct Row {
  const char* key;
  const char* bytes;
  std::int64_t value;
};

void expect_alone(const Layout& layout, std::span<const Row> rows) {
  EXPECT_EQ(rows.size(), layout.fields.size());
  for (const Row& row : rows) {
    const auto bytes = hex(row.bytes);
    ASSERT_EQ(bytes.size(), 10U) << row.key;
    for (const Field& field : layout.fields) {
      EXPECT_EQ(read(slot_of(field), bytes), field.key == row.key ? row.value : 0) << row.key << " in " << field.key;
    }
  }
}

// Table 4-1, left half, one signal at a time.
TEST(EsbOracle, Section42Input) {
  const Row rows[] = {
      {"emst", "01 00 00 00 00 00 00 00 00 00", 1},
      {"svon", "02 00 00 00 00 00 00 00 00 00", 1},
      {"run", "04 00 00 00 00 00 00 00 00 00", 1},
      {"stp", "08 00 00 00 00 00 00 00 00 00", 1},
      {"clr", "10 00 00 00 00 00 00 00 00 00", 1},
      {"ioff", "20 00 00 00 00 00 00 00 00 00", 1},
      {"hos", "40 00 00 00 00 00 00 00 00 00", 1},
      {"ord", "80 00 00 00 00 00 00 00 00 00", 1},
      {"prg", "00 3F 00 00 00 00 00 00 00 00", 63},
      {"reserved_1", "00 C0 00 00 00 00 00 00 00 00", 3},
      {"jog", "00 00 01 00 00 00 00 00 00 00", 1},
      {"dir", "00 00 02 00 00 00 00 00 00 00", 1},
      {"reserved_2", "00 00 FC 00 00 00 00 00 00 00", 63},
      {"reserved_3", "00 00 00 3F 00 00 00 00 00 00", 63},
      {"prm_req", "00 00 00 40 00 00 00 00 00 00", 1},
      {"prm_ope", "00 00 00 80 00 00 00 00 00 00", 1},
      {"prm_set_no", "00 00 00 00 34 12 00 00 00 00", 0x1234},
      {"prm_set_data", "00 00 00 00 00 00 78 56 34 12", 0x12345678},
  };
  expect_alone(kInput, rows);
}

// Table 4-1, right half, one signal at a time.
TEST(EsbOracle, Section42Output) {
  const Row rows[] = {
      {"drdy", "01 00 00 00 00 00 00 00 00 00", 1},        {"over", "02 00 00 00 00 00 00 00 00 00", 1},
      {"ipos", "04 00 00 00 00 00 00 00 00 00", 1},        {"busy", "08 00 00 00 00 00 00 00 00 00", 1},
      {"brk", "10 00 00 00 00 00 00 00 00 00", 1},         {"hcmp", "20 00 00 00 00 00 00 00 00 00", 1},
      {"home", "40 00 00 00 00 00 00 00 00 00", 1},        {"spd", "80 00 00 00 00 00 00 00 00 00", 1},
      {"ack_prg", "00 3F 00 00 00 00 00 00 00 00", 63},    {"reserved_1", "00 C0 00 00 00 00 00 00 00 00", 3},
      {"emsta", "00 00 01 00 00 00 00 00 00 00", 1},       {"otpa", "00 00 02 00 00 00 00 00 00 00", 1},
      {"otma", "00 00 04 00 00 00 00 00 00 00", 1},        {"hlsa", "00 00 08 00 00 00 00 00 00 00", 1},
      {"neara", "00 00 10 00 00 00 00 00 00 00", 1},       {"nearb", "00 00 20 00 00 00 00 00 00 00", 1},
      {"reserved_2", "00 00 C0 00 00 00 00 00 00 00", 3},  {"reserved_3", "00 00 00 3F 00 00 00 00 00 00", 63},
      {"prm_ack", "00 00 00 40 00 00 00 00 00 00", 1},     {"prm_sts", "00 00 00 80 00 00 00 00 00 00", 1},
      {"prm_get_no", "00 00 00 00 FF FF 00 00 00 00", -1}, {"prm_get_data", "00 00 00 00 00 00 FF FF FF FF", -1},
  };
  expect_alone(kOutput, rows);
}

// Figure 5-5: the control input that writes VG = 45.0.
TEST(EsbOracle, Figure55WriteVg45) {
  const auto bytes = hex("00 00 00 C0 02 00 C2 01 00 00");
  EXPECT_EQ(read(slot(kInput, "prm_req"), bytes), 1);
  EXPECT_EQ(read(slot(kInput, "prm_ope"), bytes), 1);
  EXPECT_EQ(read(slot(kInput, "prm_set_no"), bytes), 2);
  EXPECT_EQ(read(slot(kInput, "prm_set_data"), bytes), 450);
}

// Figure 5-6: the control output that answers a read of PG with 0.400.
TEST(EsbOracle, Figure56ReadPg400) {
  const auto bytes = hex("01 00 00 C0 01 00 90 01 00 00");
  EXPECT_EQ(read(slot(kOutput, "prm_ack"), bytes), 1);
  EXPECT_EQ(read(slot(kOutput, "prm_sts"), bytes), 1);
  EXPECT_EQ(read(slot(kOutput, "prm_get_no"), bytes), 1);
  EXPECT_EQ(read(slot(kOutput, "prm_get_data"), bytes), 400);
}

// Table 4-8: channel 61 is PRG5, 4, 3, 2 and 0.
TEST(EsbOracle, Table48ChannelSelect) {
  EXPECT_EQ(read(slot(kInput, "prg"), hex("00 3D 00 00 00 00 00 00 00 00")), 61);
  EXPECT_EQ(read(slot(kOutput, "ack_prg"), hex("00 05 00 00 00 00 00 00 00 00")), 5);
}

}  // namespace
}  // namespace servotrace::esb
