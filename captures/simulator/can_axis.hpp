// SPDX-License-Identifier: MIT
// A motor that follows its commands without error: positions in a drive's own units, in steps of one millisecond, in
// whole numbers, so that every machine computes the same.
#pragma once

#include <cstdint>

#include "decoder/core/time.hpp"

namespace servotrace::simulator {

class MotionAxis {
 public:
  enum class Mode : std::uint8_t { kStill, kPosition, kSpeed, kStopping };

  // Units a second, units a second squared; above 0.
  std::int64_t acceleration = 1'000'000;
  std::int64_t deceleration = 1'000'000;

  void move_to(std::int64_t target, std::int64_t speed);
  void turn(std::int64_t speed);  // signed
  void stop(std::int64_t with_deceleration);
  // Stands still at once (servo off, or a position given a new name).
  void halt();
  void set_position(std::int64_t position);
  void change_speed(std::int64_t speed);  // of a positioning that runs

  // One millisecond passes.
  void tick();

  Mode mode() const { return mode_; }
  bool moving() const { return mode_ != Mode::kStill; }
  std::int64_t position() const { return position_milli_ / 1000; }
  std::int64_t target() const { return target_; }
  std::int64_t speed() const { return speed_milli_ / 1000; }  // signed

 private:
  std::int64_t braking_speed(std::int64_t distance_milli) const;

  Mode mode_ = Mode::kStill;
  std::int64_t position_milli_ = 0;  // thousandths of a unit
  std::int64_t speed_milli_ = 0;     // thousandths of a unit a second
  std::int64_t target_ = 0;
  std::int64_t wanted_speed_ = 0;
  std::int64_t stop_deceleration_ = 1;
};

}  // namespace servotrace::simulator
