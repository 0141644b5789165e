// SPDX-License-Identifier: MIT
// RX9: what the drive reports (SX-DSV02203 4-3-3, 6-10, 8-1, 8-2).
#include "decoder/rtex/tracking.hpp"

namespace servotrace::rtex::checks {
namespace {

struct CauseRow {
  std::uint16_t error_code = 0;
  RuleId rules[8] = {};
  std::size_t count = 0;
};

template <class... Ids>
constexpr CauseRow causes(std::uint16_t error_code, Ids... ids) {
  return {error_code, {ids...}, sizeof...(ids)};
}

// Which faults of the master a command error answers (6-10-2).
constexpr CauseRow kErrorCauses[] = {
    causes(0x0011, rule("RX102")),
    causes(0x0012, rule("RX103"), rule("RX107")),
    causes(0x0021, rule("RX105")),
    causes(0x0022, rule("RX306"), rule("RX307"), rule("RX517")),
    causes(0x002E, rule("RX402"), rule("RX403"), rule("RX404"), rule("RX407"), rule("RX408"), rule("RX411"),
           rule("RX401"), rule("RX502")),
    causes(0x0031, rule("RX308"), rule("RX606")),
    causes(0x0032, rule("RX309"), rule("RX310"), rule("RX514")),
    causes(0x0034, rule("RX310"), rule("RX314")),
    causes(0x0045, rule("RX603")),
    causes(0x0046, rule("RX705")),
    causes(0x0051, rule("RX522")),
    causes(0x0052, rule("RX522")),
    causes(0x0053, rule("RX522")),
    causes(0x0055, rule("RX522")),
    causes(0x0056, rule("RX505")),
    causes(0x0057, rule("RX501")),
    causes(0x0059, rule("RX507"), rule("RX508")),
    causes(0x005A, rule("RX522")),
    causes(0x0101, rule("RX303")),
    causes(0x0104, rule("RX510")),
    causes(0x0140, rule("RX510")),
    causes(0x0201, rule("RX607")),
};

// Which earlier faults an alarm or warning answers (chapter 8; 7-1, 7-2), and how long before it they lie at most.
struct AlarmCauseRow {
  std::uint8_t main = 0;  // 0: the code was not read
  DurationNs within_ns = 0;
  RuleId rules[20] = {};
  std::size_t count = 0;
};
template <class... Ids>
constexpr AlarmCauseRow alarm_causes(std::uint8_t main, std::int64_t within_ms, Ids... ids) {
  return {main, milliseconds(within_ms), {ids...}, sizeof...(ids)};
}
constexpr AlarmCauseRow kAlarmCauses[] = {
    alarm_causes(0, 100, rule("RX404"), rule("RX407"), rule("RX408"), rule("RX411"), rule("RX502"), rule("RX507"),
                 rule("RX508"), rule("RX510"), rule("RX604"), rule("RX402"), rule("RX403"), rule("RX102"),
                 rule("RX103"), rule("RX105"), rule("RX107"), rule("RX201"), rule("RX202"), rule("RX203"),
                 rule("RX703"), rule("RX518")),
    alarm_causes(24, 1000, rule("RX702"), rule("RX703"), rule("RX706")),
    alarm_causes(26, 1000, rule("RX702"), rule("RX703")),
    alarm_causes(27, 1000, rule("RX504"), rule("RX604"), rule("RX702"), rule("RX703")),
    alarm_causes(38, 1000, rule("RX518"), rule("RX705")),
    alarm_causes(83, 1000, rule("RX101"), rule("RX110"), rule("RX108")),
    alarm_causes(84, 10'000, rule("RX111"), rule("RX112"), rule("RX108")),
    alarm_causes(86, 1000, rule("RX102"), rule("RX103"), rule("RX105"), rule("RX107"), rule("RX201"), rule("RX202"),
                 rule("RX203")),
    alarm_causes(90, 10'000, rule("RX207"), rule("RX208")),
    alarm_causes(91, 1000, rule("RX402"), rule("RX403"), rule("RX404"), rule("RX407"), rule("RX408"), rule("RX411"),
                 rule("RX502"), rule("RX507"), rule("RX508"), rule("RX510")),
    alarm_causes(93, 60'000, rule("RX210"), rule("RX611"), rule("RX613")),
    alarm_causes(0xC0, 1000, rule("RX101"), rule("RX110")),
    alarm_causes(0xC1, 1000, rule("RX101"), rule("RX110")),
    alarm_causes(0xC2, 1000, rule("RX201"), rule("RX202"), rule("RX203")),
};

Cause cause_of_alarm(const Scene& scene, std::uint8_t code, TimeNs when) {
  for (const AlarmCauseRow& row : kAlarmCauses) {
    if (row.main == code) return scene.cause_among(std::span(row.rules).first(row.count), row.within_ns, when);
  }
  return {};
}

// The present alarm and warning where this response is the answer to an alarm command (6-6-2).
struct AlarmCode {
  std::uint8_t main = 0, sub = 0;
  std::uint8_t warning = 0;
};
AlarmCode alarm_code_in(const ResponsePart& answer) {
  const bool present = answer.is(NonCyclic::kAlarm) && answer.type_code != kAlarmAttribute && answer.index == 0 &&
                       !answer.busy && !answer.err;
  if (!present) return {};
  return {static_cast<std::uint8_t>(answer.data), static_cast<std::uint8_t>(answer.data >> 8),
          static_cast<std::uint8_t>(answer.data >> 16)};
}

// The sub number is 0 where the drive does not tell it (Pr7.23 bit 1 = 0).
std::int64_t in_full(const Node& node, const AlarmCode& code) {
  const bool told = code.main != 0 && (code.sub != 0 || node.known[Fact::kAlarmSubNumber].certainly(1));
  return told ? std::int64_t{code.main} << 8 | code.sub : kSubUnknown;
}

Cause cause_of_error(const Scene& scene, std::uint16_t error_code) {
  for (const CauseRow& row : kErrorCauses) {
    if (row.error_code == error_code)
      return scene.cause_among(std::span(row.rules).first(row.count), milliseconds(scene.limits().echo_ms));
  }
  return {};
}

}  // namespace

Outcome command_error(Scene& scene) {
  const ResponsePart& answer = scene.answer();
  if (!answer.error) return Outcome::kPassed;
  return scene.raise({.arguments = {answer.error_code, scene.is_sub() ? 1 : 0},
                      .where = scene.is_sub() ? scene.bytes(16, 4) : scene.bytes(8, 2),
                      .related = {scene.node->command_frame, 0},
                      .cause = cause_of_error(scene, answer.error_code),
                      .variant = answer.error_code});
}

Outcome alarm(Scene& scene) {
  const Node& node = *scene.node;
  const AlarmState& state = node.alarms;
  if (!node.response.alarm) return Outcome::kPassed;
  // A rise, or the first status of a run where it was not set in the run before.
  const bool rises = state.known ? !state.alarm : !state.was_alarm;
  if (!rises) return Outcome::kSilent;
  const bool first = !state.known && !state.was_known;
  const AlarmCode code = alarm_code_in(node.response.main);
  scene.node->alarms.alarm_open = code.main == 0;
  scene.node->alarms.alarm_first = first;
  return scene.raise({.arguments = {code.main, in_full(node, code), first ? 1 : 0},
                      .where = scene.bytes(2, 1),
                      .cause = cause_of_alarm(scene, code.main, scene.now.time_ns)});
}

Outcome warning(Scene& scene) {
  const Node& node = *scene.node;
  const AlarmState& state = node.alarms;
  if (!node.response.warning) return Outcome::kPassed;
  const bool rises = state.known ? !state.warning : !state.was_warning;
  if (!rises) return Outcome::kSilent;
  const bool first = !state.known && !state.was_known;
  const AlarmCode code = alarm_code_in(node.response.main);
  scene.node->alarms.warning_open = code.warning == 0;
  scene.node->alarms.warning_first = first;
  return scene.raise({.arguments = {code.warning, first ? 1 : 0},
                      .where = scene.bytes(2, 1),
                      .cause = cause_of_alarm(scene, code.warning != 0 ? code.warning : 0xC2, scene.now.time_ns)});
}

Outcome processing_error(Scene& scene) {
  const ResponsePart& answer = scene.answer();
  if (!answer.answers()) return Outcome::kSilent;
  if (!answer.err) return Outcome::kPassed;
  return scene.raise({.arguments = {answer.type_code, answer.echo},
                      .where = scene.is_sub() ? scene.bytes(16, 1) : scene.bytes(9, 1),
                      .related = {scene.channel->hold.start.frame, 0}});
}

Outcome processing_warning(Scene& scene) {
  const ResponsePart& answer = scene.answer();
  if (!answer.answers()) return Outcome::kSilent;
  const bool write = !scene.is_sub() && answer.is(NonCyclic::kParameter) && answer.type_code == kParameterWrite;
  if (!answer.wng || write) return Outcome::kPassed;  // a clipped write is RX605
  return scene.raise({.arguments = {answer.type_code, answer.echo},
                      .where = scene.is_sub() ? scene.bytes(16, 1) : scene.bytes(9, 1),
                      .related = {scene.channel->hold.start.frame, 0}});
}

Outcome torque_limited(Scene& scene) {
  const Node& node = *scene.node;
  if (!node.response.torque_limited) return Outcome::kPassed;
  if (!scene.context.frame.has_time || node.limited_since.frame == 0) return Outcome::kSilent;
  const DurationNs lasting = elapsed_ns(node.limited_since.time_ns, scene.now.time_ns);
  if (lasting <= milliseconds(scene.limits().torque_limited_ms)) return Outcome::kSilent;
  return scene.raise({.arguments = {lasting}, .where = scene.bytes(2, 1), .related = {node.limited_since.frame, 0}});
}

Outcome home_lost(Scene& scene) {
  const Node& node = *scene.node;
  if (!node.response_comparable || node.main().state == Handshake::kUnknown) return Outcome::kSilent;
  if (node.response.homing_complete || !node.previous_response.homing_complete) return Outcome::kPassed;
  // The command that clears it: held, or gone within the last echo limit.
  if (scene.context.frame.has_time && node.home_cleared.frame != 0 &&
      elapsed_ns(node.home_cleared.time_ns, scene.now.time_ns) <= milliseconds(scene.limits().busy_long_ms)) {
    return Outcome::kPassed;
  }
  return scene.raise({.where = scene.bytes(2, 1)});
}

Outcome servo_dropped(Scene& scene) {
  const Node& node = *scene.node;
  if (!node.response_comparable || !node.servo_on_known) return Outcome::kSilent;
  if (node.response.servo_active || !node.previous_response.servo_active) return Outcome::kPassed;
  // Servo_On has to have been 1 for longer than the echo lags.
  if (!node.servo_on_sent || scene.now.cycle - node.servo_change_cycle <= 4) return Outcome::kPassed;
  const bool near_alarm =
      node.response.alarm || (node.alarms.alarm_rise.frame != 0 &&
                              elapsed_ns(node.alarms.alarm_rise.time_ns, scene.now.time_ns) <= milliseconds(100));
  if (near_alarm) return Outcome::kPassed;
  return scene.raise({.where = scene.bytes(2, 1), .related = {node.command_frame, 0}});
}

Outcome emergency_stop(Scene& scene) {
  const Node& node = *scene.node;
  const EmergencyInput input = emergency_input(node);
  if (!input.known || !node.emergency.known) return Outcome::kSilent;
  if (!input.active) return Outcome::kPassed;
  if (node.emergency.active) return Outcome::kSilent;
  return scene.raise({.where = scene.bytes(0, node.wide ? 32 : 16)});
}

}  // namespace servotrace::rtex::checks

namespace servotrace::rtex {

void track_alarm_code(Scene& scene) {
  Node& node = *scene.node;
  AlarmState& state = node.alarms;
  const checks::AlarmCode code = checks::alarm_code_in(scene.answer());
  Findings& findings = scene.ring.findings;
  if (state.alarm_open && node.response.alarm && code.main != 0) {
    state.alarm_open = false;
    const bool at_rise = state.alarm_rise.frame != 0;
    findings.amend(node.owner, rule("RX902"), {code.main, checks::in_full(node, code), state.alarm_first ? 1 : 0},
                   checks::cause_of_alarm(scene, code.main, at_rise ? state.alarm_rise.time_ns : scene.now.time_ns));
  }
  if (state.warning_open && node.response.warning && code.warning != 0) {
    state.warning_open = false;
    const bool at_rise = state.warning_rise.frame != 0;
    findings.amend(
        node.owner, rule("RX903"), {code.warning, state.warning_first ? 1 : 0},
        checks::cause_of_alarm(scene, code.warning, at_rise ? state.warning_rise.time_ns : scene.now.time_ns));
  }
}

}  // namespace servotrace::rtex
