// SPDX-License-Identifier: MIT
// What was measured in a capture, in lines for people: `info`, and `check --statistics`.
#pragma once

#include <string>
#include <string_view>

#include "replay/results.hpp"

namespace servotrace::replay {

// What the columns are.
inline constexpr std::string_view kStatisticColumns = "count, least, mean, 99 % within, most";

// "axis 1 System ID echo: 3, 1.061 ms, 1.062 ms, 1.062 ms, 1.062 ms", without a line end.
std::string statistic_text(const CaptureRecord& capture, const StatisticRecord& statistic);

}  // namespace servotrace::replay
