// SPDX-License-Identifier: MIT
// Starts, stops and levels of the control inputs: NK206, NK301-NK311.
#include "decoder/findings/catalogue.hpp"
#include "decoder/profiles/nsk_esb/session.hpp"

namespace servotrace::esb {
namespace {

ByteRange signals(const Message& message) { return bytes_in_frame(message, 0, 3); }
std::int64_t number_of(StartKind kind) { return static_cast<std::int64_t>(kind); }

}  // namespace

void Session::judge_motion(const Context& context, const Message& message, const Input& input) {
  judge(context, input.reserved, {.rule = rule("NK308"), .where = bytes_in_frame(message, 1, 3)});
  if (!input_) return;
  const Input& before = *input_;
  if (!before.run && input.run) judge_start(context, message, input, StartKind::kRun);
  if (!before.hos && input.hos) judge_start(context, message, input, StartKind::kHos);
  if (!before.jog && input.jog) judge_start(context, message, input, StartKind::kJog);
  if (!before.prm_req && input.prm_req && input.prm_ope && is_motion_command(input.number)) {
    judge_start(context, message, input, StartKind::kCommand);
  }
  if (!output_) return;
  const std::array<std::uint64_t, 2> related = {output_->frame, 0};
  if (!before.clr && input.clr) {
    checked(context, rule("NK306"));
    if (output_->busy) raise(context, {.rule = rule("NK306"), .where = signals(message), .related = related});
  }
  if (!before.ord && input.ord) {
    checked(context, rule("NK307"));
    if (output_->busy) raise(context, {.rule = rule("NK307"), .where = signals(message), .related = related});
  }
  if (before.svon && !input.svon) {
    checked(context, rule("NK311"));
    if (output_->busy) raise(context, {.rule = rule("NK311"), .where = signals(message), .related = related});
  }
}

// One start: the first of NK304, NK303, NK301, NK302 that applies, and beside it what it goes without.
void Session::judge_start(const Context& context, const Message& message, const Input& input, StartKind kind) {
  const ByteRange where = kind == StartKind::kCommand ? message.in_frame : signals(message);
  const std::int64_t what = number_of(kind);
  const std::uint64_t state = output_ ? output_->frame : 0;
  for (const RuleId id : {rule("NK301"), rule("NK303"), rule("NK304")}) checked(context, id);
  if (kind != StartKind::kJog) checked(context, rule("NK302"));
  bool clean = true;

  if (input.emst || (output_ && output_->emsta)) {
    clean = false;
    raise(context, {.rule = rule("NK304"),
                    .arguments = {what, input.number, input.emst ? 0 : 1},
                    .where = where,
                    .related = {input.emst ? 0 : state}});
  } else if (input.stp) {
    clean = false;
    raise(context, {.rule = rule("NK303"), .arguments = {what, input.number}, .where = where});
  } else if (!input.svon || (output_ && !output_->drdy)) {
    clean = false;
    raise(context, {.rule = rule("NK301"),
                    .arguments = {what, input.number, input.svon ? 1 : 0},
                    .where = where,
                    .related = {input.svon ? state : 0}});
  } else if (kind != StartKind::kJog && output_ && output_->busy) {
    const Channel& running = programs_.channel(output_->ack_prg);
    const bool program_runs = runs_ != Runs::kOther;
    const bool waits = program_runs && running.waits_for_run();
    if (!waits) {
      clean = false;
      raise(context, {.rule = rule("NK302"),
                      .arguments = {what, input.number, output_->ack_prg},
                      .where = where,
                      .related = {state},
                      .as_note = kind == StartKind::kRun && program_runs && !running.is_certain()});
    }
  }

  // A program left open: a motion command is NK202 or NK205 then.
  if (kind != StartKind::kCommand && program_session_ != ProgramSession::kUnknown) {
    checked(context, rule("NK206"));
    if (program_session_ != ProgramSession::kNone) {
      raise(context, {.rule = rule("NK206"),
                      .arguments = {program_session_ == ProgramSession::kEdit ? 0 : 1, session_channel_, 0},
                      .where = where,
                      .related = {session_frame_}});
    }
  }
  if (input.ord) {
    checked(context, rule("NK310"));
    const std::int32_t* ratio = known_value(kOverrideRatio);
    if (ratio != nullptr && *ratio == 0) {
      clean = false;
      raise(context, {.rule = rule("NK310"),
                      .arguments = {what, input.number},
                      .where = where,
                      .basis = basis_of(kOverrideRatio)});
    }
  }
  judge_home(context, message, input, kind);

  if (kind == StartKind::kRun && clean && output_ && !output_->busy && program_session_ != ProgramSession::kEdit &&
      program_session_ != ProgramSession::kRead) {
    busy_awaited_ = true;
    run_frame_ = context.frame.number;
    run_ns_ = context.frame.time_ns;
  }
  if (clean) runs_ = kind == StartKind::kRun || input.number == kStartProgram ? Runs::kProgram : Runs::kOther;
}

// NK309: an absolute motion without a home position.
void Session::judge_home(const Context& context, const Message& message, const Input& input, StartKind kind) {
  const bool absolute_command = kind == StartKind::kCommand && input.number >= 400 && input.number <= 407;
  if (!output_ || (kind != StartKind::kRun && !absolute_command)) return;
  checked(context, rule("NK309"));
  if (output_->hcmp) return;
  const std::int32_t* homes = known_value(kProgramHome);
  Programs::Start start = Programs::Start::kAbsolute;
  if (homes != nullptr && *homes != 0) return;
  if (kind == StartKind::kRun) {
    start = programs_.start_of(input.prg);
    if (start == Programs::Start::kHomesFirst || start == Programs::Start::kOther) return;
  }
  raise(context, {.rule = rule("NK309"),
                  .arguments = {number_of(kind), kind == StartKind::kRun ? input.prg : input.number},
                  .where = kind == StartKind::kRun ? signals(message) : message.in_frame,
                  .related = {output_->frame},
                  .basis = homes != nullptr ? basis_of(kProgramHome) : Basis{},
                  .as_note = start == Programs::Start::kUnknown});
}

// NK305: RUN, and no BUSY within the limit.
void Session::await_busy(const Context& context, const Message& message, const Output& output) {
  if (!busy_awaited_) return;
  const bool stopped = !output.drdy || output.emsta || (input_ && (input_->emst || input_->stp || !input_->svon));
  if (output.busy) {
    start_to_busy_.add(elapsed_ns(run_ns_, output.time_ns));
    checked(context, rule("NK305"));
    busy_awaited_ = false;
  } else if (stopped) {
    busy_awaited_ = false;
  } else if (elapsed_ns(run_ns_, output.time_ns) >= milliseconds(limits().start_seen_ms)) {
    checked(context, rule("NK305"));
    raise(context, {.rule = rule("NK305"),
                    .arguments = {elapsed_ns(run_ns_, output.time_ns)},
                    .where = bytes_in_frame(message, 0, 1),
                    .related = {run_frame_}});
    busy_awaited_ = false;
  }
}

}  // namespace servotrace::esb
