// SPDX-License-Identifier: MIT
// Motion in whole numbers, the same on every machine: positions in millionths of a command unit, speeds in millionths
// of a command unit a second.
#pragma once

#include <algorithm>
#include <cstdint>

#include "decoder/core/time.hpp"

namespace servotrace::simulator::ring {

inline constexpr std::int64_t kMicro = 1'000'000;

// A point that accelerates and brakes at fixed rates.
struct Ramp {
  std::int64_t position = 0;
  std::int64_t speed = 0;

  // One step toward rest at `target`: no faster than `cruise`; rates in command units a second squared.
  void toward(std::int64_t target, std::int64_t cruise, std::int64_t acceleration, std::int64_t deceleration,
              DurationNs step_ns) {
    const std::int64_t up = change(acceleration, step_ns);
    const std::int64_t down = change(deceleration, step_ns);
    const std::int64_t way = target - position;
    const int sign = way < 0 ? -1 : 1;
    std::int64_t forward = speed * sign;
    if (forward < 0) {
      forward = std::min<std::int64_t>(forward + down, 0);
    } else if (forward > cruise) {
      forward = std::max(forward - down, cruise);
    } else if (stopping(forward, deceleration) + distance(forward, step_ns) >= way * sign) {
      forward = std::max(forward - down, std::min(down, cruise));
    } else {
      forward = std::min(forward + up, cruise);
    }
    const std::int64_t step = distance(forward, step_ns);
    if (forward >= 0 && step >= way * sign && forward <= 2 * down) {
      position = target;
      speed = 0;
      return;
    }
    position += step * sign;
    speed = forward * sign;
  }

  // One step toward a speed.
  void to_speed(std::int64_t wanted, std::int64_t rate, DurationNs step_ns) {
    const std::int64_t most = change(rate, step_ns);
    speed += std::clamp(wanted - speed, -most, most);
    position += distance(speed, step_ns);
  }

  bool rests_at(std::int64_t target) const { return position == target && speed == 0; }

  static std::int64_t change(std::int64_t rate, DurationNs step_ns) {
    return std::max<std::int64_t>(rate * step_ns / 1000, 1);
  }
  static std::int64_t distance(std::int64_t speed_micro, DurationNs step_ns) {
    return speed_micro / 1000 * step_ns / 1'000'000;
  }
  static std::int64_t stopping(std::int64_t speed_micro, std::int64_t rate) {
    const std::int64_t units = speed_micro / kMicro;
    return units * units * 1000 / (2 * std::max<std::int64_t>(rate, 1)) * 1000;
  }
};

}  // namespace servotrace::simulator::ring
