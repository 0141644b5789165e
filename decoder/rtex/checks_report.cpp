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
    causes(0x0022, rule("RX306")),
    causes(0x002E, rule("RX402"), rule("RX403"), rule("RX401")),
    causes(0x0101, rule("RX303")),
};

// Which faults of the master lead to an alarm at once (8-1).
constexpr RuleId kAlarmCauses[] = {rule("RX402"), rule("RX403"), rule("RX102"), rule("RX103"), rule("RX105"),
                                   rule("RX107"), rule("RX201"), rule("RX202"), rule("RX203")};

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

}  // namespace servotrace::rtex::checks
