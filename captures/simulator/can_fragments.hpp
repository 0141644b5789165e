// SPDX-License-Identifier: MIT
// Fragments of DeviceNet messages, both kinds (DeviceNet link layer): of I/O data above eight bytes, which nobody
// acknowledges, and of explicit messages, which are acknowledged one by one.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "decoder/core/bytes.hpp"

namespace servotrace::simulator {

using ByteVector = std::vector<std::uint8_t>;

namespace fragment {
inline constexpr std::uint8_t kFirst = 0x00;
inline constexpr std::uint8_t kMiddle = 0x40;
inline constexpr std::uint8_t kLast = 0x80;
inline constexpr std::uint8_t kAcknowledge = 0xC0;
inline constexpr std::uint8_t kTypeMask = 0xC0;
inline constexpr std::uint8_t kCountMask = 0x3F;
}  // namespace fragment

// The frames' payloads of I/O data: seven bytes each behind type and count. An empty message is one empty frame (idle).
std::vector<ByteVector> split_io(Bytes message);
// The frames' payloads of an explicit message: `message` begins with the header byte. One frame where it fits.
std::vector<ByteVector> split_explicit(Bytes message);

// Joins I/O fragments. A fragment that does not follow drops what was there.
class IoAssembler {
 public:
  // The whole message where this payload completes it.
  std::optional<ByteVector> add(Bytes payload);

 private:
  ByteVector message_;
  std::uint8_t next_ = 0;
  bool open_ = false;
};

// Joins explicit fragments and says what to acknowledge.
class ExplicitAssembler {
 public:
  struct Step {
    std::optional<ByteVector> message;  // whole, header first with the fragment bit cleared
    std::optional<ByteVector> acknowledge;
  };
  explicit ExplicitAssembler(std::size_t capacity = 72) : capacity_(capacity) {}
  // Precondition: payload has two bytes at least, and bit 7 of the first is set.
  Step add(Bytes payload);

 private:
  std::size_t capacity_;  // bytes of a message; more is refused with status 1
  ByteVector message_;
  std::uint8_t next_ = 0;
  bool open_ = false;
};

}  // namespace servotrace::simulator
