// SPDX-License-Identifier: MIT
// The drive profile nsk-esb.
#pragma once

#include "decoder/profiles/nsk_esb/derived.hpp"
#include "decoder/profiles/nsk_esb/layouts.hpp"
#include "decoder/profiles/profile.hpp"

namespace servotrace::esb {

std::unique_ptr<DriveSession> make_session(const Settings& settings, const NodeRef& node, OwnerId owner,
                                           bool decode_only);

inline constexpr DriveProfile kProfile{
    .key = "nsk-esb",
    .title = "NSK Megatorque ESB",
    .protocol = "esb",
    .command_size = 10,
    .response_size = 10,
    .layouts = kLayouts,
    .derived = kDerived,
    .make_session = &make_session,
};

}  // namespace servotrace::esb
