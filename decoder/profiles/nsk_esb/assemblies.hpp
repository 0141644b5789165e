// SPDX-License-Identifier: MIT
// Input and output as values: what a session keeps of a message (ESB 4.2). Precondition of both functions: kMessageSize
// bytes.
#pragma once

#include "decoder/core/slot.hpp"
#include "decoder/core/time.hpp"
#include "decoder/profiles/nsk_esb/layouts.hpp"

namespace servotrace::esb {

struct Input {
  std::uint64_t frame = 0;
  TimeNs time_ns = 0;
  bool emst = false;
  bool svon = false;
  bool run = false;
  bool stp = false;
  bool clr = false;
  bool hos = false;
  bool ord = false;
  bool jog = false;
  bool dir = false;
  bool reserved = false;  // any reserved bit
  std::uint8_t prg = 0;
  bool prm_req = false;
  bool prm_ope = false;  // write
  std::int16_t number = 0;
  std::int32_t data = 0;
};

struct Output {
  std::uint64_t frame = 0;
  TimeNs time_ns = 0;
  bool drdy = false;
  bool over = false;
  bool ipos = false;
  bool busy = false;
  bool brk = false;
  bool hcmp = false;
  bool home = false;
  bool emsta = false;
  bool otpa = false;
  bool otma = false;
  std::uint8_t ack_prg = 0;
  bool prm_ack = false;
  bool prm_sts = false;  // successful
  std::int16_t number = 0;
  std::int32_t data = 0;
};

inline Input read_input(Bytes bytes, std::uint64_t frame, TimeNs time_ns) {
  const auto flag = [bytes](Slot slot) { return read(slot, bytes) != 0; };
  Input input;
  input.frame = frame;
  input.time_ns = time_ns;
  input.emst = flag(slot(kInput, "emst"));
  input.svon = flag(slot(kInput, "svon"));
  input.run = flag(slot(kInput, "run"));
  input.stp = flag(slot(kInput, "stp"));
  input.clr = flag(slot(kInput, "clr"));
  input.hos = flag(slot(kInput, "hos"));
  input.ord = flag(slot(kInput, "ord"));
  input.jog = flag(slot(kInput, "jog"));
  input.dir = flag(slot(kInput, "dir"));
  input.reserved =
      flag(slot(kInput, "reserved_1")) || flag(slot(kInput, "reserved_2")) || flag(slot(kInput, "reserved_3"));
  input.prg = static_cast<std::uint8_t>(read(slot(kInput, "prg"), bytes));
  input.prm_req = flag(slot(kInput, "prm_req"));
  input.prm_ope = flag(slot(kInput, "prm_ope"));
  input.number = static_cast<std::int16_t>(read(slot(kInput, "prm_set_no"), bytes));
  input.data = static_cast<std::int32_t>(read(slot(kInput, "prm_set_data"), bytes));
  return input;
}

inline Output read_output(Bytes bytes, std::uint64_t frame, TimeNs time_ns) {
  const auto flag = [bytes](Slot slot) { return read(slot, bytes) != 0; };
  Output output;
  output.frame = frame;
  output.time_ns = time_ns;
  output.drdy = flag(slot(kOutput, "drdy"));
  output.over = flag(slot(kOutput, "over"));
  output.ipos = flag(slot(kOutput, "ipos"));
  output.busy = flag(slot(kOutput, "busy"));
  output.brk = flag(slot(kOutput, "brk"));
  output.hcmp = flag(slot(kOutput, "hcmp"));
  output.home = flag(slot(kOutput, "home"));
  output.emsta = flag(slot(kOutput, "emsta"));
  output.otpa = flag(slot(kOutput, "otpa"));
  output.otma = flag(slot(kOutput, "otma"));
  output.ack_prg = static_cast<std::uint8_t>(read(slot(kOutput, "ack_prg"), bytes));
  output.prm_ack = flag(slot(kOutput, "prm_ack"));
  output.prm_sts = flag(slot(kOutput, "prm_sts"));
  output.number = static_cast<std::int16_t>(read(slot(kOutput, "prm_get_no"), bytes));
  output.data = static_cast<std::int32_t>(read(slot(kOutput, "prm_get_data"), bytes));
  return output;
}

}  // namespace servotrace::esb
