// SPDX-License-Identifier: MIT
// The command and response assemblies of the NS310, 8 bytes each (SIE-C718-7 5.3): bytes 0-3 are one layout, bytes 4-7
// another, chosen by the command or response code. Positions in steps, speeds in steps/s, accelerations in steps/s^2.
#pragma once

#include "decoder/core/layout_check.hpp"
#include "decoder/profiles/yaskawa_ns310/alarms.hpp"
#include "decoder/profiles/yaskawa_ns310/codes.hpp"

namespace servotrace::ns310 {

inline constexpr std::uint16_t kMessageSize = 8;  // bytes, either way
inline constexpr std::uint16_t kDataOffset = 4;   // of bytes 4-7

inline constexpr std::string_view kCommandSection = "SIE-C718-7 5.3.1";
inline constexpr std::string_view kDataSection = "SIE-C718-7 5.3.2";
inline constexpr std::string_view kResponseSection = "SIE-C718-7 5.3.3";

inline constexpr ValueName kIncrementalNames[] = {{0, "absolute position"}, {1, "incremental position"}};
inline constexpr ValueName kDirectionNames[] = {{0, "reverse (negative, counterclockwise)"},
                                                {1, "forward (positive, clockwise)"}};
inline constexpr ValueName kEnableNames[] = {{0, "servo off"}, {1, "servo on"}};
inline constexpr ValueName kValidNames[] = {{0, "data disabled"}, {1, "data enabled"}};
inline constexpr ValueName kAxisNames[] = {{1, "axis 1"}};

inline constexpr Field kCommandFields[] = {
    {.key = "start_trajectory",
     .label = "Start Trajectory",
     .first_bit = at(0, 0),
     .width = 1,
     .kind = Kind::kBool,
     .role = Role::kState,
     .section = kCommandSection,
     .explanation = "A rising edge starts what the command code says (01h, 11h, 12h, 1Eh)."},
    {.key = "start_block",
     .label = "Start Block",
     .first_bit = at(0, 1),
     .width = 1,
     .kind = Kind::kBool,
     .role = Role::kState,
     .section = kCommandSection,
     .explanation = "Starts the command block of Block Number and those it links to."},
    {.key = "incremental",
     .label = "Absolute/Incremental",
     .first_bit = at(0, 2),
     .width = 1,
     .values = kIncrementalNames,
     .section = kCommandSection,
     .explanation = "How a target position counts."},
    {.key = "direction",
     .label = "Direction (V mode)",
     .first_bit = at(0, 3),
     .width = 1,
     .role = Role::kState,
     .values = kDirectionNames,
     .section = kCommandSection,
     .explanation = "Of the continuous rotation, seen from the motor side of the shaft."},
    {.key = "smooth_stop",
     .label = "Smooth Stop",
     .first_bit = at(0, 4),
     .width = 1,
     .kind = Kind::kBool,
     .role = Role::kState,
     .section = kCommandSection,
     .explanation = "Stops at the set deceleration. Acts whatever Valid Data says."},
    {.key = "hard_stop",
     .label = "Hard Stop",
     .first_bit = at(0, 5),
     .width = 1,
     .kind = Kind::kBool,
     .role = Role::kState,
     .section = kCommandSection,
     .explanation = "Stops at the maximum deceleration. Acts whatever Valid Data says."},
    {.key = "valid_data",
     .label = "Valid Data",
     .first_bit = at(0, 6),
     .width = 1,
     .role = Role::kState,
     .values = kValidNames,
     .section = kCommandSection,
     .explanation = "Bytes 1-7 are taken only while it is 1; 0 clears a command error."},
    {.key = "enable",
     .label = "Enable",
     .first_bit = at(0, 7),
     .width = 1,
     .role = Role::kState,
     .values = kEnableNames,
     .section = kCommandSection,
     .explanation = "A level: the servo is on while it is 1."},
    {.key = "block_number",
     .label = "Block Number",
     .first_bit = at(1),
     .width = 8,
     .section = kCommandSection,
     .explanation = "The command block that Start Block begins with, 1 to 255."},
    {.key = "command_code",
     .label = "Command Code",
     .first_bit = at(2, 0),
     .width = 5,
     .base = Base::kHex,
     .role = Role::kState,
     .values = kCommandCodes,
     .closed = true,
     .section = kCommandSection,
     .explanation = "What bytes 4-7 hold."},
    {.key = "command_axis",
     .label = "Axis Instance (command)",
     .first_bit = at(2, 5),
     .width = 3,
     .values = kAxisNames,
     .closed = true,
     .section = kCommandSection,
     .explanation = "Always 1, else a command error."},
    {.key = "response_code",
     .label = "Response Code",
     .first_bit = at(3, 0),
     .width = 5,
     .base = Base::kHex,
     .values = kResponseCodes,
     .closed = true,
     .section = kCommandSection,
     .explanation = "What bytes 4-7 of the response shall hold."},
    {.key = "response_axis",
     .label = "Axis Instance (response)",
     .first_bit = at(3, 5),
     .width = 3,
     .values = kAxisNames,
     .closed = true,
     .section = kCommandSection,
     .explanation = "Always 1, else a command error."},
};
inline constexpr Layout kCommand{.protocol = "ns310",
                                 .key = "command",
                                 .title = "Command Assembly",
                                 .size = 4,
                                 .fields = kCommandFields,
                                 .section = kCommandSection};
static_assert(well_formed(kCommand));

inline constexpr Field kResponseFields[] = {
    {.key = "trajectory_in_progress",
     .label = "Trajectory In Progress",
     .first_bit = at(0, 0),
     .width = 1,
     .kind = Kind::kBool,
     .role = Role::kState,
     .section = kResponseSection,
     .explanation = "A positioning, continuous rotation or homing runs."},
    {.key = "block_in_execution",
     .label = "Block In Execution",
     .first_bit = at(0, 1),
     .width = 1,
     .kind = Kind::kBool,
     .role = Role::kState,
     .section = kResponseSection,
     .explanation = "Command blocks run."},
    {.key = "on_target_position",
     .label = "On Target Position",
     .first_bit = at(0, 2),
     .width = 1,
     .kind = Kind::kBool,
     .role = Role::kState,
     .section = kResponseSection,
     .explanation = "The position is within the Position Deadband (25h/38)."},
    {.key = "alarm",
     .label = "Alarm",
     .first_bit = at(0, 3),
     .width = 1,
     .kind = Kind::kBool,
     .role = Role::kState,
     .section = kResponseSection,
     .explanation = "An alarm of the NS310 or the SGDH; response code 1Eh asks which."},
    {.key = "emergency_stop_input",
     .label = "Emergency Stop Input",
     .first_bit = at(0, 4),
     .width = 1,
     .kind = Kind::kBool,
     .role = Role::kState,
     .section = kResponseSection,
     .explanation = "The emergency stop signal of the SGDH."},
    {.key = "home_flag",
     .label = "Home Flag",
     .first_bit = at(0, 5),
     .width = 1,
     .kind = Kind::kBool,
     .role = Role::kState,
     .section = kResponseSection,
     .explanation = "The home position signal of the SGDH is active."},
    {.key = "valid_data",
     .label = "Valid Data",
     .first_bit = at(0, 6),
     .width = 1,
     .kind = Kind::kBool,
     .role = Role::kState,
     .section = kResponseSection,
     .explanation = "The command data were received (with Command Error: and refused)."},
    {.key = "enable_state",
     .label = "Enable State",
     .first_bit = at(0, 7),
     .width = 1,
     .role = Role::kState,
     .values = kEnableNames,
     .section = kResponseSection,
     .explanation = "While the servo is off, Start Trajectory is ignored."},
    {.key = "executing_block_number",
     .label = "Executing Block Number",
     .first_bit = at(1),
     .width = 8,
     .role = Role::kState,
     .section = kResponseSection,
     .explanation = "The command block that runs."},
    {.key = "servo_ready",
     .label = "Servo Ready",
     .first_bit = at(2, 0),
     .width = 1,
     .kind = Kind::kBool,
     .role = Role::kState,
     .section = kResponseSection,
     .explanation = "The servo can be turned on."},
    {.key = "cw_hardware_limit",
     .label = "CW Hardware Limit",
     .first_bit = at(2, 1),
     .width = 1,
     .kind = Kind::kBool,
     .role = Role::kState,
     .section = kResponseSection,
     .explanation = "The clockwise limit switch is reached."},
    {.key = "ccw_hardware_limit",
     .label = "CCW Hardware Limit",
     .first_bit = at(2, 2),
     .width = 1,
     .kind = Kind::kBool,
     .role = Role::kState,
     .section = kResponseSection,
     .explanation = "The counterclockwise limit switch is reached."},
    {.key = "positive_software_limit",
     .label = "Positive Software Limit",
     .first_bit = at(2, 3),
     .width = 1,
     .kind = Kind::kBool,
     .role = Role::kState,
     .section = kResponseSection,
     .explanation = "The position is beyond 25h/54."},
    {.key = "negative_software_limit",
     .label = "Negative Software Limit",
     .first_bit = at(2, 4),
     .width = 1,
     .kind = Kind::kBool,
     .role = Role::kState,
     .section = kResponseSection,
     .explanation = "The position is beyond 25h/55."},
    {.key = "trajectory_start_echo",
     .label = "Trajectory Start Echo",
     .first_bit = at(2, 5),
     .width = 1,
     .kind = Kind::kBool,
     .role = Role::kState,
     .section = kResponseSection,
     .explanation = "A Start Trajectory was received normally."},
    {.key = "block_fault",
     .label = "Block Fault",
     .first_bit = at(2, 6),
     .width = 1,
     .kind = Kind::kBool,
     .role = Role::kState,
     .section = kResponseSection,
     .explanation = "An error stopped the block operation."},
    {.key = "command_error",
     .label = "Command Error",
     .first_bit = at(2, 7),
     .width = 1,
     .kind = Kind::kBool,
     .role = Role::kState,
     .section = kResponseSection,
     .explanation = "The command data were refused; cleared by Valid Data = 0."},
    {.key = "response_code",
     .label = "Response Code",
     .first_bit = at(3, 0),
     .width = 5,
     .base = Base::kHex,
     .values = kResponseCodes,
     .closed = true,
     .section = kResponseSection,
     .explanation = "What bytes 4-7 hold."},
    {.key = "response_axis",
     .label = "Axis Instance",
     .first_bit = at(3, 5),
     .width = 3,
     .values = kAxisNames,
     .closed = true,
     .section = kResponseSection,
     .explanation = "Always 1."},
};
inline constexpr Layout kResponse{.protocol = "ns310",
                                  .key = "response",
                                  .title = "Response Assembly",
                                  .size = 4,
                                  .fields = kResponseFields,
                                  .section = kResponseSection};
static_assert(well_formed(kResponse));

// Bytes 4-7 of a command, by its command code.
inline constexpr Field kDataFields[] = {{.key = "data",
                                         .label = "Data",
                                         .first_bit = at(0),
                                         .width = 32,
                                         .base = Base::kHex,
                                         .section = kDataSection,
                                         .explanation = "Of no meaning with this code."}};
inline constexpr Layout kCommandData{.protocol = "ns310",
                                     .key = "command",
                                     .title = "Command Data",
                                     .size = 4,
                                     .fields = kDataFields,
                                     .section = kDataSection};
static_assert(well_formed(kCommandData));

// The range of a position (object 25h, attribute 6).
inline constexpr Range kPositionRange{-99'999'999, 99'999'999};

inline constexpr Field kTargetPositionFields[] = {{.key = "target_position",
                                                   .label = "Target Position",
                                                   .first_bit = at(0),
                                                   .width = 32,
                                                   .kind = Kind::kSigned,
                                                   .role = Role::kSignal,
                                                   .unit = Unit::kStep,
                                                   .range = kPositionRange,
                                                   .section = kDataSection,
                                                   .explanation = "Absolute, or a distance (Absolute/Incremental)."}};
inline constexpr Layout kTargetPosition{.protocol = "ns310",
                                        .key = "command",
                                        .title = "Command Data: Target Position",
                                        .size = 4,
                                        .fields = kTargetPositionFields,
                                        .section = kDataSection};
static_assert(well_formed(kTargetPosition));

inline constexpr Field kTargetSpeedFields[] = {{.key = "target_speed",
                                                .label = "Target Speed",
                                                .first_bit = at(0),
                                                .width = 32,
                                                .kind = Kind::kSigned,
                                                .role = Role::kSignal,
                                                .unit = Unit::kStepPerSecond,
                                                .range = {1, INT32_MAX},
                                                .section = kDataSection,
                                                .explanation = "Of the positioning; always positive."}};
inline constexpr Layout kTargetSpeed{.protocol = "ns310",
                                     .key = "command",
                                     .title = "Command Data: Target Speed",
                                     .size = 4,
                                     .fields = kTargetSpeedFields,
                                     .section = kDataSection};
static_assert(well_formed(kTargetSpeed));

inline constexpr Field kAccelerationFields[] = {{.key = "acceleration",
                                                 .label = "Acceleration",
                                                 .first_bit = at(0),
                                                 .width = 32,
                                                 .kind = Kind::kSigned,
                                                 .role = Role::kSignal,
                                                 .unit = Unit::kStepPerSecond2,
                                                 .range = {1, INT32_MAX},
                                                 .section = kDataSection,
                                                 .explanation = "Always positive."}};
inline constexpr Layout kAcceleration{.protocol = "ns310",
                                      .key = "command",
                                      .title = "Command Data: Acceleration",
                                      .size = 4,
                                      .fields = kAccelerationFields,
                                      .section = kDataSection};
static_assert(well_formed(kAcceleration));

inline constexpr Field kDecelerationFields[] = {{.key = "deceleration",
                                                 .label = "Deceleration",
                                                 .first_bit = at(0),
                                                 .width = 32,
                                                 .kind = Kind::kSigned,
                                                 .role = Role::kSignal,
                                                 .unit = Unit::kStepPerSecond2,
                                                 .range = {1, INT32_MAX},
                                                 .section = kDataSection,
                                                 .explanation = "Always positive."}};
inline constexpr Layout kDeceleration{.protocol = "ns310",
                                      .key = "command",
                                      .title = "Command Data: Deceleration",
                                      .size = 4,
                                      .fields = kDecelerationFields,
                                      .section = kDataSection};
static_assert(well_formed(kDeceleration));

inline constexpr Field kContinuousSpeedFields[] = {{.key = "continuous_speed",
                                                    .label = "Continuous Rotor Speed",
                                                    .first_bit = at(0),
                                                    .width = 32,
                                                    .kind = Kind::kSigned,
                                                    .role = Role::kSignal,
                                                    .unit = Unit::kStepPerSecond,
                                                    .range = {0, INT32_MAX},
                                                    .section = kDataSection,
                                                    .explanation = "Positive; Direction says which way. 0 stops."}};
inline constexpr Layout kContinuousSpeed{.protocol = "ns310",
                                         .key = "command",
                                         .title = "Command Data: Continuous Rotor Speed",
                                         .size = 4,
                                         .fields = kContinuousSpeedFields,
                                         .section = kDataSection};
static_assert(well_formed(kContinuousSpeed));

inline constexpr Field kHomingFields[] = {
    {.key = "homing_type",
     .label = "Homing Type",
     .first_bit = at(0),
     .width = 8,
     .values = kHomingTypes,
     .closed = true,
     .section = "SIE-C718-7 5.4.3",
     .explanation = "What finds the home position."},
    {.key = "homing_reserved",
     .label = "(always 0)",
     .first_bit = at(1),
     .width = 24,
     .base = Base::kHex,
     .reserved = true,
     .section = kDataSection},
};
inline constexpr Layout kHoming{.protocol = "ns310",
                                .key = "command",
                                .title = "Command Data: Homing Type",
                                .size = 4,
                                .fields = kHomingFields,
                                .section = kDataSection};
static_assert(well_formed(kHoming));

inline constexpr Field kAlarmClearFields[] = {
    {.key = "alarm_clear",
     .label = "Alarm Clear",
     .first_bit = at(0, 0),
     .width = 1,
     .kind = Kind::kBool,
     .section = kDataSection,
     .explanation = "1 when Start Trajectory rises."},
    {.key = "alarm_clear_reserved",
     .label = "(always 0)",
     .first_bit = at(0, 1),
     .width = 31,
     .base = Base::kHex,
     .reserved = true,
     .section = kDataSection},
};
inline constexpr Layout kAlarmClear{.protocol = "ns310",
                                    .key = "command",
                                    .title = "Command Data: Alarm Clear",
                                    .size = 4,
                                    .fields = kAlarmClearFields,
                                    .section = kDataSection};
static_assert(well_formed(kAlarmClear));

// Bytes 4-7 of a response, by its response code.
inline constexpr Layout kResponseData{.protocol = "ns310",
                                      .key = "response",
                                      .title = "Response Data",
                                      .size = 4,
                                      .fields = kDataFields,
                                      .section = kResponseSection};
static_assert(well_formed(kResponseData));

inline constexpr Field kCurrentPositionFields[] = {{.key = "current_position",
                                                    .label = "Current Position",
                                                    .first_bit = at(0),
                                                    .width = 32,
                                                    .kind = Kind::kSigned,
                                                    .role = Role::kSignal,
                                                    .unit = Unit::kStep,
                                                    .section = kResponseSection}};
inline constexpr Layout kCurrentPosition{.protocol = "ns310",
                                         .key = "response",
                                         .title = "Response Data: Current Position",
                                         .size = 4,
                                         .fields = kCurrentPositionFields,
                                         .section = kResponseSection};
static_assert(well_formed(kCurrentPosition));

inline constexpr Field kCommandPositionFields[] = {{.key = "command_position",
                                                    .label = "Command Position",
                                                    .first_bit = at(0),
                                                    .width = 32,
                                                    .kind = Kind::kSigned,
                                                    .role = Role::kSignal,
                                                    .unit = Unit::kStep,
                                                    .section = kResponseSection}};
inline constexpr Layout kCommandPosition{.protocol = "ns310",
                                         .key = "response",
                                         .title = "Response Data: Command Position",
                                         .size = 4,
                                         .fields = kCommandPositionFields,
                                         .section = kResponseSection};
static_assert(well_formed(kCommandPosition));

inline constexpr Field kCurrentSpeedFields[] = {{.key = "current_speed",
                                                 .label = "Current Speed",
                                                 .first_bit = at(0),
                                                 .width = 32,
                                                 .kind = Kind::kSigned,
                                                 .role = Role::kSignal,
                                                 .unit = Unit::kStepPerSecond,
                                                 .section = kResponseSection}};
inline constexpr Layout kCurrentSpeed{.protocol = "ns310",
                                      .key = "response",
                                      .title = "Response Data: Current Speed",
                                      .size = 4,
                                      .fields = kCurrentSpeedFields,
                                      .section = kResponseSection};
static_assert(well_formed(kCurrentSpeed));

inline constexpr Field kAlarmCodeFields[] = {{.key = "alarm_code",
                                              .label = "Alarm Code",
                                              .first_bit = at(0),
                                              .width = 32,
                                              .base = Base::kHex,
                                              .role = Role::kState,
                                              .values = kAlarmCodes,
                                              .section = "SIE-C718-7 C.1",
                                              .explanation = "Of the NS310; the SGDH alarms behind it are many."}};
inline constexpr Layout kAlarmCode{.protocol = "ns310",
                                   .key = "response",
                                   .title = "Response Data: Alarm Code",
                                   .size = 4,
                                   .fields = kAlarmCodeFields,
                                   .section = "SIE-C718-7 C.1"};
static_assert(well_formed(kAlarmCode));

// The layout of bytes 4-7 of a command; kCommandData for NOP and reserved codes.
constexpr const Layout& command_data(std::int64_t code) {
  switch (static_cast<CommandCode>(code)) {
    case CommandCode::kNop:
      break;
    case CommandCode::kTargetPosition:
      return kTargetPosition;
    case CommandCode::kTargetSpeed:
      return kTargetSpeed;
    case CommandCode::kAcceleration:
      return kAcceleration;
    case CommandCode::kDeceleration:
      return kDeceleration;
    case CommandCode::kContinuousSpeed:
      return kContinuousSpeed;
    case CommandCode::kHoming:
      return kHoming;
    case CommandCode::kAlarmClear:
      return kAlarmClear;
  }
  return kCommandData;
}

// The layout of bytes 4-7 of a response; kResponseData for NOP and reserved codes.
constexpr const Layout& response_data(std::int64_t code) {
  switch (static_cast<ResponseCode>(code)) {
    case ResponseCode::kNop:
      break;
    case ResponseCode::kCurrentPosition:
      return kCurrentPosition;
    case ResponseCode::kCommandPosition:
      return kCommandPosition;
    case ResponseCode::kCurrentSpeed:
      return kCurrentSpeed;
    case ResponseCode::kAlarmCode:
      return kAlarmCode;
  }
  return kResponseData;
}

inline constexpr const Layout* kAssemblyLayouts[] = {
    &kCommand,         &kTargetPosition,  &kTargetSpeed,  &kAcceleration, &kDeceleration,
    &kContinuousSpeed, &kHoming,          &kAlarmClear,   &kCommandData,  &kResponse,
    &kCurrentPosition, &kCommandPosition, &kCurrentSpeed, &kAlarmCode,    &kResponseData,
};

}  // namespace servotrace::ns310
