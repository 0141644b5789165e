// SPDX-License-Identifier: MIT
// The fields of RTEX data blocks (SX-DSV02203 4-2 to 4-5) as the simulators fill and read them.
#pragma once

#include <cstdint>

#include "decoder/core/slot.hpp"
#include "decoder/link/rtex_record.hpp"
#include "decoder/rtex/layouts.hpp"

namespace servotrace::simulator::ring {

namespace layout = servotrace::rtex;

inline constexpr std::size_t kBlock = servotrace::rtex::kBlockSize;          // bytes
inline constexpr std::size_t kWideBlock = servotrace::rtex::kWideBlockSize;  // bytes

// The slot of a word's field, in the whole block.
constexpr Slot in_block(Slot slot, unsigned word) {
  slot.first_byte = static_cast<std::uint16_t>(slot.first_byte + 4U * word);
  return slot;
}
constexpr Slot signed_word(Slot slot, unsigned word) {
  slot = in_block(slot, word);
  slot.is_signed = true;
  return slot;
}
// A slot and the one in the bits above it, as one number.
constexpr Slot joined(Slot low, Slot high) {
  low.width = static_cast<std::uint8_t>(low.width + high.width);
  low.byte_count = static_cast<std::uint8_t>((low.shift + low.width + 7U) / 8U);
  return low;
}
constexpr Slot whole_byte(unsigned byte) { return Slot{static_cast<std::uint16_t>(byte), 1, 0, 8}; }

// Writes the value's low bits: what a controller does with a position that wraps.
inline void put(Slot slot, MutableBytes block, std::int64_t value) {
  const std::uint64_t mask = slot.width >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << slot.width) - 1;
  slot.is_signed = false;
  [[maybe_unused]] const bool written =
      write(slot, block, static_cast<std::int64_t>(static_cast<std::uint64_t>(value) & mask));
  assert(written);
}
inline std::int64_t get(Slot slot, Bytes block) { return read(slot, block); }
inline bool flag(Slot slot, Bytes block) { return read(slot, block) != 0; }

namespace command {
inline constexpr Slot kMacId = slot(layout::kCommand, "mac_id");
inline constexpr Slot kUpdateCounter = slot(layout::kCommand, "update_counter");
inline constexpr Slot kCr = slot(layout::kCommand, "cr");
inline constexpr Slot kNonCyclic = slot(layout::kCommand, "non_cyclic_command");
inline constexpr Slot kCyclic = slot(layout::kCommand, "cyclic_command");
inline constexpr Slot kCode = joined(kNonCyclic, kCyclic);
inline constexpr Slot kTmgCnt = slot(layout::kCommand, "tmg_cnt");
inline constexpr Slot kHomingCtrl = slot(layout::kCommand, "homing_ctrl");
inline constexpr Slot kTlSw = slot(layout::kCommand, "tl_sw");
inline constexpr Slot kGainSw = slot(layout::kCommand, "gain_sw");
inline constexpr Slot kServoOn = slot(layout::kCommand, "servo_on");
inline constexpr Slot kExOut1 = slot(layout::kCommand, "ex_out1");
inline constexpr Slot kExOut2 = slot(layout::kCommand, "ex_out2");
inline constexpr Slot kSlSw = slot(layout::kCommand, "sl_sw");
inline constexpr Slot kPause = slot(layout::kCommand, "pause");
inline constexpr Slot kSmoothStop = slot(layout::kCommand, "smooth_stop");
inline constexpr Slot kHardStop = slot(layout::kCommand, "hard_stop");
inline constexpr Slot kData1 = signed_word(slot(layout::kRawData1, "command_data1"), 1);
inline constexpr Slot kTypeCode = in_block(slot(layout::kMonitor, "type_code"), 2);
inline constexpr Slot kIndex = in_block(slot(layout::kMonitor, "index"), 2);
inline constexpr Slot kData3 = signed_word(slot(layout::kSettingData, "setting_data"), 3);
inline constexpr Slot kSubCode = in_block(slot(layout::kSubCommand, "command"), 4);
inline constexpr Slot kSubChk = in_block(slot(layout::kSubCommand, "sub_chk"), 4);
inline constexpr Slot kSubTypeCode = in_block(slot(layout::kSubCommand, "type_code"), 4);
inline constexpr Slot kSubIndex = in_block(slot(layout::kSubCommand, "index"), 4);
inline constexpr Slot kSubData1 = signed_word(slot(layout::kSubData1, "sub_command_data1"), 5);
inline constexpr Slot kSubData2 = signed_word(slot(layout::kSubData2, "sub_command_data2"), 6);
inline constexpr Slot kSubData3 = signed_word(slot(layout::kSubData3, "sub_command_data3"), 7);
}  // namespace command

namespace response {
inline constexpr Slot kMacId = slot(layout::kResponse, "mac_id");
inline constexpr Slot kCounterEcho = slot(layout::kResponse, "update_counter_echo");
inline constexpr Slot kCr = slot(layout::kResponse, "cr");
inline constexpr Slot kCodeEcho =
    joined(slot(layout::kResponse, "non_cyclic_command_echo"), slot(layout::kResponse, "cyclic_command_echo"));
inline constexpr Slot kCmdError = slot(layout::kResponse, "cmd_error");
inline constexpr Slot kInPosition = slot(layout::kResponse, "in_position");
inline constexpr Slot kInProgress = slot(layout::kResponse, "in_progress");
inline constexpr Slot kHomingComplete = slot(layout::kResponse, "homing_complete");
inline constexpr Slot kTorqueLimited = slot(layout::kResponse, "torque_limited");
inline constexpr Slot kWarning = slot(layout::kResponse, "warning");
inline constexpr Slot kAlarm = slot(layout::kResponse, "alarm");
inline constexpr Slot kServoReady = slot(layout::kResponse, "servo_ready");
inline constexpr Slot kServoActive = slot(layout::kResponse, "servo_active");
inline constexpr Slot kInputs = whole_byte(3);
inline constexpr Slot kData1 = signed_word(slot(layout::kRawResponse1, "response_data1"), 1);
inline constexpr Slot kData2 = signed_word(slot(layout::kRawResponse2, "response_data2"), 2);
inline constexpr Slot kErrorCode = in_block(slot(layout::kError, "error_code"), 2);
inline constexpr Slot kTypeLow = in_block(slot(layout::kHomingEcho, "type_code_echo"), 2);
inline constexpr Slot kLatchComp1 = in_block(slot(layout::kProfileEcho, "latch_comp1"), 2);
inline constexpr Slot kLatchComp2 = in_block(slot(layout::kHomingEcho, "latch_comp2"), 2);
inline constexpr Slot kNear = in_block(slot(layout::kProfileEcho, "near"), 2);
inline constexpr Slot kPsl = in_block(slot(layout::kProfileEcho, "psl"), 2);
inline constexpr Slot kNsl = in_block(slot(layout::kProfileEcho, "nsl"), 2);
inline constexpr Slot kPslSwapped = in_block(slot(layout::kProfileEchoSwapped, "psl"), 2);
inline constexpr Slot kNslSwapped = in_block(slot(layout::kProfileEchoSwapped, "nsl"), 2);
inline constexpr Slot kType = in_block(slot(layout::kMonitorEcho, "type_code_echo"), 2);
inline constexpr Slot kBusy = in_block(slot(layout::kMonitorEcho, "busy"), 2);
inline constexpr Slot kWng = in_block(slot(layout::kMonitorEcho, "wng"), 2);
inline constexpr Slot kErr = in_block(slot(layout::kMonitorEcho, "err"), 2);
inline constexpr Slot kIndexEcho = in_block(slot(layout::kMonitorEcho, "index_echo"), 2);
inline constexpr Slot kData3 = signed_word(slot(layout::kRawResponse3, "response_data3"), 3);
inline constexpr Slot kSubCodeEcho = in_block(slot(layout::kSubResponse, "command_echo"), 4);
inline constexpr Slot kSubBusy = in_block(slot(layout::kSubResponse, "busy"), 4);
inline constexpr Slot kSubWng = in_block(slot(layout::kSubResponse, "wng"), 4);
inline constexpr Slot kSubErr = in_block(slot(layout::kSubResponse, "err"), 4);
inline constexpr Slot kSubCmdError = in_block(slot(layout::kSubResponse, "cmd_err"), 4);
inline constexpr Slot kSubTypeEcho = in_block(slot(layout::kSubResponse, "type_code_echo"), 4);
inline constexpr Slot kSubIndexEcho = in_block(slot(layout::kSubResponse, "index_echo"), 4);
inline constexpr Slot kSubErrorCode = in_block(slot(layout::kSubError, "error_code"), 4);
inline constexpr Slot kSubData1 = signed_word(slot(layout::kSubRaw1, "sub_response_data1"), 5);
inline constexpr Slot kSubData2 = signed_word(slot(layout::kSubRaw2, "sub_response_data2"), 6);
inline constexpr Slot kSubData3 = signed_word(slot(layout::kSubRaw3, "sub_response_data3"), 7);
}  // namespace response

// Cyclic codes, 4-2-1.
inline constexpr int kNoOperation = 0;
inline constexpr int kPp = 1;
inline constexpr int kCp = 2;
inline constexpr int kCv = 3;
inline constexpr int kCt = 4;

// Non-cyclic codes, 4-2-1.
inline constexpr int kNormalCommand = 0;
inline constexpr int kResetCommand = 1;
inline constexpr int kSystemIdCommand = 2;
inline constexpr int kHomingCommand = 4;
inline constexpr int kAlarmCommand = 5;
inline constexpr int kParameterCommand = 6;
inline constexpr int kProfileCommand = 7;
inline constexpr int kMonitorCommand = 10;

}  // namespace servotrace::simulator::ring
