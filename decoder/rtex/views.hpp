// SPDX-License-Identifier: MIT
// A block's fields as plain values, read once where a block differs from the one before.
#pragma once

#include "decoder/rtex/decode.hpp"

namespace servotrace::rtex {

// A block of 16 or 32 bytes; of 16 the last two words are 0.
using BlockWords = std::array<std::uint64_t, 4>;
inline BlockWords words_of(Bytes block) {
  BlockWords words = {load_le64(block, 0), load_le64(block, 8), 0, 0};
  if (block.size() == kWideBlockSize) {
    words[2] = load_le64(block, 16);
    words[3] = load_le64(block, 24);
  }
  return words;
}

// The non-cyclic part of a command, main or sub channel.
struct CommandPart {
  std::uint8_t code = 0;
  std::uint16_t type_code = 0;
  std::uint16_t index = 0;        // bytes 10-11; main channel homing and profile: Latch_Sel and Monitor_Sel
  std::int32_t setting_data = 0;  // where the arguments hold it, else 0; sub channel: Sub_Command_Data1
  std::int32_t position = 0;      // profile only: TPOS

  std::uint8_t latch_sel1() const { return static_cast<std::uint8_t>(index & 0xFU); }
  std::uint8_t latch_sel2() const { return static_cast<std::uint8_t>(index >> 4U & 0xFU); }
  std::uint8_t monitor_sel() const { return static_cast<std::uint8_t>(index >> 8U); }
  bool same_arguments(const CommandPart& other) const {
    return type_code == other.type_code && index == other.index && setting_data == other.setting_data &&
           position == other.position;
  }
  bool operator==(const CommandPart&) const = default;
};

struct CommandView {
  std::uint8_t mac_id = 0;
  std::uint8_t counter = 0;
  bool cr = false;
  std::uint8_t cyclic = 0;
  bool tmg_cnt = false;
  bool servo_on = false, homing_ctrl = false, pause = false, smooth_stop = false, hard_stop = false;
  std::uint16_t unused_bits = 0;  // byte 2 in bits 0-7, byte 3 in bits 8-15
  std::int32_t data1 = 0;
  std::uint32_t data3 = 0;
  CommandPart main;
  // 32-byte mode
  bool wide = false;
  bool sub_chk = false;
  std::uint8_t sub_unused = 0;
  CommandPart sub;
  std::uint32_t sub_data2 = 0, sub_data3 = 0;

  bool is_nop() const { return cyclic == 0; }
  bool is_mode() const { return cyclic >= 1 && cyclic <= 4; }
  bool is(Cyclic mode) const { return cyclic == static_cast<std::uint8_t>(mode); }
  bool is(NonCyclic code) const { return !is_nop() && main.code == static_cast<std::uint8_t>(code); }
  bool data3_is_setting() const { return has_setting_data(main.code, main.type_code); }
};

// The non-cyclic part of a response.
struct ResponsePart {
  std::uint8_t echo = 0;  // of the non-cyclic code
  bool error = false;     // CMD_Error, Sub_CMD_Err
  std::uint16_t error_code = 0;
  std::uint16_t type_code = 0;
  std::uint16_t index = 0;
  bool busy = false, wng = false, err = false;
  bool latch_comp1 = false, latch_comp2 = false;  // homing 5xh; profile: latch_comp1
  bool psl = false, nsl = false;
  std::uint32_t data = 0;  // bytes 12-15; sub channel: 20-23

  bool operator==(const ResponsePart&) const = default;
  bool answers() const { return echo != 0 && !error; }
  // But for a monitored value.
  bool is_again(ResponsePart other) const {
    if (is(NonCyclic::kMonitor)) other.data = data;
    return *this == other;
  }
  bool is(NonCyclic code) const { return answers() && echo == static_cast<std::uint8_t>(code); }
};

struct ResponseView {
  std::uint8_t mac_id = 0;
  std::uint8_t counter = 0;
  bool cr = false;
  std::uint8_t cyclic = 0;
  bool communication_error = false;
  bool servo_active = false, servo_ready = false, alarm = false, warning = false, torque_limited = false;
  bool homing_complete = false, in_progress = false;
  bool low_input = false, high_input = false;  // bits 0 and 1 of byte 3: NOT and POT, unless Pr7.23 bit 3 = 1
  bool bit7_input = false;                     // SI-MON5 or E-STOP
  std::int32_t data1 = 0, data2 = 0, data3 = 0;
  ResponsePart main;
  bool wide = false;
  ResponsePart sub;
};

CommandView view_of_command(Bytes block, BlockSize size);
ResponseView view_of_response(Bytes block, BlockSize size);

}  // namespace servotrace::rtex
