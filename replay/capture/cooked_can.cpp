// SPDX-License-Identifier: MIT
#include "replay/capture/cooked_can.hpp"

#include <algorithm>

#include "decoder/link/socketcan.hpp"

namespace servotrace::replay {

Bytes as_little_endian(const RawFrame& frame, std::vector<std::uint8_t>& storage) {
  const bool cooked = frame.link_type == LinkType::kLinuxSll || frame.link_type == LinkType::kLinuxSll2;
  if (!cooked || frame.file_order == ByteOrder::kLittle) return frame.bytes;
  const can::Place place = can::find_frame(frame);
  constexpr std::size_t kIdentifier = 4;  // bytes
  if (!place.found || frame.bytes.size() < place.header_offset + kIdentifier) return frame.bytes;
  storage.assign(frame.bytes.begin(), frame.bytes.end());
  const auto first = storage.begin() + place.header_offset;
  std::reverse(first, first + kIdentifier);
  return storage;
}

}  // namespace servotrace::replay
