// SPDX-License-Identifier: MIT
// Since when a state that a drive reports is there; an argument of the rules "what the drive reports".
#pragma once

#include "decoder/core/layout.hpp"

namespace servotrace {

// A state of the first response seen is a note: it is older than what the capture (or the node's start) shows.
enum class Phase : std::uint8_t { kRises, kSinceCaptureBegan, kSinceStart };
inline constexpr ValueName kPhaseNames[] = {
    {0, "now"},
    {1, "since the capture began"},
    {2, "since the node started"},
};

}  // namespace servotrace
