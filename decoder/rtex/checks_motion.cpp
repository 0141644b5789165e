// SPDX-License-Identifier: MIT
// RX5, RX6 and RX7: homing and profile, reset and parameters, servo on (SX-DSV02203 4-2-3-1, 6-3 to 6-8, 7-1 to 7-5).
#include "decoder/rtex/scene.hpp"

namespace servotrace::rtex::checks {
namespace {

// A homing command other than latch that is left.
const Hold* left_homing(const Scene& scene) {
  const HandshakeStep step = scene.channel->step;
  if (scene.is_sub() || scene.node->mode_changed) return nullptr;
  if (step != HandshakeStep::kLeft && step != HandshakeStep::kLeftBusy && step != HandshakeStep::kChained)
    return nullptr;
  const Hold& hold = scene.channel->hold;
  return is_homing(hold.part) ? &hold : nullptr;
}

}  // namespace

Outcome homing_servo_off(Scene& scene) {
  if (scene.is_sub() || !is_homing_search(scene.part()) || !has_status(*scene.node)) return Outcome::kSilent;
  if (scene.node->response.servo_active) return Outcome::kPassed;
  return raise_start(scene);
}

Outcome homing_in_cv_ct(Scene& scene) {
  const CommandView& command = scene.node->command;
  if (!starts(scene, NonCyclic::kHoming)) return Outcome::kSilent;
  const bool refused = is_homing(scene.part()) && scene.part().type_code != 0x31;
  if (!refused || !(command.is(Cyclic::kCv) || command.is(Cyclic::kCt))) return Outcome::kPassed;
  return raise_start(scene, {.where = scene.bytes(1, 1)});
}

Outcome homing_abandoned(Scene& scene) {
  const Hold* hold = left_homing(scene);
  if (hold == nullptr || !hold->seen_start || !hold->every_response) return Outcome::kSilent;
  if (hold->homing_complete) return Outcome::kPassed;
  const bool search = is_homing_search(hold->part);
  if (hold->refused || hold->ended || hold->not_started) return Outcome::kSilent;
  if (search && !scene.node->response.servo_active) return Outcome::kSilent;
  return scene.raise({.arguments = {hold->part.type_code},
                      .where = scene.bytes(1, 1),
                      .related = {hold->start.frame, 0},
                      .as_error = !search});
}

Outcome multi_turn_servo_on(Scene& scene) {
  if (!starts(scene, NonCyclic::kHoming, 0x31) || !has_status(*scene.node)) return Outcome::kSilent;
  if (!scene.node->response.servo_active) return Outcome::kPassed;
  return raise_start(scene);
}

Outcome multi_turn_short(Scene& scene) {
  const Hold* hold = left_homing(scene);
  if (hold == nullptr || hold->part.type_code != 0x31 || !hold->seen_start || hold->refused ||
      !scene.context.frame.has_time) {
    return Outcome::kSilent;
  }
  const DurationNs held = elapsed_ns(hold->echo.time_ns, scene.now.time_ns);
  if (held >= milliseconds(10)) return Outcome::kPassed;
  return scene.raise({.arguments = {held}, .where = scene.bytes(1, 1), .related = {hold->echo.frame, 0}});
}

Outcome homing_in_profile_latch(Scene& scene) {
  if (!starts(scene, NonCyclic::kHoming)) return Outcome::kSilent;
  const std::uint8_t profile = profile_in_progress(*scene.node);
  if (!is_latch_or_homing_profile(profile)) return Outcome::kPassed;
  return raise_start(scene, {.arguments = {scene.part().type_code, profile}});
}

Outcome homing_in_profile(Scene& scene) {
  if (!starts(scene, NonCyclic::kHoming)) return Outcome::kSilent;
  const std::uint8_t profile = profile_in_progress(*scene.node);
  const bool plain = profile == 0x10 || profile == 0x11 || profile == 0x20;
  if (!plain || !(is_homing_search(scene.part()) || scene.part().type_code == 0x31)) return Outcome::kPassed;
  return raise_start(scene, {.arguments = {scene.part().type_code, profile}});
}

Outcome profile_type_changed(Scene& scene) {
  const Node& node = *scene.node;
  if (scene.is_sub() || !node.comparable || node.mode_changed) return Outcome::kSilent;
  if (!node.command.is(NonCyclic::kProfile) || !node.previous.is(NonCyclic::kProfile)) return Outcome::kSilent;
  const CommandPart& part = node.command.main;
  const CommandPart& before = node.previous.main;
  const bool changed = part.type_code != before.type_code || part.latch_sel1() != before.latch_sel1();
  if (!changed) return Outcome::kPassed;
  const Answer progress = in_progress(node);
  if (!progress.yes) return Outcome::kSilent;
  return scene.raise({.arguments = {before.type_code, part.type_code},
                      .where = scene.bytes(8, 3),
                      .related = {node.previous_frame, node.response_frame},
                      .basis = progress.basis});
}

Outcome profile_before_home(Scene& scene) {
  const Node& node = *scene.node;
  if (!starts(scene, NonCyclic::kProfile) || !has_status(node)) return Outcome::kSilent;
  const bool absolute = scene.part().type_code == 0x10 || scene.part().type_code == 0x12;
  if (!absolute) return Outcome::kSilent;
  if (node.response.homing_complete) return Outcome::kPassed;
  return raise_start(scene);
}

Outcome profile_negative_speed(Scene& scene) {
  if (!starts(scene, NonCyclic::kProfile)) return Outcome::kSilent;
  const CommandPart& part = scene.part();
  if (part.type_code < 0x10 || part.type_code > 0x13) return Outcome::kSilent;
  if (part.setting_data >= 0) return Outcome::kPassed;
  return raise_start(scene, {.arguments = {part.type_code, part.setting_data}, .where = scene.bytes(kData3At, 4)});
}

Outcome profile_unused_not_zero(Scene& scene) {
  if (!starts(scene, NonCyclic::kProfile)) return Outcome::kSilent;
  const CommandPart& part = scene.part();
  const bool homing = part.type_code >= 0x31 && part.type_code <= 0x33;
  const bool position = (part.type_code == 0x20 || homing) && part.position != 0;
  const bool speed = homing && part.setting_data != 0;
  const bool latch = part.type_code != 0x12 && part.type_code != 0x13 && part.latch_sel1() != 0;
  if (!position && !speed && !latch) return Outcome::kPassed;
  return raise_start(scene, {.where = position ? scene.bytes(kData1At, 4)
                                      : speed  ? scene.bytes(kData3At, 4)
                                               : scene.bytes(10, 1)});
}

Outcome homing_in_pp(Scene& scene) {
  if (scene.is_sub() || !is_homing_search(scene.part())) return Outcome::kSilent;
  if (!scene.node->command.is(Cyclic::kPp)) return Outcome::kPassed;
  return raise_start(scene);
}

Outcome profile_start_blocked(Scene& scene) {
  const Node& node = *scene.node;
  if (!starts(scene, NonCyclic::kProfile) || !has_status(node)) return Outcome::kSilent;
  const CommandView& command = node.command;
  const bool stopped = command.hard_stop || command.smooth_stop || command.pause;
  // A change into PP in motion uses a stop bit to decelerate (7-3): that is how one stops.
  if (stopped && node.mode_changed) return Outcome::kSilent;
  if (node.response.servo_active && !stopped) return Outcome::kPassed;
  return raise_start(scene, {.where = stopped ? scene.bytes(3, 1) : scene.bytes(1, 1)});
}

// --- RX6 ------------------------------------------------------------------------------------------------------------

Outcome reset_before_all_echoed(Scene& scene) {
  const ChannelState& channel = *scene.channel;
  if (scene.is_sub() || channel.hold.part.code != static_cast<std::uint8_t>(NonCyclic::kReset) ||
      channel.hold.part.type_code != kSoftwareReset) {
    return Outcome::kSilent;
  }
  const bool leaves = channel.step == HandshakeStep::kLeft || channel.step == HandshakeStep::kLeftBusy;
  if (!leaves || scene.ring.reset_reported || channel.hold.refused) return Outcome::kSilent;
  scene.ring.reset_reported = true;
  std::int64_t missing = 0;
  for (const auto& other : scene.ring.all()) {
    if (other == nullptr || other.get() == scene.node) continue;
    const Hold& hold = other->main().hold;
    const bool held =
        hold.part.code == static_cast<std::uint8_t>(NonCyclic::kReset) && hold.part.type_code == kSoftwareReset;
    // Where a response is missing in the capture, the echo may have been in it.
    const bool echoed = held && ((hold.echoed && !hold.refused) || !hold.every_response);
    if (!echoed) missing |= std::int64_t{1} << (other->ref.mac_id < 0 ? other->place : other->ref.mac_id);
  }
  if (missing == 0) return Outcome::kPassed;
  return scene.raise({.arguments = {missing}, .where = scene.bytes(1, 1), .related = {channel.hold.start.frame, 0}});
}

Outcome reset_servo_on(Scene& scene) {
  if (!starts(scene, NonCyclic::kReset, kSoftwareReset) || !has_status(*scene.node)) return Outcome::kSilent;
  if (!scene.node->response.servo_active) return Outcome::kPassed;
  return raise_start(scene);
}

Outcome validation_servo_on(Scene& scene) {
  if (!starts(scene, NonCyclic::kReset, kValidation) || !has_status(*scene.node)) return Outcome::kSilent;
  if (!scene.node->response.servo_active) return Outcome::kPassed;
  return raise_start(scene);
}

Outcome servo_on_in_validation(Scene& scene) {
  const Node& node = *scene.node;
  if (!node.status_undefined || !node.have_response) return Outcome::kPassed;
  if (!node.command.servo_on) return Outcome::kPassed;
  return scene.raise({.where = scene.bytes(2, 1), .related = {node.response_frame, 0}});
}

Outcome parameter_clipped(Scene& scene) {
  const Hold& hold = scene.channel->hold;
  if (scene.is_sub() || hold.part.code != static_cast<std::uint8_t>(NonCyclic::kParameter) ||
      hold.part.type_code != kParameterWrite || scene.answer().err) {
    return Outcome::kSilent;
  }
  const auto written = static_cast<std::int32_t>(scene.answer().data);
  if (written == hold.part.setting_data && !scene.answer().wng) return Outcome::kPassed;
  return scene.raise({.arguments = {hold.part.index, hold.part.setting_data, written},
                      .where = scene.bytes(kData2At, 8),
                      .related = {hold.start.frame, 0}});
}

Outcome a4n_parameter_code(Scene& scene) {
  if (!starts(scene, NonCyclic::kParameter)) return Outcome::kSilent;
  if (scene.part().type_code > 1) return Outcome::kPassed;
  return scene.raise({.arguments = {scene.part().type_code}, .where = scene.bytes(8, 2)});
}

Outcome parameter_protected(Scene& scene) {
  if (!starts(scene, NonCyclic::kParameter)) return Outcome::kSilent;
  const std::uint16_t type = scene.part().type_code;
  const bool writes = type == kParameterWrite || type == kEepromWrite || type == kEepromWriteConventional;
  const Known& inhibited = scene.node->known[Fact::kWriteInhibited];
  if (!writes || !inhibited.certain()) return Outcome::kSilent;
  if (inhibited.value == 0) return Outcome::kPassed;
  return raise_start(scene, {.basis = inhibited.basis});
}

// --- RX7 ------------------------------------------------------------------------------------------------------------

Outcome servo_on_not_ready(Scene& scene) {
  const Node& node = *scene.node;
  if (!has_status(node)) return Outcome::kSilent;
  if (node.response.servo_ready) return Outcome::kPassed;
  return scene.raise({.where = scene.bytes(2, 1), .related = {node.response_frame, 0}});
}

Outcome servo_off_in_progress(Scene& scene) {
  const Node& node = *scene.node;
  const Answer progress = in_progress(node);
  if (!progress.yes || node.mode != static_cast<std::uint8_t>(Cyclic::kPp)) return Outcome::kPassed;
  return scene.raise({.where = scene.bytes(2, 1), .related = {node.response_frame, 0}, .basis = progress.basis});
}

Outcome servo_on_while_turning(Scene& scene) {
  const Node& node = *scene.node;
  const Speed speed = actual_speed(node);
  if (!speed.known || speed.in_units) return Outcome::kSilent;
  if (speed.value > -30 && speed.value < 30) return Outcome::kPassed;
  return scene.raise({.arguments = {speed.value},
                      .where = scene.bytes(2, 1),
                      .related = {node.response_frame, 0},
                      .basis = speed.basis});
}

}  // namespace servotrace::rtex::checks
