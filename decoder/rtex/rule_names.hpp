// SPDX-License-Identifier: MIT
// The words of the RX rules' arguments.
#pragma once

#include <array>

#include "decoder/rtex/alarms.hpp"
#include "decoder/rtex/codes.hpp"
#include "decoder/rtex/parameters.hpp"

namespace servotrace::rtex {

inline constexpr ValueName kChannelNames[] = {{0, "main"}, {1, "sub"}};
inline constexpr ValueName kSinceNames[] = {{0, "rises"}, {1, "is set in the first response of the capture"}};
// Argument values of RX902 where the code was not read.
inline constexpr std::int64_t kSubUnknown = -1;
inline constexpr auto kAlarmCodeNames = [] {
  auto names = std::to_array(kAlarmMainNames);
  names[0].name = "code not read";
  return names;
}();
inline constexpr auto kWarningCodeNames = [] {
  auto names = std::to_array(kWarningNames);
  names[0].name = "not read";
  return names;
}();
inline constexpr ValueName kTimingNames[] = {{0, "toggles"}, {1, "has not toggled"}};
inline constexpr ValueName kProfileValues[] = {{0, "TPOS"}, {1, "TSPD"}, {2, "Monitor_Sel"}};
inline constexpr ValueName kSoftwareLimits[] = {{1, "PSL"}, {2, "NSL"}, {3, "PSL or NSL"}};
inline constexpr ValueName kInhibitInputs[] = {{-1, "NOT"}, {1, "POT"}};
inline constexpr ValueName kForbiddenBeside[] = {
    {0, "at all"},
    {pr(7, 11), "beside Pr7.11"},
    {pr(7, 12), "beside Pr7.12"},
    {pr(7, 35), "beside Pr7.35"},
    {pr(7, 36), "beside Pr7.36"},
    {pr(7, 37), "beside Pr7.37"},
};
inline constexpr ValueName kMissingKinds[] = {
    {0, "no response record on consecutive cycles"},
    {1, "the response block is all zero"},
    {2, "the response block stays byte for byte the same while Update_Counter moves"},
};

}  // namespace servotrace::rtex
