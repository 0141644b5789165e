// SPDX-License-Identifier: MIT
// The command position against the actual one: RX504, RX509, RX702, RX703, RX705, RX706 (SX-DSV02203 7-1, 7-2).
#include "decoder/rtex/scene.hpp"

namespace servotrace::rtex::checks {
namespace {

constexpr std::int64_t kHomingUnits = 1000;  // RX504, where the maximum speed is not known

std::int64_t magnitude(std::int64_t value) { return value < 0 ? -value : value; }

// The way of one updating cycle at the configured maximum speed, rounded up; 0 where it is not known.
std::int64_t longest_step(const Scene& scene) {
  const Node& node = *scene.node;
  if (node.settings == nullptr || !node.settings->max_speed || !scene.ring.cycle_ns) return 0;
  const std::int64_t ratio = scene.ring.ratio ? scene.ring.ratio.value : 2;
  const double way = static_cast<double>(*node.settings->max_speed) * static_cast<double>(scene.ring.cycle_ns.value) *
                     static_cast<double>(ratio) / static_cast<double>(kSecondNs);
  return way > 2e9 ? std::int64_t{2'000'000'000} : static_cast<std::int64_t>(way) + 1;
}

bool is_position_set(const CommandPart& part) {
  return part.code == static_cast<std::uint8_t>(NonCyclic::kHoming) &&
         (part.type_code == 0x21 || part.type_code == 0x22);
}

}  // namespace

Outcome homing_position_not_set(Scene& scene) {
  const Node& node = *scene.node;
  const HandshakeStep step = scene.channel->step;
  if (scene.is_sub() || node.mode_changed || !node.comparable || !node.command.is(Cyclic::kCp)) return Outcome::kSilent;
  if (step != HandshakeStep::kLeft && step != HandshakeStep::kLeftBusy) return Outcome::kSilent;
  const Hold& hold = scene.channel->hold;
  const bool search = is_homing_search(hold.part);
  if (!search && !is_position_set(hold.part)) return Outcome::kSilent;
  if (!hold.homing_complete || hold.refused || hold.ended || hold.not_started) return Outcome::kSilent;
  // With the servo off the command position acts at servo-on only: that is RX702.
  if (node.status_undefined || !node.response.servo_active) return Outcome::kSilent;
  const std::int32_t reference = search ? 0 : hold.part.setting_data;
  const std::int64_t way = longest_step(scene);
  const std::int64_t allowed = way != 0 ? way : kHomingUnits;
  const std::int64_t off = magnitude(apart(node.command.data1, reference));
  const bool carried = node.command.data1 == reference || node.previous.data1 == reference;
  if (carried && off <= allowed) return Outcome::kPassed;
  return scene.raise({.arguments = {hold.part.type_code, reference, node.previous.data1, node.command.data1},
                      .where = scene.bytes(kData1At, 4),
                      .related = {node.previous_frame, hold.start.frame},
                      .basis = way != 0 ? Basis{BasisKind::kConfigured, 0} : Basis{}});
}

Outcome position_set_moving(Scene& scene) {
  const Node& node = *scene.node;
  const Hold& hold = node.main().hold;
  if (!node.comparable || !is_position_set(node.command.main) || !is_position_set(node.previous.main))
    return Outcome::kSilent;
  if (!node.command.is(Cyclic::kCp) || !node.previous.is(Cyclic::kCp) || !hold.seen_start || !hold.every_response ||
      hold.refused || hold.homing_complete) {
    return Outcome::kSilent;
  }
  if (!node.have_response || node.status_undefined || !node.response.servo_active) return Outcome::kSilent;
  if (node.command.data1 == node.previous.data1) return Outcome::kPassed;
  return scene.raise({.arguments = {node.command.main.type_code, node.previous.data1, node.command.data1},
                      .where = scene.bytes(kData1At, 4),
                      .related = {node.previous_frame, hold.start.frame}});
}

Outcome servo_on_position_jump(Scene& scene) {
  const Node& node = *scene.node;
  const Position position = actual_position(node);
  if (!node.command.is(Cyclic::kCp) || !position.known || !node.response_chain) return Outcome::kSilent;
  const std::int64_t jump = apart(node.command.data1, position.value);
  if (magnitude(jump) <= scene.limits().servo_on_units) return Outcome::kPassed;
  return scene.raise({.arguments = {node.command.data1, position.value, jump},
                      .where = scene.bytes(kData1At, 4),
                      .related = {node.response_frame, 0},
                      .basis = position.basis});
}

Outcome position_step(Scene& scene) {
  const Node& node = *scene.node;
  const std::int64_t allowed = longest_step(scene);
  if (allowed == 0 || !node.comparable || node.mode_changed) return Outcome::kSilent;
  const auto is_on = [](const CommandView& command) { return command.is(Cyclic::kCp) && command.servo_on; };
  if (!is_on(node.command) || !is_on(node.previous)) return Outcome::kSilent;
  if (is_homing(node.command.main) || is_homing(node.previous.main)) return Outcome::kSilent;
  if (!node.have_response || node.status_undefined || !node.response.servo_active) return Outcome::kSilent;
  const std::int64_t step = apart(node.command.data1, node.previous.data1);
  if (magnitude(step) <= allowed) return Outcome::kPassed;
  return scene.raise({.arguments = {node.previous.data1, node.command.data1, allowed},
                      .where = scene.bytes(kData1At, 4),
                      .related = {node.previous_frame, 0},
                      .basis = {BasisKind::kConfigured, 0}});
}

Outcome drive_inhibit(Scene& scene) {
  const Node& node = *scene.node;
  const InhibitWatch& watch = node.inhibit;
  if (watch.direction == 0) return Outcome::kSilent;
  if (!watch.toward) return Outcome::kPassed;
  const bool profile = node.command.is(Cyclic::kPp);
  return scene.raise({.arguments = {watch.direction, node.command.cyclic},
                      .where = profile ? scene.bytes(kData1At, 12) : scene.bytes(kData1At, 4),
                      .related = {watch.frame, 0},
                      .basis = watch.basis});
}

Outcome command_while_off(Scene& scene) {
  const Node& node = *scene.node;
  const OffWatch& off = node.off;
  if (!off.known || !scene.context.frame.has_time) return Outcome::kSilent;
  const Position position = actual_position(node);
  const std::int64_t limit = scene.limits().servo_on_units;
  const std::int64_t distance = magnitude(apart(node.command.data1, position.value));
  if (off.moves == 0) return Outcome::kPassed;
  if (!off.moves_now) return Outcome::kSilent;
  // The master gets the echo limit to see that the servo is off; the command moves, not the axis.
  const bool away = off.moves >= 3 && distance - off.least > limit &&
                    magnitude(apart(node.command.data1, off.at_least)) > limit &&
                    elapsed_ns(off.since.time_ns, scene.now.time_ns) > milliseconds(scene.limits().echo_ms);
  if (!away) return Outcome::kSilent;
  return scene.raise({.arguments = {node.command.data1, position.value},
                      .where = scene.bytes(kData1At, 4),
                      .related = {off.frame_least, node.response_frame},
                      .basis = position.basis});
}

}  // namespace servotrace::rtex::checks
