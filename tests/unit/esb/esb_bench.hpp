// SPDX-License-Identifier: MIT
// Inputs and outputs of an ESB by their signals, and the handshake as a master does it.
#pragma once

#include <gtest/gtest.h>

#include "decoder/core/slot.hpp"
#include "decoder/profiles/nsk_esb/profile.hpp"
#include "decoder/profiles/nsk_esb/programs.hpp"
#include "decoder/profiles/nsk_esb/rules.hpp"
#include "tests/support/bytes.hpp"
#include "tests/support/drive_bench.hpp"

namespace servotrace::esb {

// Byte 0 of the input.
inline constexpr unsigned kEmst = 0x01, kSvon = 0x02, kRun = 0x04, kStp = 0x08, kClr = 0x10, kHos = 0x40, kOrd = 0x80;
// Byte 2 of the input.
inline constexpr unsigned kJog = 0x01;
// Byte 0 of the output.
inline constexpr unsigned kDrdy = 0x01, kOver = 0x02, kBusy = 0x08, kBrk = 0x10, kHcmp = 0x20;
inline constexpr unsigned kReady = kDrdy | kBrk | kHcmp;
// Byte 2 of the output.
inline constexpr unsigned kEmsta = 0x01, kOtpa = 0x02;

struct In {
  unsigned byte0 = kSvon;
  unsigned prg = 0;
  unsigned byte2 = 0;
  bool request = false;
  bool write = false;
  int number = 0;
  int data = 0;
};
struct Out {
  unsigned byte0 = kReady;
  unsigned ack_prg = 0;
  unsigned byte2 = 0;
  bool ack = false;
  bool sts = false;
  int number = 0;
  int data = 0;
};

inline std::vector<std::uint8_t> message_of(unsigned byte0, unsigned byte1, unsigned byte2, unsigned byte3, int number,
                                            int data) {
  std::vector<std::uint8_t> bytes = {static_cast<std::uint8_t>(byte0), static_cast<std::uint8_t>(byte1),
                                     static_cast<std::uint8_t>(byte2), static_cast<std::uint8_t>(byte3)};
  for (int i = 0; i < 2; ++i) bytes.push_back(static_cast<std::uint8_t>(static_cast<unsigned>(number) >> (8 * i)));
  for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<std::uint8_t>(static_cast<unsigned>(data) >> (8 * i)));
  return bytes;
}
inline std::vector<std::uint8_t> bytes_of(const In& in) {
  return message_of(in.byte0, in.prg, in.byte2, (in.request ? 0x40U : 0U) | (in.write ? 0x80U : 0U), in.number,
                    in.data);
}
inline std::vector<std::uint8_t> bytes_of(const Out& out) {
  return message_of(out.byte0, out.ack_prg, out.byte2, (out.ack ? 0x40U : 0U) | (out.sts ? 0x80U : 0U), out.number,
                    out.data);
}

class EsbRules : public ::testing::Test {
 protected:
  void poll(const In& in, const Out& out = {}, int times = 1) { bench_.poll(bytes_of(in), bytes_of(out), times); }
  void ready() { poll({}, {}, 2); }
  // A whole transaction, as figures 5-1 and 5-2 draw it. `answer`: of a read.
  void transact(bool write, int number, int data = 0, int answer = 0, bool success = true, int answer_number = -2) {
    const In asked{.request = true, .write = write, .number = number, .data = data};
    const Out done{.ack = true,
                   .sts = success,
                   .number = answer_number == -2 ? number : answer_number,
                   .data = write ? data : answer};
    poll({.number = number, .data = data});
    poll(asked);
    poll(asked, done);
    poll({.number = number, .data = data}, done);
    poll({.number = number, .data = data});
  }
  void write(int number, int data = 0) { transact(true, number, data); }
  void read(int number, int answer) { transact(false, number, 0, answer); }

  test::DriveBench bench_{kProfile};
};

}  // namespace servotrace::esb
