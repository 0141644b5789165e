// SPDX-License-Identifier: MIT
// Homing and latch: RX518 to RX520, RX522 to RX524 (SX-DSV02203 6-5, 6-8-1, 7-2).
#include "decoder/rtex/scene.hpp"

namespace servotrace::rtex::checks {
namespace {

// Why the configured encoder, scale or loop excludes a command (kExclusions of rules.hpp); 0: it does not.
std::int64_t exclusion(const Node& node, const CommandPart& part) {
  const bool homing = part.code == static_cast<std::uint8_t>(NonCyclic::kHoming);
  const bool profile = part.code == static_cast<std::uint8_t>(NonCyclic::kProfile);
  const Known& loop = node.known[Fact::kFullClosed];
  const bool full_closed = loop.certain() && loop.value != 0;
  const bool position_known = node.settings != nullptr && node.settings->absolute.has_value();
  const bool absolute = position_known && *node.settings->absolute;
  const std::uint16_t type = part.type_code;
  if (homing && type == 0x31) {
    if (full_closed) return 0x0055;
    return position_known && !absolute ? 0x0051 : 0;
  }
  if (!absolute) return 0;
  if (is_homing_search(part) || (profile && type >= 0x31 && type <= 0x33)) return 0x0052;
  if (homing && (type == 0x21 || type == 0x22)) return 0x0053;
  const bool first = homing ? type == 0x51 || type == 0x53 : profile && (type == 0x12 || type == 0x13);
  const bool second = homing && (type == 0x52 || type == 0x53);
  const bool z_phase = (first && part.latch_sel1() == 0) || (second && part.latch_sel2() == 0);
  return full_closed && z_phase ? 0x005A : 0;
}

}  // namespace

Outcome homing_on_inhibit_input(Scene& scene) {
  const Known& setup = scene.node->known[Fact::kInhibitSetup];
  if (!starts(scene, NonCyclic::kHoming) || !setup.certain()) return Outcome::kSilent;
  const std::uint16_t type = scene.part().type_code;
  if (type < 0x14 || type > 0x17) return Outcome::kSilent;
  if (setup.value == 1) return Outcome::kPassed;
  return raise_start(scene, {.arguments = {type, setup.value}, .basis = setup.basis});
}

Outcome position_set_in_motion(Scene& scene) {
  const Node& node = *scene.node;
  if (!starts(scene, NonCyclic::kHoming, 0x21) && !starts(scene, NonCyclic::kHoming, 0x22)) return Outcome::kSilent;
  if (!has_status(node) || is_latch_or_homing_profile(profile_in_progress(node))) return Outcome::kSilent;  // RX507
  const Answer moving = moves(scene.ring, node);
  if (!moving.yes) return Outcome::kPassed;
  return raise_start(scene, {.basis = moving.basis});
}

Outcome multi_turn_no_power_cycle(Scene& scene) {
  Node& node = *scene.node;
  if (node.multi_turn_frame == 0) return Outcome::kPassed;
  const std::uint64_t cleared = node.multi_turn_frame;
  node.multi_turn_frame = 0;  // said once
  return scene.raise({.where = scene.bytes(2, 1), .related = {cleared, node.response_frame}});
}

Outcome homing_not_for_encoder(Scene& scene) {
  const Node& node = *scene.node;
  if (!starts(scene, NonCyclic::kHoming) && !starts(scene, NonCyclic::kProfile)) return Outcome::kSilent;
  const Known& loop = node.known[Fact::kFullClosed];
  const bool position_known = node.settings != nullptr && node.settings->absolute.has_value();
  if (!position_known && !loop.certain()) return Outcome::kSilent;
  const std::int64_t error = exclusion(node, scene.part());
  if (error == 0) return Outcome::kPassed;
  const bool by_loop = error == 0x0055 || error == 0x005A;
  return raise_start(scene, {.arguments = {scene.part().code, scene.part().type_code, error},
                             .basis = by_loop ? loop.basis : Basis{BasisKind::kConfigured, 0}});
}

Outcome latch_read_early(Scene& scene) {
  const CommandPart& part = scene.part();
  if (part.code != static_cast<std::uint8_t>(NonCyclic::kMonitor)) return Outcome::kSilent;
  if (part.type_code != 0x09 && part.type_code != 0x0A) return Outcome::kSilent;
  const LatchState& latch = scene.node->latch;
  const bool first = part.type_code == 0x09;
  if (!(first ? latch.shown1 : latch.shown2)) return Outcome::kSilent;
  if (first ? latch.complete1 : latch.complete2) return Outcome::kPassed;
  return scene.raise({.arguments = {first ? 1 : 2},
                      .where = scene.is_sub() ? scene.bytes(17, 1) : scene.bytes(8, 2),
                      .related = {scene.node->response_frame, 0}});
}

Outcome latch_cancelled(Scene& scene) {
  const Node& node = *scene.node;
  const bool resets = starts(scene, NonCyclic::kReset);
  if (!resets && (scene.is_sub() || !is_homing(scene.part()))) return Outcome::kSilent;
  if (!node.latch.started1 && !node.latch.started2) return Outcome::kPassed;
  const std::int64_t open = (node.latch.started1 ? 2 : 0) | (node.latch.started2 ? 4 : 0);
  return raise_start(scene, {.arguments = {scene.part().code, scene.part().type_code, open}});
}

}  // namespace servotrace::rtex::checks
