// SPDX-License-Identifier: MIT
// What the drive reports (NK901-NK905), and the deadlines that pass between messages (NK104, NK105).
#include <algorithm>

#include "decoder/findings/catalogue.hpp"
#include "decoder/profiles/nsk_esb/session.hpp"

namespace servotrace::esb {
namespace {

// A report waits this long for a read of the alarm word (catalogue, NK901).
constexpr DurationNs kReportWaitNs = kSecondNs;
// A home position lost within this time of a write of DI is lost by it.
constexpr DurationNs kInversionActsNs = kSecondNs;
constexpr std::int64_t kWordNotRead = -1;

}  // namespace

void Session::judge_reports(const Context& context, const Message& message, const Output& output) {
  const bool first = !reported_.known;
  const Phase phase = !first ? Phase::kRises : start_seen_ ? Phase::kSinceStart : Phase::kSinceCaptureBegan;
  const auto phase_argument = static_cast<std::int64_t>(phase);
  const ByteRange limits_byte = bytes_in_frame(message, 2, 1);
  for (const RuleId id : {rule("NK901"), rule("NK902"), rule("NK903"), rule("NK904"), rule("NK905")}) {
    checked(context, id);
  }
  // The brake output says nothing of the alarm while the servo is off or an emergency stop holds it (4.4.4).
  const bool brake_counts = input_ && input_->svon && !output.emsta;
  const std::uint8_t outputs = pattern(output.drdy, output.over, output.brk);

  if (!output.drdy && (first || reported_.drdy)) {
    not_ready_ = {true, output.frame, output.time_ns, outputs, brake_counts, phase, {}};
  } else if (!output.drdy && not_ready_.active) {
    not_ready_.outputs = outputs;  // the outputs need not change in one message
  } else if (output.drdy && not_ready_.active) {
    // A drive that has just started gets ready within this time: nothing to report.
    if (not_ready_.phase == Phase::kSinceStart) {
      not_ready_.active = false;
    } else {
      issue_not_ready(context, kWordNotRead);
    }
  }
  const bool warns = output.drdy && output.over;
  const bool warned = reported_.drdy && reported_.over;
  if (warns && (first || (!warned && !reported_.over))) {
    warning_ = {true, output.frame, output.time_ns, outputs, brake_counts, phase, {}};
  } else if (!output.over && warning_.active) {
    issue_warning(context, kWordNotRead);
  }

  if (output.emsta && !reported_.emsta) {
    raise(context, {.rule = rule("NK903"), .arguments = {phase_argument}, .where = limits_byte, .as_note = first});
  }
  const bool plus = output.otpa && !reported_.otpa;
  const bool minus = output.otma && !reported_.otma;
  if (plus || minus) {
    raise(context, {.rule = rule("NK904"),
                    .arguments = {(plus ? 1 : 0) | (minus ? 2 : 0), phase_argument},
                    .where = limits_byte,
                    .as_note = first});
  }
  if (!output.hcmp && reported_.known && reported_.hcmp) {
    const bool inverted = inversion_frame_ != 0 && elapsed_ns(inversion_ns_, output.time_ns) < kInversionActsNs;
    raise(context, {.rule = rule("NK905"),
                    .arguments = {inverted ? 1 : 0},
                    .where = bytes_in_frame(message, 0, 1),
                    .related = {inverted ? inversion_frame_ : 0}});
  }
  reported_ = {true, output.drdy, output.over, output.emsta, output.otpa, output.otma, output.hcmp};
}

std::uint64_t Session::fitting(const PendingReport& report, std::int64_t word) const {
  const std::uint64_t set =
      alarms_that_fit((report.outputs & 1U) != 0, (report.outputs & 2U) != 0, (report.outputs & 4U) != 0,
                      report.brake_counts, [this](std::uint16_t number) { return known_value(number); });
  return word < 0 ? set : narrowed(set, static_cast<std::uint32_t>(word));
}

void Session::issue_not_ready(const Context& context, std::int64_t word) {
  not_ready_.active = false;
  raise(context, {.rule = rule("NK901"),
                  .arguments = {not_ready_.outputs, word, static_cast<std::int64_t>(fitting(not_ready_, word)),
                                static_cast<std::int64_t>(not_ready_.phase)},
                  .related = {not_ready_.frame == context.frame.number ? 0 : not_ready_.frame},
                  .as_note = not_ready_.phase != Phase::kRises});
}

void Session::issue_warning(const Context& context, std::int64_t word) {
  warning_.active = false;
  raise(context, {.rule = rule("NK902"),
                  .arguments = {warning_.outputs, word, static_cast<std::int64_t>(fitting(warning_, word)),
                                static_cast<std::int64_t>(warning_.phase)},
                  .related = {warning_.frame == context.frame.number ? 0 : warning_.frame},
                  .as_note = warning_.phase != Phase::kRises});
}

void Session::expire(const Context& context) {
  const TimeNs now = context.frame.time_ns;
  if (not_ready_.active && elapsed_ns(not_ready_.since_ns, now) >= kReportWaitNs) {
    issue_not_ready(context, kWordNotRead);
  }
  if (warning_.active && elapsed_ns(warning_.since_ns, now) >= kReportWaitNs) issue_warning(context, kWordNotRead);
  if (handshake_ == Handshake::kRequested && transaction_.begun) {
    const DurationNs limit = std::max(limit_ns(transaction_.number), limit_ns(transaction_.changed_number));
    if (elapsed_ns(transaction_.time_ns, now) > limit) step_handshake(context, {}, HandshakeEvent::kLimitPasses);
  }
  if (handshake_ == Handshake::kReleased && release_seen_ && output_ && output_->prm_ack &&
      output_->frame == context.frame.number && elapsed_ns(release_ns_, now) > milliseconds(limits().prm_ack_ms)) {
    step_handshake(context, {}, HandshakeEvent::kLimitPasses);
  }
}

}  // namespace servotrace::esb
