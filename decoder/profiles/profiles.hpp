// SPDX-License-Identifier: MIT
// The drive profiles there are: one line a profile.
#pragma once

#include <array>

#include "decoder/profiles/nsk_esb/profile.hpp"
#include "decoder/profiles/profile.hpp"
#include "decoder/profiles/yaskawa_ns310/profile.hpp"

namespace servotrace {

inline constexpr std::array kProfiles = {
    &ns310::kProfile,
    &esb::kProfile,
};

}  // namespace servotrace
