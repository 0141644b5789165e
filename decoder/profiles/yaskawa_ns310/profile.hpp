// SPDX-License-Identifier: MIT
// The drive profile yaskawa-ns310.
#pragma once

#include "decoder/profiles/profile.hpp"
#include "decoder/profiles/yaskawa_ns310/layouts.hpp"

namespace servotrace::ns310 {

std::unique_ptr<DriveSession> make_session(const Settings& settings, const NodeRef& node, OwnerId owner,
                                           bool decode_only);

inline constexpr DriveProfile kProfile{
    .key = "yaskawa-ns310",
    .title = "Yaskawa SGDH with NS310",
    .command_size = 8,
    .response_size = 8,
    .layouts = kLayouts,
    .make_session = &make_session,
};

}  // namespace servotrace::ns310
