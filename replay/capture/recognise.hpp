// SPDX-License-Identifier: MIT
// What kind of file this is, by its first bytes.
#pragma once

#include <cstdint>
#include <string>

#include "decoder/core/result.hpp"
#include "replay/capture/input.hpp"

namespace servotrace::replay {

enum class Kind : std::uint8_t { kPcap, kPcapng, kCandump, kAsc, kTrc, kCsv, kGzip, kZstd };

// Looks at the first bytes of `input` and takes none. A kind that is not read is refused by name, with the converter
// that would help; `foreign_capture` is then set where it is a capture all the same.
Result<Kind> recognise(Input& input, const std::string& name, bool* foreign_capture = nullptr);

inline constexpr int kMaxLayers = 2;  // of compression, one in the other

}  // namespace servotrace::replay
