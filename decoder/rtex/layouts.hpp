// SPDX-License-Identifier: MIT
// Layouts of RTEX data blocks (SX-DSV02203 chapters 4 and 6).
#pragma once

#include <span>

#include "decoder/core/layout_check.hpp"

namespace servotrace::rtex {

// Every layout of this protocol, the record header's included.
std::span<const Layout* const> layouts();
// Fields no single frame holds.
std::span<const Field* const> derived();

}  // namespace servotrace::rtex
