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
inline constexpr Field kBlockAttribute{.key = "block_attribute",
                                       .label = "Command block attribute",
                                       .kind = Kind::kText,
                                       .section = "SIE-C718-7 5.5.2",
                                       .explanation = "What a single attribute means in the block's command."};
// What Table C.1 and chapter 9 say of the alarm code of a response.
inline constexpr Field kAlarmSgdhText{
    .key = "alarm_sgdh", .label = "SGDH alarms behind it", .kind = Kind::kText, .section = "SIE-C718-7 C.1"};
inline constexpr Field kAlarmIndicatorText{
    .key = "alarm_indicator", .label = "Indicator", .kind = Kind::kText, .section = "SIE-C718-7 C.1"};
inline constexpr Field kAlarmCausesText{
    .key = "alarm_causes", .label = "Causes", .kind = Kind::kText, .section = "SIE-C718-7 9"};
inline constexpr Field kAlarmRemediesText{
    .key = "alarm_remedies", .label = "Remedies", .kind = Kind::kText, .section = "SIE-C718-7 9"};
inline constexpr const Field* kDerived[] = {&kBlockListing,       &kBlockAttribute,  &kAlarmSgdhText,
                                            &kAlarmIndicatorText, &kAlarmCausesText, &kAlarmRemediesText};

}  // namespace servotrace::ns310
