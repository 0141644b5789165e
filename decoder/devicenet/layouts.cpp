// SPDX-License-Identifier: MIT
#include "decoder/devicenet/layouts.hpp"

namespace servotrace::devicenet {

std::span<const Layout* const> layouts() { return {}; }
std::span<const Field* const> derived() { return {}; }

}  // namespace servotrace::devicenet
