// SPDX-License-Identifier: MIT
// The two assemblies as values: what a session keeps of a message (SIE-C718-7 5.3). Precondition of both functions:
// kMessageSize bytes.
#pragma once

#include "decoder/core/slot.hpp"
#include "decoder/core/time.hpp"
#include "decoder/profiles/yaskawa_ns310/layouts.hpp"

namespace servotrace::ns310 {

struct Command {
  std::uint64_t frame = 0;
  TimeNs time_ns = 0;
  bool start_trajectory = false;
  bool start_block = false;
  bool incremental = false;
  bool forward = false;  // Direction
  bool smooth_stop = false;
  bool hard_stop = false;
  bool valid_data = false;
  bool enable = false;
  std::uint8_t block_number = 0;
  std::uint8_t code = 0;
  std::uint8_t command_axis = 0;
  std::uint8_t response_code = 0;
  std::uint8_t response_axis = 0;
  std::int32_t data = 0;

  bool is(CommandCode wanted) const { return code == static_cast<std::uint8_t>(wanted); }
  // A code that Start_Trajectory sets in motion (5.3.1).
  bool is_motion() const {
    return is(CommandCode::kTargetPosition) || is(CommandCode::kContinuousSpeed) || is(CommandCode::kHoming);
  }
  bool stops() const { return smooth_stop || hard_stop; }
};

struct Response {
  std::uint64_t frame = 0;
  TimeNs time_ns = 0;
  bool in_progress = false;
  bool block_in_execution = false;
  bool on_target = false;
  bool alarm = false;
  bool emergency_stop = false;
  bool home = false;
  bool valid_data = false;
  bool enable_state = false;
  bool servo_ready = false;
  bool cw_limit = false;
  bool ccw_limit = false;
  bool positive_limit = false;
  bool negative_limit = false;
  bool start_echo = false;
  bool block_fault = false;
  bool command_error = false;
  std::uint8_t executing_block = 0;
  std::uint8_t code = 0;
  std::int32_t data = 0;

  bool is(ResponseCode wanted) const { return code == static_cast<std::uint8_t>(wanted); }
};

inline Command read_command(Bytes bytes, std::uint64_t frame, TimeNs time_ns) {
  const auto flag = [bytes](Slot slot) { return read(slot, bytes) != 0; };
  const auto byte = [bytes](Slot slot) { return static_cast<std::uint8_t>(read(slot, bytes)); };
  Command command;
  command.frame = frame;
  command.time_ns = time_ns;
  command.start_trajectory = flag(slot(kCommand, "start_trajectory"));
  command.start_block = flag(slot(kCommand, "start_block"));
  command.incremental = flag(slot(kCommand, "incremental"));
  command.forward = flag(slot(kCommand, "direction"));
  command.smooth_stop = flag(slot(kCommand, "smooth_stop"));
  command.hard_stop = flag(slot(kCommand, "hard_stop"));
  command.valid_data = flag(slot(kCommand, "valid_data"));
  command.enable = flag(slot(kCommand, "enable"));
  command.block_number = byte(slot(kCommand, "block_number"));
  command.code = byte(slot(kCommand, "command_code"));
  command.command_axis = byte(slot(kCommand, "command_axis"));
  command.response_code = byte(slot(kCommand, "response_code"));
  command.response_axis = byte(slot(kCommand, "response_axis"));
  command.data = static_cast<std::int32_t>(read(slot(kTargetPosition, "target_position"), bytes.subspan(kDataOffset)));
  return command;
}

inline Response read_response(Bytes bytes, std::uint64_t frame, TimeNs time_ns) {
  const auto flag = [bytes](Slot slot) { return read(slot, bytes) != 0; };
  const auto byte = [bytes](Slot slot) { return static_cast<std::uint8_t>(read(slot, bytes)); };
  Response response;
  response.frame = frame;
  response.time_ns = time_ns;
  response.in_progress = flag(slot(kResponse, "trajectory_in_progress"));
  response.block_in_execution = flag(slot(kResponse, "block_in_execution"));
  response.on_target = flag(slot(kResponse, "on_target_position"));
  response.alarm = flag(slot(kResponse, "alarm"));
  response.emergency_stop = flag(slot(kResponse, "emergency_stop_input"));
  response.home = flag(slot(kResponse, "home_flag"));
  response.valid_data = flag(slot(kResponse, "valid_data"));
  response.enable_state = flag(slot(kResponse, "enable_state"));
  response.servo_ready = flag(slot(kResponse, "servo_ready"));
  response.cw_limit = flag(slot(kResponse, "cw_hardware_limit"));
  response.ccw_limit = flag(slot(kResponse, "ccw_hardware_limit"));
  response.positive_limit = flag(slot(kResponse, "positive_software_limit"));
  response.negative_limit = flag(slot(kResponse, "negative_software_limit"));
  response.start_echo = flag(slot(kResponse, "trajectory_start_echo"));
  response.block_fault = flag(slot(kResponse, "block_fault"));
  response.command_error = flag(slot(kResponse, "command_error"));
  response.executing_block = byte(slot(kResponse, "executing_block_number"));
  response.code = byte(slot(kResponse, "response_code"));
  response.data =
      static_cast<std::int32_t>(read(slot(kCurrentPosition, "current_position"), bytes.subspan(kDataOffset)));
  return response;
}

}  // namespace servotrace::ns310
