// SPDX-License-Identifier: MIT
// What a response assembly shows: missing echoes (YS109, YS111) and what the drive reports (YS901-YS905).
#include "decoder/findings/catalogue.hpp"
#include "decoder/profiles/yaskawa_ns310/session.hpp"

namespace servotrace::ns310 {
namespace {

// A report waits this long for its code (catalogue, YS901).
constexpr DurationNs kReportWaitNs = kSecondNs;
// A pair of parameters is judged this long after the last Set (catalogue, YS401).
constexpr DurationNs kSettleNs = kSecondNs;

}  // namespace

// Which kind of operation runs, and where the axis stands.
void Session::track_operation(const Response& response) {
  if (!response.in_progress) {
    operation_ = Operation::kNone;
  } else if (!response_ || !response_->in_progress) {
    operation_ = !response_ ? Operation::kUnknown : response.block_in_execution ? Operation::kBlock : candidate_;
    candidate_ = Operation::kUnknown;
  }
  if (response.is(ResponseCode::kCurrentPosition) || response.is(ResponseCode::kCommandPosition)) {
    position_ = response.data;
  } else if (response.in_progress) {
    position_.reset();
  }
}

void Session::judge_echoes(const Context& context, const Message& message, const Response& response) {
  const ByteRange where = bytes_in_frame(message, 0, 3);
  if (valid_wait_.active) {
    ++valid_wait_.polls;
    if (response.valid_data) {
      valid_echo_.add(elapsed_ns(valid_wait_.since_ns, response.time_ns));
      valid_wait_.end();
      judge(context, false, {.rule = rule("YS109")});
    } else {
      judge(context, elapsed(context, valid_wait_),
            {.rule = rule("YS109"),
             .arguments = {valid_wait_.polls, elapsed_ns(valid_wait_.since_ns, response.time_ns)},
             .where = where,
             .related = {valid_wait_.frame}});
    }
  }
  if (start_wait_.active) {
    ++start_wait_.polls;
    checked(context, rule("YS111"));
    if (response.start_echo) {
      start_echo_.add(elapsed_ns(start_wait_.since_ns, response.time_ns));
      start_wait_.end();
    } else if (response.command_error || response.alarm || !response.enable_state) {
      start_wait_.end();
    } else if (elapsed(context, start_wait_)) {
      raise(context, {.rule = rule("YS111"),
                      .arguments = {start_wait_.polls, elapsed_ns(start_wait_.since_ns, response.time_ns)},
                      .where = where,
                      .related = {start_wait_.frame}});
      start_wait_.end();
    }
  }
}

// YS202: a block 10h runs, and the capture shows the node's start and no homing since.
void Session::judge_home_travel(const Context& context, const Message& message, const Response& response) {
  const Block& block = blocks_.at(response.executing_block);
  if (!response.block_in_execution || !block.command_known ||
      block.command != static_cast<std::uint8_t>(BlockCommand::kHomeTravel)) {
    homing_block_ = 0;
    return;
  }
  if (homing_block_ == response.executing_block) return;
  homing_block_ = response.executing_block;
  checked(context, rule("YS202"));
  if (!start_seen_ || homed_) return;
  raise(context, {.rule = rule("YS202"),
                  .arguments = {response.executing_block},
                  .where = bytes_in_frame(message, 0, 2),
                  .related = {block.frame}});
}

void Session::judge_reports(const Context& context, const Message& message, const Response& response) {
  const bool first = !reported_.known;
  const Phase phase = !first ? Phase::kRises : start_seen_ ? Phase::kSinceStart : Phase::kSinceCaptureBegan;
  const auto phase_argument = static_cast<std::int64_t>(phase);
  const ByteRange bits = bytes_in_frame(message, 0, 1);
  const ByteRange status = bytes_in_frame(message, 2, 1);
  for (const RuleId id : {rule("YS901"), rule("YS902"), rule("YS903"), rule("YS904"), rule("YS905")}) {
    checked(context, id);
  }

  if (response.alarm && !reported_.alarm) {
    pending_alarm_ = {true, response.frame, response.time_ns, phase, cause_of_refusal(context)};
  }
  const bool shows_code = response.is(ResponseCode::kAlarmCode) && response.data != 0;
  if (pending_alarm_.active && response.alarm && shows_code) {
    issue_alarm(context, static_cast<std::uint32_t>(response.data), bytes_in_frame(message, 0, kMessageSize));
  } else if (pending_alarm_.active && !response.alarm) {
    issue_alarm(context, kCodeNotRead, bits);
  }

  if (response.command_error && !reported_.command_error) {
    raise(context, {.rule = rule("YS902"),
                    .arguments = {command_ ? command_->code : kCodeNotRead, phase_argument},
                    .where = status,
                    .related = {command_ ? command_->frame : 0},
                    .cause = first ? Cause{} : cause_of_refusal(context),
                    .as_note = first});
    if (!first) error_cleared_ = false;
  }
  if (!response.command_error) refusable_since_ = command_ ? command_->frame : response.frame;

  if (response.emergency_stop && !reported_.emergency_stop) {
    raise(context, {.rule = rule("YS903"), .arguments = {phase_argument}, .where = bits, .as_note = first});
  }
  const auto limits =
      static_cast<std::uint8_t>((response.cw_limit ? 1U : 0U) | (response.ccw_limit ? 2U : 0U) |
                                (response.positive_limit ? 4U : 0U) | (response.negative_limit ? 8U : 0U));
  const std::uint8_t reached = limits & static_cast<std::uint8_t>(~reported_.limits);
  if (reached != 0) {
    raise(context, {.rule = rule("YS904"), .arguments = {reached, phase_argument}, .where = status, .as_note = first});
  }
  if (response.block_fault && !reported_.block_fault) {
    pending_block_fault_ = {true, response.frame, response.time_ns, phase, {}};
  }
  reported_ = {true, response.alarm, response.command_error, response.emergency_stop, response.block_fault, limits};
}

void Session::issue_alarm(const Context& context, std::int64_t code, ByteRange where) {
  pending_alarm_.active = false;
  const std::int64_t detail = code >= 0 && find_alarm(code) == nullptr ? kCodeUnknown : code;
  raise(context, {.rule = rule("YS901"),
                  .arguments = {code, static_cast<std::int64_t>(pending_alarm_.phase), detail, detail},
                  .where = where,
                  .related = {pending_alarm_.frame == context.frame.number ? 0 : pending_alarm_.frame},
                  .cause = pending_alarm_.cause,
                  .as_note = pending_alarm_.phase != Phase::kRises});
}

void Session::issue_block_fault(const Context& context, std::int64_t code) {
  pending_block_fault_.active = false;
  raise(context, {.rule = rule("YS905"),
                  .arguments = {static_cast<std::int64_t>(pending_block_fault_.phase), code},
                  .related = {pending_block_fault_.frame == context.frame.number ? 0 : pending_block_fault_.frame},
                  .as_note = pending_block_fault_.phase != Phase::kRises});
}

// Deadlines that have passed by this frame.
void Session::expire(const Context& context) {
  const TimeNs now = context.frame.time_ns;
  if (pending_alarm_.active && elapsed_ns(pending_alarm_.since_ns, now) >= kReportWaitNs) {
    issue_alarm(context, kCodeNotRead, {});
  }
  if (pending_block_fault_.active && elapsed_ns(pending_block_fault_.since_ns, now) >= kReportWaitNs) {
    issue_block_fault(context, kCodeNotRead);
  }
  if (settle_pending_ && elapsed_ns(settle_ns_, now) >= kSettleNs) judge_pairs(context);
}

// The master's finding that a refusal answers: one that held when the drive was last seen to accept, or later.
Cause Session::cause_of_refusal(const Context& context) const {
  return cause_among(
      context,
      {rule("YS101"), rule("YS102"), rule("YS103"), rule("YS107"), rule("YS108"), rule("YS112"), rule("YS113"),
       rule("YS114"), rule("YS115"), rule("YS121"), rule("YS201"), rule("YS301"), rule("YS303"), rule("YS304")},
      refusable_since_);
}

}  // namespace servotrace::ns310
