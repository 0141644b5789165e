// SPDX-License-Identifier: MIT
// The master's side of one axis: takes the scenario's steps one by one and makes the command block of each cycle.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "captures/simulator/rtex_step.hpp"

namespace servotrace::simulator::ring {

// What the axes of a ring share.
struct RingState {
  std::int64_t cycle = 0;
  DurationNs now_ns = 0;          // since the ring's start
  bool all_reset_echoed = false;  // every drive echoes x1h
  int slowest_sync = 0;           // sync steps that every axis has reached
  std::vector<Fault> faults;      // with the cycle they begin in
};

class AxisMaster {
 public:
  AxisMaster(A5nDrive& drive, Timing timing, int first_mode);

  void add(const Step& step) { steps_.push_back(step); }
  bool idle() const { return steps_.empty() && !current_; }
  int syncs_reached() const { return syncs_reached_; }
  bool echoes_reset() const;
  // The step that waits for longer than it may, if any.
  const Step* overdue(DurationNs now_ns) const;

  // This axis's reception memory of the cycle.
  void observe(Bytes response);
  // The next updating cycle: takes steps and updates the command.
  void update(RingState& ring);
  // After the ring was initialised again: what was commanded before is forgotten, the steps go on.
  void start_again();
  // The command block of this cycle, without the counters.
  void fill(MutableBytes block);

 private:
  bool finished(const Step& step, RingState& ring);
  void start(const Step& step, RingState& ring);
  void start_request(const Step& step);
  bool run_request(const Step& step, const RingState& ring);
  bool is_answered(const Request& request) const;
  void advance();
  bool seen(Slot place) const { return has_response_ && flag(place, response_); }
  std::int64_t seen_value(Slot place) const { return has_response_ ? get(place, response_) : 0; }
  int& code(bool sub) { return sub ? sub_code_ : code_; }

  A5nDrive& drive_;
  Timing timing_;
  DurationNs update_ns_;
  bool wide_;

  std::deque<Step> steps_;
  std::optional<Step> current_;
  bool started_ = false;
  DurationNs started_ns_ = 0;
  std::int64_t started_cycle_ = 0;
  int syncs_reached_ = 0;

  // The command.
  int cyclic_;
  bool nop_ = false;
  std::array<std::uint8_t, kWideBlock> control_{};  // bytes 2 and 3 are used
  int code_ = kNormalCommand;
  int type_ = 0;
  int index_ = 0;
  std::int32_t data3_ = 0;
  int sub_code_ = kNormalCommand;
  int sub_type_ = 0;
  int sub_index_ = 0;

  // Motion the master generates.
  Ramp planned_;
  std::int64_t goal_ = 0;
  std::int64_t cruise_ = 0;
  std::int64_t rate_ = 1'000'000;
  bool moving_ = false;
  std::int64_t drift_ = 0;  // CP: speed while homing to a trigger
  bool detached_ = false;   // CP, servo off: the command position does not follow the actual one
  std::int64_t level_ = 0;  // CV: speed, CT: torque; thousandths
  std::int64_t level_goal_ = 0;
  std::int64_t level_step_ = 0;
  std::int32_t profile_target_ = 0;
  DurationNs mode_changed_ns_ = -kSecondNs;

  // The handshake of the present request.
  enum class Phase : std::uint8_t { kRestoring, kHeld, kHolding, kSettling };
  Phase phase_ = Phase::kHeld;
  std::int64_t phase_cycle_ = 0;
  bool seen_running_ = false;
  bool chained_ = false;            // the command before stays until the next one replaces it
  int sent_code_ = kNormalCommand;  // of the block sent last
  int sent_sub_code_ = kNormalCommand;

  std::array<std::uint8_t, kWideBlock> response_{};
  bool has_response_ = false;
};

}  // namespace servotrace::simulator::ring
