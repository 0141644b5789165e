// SPDX-License-Identifier: MIT
// The drive profiles there are: one line a profile (and its include). The catalogue takes their rules from here, the
// DeviceNet stage and the plugin everything else.
#pragma once

#include "decoder/profiles/nsk_esb/rules.hpp"
#include "decoder/profiles/profile_list.hpp"
#include "decoder/profiles/yaskawa_ns310/rules.hpp"

namespace servotrace {

using Profiles = ProfileList<  //
    ns310::Profile,            //
    esb::Profile>;

inline auto profiles() { return Profiles::rows(); }

}  // namespace servotrace
