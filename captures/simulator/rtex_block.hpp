// SPDX-License-Identifier: MIT
// The fields of RTEX data blocks (SX-DSV02203 4-2 to 4-5) as the simulators fill and read them.
#pragma once

#include <cstdint>

#include "decoder/core/layout.hpp"
#include "decoder/core/slot.hpp"

namespace servotrace::simulator::ring {

inline constexpr std::size_t kBlock = 16;      // bytes
inline constexpr std::size_t kWideBlock = 32;  // bytes

constexpr Slot bits(unsigned byte, unsigned bit, unsigned width, bool is_signed = false) {
  return Slot{static_cast<std::uint16_t>(byte), static_cast<std::uint8_t>((bit + width + 7U) / 8U),
              static_cast<std::uint8_t>(bit), static_cast<std::uint8_t>(width), is_signed};
}

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
inline constexpr Slot kMacId = bits(0, 0, 5);
inline constexpr Slot kUpdateCounter = bits(0, 5, 2);
inline constexpr Slot kCr = bits(0, 7, 1);
inline constexpr Slot kCode = bits(1, 0, 7);  // cyclic and non-cyclic
inline constexpr Slot kNonCyclic = bits(1, 0, 4);
inline constexpr Slot kCyclic = bits(1, 4, 3);
inline constexpr Slot kTmgCnt = bits(1, 7, 1);
inline constexpr Slot kHomingCtrl = bits(2, 2, 1);
inline constexpr Slot kTlSw = bits(2, 3, 1);
inline constexpr Slot kGainSw = bits(2, 4, 1);
inline constexpr Slot kServoOn = bits(2, 7, 1);
inline constexpr Slot kExOut1 = bits(3, 0, 1);
inline constexpr Slot kExOut2 = bits(3, 1, 1);
inline constexpr Slot kSlSw = bits(3, 3, 1);
inline constexpr Slot kPause = bits(3, 5, 1);
inline constexpr Slot kSmoothStop = bits(3, 6, 1);
inline constexpr Slot kHardStop = bits(3, 7, 1);
inline constexpr Slot kData1 = bits(4, 0, 32, true);
inline constexpr Slot kTypeCode = bits(8, 0, 12);  // 6-3 to 6-9: byte 8 and the low half of byte 9
inline constexpr Slot kIndex = bits(10, 0, 16);
inline constexpr Slot kData3 = bits(12, 0, 32, true);
inline constexpr Slot kSubCode = bits(16, 0, 4);
inline constexpr Slot kSubChk = bits(16, 7, 1);
inline constexpr Slot kSubTypeCode = bits(17, 0, 8);
inline constexpr Slot kSubIndex = bits(18, 0, 16);
inline constexpr Slot kSubData1 = bits(20, 0, 32, true);
inline constexpr Slot kSubData2 = bits(24, 0, 32, true);
inline constexpr Slot kSubData3 = bits(28, 0, 32, true);
}  // namespace command

namespace response {
inline constexpr Slot kMacId = bits(0, 0, 5);
inline constexpr Slot kCounterEcho = bits(0, 5, 2);
inline constexpr Slot kCr = bits(0, 7, 1);
inline constexpr Slot kCodeEcho = bits(1, 0, 7);
inline constexpr Slot kCmdError = bits(1, 7, 1);
inline constexpr Slot kInPosition = bits(2, 0, 1);
inline constexpr Slot kInProgress = bits(2, 1, 1);
inline constexpr Slot kHomingComplete = bits(2, 2, 1);
inline constexpr Slot kTorqueLimited = bits(2, 3, 1);
inline constexpr Slot kWarning = bits(2, 4, 1);
inline constexpr Slot kAlarm = bits(2, 5, 1);
inline constexpr Slot kServoReady = bits(2, 6, 1);
inline constexpr Slot kServoActive = bits(2, 7, 1);
inline constexpr Slot kInputs = bits(3, 0, 8);
inline constexpr Slot kData1 = bits(4, 0, 32, true);
inline constexpr Slot kData2 = bits(8, 0, 32, true);
inline constexpr Slot kErrorCode = bits(8, 0, 16);
inline constexpr Slot kTypeLow = bits(8, 0, 8);
inline constexpr Slot kTypeHigh = bits(9, 0, 4);  // homing and profile: latch, NEAR, NSL and PSL instead
inline constexpr Slot kBusy = bits(9, 4, 1);
inline constexpr Slot kWng = bits(9, 6, 1);
inline constexpr Slot kErr = bits(9, 7, 1);
inline constexpr Slot kIndexEcho = bits(10, 0, 16);
inline constexpr Slot kData3 = bits(12, 0, 32, true);
inline constexpr Slot kSubCodeEcho = bits(16, 0, 4);
inline constexpr Slot kSubBusy = bits(16, 4, 1);
inline constexpr Slot kSubWng = bits(16, 5, 1);
inline constexpr Slot kSubErr = bits(16, 6, 1);
inline constexpr Slot kSubCmdError = bits(16, 7, 1);
inline constexpr Slot kSubTypeEcho = bits(17, 0, 8);
inline constexpr Slot kSubIndexEcho = bits(18, 0, 16);
inline constexpr Slot kSubData1 = bits(20, 0, 32, true);
inline constexpr Slot kSubData2 = bits(24, 0, 32, true);
inline constexpr Slot kSubData3 = bits(28, 0, 32, true);
}  // namespace response

// Cyclic codes, 4-2-1.
inline constexpr int kNop = 0;
inline constexpr int kPp = 1;
inline constexpr int kCp = 2;
inline constexpr int kCv = 3;
inline constexpr int kCt = 4;

// Non-cyclic codes, 4-2-1.
inline constexpr int kNormal = 0;
inline constexpr int kReset = 1;
inline constexpr int kSystemId = 2;
inline constexpr int kHoming = 4;
inline constexpr int kAlarm = 5;
inline constexpr int kParameter = 6;
inline constexpr int kProfile = 7;
inline constexpr int kMonitor = 10;

}  // namespace servotrace::simulator::ring
