// SPDX-License-Identifier: MIT
#include "captures/simulator/can_ns310.hpp"

#include <cassert>
#include <cstdlib>

#include "decoder/core/slot.hpp"
#include "decoder/profiles/yaskawa_ns310/layouts.hpp"

namespace servotrace::simulator {
namespace {

using namespace ns310;

constexpr unsigned kEnablingMs = 30;                       // from Enable to the servo being on
constexpr std::int64_t kMaximumDeceleration = 40'000'000;  // steps/s^2, of a hard stop
constexpr std::int64_t kPositionLimit = 99'999'999;

template <class Value>
void put(Slot place, ByteVector& bytes, Value value) {
  const bool fitted = write(place, bytes, static_cast<std::int64_t>(value));
  assert(fitted);
  (void)fitted;
}

bool starts_motion(std::uint8_t code) { return code == 0x01 || code == 0x11 || code == 0x12; }

}  // namespace

Ns310::Ns310(CanBus& can, std::uint8_t mac_id, std::uint32_t serial_number)
    : Slave(can, {.mac_id = mac_id,
                  .identity = {.vendor_id = 44,
                               .device_type = 0,
                               .product_code = 0x51,
                               .major = 1,
                               .minor = 0,
                               .serial_number = serial_number,
                               .product_name = "JUSP-NS310"},
                  .command_size = kMessageSize,
                  .response_size = kMessageSize,
                  .poll_latency_ns = 350 * kMicrosecondNs}) {
  Ns310::restart();
}

void Ns310::restart() {
  ticked_ns_ = now_ns();
  axis_.halt();
  last_ = {};
  valid_echo_ = command_error_ = start_echo_ = false;
  response_code_ = 0;
  enabled_ = false;
  enabling_ms_ = 0;
  homed_ = false;
  operation_ = Operation::kNone;
  homing_ = Homing::kNone;
  in_blocks_ = block_fault_ = false;
  executing_ = 0;
  axis_.acceleration = axis_.deceleration = 2'000'000;
}

// The connection is gone: the drive stops and turns its servo off.
void Ns310::lose_master() {
  catch_up();
  stop_at_once();
  enabled_ = false;
  last_.enable = false;
}

void Ns310::raise_alarm(std::uint8_t code) {
  catch_up();
  alarm_ = code;
  stop_at_once();
  enabled_ = false;
}

void Ns310::set_emergency_stop(bool active) {
  catch_up();
  emergency_ = active;
  if (active && axis_.moving()) axis_.stop(kMaximumDeceleration);
}

void Ns310::set_cw_limit(bool active) {
  catch_up();
  cw_limit_ = active;
}

void Ns310::set_ccw_limit(bool active) {
  catch_up();
  ccw_limit_ = active;
}

void Ns310::set_home_switch(std::int64_t position, std::int64_t width) {
  home_switch_ = position;
  home_width_ = width;
}

Ns310::Command Ns310::parse(Bytes bytes) {
  const Bytes head = bytes.first(4);
  const auto bit = [&](Slot place) { return read(place, head) != 0; };
  Command command;
  command.start = bit(slot(kCommand, "start_trajectory"));
  command.start_block = bit(slot(kCommand, "start_block"));
  command.incremental = bit(slot(kCommand, "incremental"));
  command.forward = bit(slot(kCommand, "direction"));
  command.smooth_stop = bit(slot(kCommand, "smooth_stop"));
  command.hard_stop = bit(slot(kCommand, "hard_stop"));
  command.valid = bit(slot(kCommand, "valid_data"));
  command.enable = bit(slot(kCommand, "enable"));
  command.block = static_cast<std::uint8_t>(read(slot(kCommand, "block_number"), head));
  command.code = static_cast<std::uint8_t>(read(slot(kCommand, "command_code"), head));
  command.axis = static_cast<std::uint8_t>(read(slot(kCommand, "command_axis"), head));
  command.response_code = static_cast<std::uint8_t>(read(slot(kCommand, "response_code"), head));
  command.response_axis = static_cast<std::uint8_t>(read(slot(kCommand, "response_axis"), head));
  command.data = static_cast<std::int32_t>(read(slot(kTargetPosition, "target_position"), bytes.subspan(kDataOffset)));
  return command;
}

// What 5.3.2 says of the data of each code.
bool Ns310::acceptable(const Command& command) const {
  if (command.axis != 1 || command.response_axis != 1) return false;
  switch (command.response_code) {
    case 0x00:
    case 0x01:
    case 0x02:
    case 0x03:
    case 0x1E:
      break;
    default:
      return false;
  }
  switch (command.code) {
    case 0x00:
      return true;
    case 0x01:
      return std::abs(std::int64_t{command.data}) <= kPositionLimit;
    case 0x02:
    case 0x03:
    case 0x04:
      return command.data > 0;
    case 0x11:
      return command.data >= 0;
    case 0x12:
      return command.data == 0 || command.data == 1 || command.data == 3;
    case 0x1E:
      return (command.data & ~1) == 0;
    default:
      return false;
  }
}

void Ns310::take_command(Bytes bytes) {
  catch_up();
  const Command command = parse(bytes);
  const Command before = last_;
  last_ = command;
  take_levels(command);
  if (!command.valid) {
    valid_echo_ = command_error_ = start_echo_ = false;
    return;
  }
  valid_echo_ = true;
  if (command_error_) return;  // until Valid Data = 0
  if (!acceptable(command)) {
    command_error_ = true;
    return;
  }
  response_code_ = command.response_code;
  take_values(command);
  const bool rises = command.start && !before.start;
  if (!command.start) start_echo_ = false;
  // Enable and Start in one message: the start is ignored (5.4.1).
  if (rises && (command.code == 0x1E || before.enable)) start(command);
  if (command.start_block && !before.start_block) start_block(command.block);
  if (operation_ == Operation::kContinuous && command.start && command.code == 0x11 &&
      axis_.mode() == MotionAxis::Mode::kSpeed) {
    axis_.turn(command.forward ? command.data : -std::int64_t{command.data});
  }
}

// Enable, Smooth Stop, Hard Stop act whatever Valid Data says.
void Ns310::take_levels(const Command& command) {
  if (!command.enable) {
    if (enabled_) stop_at_once();
    enabled_ = false;
    enabling_ms_ = 0;
    needs_new_enable_ = false;
  }
  if (command.hard_stop) {
    axis_.stop(kMaximumDeceleration);
  } else if (command.smooth_stop && axis_.mode() != MotionAxis::Mode::kStopping) {
    axis_.stop(axis_.deceleration);
  }
  if ((command.hard_stop || command.smooth_stop) && in_blocks_) {
    in_blocks_ = false;
    executing_ = 0;
  }
  if ((command.hard_stop || command.smooth_stop) && homing_ != Homing::kNone) homing_ = Homing::kNone;
}

void Ns310::take_values(const Command& command) {
  switch (command.code) {
    case 0x02:
      target_speed_ = command.data;
      break;
    case 0x03:
      axis_.acceleration = command.data;
      break;
    case 0x04:
      axis_.deceleration = command.data;
      break;
    default:
      break;
  }
}

bool Ns310::ready_to_move() const {
  return enabled_ && alarm_ == 0 && !emergency_ && !last_.hard_stop && !last_.smooth_stop;
}

void Ns310::start(const Command& command) {
  if (command.code == 0x1E) {
    if ((command.data & 1) == 0) return;
    alarm_ = 0;
    start_echo_ = true;
    return;
  }
  if (!starts_motion(command.code) || !ready_to_move()) return;
  const Operation wanted = command.code == 0x01   ? Operation::kPositioning
                           : command.code == 0x11 ? Operation::kContinuous
                                                  : Operation::kHoming;
  if (operation_ != Operation::kNone && operation_ != wanted) return;  // disabled (5.4.1-5.4.3)
  if (operation_ == Operation::kHoming) return;
  switch (wanted) {
    case Operation::kPositioning: {
      const std::int64_t base = command.incremental ? axis_.position() : 0;
      const std::int64_t target = base + command.data;
      if (blocked_by_limit(target - axis_.position())) return;
      axis_.move_to(target, target_speed_);
      break;
    }
    case Operation::kContinuous:
      if (blocked_by_limit(command.forward ? 1 : -1)) return;
      axis_.turn(command.forward ? command.data : -std::int64_t{command.data});
      break;
    default:
      start_homing(static_cast<std::uint8_t>(command.data));
      break;
  }
  operation_ = wanted;
  start_echo_ = true;
}

// Clockwise is positive where 25h/24 says so (0).
bool Ns310::blocked_by_limit(std::int64_t direction) const {
  const bool cw_is_positive = parameter(0x25, 24) == 0;
  const bool positive_switch = cw_is_positive ? cw_limit_ : ccw_limit_;
  const bool negative_switch = cw_is_positive ? ccw_limit_ : cw_limit_;
  const bool software = homed_ && parameter(0x25, 52) != 0;
  if (direction > 0) return positive_switch || (software && axis_.position() > parameter(0x25, 54));
  if (direction < 0) return negative_switch || (software && axis_.position() < parameter(0x25, 55));
  return false;
}

void Ns310::tick_limits() {
  const std::int64_t speed = axis_.speed();
  if (speed == 0 || axis_.mode() == MotionAxis::Mode::kStopping || operation_ == Operation::kHoming) return;
  const bool cw_is_positive = parameter(0x25, 24) == 0;
  const bool switch_hit =
      speed > 0 ? (cw_is_positive ? cw_limit_ : ccw_limit_) : (cw_is_positive ? ccw_limit_ : cw_limit_);
  if (switch_hit) {
    axis_.stop(kMaximumDeceleration);
  } else if (blocked_by_limit(speed)) {
    axis_.stop(axis_.deceleration);
  }
}

void Ns310::stop_at_once() {
  axis_.halt();
  end_operation();
  homing_ = Homing::kNone;
  in_blocks_ = false;
  executing_ = 0;
}

void Ns310::end_operation() { operation_ = Operation::kNone; }

void Ns310::catch_up() {
  while (ticked_ns_ + kMillisecondNs <= now_ns()) {
    ticked_ns_ += kMillisecondNs;
    tick();
  }
}

void Ns310::tick() {
  if (last_.enable && !enabled_ && servo_ready_ && alarm_ == 0 && !emergency_ && !needs_new_enable_) {
    if (++enabling_ms_ >= kEnablingMs) enabled_ = true;
  }
  const std::int64_t from = axis_.position();
  axis_.tick();
  if (homing_ != Homing::kNone) tick_homing();
  if (homing_ == Homing::kPhaseC && passed_phase_c(from, axis_.position())) {
    homing_mark_ = axis_.position();
    homing_ = Homing::kReturn;
    axis_.move_to(homing_mark_, parameter(0x25, 255));
  }
  tick_limits();
  if (operation_ != Operation::kNone && !axis_.moving() && homing_ == Homing::kNone) end_operation();
  if (emergency_ && enabled_ && !axis_.moving()) {
    enabled_ = false;
    needs_new_enable_ = true;
    enabling_ms_ = 0;
    in_blocks_ = false;
    end_operation();
  }
  if (in_blocks_) tick_block();
}

std::int64_t Ns310::response_value() const {
  switch (response_code_) {
    case 0x01:
    case 0x02:
      return axis_.position();
    case 0x03:
      return axis_.speed();
    case 0x1E:
      return alarm_;
    default:
      return 0;
  }
}

ByteVector Ns310::make_response() {
  catch_up();
  ByteVector bytes(kMessageSize, 0);
  const bool software = homed_ && parameter(0x25, 52) != 0;
  put(slot(kResponse, "trajectory_in_progress"), bytes, operation_ != Operation::kNone || axis_.moving());
  put(slot(kResponse, "block_in_execution"), bytes, in_blocks_);
  put(slot(kResponse, "on_target_position"), bytes,
      !axis_.moving() || std::abs(axis_.target() - axis_.position()) <= parameter(0x25, 38));
  put(slot(kResponse, "alarm"), bytes, alarm_ != 0);
  put(slot(kResponse, "emergency_stop_input"), bytes, emergency_);
  put(slot(kResponse, "home_flag"), bytes, at_home_switch());
  put(slot(kResponse, "valid_data"), bytes, valid_echo_);
  put(slot(kResponse, "enable_state"), bytes, enabled_);
  put(slot(kResponse, "executing_block_number"), bytes, in_blocks_ ? executing_ : std::uint8_t{0});
  put(slot(kResponse, "servo_ready"), bytes, servo_ready_ && alarm_ == 0);
  put(slot(kResponse, "cw_hardware_limit"), bytes, cw_limit_);
  put(slot(kResponse, "ccw_hardware_limit"), bytes, ccw_limit_);
  put(slot(kResponse, "positive_software_limit"), bytes, software && axis_.position() > parameter(0x25, 54));
  put(slot(kResponse, "negative_software_limit"), bytes, software && axis_.position() < parameter(0x25, 55));
  put(slot(kResponse, "trajectory_start_echo"), bytes, start_echo_);
  put(slot(kResponse, "block_fault"), bytes, block_fault_);
  put(slot(kResponse, "command_error"), bytes, command_error_);
  put(slot(kResponse, "response_code"), bytes, response_code_);
  put(slot(kResponse, "response_axis"), bytes, 1);
  const auto raw = static_cast<std::uint32_t>(response_value());
  for (unsigned i = 0; i < 4; ++i) bytes[kDataOffset + i] = static_cast<std::uint8_t>(raw >> (8U * i) & 0xFFU);
  return bytes;
}

}  // namespace servotrace::simulator
