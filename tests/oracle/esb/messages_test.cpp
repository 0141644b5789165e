// SPDX-License-Identifier: MIT
// The examples of ESB chapter 5 as frames of node 9, and what is printed of them.
#include <gtest/gtest.h>

#include "tests/support/can_decoder.hpp"

namespace servotrace::esb {
namespace {

constexpr std::uint32_t kCommand = 0x44D;   // 405h + 8 x 9
constexpr std::uint32_t kResponse = 0x3C9;  // 3C0h + 9
// DRDY, IPOS, BRK, HCMP; nothing asked for.
constexpr std::string_view kIdle = "35 00 00 00 00 00 00 00 00 00";

void expect_lines(const std::string& text, std::initializer_list<std::string_view> lines) {
  for (const std::string_view line : lines) EXPECT_NE(text.find(line), std::string::npos) << line << " in\n" << text;
}

class Bus {
 public:
  Bus() {
    decoder_.in_fragments(kCommand, "02 00 00 00 00 00 00 00 00 00");
    decoder_.in_fragments(kResponse, kIdle);
  }
  // PRM_REQ rises with `request`, PRM_ACK with `answer`; both fall. The texts of the two rising messages.
  std::string transact(std::string_view request, std::string_view answer) {
    request_ = decoder_.in_fragments(kCommand, request);
    const std::string text = decoder_.in_fragments(kResponse, answer);
    decoder_.in_fragments(kCommand, "02 00 00 00 00 00 00 00 00 00");
    decoder_.in_fragments(kResponse, kIdle);
    return text;
  }
  const std::string& request() const { return request_; }

 private:
  test::CanDecoder decoder_{9, "nsk-esb"};
  std::string request_;
};

// Figure 5-5.
TEST(EsbMessages, Section547WriteVg45) {
  Bus bus;
  const std::string text = bus.transact("02 00 00 C0 02 00 C2 01 00 00", "35 00 00 C0 02 00 C2 01 00 00");
  expect_lines(bus.request(),
               {"PRM_SET_NO (Parameter number): 2 (VG)\n", "VG: 45.0\n", "Transaction: write VG45.0]\n"});
  expect_lines(text, {"Transaction: write VG45.0: successful]\n", "request in frame"});
}

// Figure 5-6: the answer 400 is PG 0.400.
TEST(EsbMessages, Section547ReadPg400) {
  Bus bus;
  const std::string text = bus.transact("02 00 00 40 01 00 00 00 00 00", "35 00 00 C0 01 00 90 01 00 00");
  expect_lines(bus.request(), {"Transaction: read PG]\n"});
  expect_lines(text, {"PG: 0.400\n", "Transaction: read PG: 0.400]\n"});
}

// 5.3.1: channel 5 gets AD/PL9000& with CV1.5000 and CA10.00; the edit prints the program.
TEST(EsbMessages, Section531EditPrintsTheProgram) {
  Bus bus;
  bus.transact("02 00 00 C0 F4 01 05 00 00 00", "35 00 00 C0 F4 01 05 00 00 00");               // 500 (CH) 5
  expect_lines(bus.transact("02 00 00 C0 59 02 28 23 00 00", "35 00 00 C0 59 02 28 23 00 00"),  // 601 (AD/PL) 9000
               {"Program: CH5: AD/PL9000]\n"});
  expect_lines(bus.transact("02 00 00 C0 95 02 02 00 00 00", "35 00 00 C0 95 02 02 00 00 00"),  // 661 (OE) 2
               {"Program: CH5: AD/PL9000&]\n"});
  bus.transact("02 00 00 C0 96 02 98 3A 00 00", "35 00 00 C0 96 02 98 3A 00 00");               // 662 (CV) 15000
  bus.transact("02 00 00 C0 97 02 E8 03 00 00", "35 00 00 C0 97 02 E8 03 00 00");               // 663 (CA) 1000
  expect_lines(bus.transact("02 00 00 C0 F6 01 00 00 00 00", "35 00 00 C0 F6 01 00 00 00 00"),  // 502
               {"Program: CH5: AD/PL9000&, CV1.5000, CA10.00]\n"});
}

// 5.3.2: 501, 820 until PRM_GET_NO = -1, 502.
TEST(EsbMessages, Section532ReadOutPrintsTheProgram) {
  Bus bus;
  bus.transact("02 00 00 C0 F5 01 03 00 00 00", "35 00 00 C0 F5 01 03 00 00 00");  // 501 (TC) 3
  bus.transact("02 00 00 40 34 03 00 00 00 00", "35 00 00 C0 62 02 FF FF FF FF");  // 610 (IR) -1
  bus.transact("02 00 00 40 34 03 00 00 00 00", "35 00 00 C0 94 02 04 00 00 00");  // 660, 4
  expect_lines(bus.transact("02 00 00 40 34 03 00 00 00 00", "35 00 00 C0 FF FF 00 00 00 00"),
               {"Program: CH3: IR-1/4]\n", "end of the program]\n"});
}

// Table 5-10 and Table 5-11: the alarm word and IO0, bit by bit.
TEST(EsbMessages, Section546MonitorsBitByBit) {
  Bus bus;
  expect_lines(bus.transact("02 00 00 40 20 03 00 00 00 00", "35 00 00 C0 20 03 02 00 00 01"),
               {"F1 Excess position error: 1\n", "P0 Heat sink overheat: 1\n", "A4 Velocity error over: 0\n"});
  expect_lines(bus.transact("02 00 00 40 48 03 00 00 00 00", "35 00 00 C0 48 03 08 08 00 00"),
               {"SVON: 1\n", "DRDY: 1\n", "EMST: 0\n"});
}

}  // namespace
}  // namespace servotrace::esb
