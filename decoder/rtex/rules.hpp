// SPDX-License-Identifier: MIT
// Block RX: the rules of RTEX, in the order of their ids: one file a block in rules/. The row is the only place where a
// rule is described; its check stands in the checks_*.cpp file of its block.
#pragma once

#include <algorithm>
#include <array>

#include "decoder/rtex/rules/counter.hpp"
#include "decoder/rtex/rules/handshake.hpp"
#include "decoder/rtex/rules/homing.hpp"
#include "decoder/rtex/rules/mode.hpp"
#include "decoder/rtex/rules/parameter.hpp"
#include "decoder/rtex/rules/report.hpp"
#include "decoder/rtex/rules/ring.hpp"
#include "decoder/rtex/rules/safety.hpp"

namespace servotrace::rtex {

namespace detail {
template <class... Blocks>
consteval auto join_blocks(const Blocks&... blocks) {
  std::array<RtexRule, (std::tuple_size_v<Blocks> + ...)> all{};
  auto next = all.begin();
  ((next = std::copy(blocks.begin(), blocks.end(), next)), ...);
  return all;
}
}  // namespace detail

inline constexpr auto kRules = detail::join_blocks(kRingRules, kCounterRules, kHandshakeRules, kModeRules, kHomingRules,
                                                   kParameterRules, kSafetyRules, kReportRules);

}  // namespace servotrace::rtex
