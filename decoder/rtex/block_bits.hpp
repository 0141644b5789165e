// SPDX-License-Identifier: MIT
// The bits of a block as the short cut looks at them.
#pragma once

#include "decoder/rtex/views.hpp"

namespace servotrace::rtex::bits {

inline constexpr Slot kCounter = slot(kCommand, "update_counter");
inline constexpr Slot kEcho = slot(kResponse, "update_counter_echo");
static_assert(kCounter.first_byte == kEcho.first_byte && kCounter.shift == kEcho.shift &&
              kCounter.width == kEcho.width);
inline constexpr Slot kCode = slot(kCommand, "non_cyclic_command");
inline constexpr Slot kCodeEcho = slot(kResponse, "non_cyclic_command_echo");
static_assert(kCode.first_byte == kCodeEcho.first_byte && kCode.shift == kCodeEcho.shift &&
              kCode.width == kCodeEcho.width);

constexpr unsigned shift_of(Slot field) { return 8U * field.first_byte + field.shift; }
constexpr std::uint64_t mask_of(Slot field) { return ((std::uint64_t{1} << field.width) - 1) << shift_of(field); }
inline constexpr std::uint64_t kAll = ~std::uint64_t{0};
inline constexpr std::uint64_t kFirst = 0xFFFFFFFFU;  // the first four bytes of a word
static_assert(kData1At == 4 && kData2At == 8 && kSubHeaderAt == 16 && kSubData2At == 24);

constexpr std::uint8_t counter_of(std::uint64_t first_word) {
  return static_cast<std::uint8_t>((first_word & mask_of(kCounter)) >> shift_of(kCounter));
}

constexpr bool is_monitor(std::uint8_t code) { return code == static_cast<std::uint8_t>(NonCyclic::kMonitor); }
constexpr bool is_monitor_or_none(std::uint8_t code) { return code == 0 || is_monitor(code); }

constexpr std::uint8_t code_of(std::uint64_t first_word) {
  return static_cast<std::uint8_t>((first_word & mask_of(kCode)) >> shift_of(kCode));
}
inline constexpr Slot kSubCode = slot(kSubCommand, "command");
inline constexpr Slot kSubEcho = slot(kSubResponse, "command_echo");
static_assert(kSubCode.first_byte == kSubEcho.first_byte && kSubCode.shift == 0 && kSubEcho.shift == 0 &&
              kSubCode.width == kSubEcho.width);
constexpr std::uint8_t sub_code_of(std::uint64_t third_word) {
  return static_cast<std::uint8_t>(third_word & mask_of(kSubCode));
}

// Bits in which two blocks differ; the counter is none.
[[gnu::always_inline]] inline BlockWords changes(const BlockWords& left, const BlockWords& right) {
  return {(left[0] ^ right[0]) & ~mask_of(kCounter), left[1] ^ right[1], left[2] ^ right[2], left[3] ^ right[3]};
}
[[gnu::always_inline]] inline bool any(const BlockWords& changes, const BlockWords& among) {
  return ((changes[0] & among[0]) | (changes[1] & among[1]) | (changes[2] & among[2]) | (changes[3] & among[3])) != 0;
}

inline constexpr BlockWords kEveryBit = {kAll, kAll, kAll, kAll};
// What has to stay as it is where the channels hold nothing but monitor commands.
inline constexpr BlockWords kOpenCommand = {
    kFirst & ~mask_of(kCode), 0, mask_of(slot(kSubCommand, "unused_16_4")) | mask_of(slot(kSubCommand, "sub_chk")), 0};
inline constexpr BlockWords kOpenResponse = {kFirst & ~mask_of(kCode), 0, mask_of(slot(kSubResponse, "cmd_err")), 0};

}  // namespace servotrace::rtex::bits
