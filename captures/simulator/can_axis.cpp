// SPDX-License-Identifier: MIT
#include "captures/simulator/can_axis.hpp"

#include <algorithm>
#include <cstdlib>

namespace servotrace::simulator {
namespace {

constexpr std::int64_t kMaximumSpeed = 4'000'000;

std::int64_t square_root(std::int64_t value) {
  std::int64_t low = 0;
  std::int64_t high = kMaximumSpeed;
  while (low < high) {
    const std::int64_t middle = (low + high + 1) / 2;
    if (middle * middle <= value) {
      low = middle;
    } else {
      high = middle - 1;
    }
  }
  return low;
}

// `value` moved toward `goal` by at most `step`.
std::int64_t toward(std::int64_t value, std::int64_t goal, std::int64_t step) {
  return value < goal ? std::min(value + step, goal) : std::max(value - step, goal);
}

}  // namespace

void MotionAxis::move_to(std::int64_t target, std::int64_t speed) {
  target_ = target;
  wanted_speed_ = speed;
  mode_ = Mode::kPosition;
}

void MotionAxis::turn(std::int64_t speed) {
  wanted_speed_ = speed;
  mode_ = Mode::kSpeed;
}

void MotionAxis::stop(std::int64_t with_deceleration) {
  if (mode_ == Mode::kStill) return;
  stop_deceleration_ = std::max<std::int64_t>(with_deceleration, 1);
  mode_ = Mode::kStopping;
}

void MotionAxis::halt() {
  mode_ = Mode::kStill;
  speed_milli_ = 0;
  target_ = position();
}

void MotionAxis::set_position(std::int64_t position) {
  position_milli_ = position * 1000;
  halt();
}

void MotionAxis::change_speed(std::int64_t speed) { wanted_speed_ = speed; }

// The speed from which the axis still stops within the distance.
std::int64_t MotionAxis::braking_speed(std::int64_t distance_milli) const {
  return std::max<std::int64_t>(square_root(2 * deceleration * (distance_milli / 1000)), 1000);
}

void MotionAxis::tick() {
  switch (mode_) {
    case Mode::kStill:
      return;
    case Mode::kPosition: {
      const std::int64_t rest = target_ * 1000 - position_milli_;
      const std::int64_t sign = rest < 0 ? -1 : 1;
      const std::int64_t limit = std::min({wanted_speed_, braking_speed(std::abs(rest)), kMaximumSpeed}) * 1000;
      const std::int64_t step = std::abs(speed_milli_) > limit ? INT64_C(1) << 40 : acceleration;
      speed_milli_ = toward(speed_milli_, sign * limit, step);
      if (speed_milli_ * sign >= std::abs(rest) * 1000 || rest == 0) {
        position_milli_ = target_ * 1000;
        halt();
        return;
      }
      break;
    }
    case Mode::kSpeed:
      speed_milli_ = toward(speed_milli_, wanted_speed_ * 1000,
                            std::abs(wanted_speed_ * 1000) > std::abs(speed_milli_) ? acceleration : deceleration);
      if (wanted_speed_ == 0 && speed_milli_ == 0) {
        halt();
        return;
      }
      break;
    case Mode::kStopping:
      speed_milli_ = toward(speed_milli_, 0, stop_deceleration_);
      if (speed_milli_ == 0) {
        halt();
        return;
      }
      break;
  }
  position_milli_ += speed_milli_ / 1000;
}

}  // namespace servotrace::simulator
