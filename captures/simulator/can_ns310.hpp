// SPDX-License-Identifier: MIT
// A SGDH with NS310 (SIE-C718-7): poll messages of 5.3, operations of 5.4, command blocks of 5.5, objects of
// Appendix B. Written from the manual, independently of the decoder's sessions.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>

#include "captures/simulator/can_axis.hpp"
#include "captures/simulator/can_slave.hpp"

namespace servotrace::simulator {

class Ns310 : public Slave {
 public:
  Ns310(CanBus& bus, std::uint8_t mac_id, std::uint32_t serial_number);

  // What the machine around the drive does.
  void raise_alarm(std::uint8_t code);
  void set_emergency_stop(bool active);
  void set_cw_limit(bool active);
  void set_ccw_limit(bool active);
  void set_servo_ready(bool ready) { servo_ready_ = ready; }
  void set_homed(bool homed) { homed_ = homed; }
  // Where the home position signal lies, and how wide it is [step].
  void set_home_switch(std::int64_t position, std::int64_t width);
  void set_phase_c(std::int64_t distance) { phase_c_distance_ = distance; }  // steps between two phases C, above 0

 protected:
  void take_command(Bytes command) override;
  ByteVector make_response() override;
  ExplicitReply serve(const ExplicitRequest& request) override;
  void restart() override;
  void lose_master() override;

 private:
  enum class Operation : std::uint8_t { kNone, kPositioning, kContinuous, kHoming };
  enum class Homing : std::uint8_t { kNone, kApproach, kBack, kPhaseC, kReturn };
  struct Command {
    bool start = false, start_block = false, incremental = false, forward = false;
    bool smooth_stop = false, hard_stop = false, valid = false, enable = false;
    std::uint8_t block = 0, code = 0, axis = 0, response_code = 0, response_axis = 0;
    std::int32_t data = 0;
  };
  using Block = std::array<std::int64_t, 8>;  // attributes 1..7; index 0 unused

  static Command parse(Bytes bytes);
  // Runs the model up to now, millisecond by millisecond.
  void catch_up();
  void tick();
  bool acceptable(const Command& command) const;
  void take_levels(const Command& command);
  void take_values(const Command& command);
  void start(const Command& command);
  bool ready_to_move() const;
  bool blocked_by_limit(std::int64_t direction) const;
  void start_homing(std::uint8_t type);
  void tick_homing();
  void tick_limits();
  void finish_homing();
  void stop_at_once();
  void end_operation();
  void start_block(std::uint8_t number);
  void run_block();
  void tick_block();
  void fail_block(std::uint8_t code);
  bool at_home_switch() const;
  bool passed_phase_c(std::int64_t from, std::int64_t to) const;
  std::int64_t response_value() const;

  ExplicitReply serve_block(const ExplicitRequest& request);
  ExplicitReply serve_sequencer(const ExplicitRequest& request);
  ExplicitReply serve_attribute(const ExplicitRequest& request);
  std::int64_t attribute_value(std::uint8_t class_id, std::uint8_t attribute) const;
  void attribute_written(std::uint8_t class_id, std::uint8_t attribute, std::int64_t value);
  std::int64_t parameter(std::uint8_t class_id, std::uint8_t attribute) const;

  MotionAxis axis_;
  TimeNs ticked_ns_ = 0;
  Command last_;
  bool valid_echo_ = false;
  bool command_error_ = false;
  bool start_echo_ = false;
  std::uint8_t response_code_ = 0;
  std::int64_t target_speed_ = 400'000;
  bool enabled_ = false;
  unsigned enabling_ms_ = 0;
  bool servo_ready_ = true;
  bool emergency_ = false;
  bool needs_new_enable_ = false;  // after an emergency stop a servo-on command must be sent (5.4.6)
  bool cw_limit_ = false;
  bool ccw_limit_ = false;
  std::uint8_t alarm_ = 0;
  bool homed_ = false;
  Operation operation_ = Operation::kNone;
  Homing homing_ = Homing::kNone;
  std::uint8_t homing_type_ = 0;
  std::int64_t homing_mark_ = 0;
  std::int64_t home_switch_ = -20'000;
  std::int64_t home_width_ = 2'000;
  std::int64_t phase_c_distance_ = 8'192;
  std::map<std::uint8_t, Block> blocks_;
  std::uint8_t executing_ = 0;
  std::uint8_t next_block_ = 0;
  bool in_blocks_ = false;
  bool block_waits_ = false;
  std::int64_t block_left_ms_ = 0;
  bool block_fault_ = false;
  std::uint8_t block_fault_code_ = 0;
  std::map<std::uint16_t, std::int64_t> written_;  // class << 8 | attribute
};

}  // namespace servotrace::simulator
