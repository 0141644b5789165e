// SPDX-License-Identifier: MIT
// [rtex.log] as a part of the settings.
#pragma once

#include "replay/settings/rtex_log_map.hpp"
#include "replay/settings/toml_reader.hpp"

namespace servotrace::replay {

RtexLogMap read_log_table(const toml::table& source, TomlErrors& errors);

// One of the four communication cycles (2-5-1), within 2 %.
std::optional<DurationNs> nearest_cycle_ns(double cycle_us);

}  // namespace servotrace::replay
