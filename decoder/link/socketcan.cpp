// SPDX-License-Identifier: MIT
#include "decoder/link/socketcan.hpp"

#include "decoder/core/slot.hpp"

namespace servotrace::can {
namespace {

constexpr std::uint32_t kExtendedFlag = 0x80000000U;
constexpr std::uint32_t kRemoteFlag = 0x40000000U;
constexpr std::uint32_t kErrorFlag = 0x20000000U;
constexpr std::size_t kHeader = 8;       // identifier (4), length, flags, two reserved bytes
constexpr std::uint32_t kFdFlag = 0x04;  // in the flags byte
constexpr std::uint32_t kXlFlag = 0x80;  // in the length byte's place
constexpr std::uint32_t kProtocolCan = 0x000C;
constexpr std::uint32_t kProtocolCanFd = 0x000D;
constexpr std::uint32_t kProtocolCanXl = 0x000E;

Place malformed(Place place, capture::Malformed why) {
  place.malformed = true;
  place.why = why;
  return place;
}

}  // namespace

Place find_frame(const RawFrame& raw) {
  Place place;
  const Bytes bytes = raw.bytes;
  std::size_t offset = 0;
  ByteOrder order = ByteOrder::kBig;
  std::uint32_t protocol = kProtocolCan;
  switch (raw.link_type) {
    case LinkType::kCanSocketcan:
      break;
    case LinkType::kLinuxSll:
      if (bytes.size() < 16) return place;
      protocol = load_be(bytes, 14, 2);
      offset = 16;
      order = raw.file_order;
      break;
    case LinkType::kLinuxSll2:
      if (bytes.size() < 20) return place;
      protocol = load_be(bytes, 0, 2);
      place.frame.interface_index = load_be(bytes, 4, 4);
      offset = 20;
      order = raw.file_order;
      break;
    default:
      return place;
  }
  if (protocol != kProtocolCan && protocol != kProtocolCanFd && protocol != kProtocolCanXl) return place;
  place.found = true;
  place.header_offset = static_cast<std::uint32_t>(offset);
  if (protocol == kProtocolCanXl) return malformed(place, capture::Malformed::kCanXl);
  if (protocol == kProtocolCanFd) return malformed(place, capture::Malformed::kCanFd);
  if (bytes.size() < offset + 5) return malformed(place, capture::Malformed::kCanCut);
  const std::uint32_t word = order == ByteOrder::kBig ? load_be(bytes, offset, 4) : load_le(bytes, offset, 4);
  const std::uint32_t length = load_be(bytes, offset + 4, 1);
  const std::uint32_t flags = bytes.size() > offset + 5 ? load_be(bytes, offset + 5, 1) : 0;
  if ((length & kXlFlag) != 0) return malformed(place, capture::Malformed::kCanXl);
  if ((flags & kFdFlag) != 0) return malformed(place, capture::Malformed::kCanFd);
  if (length > 8) return malformed(place, capture::Malformed::kCanLength);
  Frame& frame = place.frame;
  frame.extended = (word & kExtendedFlag) != 0;
  frame.remote = (word & kRemoteFlag) != 0;
  frame.error = (word & kErrorFlag) != 0;
  frame.identifier = word & (frame.extended || frame.error ? 0x1FFFFFFFU : 0x7FFU);
  frame.data_offset = static_cast<std::uint32_t>(offset + kHeader);
  if (frame.remote) return place;  // its length is that of the data asked for
  if (bytes.size() < offset + kHeader + length) return malformed(place, capture::Malformed::kCanCut);
  frame.data = bytes.subspan(offset + kHeader, length);
  return place;
}

}  // namespace servotrace::can
