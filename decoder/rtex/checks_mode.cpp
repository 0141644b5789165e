// SPDX-License-Identifier: MIT
// RX4: the control mode and its changes (SX-DSV02203 5-2, 7-6).
#include "decoder/rtex/scene.hpp"

namespace servotrace::rtex::checks {
namespace {

// The command the mode change left. One change reports the most specific rule: RX411, RX404, RX402, RX401.
bool in_homing(const Scene& scene) {
  const Node& node = *scene.node;
  return node.comparable && !node.previous.is_nop() && is_homing(node.previous.main);
}

bool in_special_profile(const Scene& scene) {
  const Node& node = *scene.node;
  if (!node.profile.known || node.mode_before != static_cast<std::uint8_t>(Cyclic::kPp)) return false;
  const std::uint8_t type = node.profile.type_code;
  const bool special = type == 0x12 || type == 0x13 || (type >= 0x31 && type <= 0x33);
  return special && in_progress(node).yes;
}

// Whether the axis moves under the mode it had until now.
Answer moved(const Scene& scene) {
  const Node& node = *scene.node;
  if (node.mode_before == static_cast<std::uint8_t>(Cyclic::kPp)) {
    const Answer progress = in_progress(node);
    if (progress.yes && node.response.servo_active) return progress;
  }
  return speed_moves(scene.ring, node);
}

}  // namespace

Outcome mode_change_not_normal(Scene& scene) {
  const Node& node = *scene.node;
  if (!node.comparable) return Outcome::kSilent;
  if (in_homing(scene) || in_special_profile(scene) || node.main().process.busy) return Outcome::kSilent;
  if (node.previous.is_nop() || node.previous.main.code == 0) return Outcome::kPassed;
  return scene.raise({.arguments = {node.mode_before, node.command.cyclic, node.previous.main.code},
                      .where = scene.bytes(1, 1),
                      .related = {node.previous_frame, 0}});
}

Outcome mode_change_while_busy(Scene& scene) {
  const Node& node = *scene.node;
  if (in_homing(scene) || in_special_profile(scene)) return Outcome::kSilent;
  const Process& process = node.main().process;
  if (!process.busy) return Outcome::kPassed;
  return scene.raise({.arguments = {node.mode_before, node.command.cyclic, process.code},
                      .where = scene.bytes(1, 1),
                      .related = {process.since.frame, 0}});
}

Outcome mode_change_too_soon(Scene& scene) {
  const Node& node = *scene.node;
  const std::int64_t needed = cycles_in(scene.ring, milliseconds(2));
  if (!node.mode_changed_before || needed == 0) return Outcome::kSilent;
  const std::int64_t passed = scene.now.cycle - node.mode_change_cycle;
  if (passed >= needed) return Outcome::kPassed;
  return scene.raise({.arguments = {node.mode_before, node.command.cyclic, passed, needed},
                      .where = scene.bytes(1, 1),
                      .related = {node.mode_change_frame, 0},
                      .basis = scene.ring.cycle_ns.basis});
}

Outcome mode_change_in_profile(Scene& scene) {
  const Node& node = *scene.node;
  if (in_homing(scene)) return Outcome::kSilent;
  if (!in_special_profile(scene)) return Outcome::kPassed;
  return scene.raise({.arguments = {node.mode_before, node.command.cyclic, node.profile.type_code},
                      .where = scene.bytes(1, 1),
                      .related = {node.response_frame, 0},
                      .basis = in_progress(node).basis});
}

Outcome mode_change_to_cp_moving(Scene& scene) {
  const Node& node = *scene.node;
  if (!node.command.is(Cyclic::kCp)) return Outcome::kSilent;
  const Answer moving = moved(scene);
  if (!moving.yes) return Outcome::kPassed;
  return scene.raise({.arguments = {node.mode_before},
                      .where = scene.bytes(1, 1),
                      .related = {node.response_frame, 0},
                      .basis = moving.basis});
}

Outcome mode_change_to_pp_normal(Scene& scene) {
  const Node& node = *scene.node;
  if (!node.command.is(Cyclic::kPp)) return Outcome::kSilent;
  const Answer moving = moved(scene);
  if (node.command.main.code != 0 || !moving.yes) return Outcome::kPassed;
  return scene.raise({.arguments = {node.mode_before},
                      .where = scene.bytes(1, 1),
                      .related = {node.response_frame, 0},
                      .basis = moving.basis});
}

Outcome mode_full_closed(Scene& scene) {
  const Node& node = *scene.node;
  const Known& loop = node.known[Fact::kFullClosed];
  if (!node.command.is_mode() || !loop.certain()) return Outcome::kSilent;
  if (loop.value != 6 || node.command.is(Cyclic::kPp) || node.command.is(Cyclic::kCp)) return Outcome::kPassed;
  return scene.raise({.arguments = {node.command.cyclic}, .where = scene.bytes(1, 1), .basis = loop.basis});
}

Outcome mode_not_in_cycle(Scene& scene) {
  const Node& node = *scene.node;
  const Learnt& cycle = scene.ring.cycle_ns;
  if (!node.command.is_mode() || !cycle) return Outcome::kSilent;
  if (cycle.value >= 500'000) return Outcome::kPassed;
  const Known& loop = node.known[Fact::kFullClosed];
  const Known& scale = node.known[Fact::kScaleMonitor];
  const bool position = node.command.is(Cyclic::kPp) || node.command.is(Cyclic::kCp);
  const bool refused =
      node.command.is(Cyclic::kPp) || node.command.wide || (loop.certainly(6) && position) || scale.certainly(1);
  if (!refused) return Outcome::kPassed;
  return scene.raise({.arguments = {node.command.cyclic, cycle.value, node.command.wide ? 32 : 16},
                      .where = scene.bytes(1, 1),
                      .basis = cycle.basis});
}

Outcome mode_change_in_homing(Scene& scene) {
  const Node& node = *scene.node;
  if (!node.comparable) return Outcome::kSilent;
  if (!in_homing(scene)) return Outcome::kPassed;
  return scene.raise({.arguments = {node.mode_before, node.command.cyclic, node.previous.main.type_code},
                      .where = scene.bytes(1, 1),
                      .related = {node.previous_frame, 0}});
}

Outcome mode_change_velocity(Scene& scene) {
  const Node& node = *scene.node;
  const CommandView& command = node.command;
  std::int64_t commanded = 0;
  if (command.is(Cyclic::kCv)) {
    commanded = command.data1;
  } else if (command.is(Cyclic::kPp) && command.is(NonCyclic::kProfile)) {
    const std::uint16_t type = command.main.type_code;
    const bool has_speed = (type >= 0x10 && type <= 0x13) || type == 0x20;
    // A change that stops the axis brings no speed of its own.
    if (!has_speed || command.hard_stop || command.smooth_stop || command.pause) return Outcome::kSilent;
    commanded = command.main.setting_data;
  } else {
    return Outcome::kSilent;
  }
  const Speed speed = actual_speed(node);
  const auto& least = scene.limits().moving_speed;
  if (!speed.known || !node.response_chain || (speed.in_units && !least) || !speed_moves(scene.ring, node).yes)
    return Outcome::kSilent;
  std::int64_t actual = speed.value;
  if (command.is(Cyclic::kPp)) {  // the direction is the target's
    actual = actual < 0 ? -actual : actual;
    commanded = commanded < 0 ? -commanded : commanded;
  }
  const std::int64_t difference = commanded > actual ? commanded - actual : actual - commanded;
  const std::int64_t magnitude = actual < 0 ? -actual : actual;
  const bool jumps =
      difference > least.value_or(30) && difference * 100 > scene.limits().mode_change_velocity_percent * magnitude;
  if (!jumps) return Outcome::kPassed;
  return scene.raise({.arguments = {command.cyclic, commanded, actual},
                      .where = command.is(Cyclic::kCv) ? scene.bytes(kData1At, 4) : scene.bytes(kData3At, 4),
                      .related = {node.response_frame, 0},
                      .basis = speed.basis});
}

Outcome nop_after_start(Scene& scene) {
  const Node& node = *scene.node;
  if (!scene.ring.running || !node.mode_commanded) return Outcome::kSilent;
  if (!node.command.is_nop()) return Outcome::kPassed;
  return scene.raise({.where = scene.bytes(1, 1), .related = {node.comparable ? node.previous_frame : 0, 0}});
}

}  // namespace servotrace::rtex::checks
