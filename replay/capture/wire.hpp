// SPDX-License-Identifier: MIT
// Whole numbers in capture file headers (never of packets: those are read through core/slot.hpp). `swap`: the file's
// byte order is not this machine's.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>

#include "decoder/core/bytes.hpp"

namespace servotrace::replay {

inline constexpr bool kNativeIsLittle = std::endian::native == std::endian::little;

inline std::uint16_t load16(const std::uint8_t* from, bool swap) {
  std::uint16_t value = 0;
  std::memcpy(&value, from, sizeof value);
  return swap ? __builtin_bswap16(value) : value;
}
inline std::uint32_t load32(const std::uint8_t* from, bool swap) {
  std::uint32_t value = 0;
  std::memcpy(&value, from, sizeof value);
  return swap ? __builtin_bswap32(value) : value;
}
inline std::uint64_t load64(const std::uint8_t* from, bool swap) {
  std::uint64_t value = 0;
  std::memcpy(&value, from, sizeof value);
  return swap ? __builtin_bswap64(value) : value;
}

inline ByteOrder order_of(bool swap) { return swap == kNativeIsLittle ? ByteOrder::kBig : ByteOrder::kLittle; }

}  // namespace servotrace::replay
