// SPDX-License-Identifier: MIT
#include "captures/simulator/can_frame.hpp"

#include <algorithm>

namespace servotrace::simulator {
namespace {

constexpr std::uint32_t kExtendedFlag = 0x80000000U;
constexpr std::uint32_t kRemoteFlag = 0x40000000U;
constexpr std::uint32_t kErrorFlag = 0x20000000U;
constexpr unsigned kErrorFrameBits = 6 + 8 + 3;
// CRC delimiter, acknowledge slot and delimiter, end of frame, intermission: never stuffed.
constexpr unsigned kTailBits = 1 + 2 + 7 + 3;

// Counts the bits of the stuffed part and forms its CRC.
class WireCounter {
 public:
  void put(bool bit) {
    const bool invert = bit != ((crc_ >> 14U & 1U) != 0);
    crc_ = crc_ << 1U & 0x7FFFU;
    if (invert) crc_ ^= 0x4599U;
    count(bit);
  }
  void put(std::uint32_t value, unsigned width) {
    for (unsigned i = width; i > 0; --i) put((value >> (i - 1U) & 1U) != 0);
  }
  unsigned finish() {
    const std::uint32_t crc = crc_;
    for (unsigned i = 15; i > 0; --i) count((crc >> (i - 1U) & 1U) != 0);
    return bits_ + kTailBits;
  }

 private:
  void count(bool bit) {
    ++bits_;
    run_ = bit == last_ ? run_ + 1 : 1;
    last_ = bit;
    if (run_ == 5) {  // a bit of the other value is put in, and starts a run of its own
      ++bits_;
      last_ = !bit;
      run_ = 1;
    }
  }
  std::uint32_t crc_ = 0;
  unsigned bits_ = 0;
  unsigned run_ = 0;
  bool last_ = true;
};

}  // namespace

CanFrame can_frame(std::uint32_t identifier, Bytes payload) {
  CanFrame frame;
  frame.identifier = identifier;
  frame.length = static_cast<std::uint8_t>(std::min<std::size_t>(payload.size(), 8));
  std::copy_n(payload.begin(), frame.length, frame.data.begin());
  return frame;
}

unsigned wire_bits(const CanFrame& frame) {
  if (frame.error) return kErrorFrameBits;
  WireCounter wire;
  wire.put(false);
  if (frame.extended) {
    wire.put(frame.identifier >> 18U, 11);
    wire.put(0b11, 2);
    wire.put(frame.identifier & 0x3FFFFU, 18);
    wire.put(frame.remote);
    wire.put(0, 2);
  } else {
    wire.put(frame.identifier, 11);
    wire.put(frame.remote);
    wire.put(0, 2);
  }
  wire.put(frame.length, 4);
  for (const std::uint8_t byte : frame.payload()) wire.put(byte, 8);
  return wire.finish();
}

std::vector<std::uint8_t> socketcan_bytes(const CanFrame& frame) {
  std::vector<std::uint8_t> bytes(16, 0);
  std::uint32_t word = frame.identifier;
  if (frame.extended) word |= kExtendedFlag;
  if (frame.remote) word |= kRemoteFlag;
  if (frame.error) word |= kErrorFlag;
  for (unsigned i = 0; i < 4; ++i) bytes[i] = static_cast<std::uint8_t>(word >> (24U - 8U * i) & 0xFFU);
  bytes[4] = frame.length;
  if (!frame.remote) std::copy_n(frame.data.begin(), frame.length, bytes.begin() + 8);
  return bytes;
}

}  // namespace servotrace::simulator
