// SPDX-License-Identifier: MIT
// What no single message of the NS310 holds: command blocks as the program they form.
#pragma once

#include "decoder/core/layout.hpp"

namespace servotrace::ns310 {

inline constexpr Field kBlockListing{
    .key = "block_listing",
    .label = "Command blocks",
    .kind = Kind::kText,
    .section = "SIE-C718-7 5.5",
    .explanation = "A block, or the chain a start begins, as far as the capture shows it."};
inline constexpr const Field* kDerived[] = {&kBlockListing};

}  // namespace servotrace::ns310
