// SPDX-License-Identifier: MIT
// RX9: what the drive reports (SX-DSV02203 4-3-3, 6-10, 8-1, 8-2).
#include "decoder/rtex/scene.hpp"

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

// Which faults of the master lead to an alarm at once (8-1).
constexpr RuleId kAlarmCauses[] = {rule("RX404"), rule("RX407"), rule("RX408"), rule("RX411"), rule("RX502"),
                                   rule("RX507"), rule("RX508"), rule("RX510"), rule("RX604"), rule("RX402"),
                                   rule("RX403"), rule("RX102"), rule("RX103"), rule("RX105"), rule("RX107"),
                                   rule("RX201"), rule("RX202"), rule("RX203")};

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
  return scene.raise({.arguments = {0, kSubUnknown, first ? 1 : 0},
                      .where = scene.bytes(2, 1),
                      .cause = scene.cause_among(kAlarmCauses, milliseconds(scene.limits().echo_ms))});
}

Outcome warning(Scene& scene) {
  const Node& node = *scene.node;
  const AlarmState& state = node.alarms;
  if (!node.response.warning) return Outcome::kPassed;
  const bool rises = state.known ? !state.warning : !state.was_warning;
  if (!rises) return Outcome::kSilent;
  static constexpr RuleId kCauses[] = {rule("RX201"), rule("RX202"), rule("RX203")};
  const bool first = !state.known && !state.was_known;
  return scene.raise({.arguments = {0, first ? 1 : 0},
                      .where = scene.bytes(2, 1),
                      .cause = scene.cause_among(kCauses, milliseconds(scene.limits().echo_ms))});
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
