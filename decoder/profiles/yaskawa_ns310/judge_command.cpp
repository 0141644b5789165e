// SPDX-License-Identifier: MIT
// What a command assembly does wrong: YS101-YS108, YS110, YS112-YS121, YS201, YS203.
#include "decoder/findings/catalogue.hpp"
#include "decoder/profiles/yaskawa_ns310/session.hpp"

namespace servotrace::ns310 {
namespace {

constexpr ByteRange kWholeMessage{0, kMessageSize};

ByteRange in(const Message& message, std::uint32_t offset, std::uint32_t length) {
  return bytes_in_frame(message, offset, length);
}
ByteRange whole(const Message& message) { return in(message, kWholeMessage.offset, kWholeMessage.length); }
ByteRange data(const Message& message) { return in(message, kDataOffset, 4); }

Operation operation_of(const Command& command) {
  if (command.is(CommandCode::kTargetPosition)) return Operation::kPositioning;
  if (command.is(CommandCode::kContinuousSpeed)) return Operation::kContinuous;
  if (command.is(CommandCode::kHoming)) return Operation::kHoming;
  return Operation::kUnknown;
}

// The data of a command code that a start acts on (position, speed, homing type).
bool same_motion(const Command& a, const Command& b) { return a.code == b.code && a.data == b.data; }

}  // namespace

// Codes and values, wherever Valid_Data = 1 makes the drive take them.
void Session::judge_data(const Context& context, const Message& message, const Command& command) {
  const bool valid = command.valid_data;
  const std::int64_t code = command.code;
  fault_while(
      context, valid && (command.command_axis != 1 || command.response_axis != 1),
      {.rule = rule("YS101"), .arguments = {command.command_axis, command.response_axis}, .where = in(message, 2, 2)});
  fault_while(context, valid && find_value(kCommandCodes, code) == nullptr,
              {.rule = rule("YS102"), .arguments = {code}, .where = in(message, 2, 1), .variant = code});
  fault_while(context, valid && find_value(kResponseCodes, command.response_code) == nullptr,
              {.rule = rule("YS103"),
               .arguments = {command.response_code},
               .where = in(message, 3, 1),
               .variant = command.response_code});
  const bool wants_positive = command.is(CommandCode::kTargetSpeed) || command.is(CommandCode::kAcceleration) ||
                              command.is(CommandCode::kDeceleration);
  const bool not_positive =
      (wants_positive && command.data <= 0) || (command.is(CommandCode::kContinuousSpeed) && command.data < 0);
  fault_while(context, valid && not_positive,
              {.rule = rule("YS107"), .arguments = {code, command.data}, .where = data(message), .variant = code});
  fault_while(context,
              valid && command.is(CommandCode::kTargetPosition) &&
                  (command.data < kPositionRange.minimum || command.data > kPositionRange.maximum),
              {.rule = rule("YS108"), .arguments = {command.data}, .where = data(message)});
  const Bytes bytes = message.bytes.subspan(kDataOffset);
  const std::int64_t type = read(slot(kHoming, "homing_type"), bytes);
  fault_while(context, valid && command.is(CommandCode::kHoming) && find_value(kHomingTypes, type) == nullptr,
              {.rule = rule("YS114"), .arguments = {type}, .where = in(message, kDataOffset, 1), .variant = type});
  const bool reserved =
      (command.is(CommandCode::kHoming) && read(slot(kHoming, "homing_reserved"), bytes) != 0) ||
      (command.is(CommandCode::kAlarmClear) && read(slot(kAlarmClear, "alarm_clear_reserved"), bytes) != 0);
  const bool rises = command_ && !command_->start_trajectory && command.start_trajectory;
  const bool clears_nothing =
      command.is(CommandCode::kAlarmClear) && rises && read(slot(kAlarmClear, "alarm_clear"), bytes) == 0;
  fault_while(context, valid && (reserved || clears_nothing),
              {.rule = rule("YS115"), .arguments = {code, reserved ? 0 : 1}, .where = data(message), .variant = code});
}

// Levels and their edges that start nothing.
void Session::judge_levels(const Context& context, const Message& message, const Command& command) {
  const ByteRange bits = in(message, 0, 1);
  if (command_ && response_) {
    const Command& before = *command_;
    const Response& state = *response_;
    const bool dropped_hard = before.hard_stop && !command.hard_stop;
    const bool dropped_smooth = before.smooth_stop && !command.smooth_stop;
    if (dropped_hard || dropped_smooth) {
      checked(context, rule("YS117"));
      if (state.in_progress) {
        fault(context,
              {.rule = rule("YS117"), .arguments = {dropped_hard ? 1 : 0}, .where = bits, .related = {state.frame}});
      }
    }
    if (!before.enable && command.enable) {
      checked(context, rule("YS118"));
      if (!state.servo_ready) {
        raise(context, {.rule = rule("YS118"), .where = bits, .related = {state.frame}});
      }
    }
    if (before.enable && !command.enable) {
      checked(context, rule("YS203"));
      if (state.in_progress) {
        fault(context, {.rule = rule("YS203"), .where = bits, .related = {state.frame}});
      }
    }
    // YS110: the refused data may change only after Valid_Data = 0.
    if (state.command_error && command.valid_data && before.valid_data && !error_cleared_) {
      const bool changed = before.block_number != command.block_number || before.code != command.code ||
                           before.command_axis != command.command_axis || before.data != command.data ||
                           before.forward != command.forward || before.incremental != command.incremental;
      const bool starts =
          (!before.start_trajectory && command.start_trajectory) || (!before.start_block && command.start_block);
      fault_while(context, changed || starts,
                  {.rule = rule("YS110"), .where = whole(message), .related = {state.frame}});
    }
  }
  if (!command.valid_data) error_cleared_ = true;
}

// A rising Start_Trajectory or Start_Block: the first rule that applies, in the catalogue's order.
void Session::judge_start(const Context& context, const Message& message, const Command& command) {
  if (!command_) return;
  const bool trajectory = !command_->start_trajectory && command.start_trajectory;
  const bool block = !command_->start_block && command.start_block;
  if (!trajectory && !block) {
    if (!command.start_trajectory) start_wait_.end();
    return;
  }
  const ByteRange bits = in(message, 0, 1);
  const ByteRange head = in(message, 0, 3);
  const bool alarm_clear = trajectory && !block && command.is(CommandCode::kAlarmClear);
  const std::int64_t which = trajectory ? (block ? 2 : 0) : 1;
  const bool known = response_.has_value();
  const std::uint64_t state_frame = known ? response_->frame : 0;
  const bool clean_before = command_clean_;
  for (const RuleId id : {rule("YS106"), rule("YS113"), rule("YS104"), rule("YS120"), rule("YS121")}) {
    checked(context, id);
  }
  if (trajectory) checked(context, rule("YS105"));
  if (trajectory) started_ = command;

  if (!command.valid_data) {
    fault(context, {.rule = rule("YS106"), .arguments = {which}, .where = bits});
  } else if (trajectory && !alarm_clear && !command_->enable && command.enable) {
    fault(context, {.rule = rule("YS105"), .where = bits});
  } else if (known && response_->alarm && !alarm_clear) {
    fault(context, {.rule = rule("YS113"), .arguments = {which}, .where = bits, .related = {state_frame}});
  } else if (known && !response_->enable_state && !alarm_clear) {
    fault(context, {.rule = rule("YS104"), .arguments = {which}, .where = bits, .related = {state_frame}});
  } else if (block && !trajectory && command.block_number == 0) {
    fault(context, {.rule = rule("YS301"), .arguments = {0, 0}, .where = in(message, 0, 2)});
  } else if (block && !trajectory && known && response_->block_in_execution) {
    fault(context, {.rule = rule("YS301"),
                    .arguments = {1, command.block_number},
                    .where = in(message, 0, 2),
                    .related = {state_frame},
                    .as_warning = true});
  } else if (trajectory && !block && command.is_motion() && known && response_->in_progress &&
             operation_ != Operation::kUnknown && operation_ != Operation::kNone && operation_ != Operation::kBlock &&
             operation_ != operation_of(command)) {
    checked(context, rule("YS112"));
    fault(context,
          {.rule = rule("YS112"),
           .arguments = {static_cast<std::int64_t>(operation_of(command)), static_cast<std::int64_t>(operation_)},
           .where = head,
           .related = {state_frame}});
    operation_ = Operation::kUnknown;  // whether the drive took it is not known
  } else if (trajectory && !block && into_limit(context, message, command)) {
    command_clean_ = false;
  } else if ((trajectory && block) || (trajectory && !command.is_motion() && !alarm_clear &&
                                       find_value(kCommandCodes, command.code) != nullptr)) {
    fault(context, {.rule = rule("YS121"), .arguments = {command.code, block ? 1 : 0}, .where = head});
  } else if (command.stops() && !alarm_clear) {
    fault(context, {.rule = rule("YS120"), .arguments = {which, command.hard_stop ? 1 : 0}, .where = bits});
  } else if (trajectory && command.is_motion()) {
    judge_parameters_at_start(context, head);
    if (known) checked(context, rule("YS112"));
    // No other finding on the command, no known reason to refuse it: the drive must echo it.
    if (command_clean_ && clean_before && known && response_->enable_state && !response_->in_progress &&
        !response_->block_in_execution && !response_->command_error) {
      start_wait_.begin(command.frame, command.time_ns);
    }
    start_accepted(command);
  } else if (block) {
    checked(context, rule("YS301"));
    judge_parameters_at_start(context, head);
    judge_chain(context, command.block_number, in(message, 0, 2));
    candidate_ = Operation::kBlock;
    homing_block_ = 0;
  }
}

void Session::start_accepted(const Command& command) {
  candidate_ = operation_of(command);
  if (candidate_ == Operation::kHoming) homed_ = true;
  if (candidate_ == Operation::kContinuous) rotation_ = command;
}

// YS201: a start toward a limit the last response shows active.
bool Session::into_limit(const Context& context, const Message& message, const Command& command) {
  if (!response_ || response_->in_progress) return false;
  bool positive = false;
  if (command.is(CommandCode::kContinuousSpeed)) {
    if (command.data <= 0) return false;
    positive = command.forward;
  } else if (command.is(CommandCode::kTargetPosition)) {
    std::int64_t distance = command.data;
    if (!command.incremental) {
      if (!position_) return false;
      distance -= *position_;
    }
    if (distance == 0) return false;
    positive = distance > 0;
  } else {
    return false;
  }
  checked(context, rule("YS201"));
  const ByteRange where = in(message, 0, kMessageSize);
  if (positive ? response_->positive_limit : response_->negative_limit) {
    raise(context, {.rule = rule("YS201"),
                    .arguments = {positive ? 2 : 3, positive ? 1 : 0},
                    .where = where,
                    .related = {response_->frame}});
    return true;
  }
  // Which way is clockwise is the reference direction's to say (25h/24).
  if (!response_->cw_limit && !response_->ccw_limit) return false;
  // With 1, the text of the Direction bit and the reference direction contradict each other: silent.
  const bool counter = reference_direction_.value == 1;
  if (counter && command.is(CommandCode::kContinuousSpeed)) return false;
  const bool clockwise = positive != counter;
  if (clockwise ? !response_->cw_limit : !response_->ccw_limit) return false;
  raise(context, {.rule = rule("YS201"),
                  .arguments = {clockwise ? 0 : 1, positive ? 1 : 0},
                  .where = where,
                  .related = {response_->frame},
                  .basis = reference_direction_.basis,
                  .as_warning = !reference_direction_.is_known()});
  return true;
}

// Changes under a held Start_Trajectory, and speeds a rotation does not take.
void Session::judge_unchanged_start(const Context& context, const Message& message, const Command& command) {
  const bool held = command_ && command_->start_trajectory && command.start_trajectory;
  // YS116
  const bool rotates =
      started_ && started_->is(CommandCode::kContinuousSpeed) && command.is(CommandCode::kContinuousSpeed);
  if (held && !started_) started_ = *command_;  // the capture began under a held start
  const bool ignored = held && command.valid_data && command.is_motion() && started_->valid_data && !rotates &&
                       !same_motion(*started_, command);
  if (!ignored) {
    edge_wait_.end();
    edge_found_ = false;
  } else if (!edge_wait_.active || !same_motion(*command_, command)) {
    edge_wait_.begin(command.frame, command.time_ns);
    edge_found_ = false;
  } else {
    ++edge_wait_.polls;
    if (!edge_found_ && elapsed(context, edge_wait_)) {
      edge_found_ = true;
      fault(context, {.rule = rule("YS116"),
                      .arguments = {command.code, command.data},
                      .where = in(message, 2, 6),
                      .related = {edge_wait_.frame, started_->frame}});
    }
  }
  if (held) checked(context, rule("YS116"));
  // YS119
  const bool rotating = rotation_ && response_ && response_->in_progress && operation_ == Operation::kContinuous &&
                        !command.stops() && command.is(CommandCode::kContinuousSpeed);
  if (rotating && command.valid_data && command.start_trajectory) rotation_ = command;
  const bool untaken = rotating && (command.data != rotation_->data || command.forward != rotation_->forward);
  if (!untaken) {
    continuous_wait_.end();
    continuous_found_ = false;
  } else if (!continuous_wait_.active || command_->data != command.data || command_->forward != command.forward) {
    continuous_wait_.begin(command.frame, command.time_ns);
    continuous_found_ = false;
  } else {
    ++continuous_wait_.polls;
    if (!continuous_found_ && elapsed(context, continuous_wait_)) {
      continuous_found_ = true;
      fault(context, {.rule = rule("YS119"),
                      .arguments = {command.data, command.forward ? 1 : 0, command.valid_data ? 1 : 0},
                      .where = in(message, 0, kMessageSize),
                      .related = {continuous_wait_.frame, rotation_->frame}});
    }
  }
  if (rotating) checked(context, rule("YS119"));
}

}  // namespace servotrace::ns310
