// SPDX-License-Identifier: MIT
// Layouts of DeviceNet messages (link layer facts: decoder/docs/reference).
#pragma once

#include <span>

#include "decoder/core/layout_check.hpp"

namespace servotrace::devicenet {

std::span<const Layout* const> layouts();
// Fields no single frame holds.
std::span<const Field* const> derived();

}  // namespace servotrace::devicenet
