// SPDX-License-Identifier: MIT
// Views of bytes. A view never owns: it lives as long as the buffer it was taken from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace servotrace {

using Bytes = std::span<const std::uint8_t>;
using MutableBytes = std::span<std::uint8_t>;

enum class ByteOrder : std::uint8_t { kLittle, kBig };

}  // namespace servotrace
