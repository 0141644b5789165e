// SPDX-License-Identifier: MIT
#include "replay/statistic_text.hpp"

#include <fmt/format.h>

#include "decoder/render/value.hpp"

namespace servotrace::replay {

std::string statistic_text(const CaptureRecord& capture, const StatisticRecord& statistic) {
  const Statistic& values = statistic.values;
  const std::string who = capture.who(statistic.node);
  return fmt::format("{}{}{}: {}, {}, {}, {}, {}", who, who.empty() ? "" : " ", values.key, values.count,
                     duration_text(values.minimum_ns), duration_text(static_cast<DurationNs>(values.mean_ns)),
                     duration_text(values.percentile_99_ns), duration_text(values.maximum_ns));
}

}  // namespace servotrace::replay
