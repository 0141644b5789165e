// SPDX-License-Identifier: MIT
// The keys of [limits] with their range; the unit stands in the key. moving_speed stands apart: it has no default of
// its own.
#pragma once

#include <cstdint>
#include <string_view>

#include "decoder/pipeline/settings.hpp"

namespace servotrace::replay {

struct LimitRow {
  std::string_view key;
  std::int64_t Limits::*member;
  std::int64_t minimum;
  std::int64_t maximum;
};

inline constexpr std::int64_t kDayMs = 86'400'000;
inline constexpr std::int64_t kDefaultMovingSpeed = 30;  // r/min, where Pr7.25 is not 1

inline constexpr LimitRow kLimitRows[] = {
    {"echo_ms", &Limits::echo_ms, 1, kDayMs},
    {"busy_ms", &Limits::busy_ms, 1, kDayMs},
    {"busy_long_ms", &Limits::busy_long_ms, 1, kDayMs},
    {"communication_errors", &Limits::communication_errors, 1, 1'000'000},
    {"jitter_percent", &Limits::jitter_percent, 1, 10'000},
    {"timeout_cycles", &Limits::timeout_cycles, 2, 1'000'000},
    {"servo_on_units", &Limits::servo_on_units, 0, INT32_MAX},
    {"inhibit_units", &Limits::inhibit_units, 0, INT32_MAX},
    {"dead_band_units", &Limits::dead_band_units, 0, INT32_MAX},
    {"mode_change_velocity_percent", &Limits::mode_change_velocity_percent, 0, 10'000},
    {"torque_limited_ms", &Limits::torque_limited_ms, 0, kDayMs},
    {"eeprom_writes_per_hour", &Limits::eeprom_writes_per_hour, 0, 1'000'000},
    {"explicit_response_ms", &Limits::explicit_response_ms, 1, kDayMs},
    {"epr_factor", &Limits::epr_factor, 1, 1000},
    {"poll_echo_count", &Limits::poll_echo_count, 1, 1000},
    {"prm_ack_ms", &Limits::prm_ack_ms, 1, kDayMs},
    {"prm_ack_long_ms", &Limits::prm_ack_long_ms, 1, kDayMs},
    {"start_seen_ms", &Limits::start_seen_ms, 1, kDayMs},
    {"handshake_ms", &Limits::handshake_ms, 1, kDayMs},
    {"fragment_ms", &Limits::fragment_ms, 1, kDayMs},
    {"fragment_ack_ms", &Limits::fragment_ack_ms, 1, kDayMs},
    {"first_io_ms", &Limits::first_io_ms, 1, kDayMs},
    {"flash_writes_per_hour", &Limits::flash_writes_per_hour, 0, 1'000'000},
};

}  // namespace servotrace::replay
