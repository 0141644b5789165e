// SPDX-License-Identifier: MIT
// Exit statuses: public interface.
#pragma once

#include <algorithm>

namespace servotrace::replay {

inline constexpr int kExitClean = 0;
inline constexpr int kExitFindings = 1;
inline constexpr int kExitFailed = 2;   // usage, configuration, unreadable or unknown input, internal error
inline constexpr int kExitNothing = 3;  // no frame of a known bus

// 2 outranks 1, 1 outranks 3, 3 outranks 0.
constexpr int worse_status(int left, int right) {
  constexpr auto rank = [](int status) {
    constexpr int kRanks[] = {0, 2, 3, 1};
    return status >= 0 && status <= 3 ? kRanks[status] : 3;
  };
  return rank(left) >= rank(right) ? left : right;
}

}  // namespace servotrace::replay
