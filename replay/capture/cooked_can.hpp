// SPDX-License-Identifier: MIT
// Linux cooked captures hold CAN identifiers in the byte order of their file: what goes into another file may need a
// turn.
#pragma once

#include <cstdint>
#include <vector>

#include "decoder/link/raw_frame.hpp"

namespace servotrace::replay {

// The bytes of `frame` as a little-endian file holds them. `storage` keeps the copy where one is needed; the result
// lives as long as both.
Bytes as_little_endian(const RawFrame& frame, std::vector<std::uint8_t>& storage);

}  // namespace servotrace::replay
