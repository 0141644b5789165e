// SPDX-License-Identifier: MIT
// An invented third drive: the folder a new profile brings. Speed and a running bit in three bytes; a Reset stops it.
#pragma once

#include "decoder/profiles/profile.hpp"

namespace servotrace::spindle {

inline constexpr Field kStatusFields[] = {
    {.key = "speed",
     .label = "Speed",
     .first_bit = at(0),
     .width = 16,
     .role = Role::kSignal,
     .unit = Unit::kRevolutionsPerMinute,
     .section = "invented 1"},
    {.key = "runs", .label = "Runs", .first_bit = at(2), .width = 1, .kind = Kind::kBool, .section = "invented 1"},
    {.key = "reserved",
     .label = "(reserved)",
     .first_bit = at(2, 1),
     .width = 7,
     .reserved = true,
     .section = "invented 1"},
};
inline constexpr Layout kStatus{.protocol = "spindle",
                                .key = "status",
                                .title = "Status",
                                .size = 3,
                                .fields = kStatusFields,
                                .section = "invented 1"};
inline constexpr const Layout* kLayouts[] = {&kStatus};
inline constexpr std::uint16_t kVendorIds[] = {0x0EEE};

std::unique_ptr<DriveSession> make_session(const Settings& settings, const NodeRef& node, OwnerId owner,
                                           bool decode_only);

inline constexpr DriveProfile kProfile{.key = "invented-spindle",
                                       .title = "Invented spindle",
                                       .protocol = "spindle",
                                       .command_size = 1,
                                       .response_size = 3,
                                       .vendor_ids = kVendorIds,
                                       .product_code = 7,
                                       .layouts = kLayouts,
                                       .make_session = &make_session};

}  // namespace servotrace::spindle
