// SPDX-License-Identifier: MIT
// Parameters and their EEPROM: RX608 to RX613 (SX-DSV02203 2-5, 6-3-2, 6-7, 6-8-6, 7-7-4).
#include <algorithm>
#include <initializer_list>
#include <iterator>

#include "decoder/rtex/scene.hpp"

namespace servotrace::rtex::checks {
namespace {

// Attribute B, and named by the manual (6-7-4).
constexpr std::uint16_t kNotInMotion[] = {pr(1, 14), pr(3, 17), pr(3, 21), pr(3, 22), pr(5, 21), pr(7, 23),
                                          pr(8, 1),  pr(8, 4),  pr(8, 10), pr(8, 12), pr(8, 13), pr(8, 14)};

struct Judgement {
  bool known = false;
  bool forbidden = false;
  std::uint16_t other = 0;  // the parameter it clashes with, 0: none
  Basis basis;
};

// Pr7.35 to Pr7.37 in 32-byte mode: one feedforward once.
Judgement judge_feedforward(const Node& node, std::uint16_t index, std::int32_t value) {
  Judgement result;
  if (!node.wide || value == 0) return {node.wide, false, 0, {}};
  for (unsigned i = 0; i < 3; ++i) {
    const std::uint16_t other = pr(7, 35 + i);
    if (other == index) continue;
    const Known& known = node.known[static_cast<Fact>(static_cast<std::size_t>(Fact::kForward1) + i)];
    if (!known.certain()) continue;
    result.known = true;
    if (known.value == value) return {true, true, other, known.basis};
  }
  return result;
}

Judgement judge_value(const Node& node, std::uint16_t index, std::int32_t value) {
  const auto one_of = [value](std::initializer_list<std::int32_t> allowed) {
    return Judgement{true, std::find(allowed.begin(), allowed.end(), value) == allowed.end(), 0, {}};
  };
  switch (index) {
    case pr(0, 1):
      return one_of({0, 6});
    case pr(7, 20):
      return one_of({0, 1, 3, 6});
    case pr(7, 21):
      return one_of({1, 2});
    case pr(7, 22):
      return {true, (static_cast<std::uint32_t>(value) & 0xCU) != 0, 0, {}};
    case pr(7, 11): {
      const Known& other = node.known[Fact::kNegativeLimit];
      return {other.certain(), other.certain() && value <= other.value, pr(7, 12), other.basis};
    }
    case pr(7, 12): {
      const Known& other = node.known[Fact::kPositiveLimit];
      return {other.certain(), other.certain() && value >= other.value, pr(7, 11), other.basis};
    }
    case pr(7, 35):
    case pr(7, 36):
    case pr(7, 37):
      return judge_feedforward(node, index, value);
    default:
      return {};
  }
}

DurationNs cycle_of(std::int32_t value) {  // Pr7.20
  switch (value) {
    case 0:
      return 83'333;
    case 1:
      return 166'667;
    case 3:
      return 500'000;
    case 6:
      return 1'000'000;
    default:
      return 0;
  }
}

}  // namespace

Outcome eeprom_wear(Scene& scene) {
  const Hold& hold = scene.channel->hold;
  const bool writes = hold.part.code == static_cast<std::uint8_t>(NonCyclic::kParameter) &&
                      (hold.part.type_code == kEepromWrite || hold.part.type_code == kEepromWriteConventional);
  if (scene.is_sub() || !writes || scene.answer().err || !scene.context.frame.has_time) return Outcome::kSilent;
  if (!scene.node->eeprom_writes.add(scene.now.time_ns)) return Outcome::kPassed;
  return scene.raise({.arguments = {scene.limits().eeprom_writes_per_hour},
                      .where = scene.bytes(8, 2),
                      .related = {hold.start.frame, 0}});
}

Outcome parameter_while_moving(Scene& scene) {
  if (!starts(scene, NonCyclic::kParameter, kParameterWrite) || !has_status(*scene.node)) return Outcome::kSilent;
  const std::uint16_t index = scene.part().index;
  if (std::find(std::begin(kNotInMotion), std::end(kNotInMotion), index) == std::end(kNotInMotion))
    return Outcome::kSilent;
  const Answer moving = moves(scene.ring, *scene.node);
  if (!moving.yes) return Outcome::kPassed;
  return raise_start(scene, {.arguments = {index}, .basis = moving.basis});
}

Outcome parameter_value_forbidden(Scene& scene) {
  if (!starts(scene, NonCyclic::kParameter, kParameterWrite)) return Outcome::kSilent;
  const CommandPart& part = scene.part();
  const Judgement judged = judge_value(*scene.node, part.index, part.setting_data);
  if (!judged.known) return Outcome::kSilent;
  if (!judged.forbidden) return Outcome::kPassed;
  return raise_start(scene, {.arguments = {part.index, part.setting_data, judged.other},
                             .where = scene.bytes(kData3At, 4),
                             .basis = judged.basis});
}

Outcome reset_without_eeprom(Scene& scene) {
  if (!starts(scene, NonCyclic::kReset, kSoftwareReset)) return Outcome::kSilent;
  const Knowledge::Unsaved& unsaved = scene.node->known.unsaved();
  if (unsaved.count == 0) return Outcome::kPassed;
  return raise_start(scene, {.arguments = {unsaved.index, unsaved.count}, .related = {unsaved.frame, 0}});
}

Outcome parameter_differs_from_ring(Scene& scene) {
  const Hold& hold = scene.channel->hold;
  const Node& node = *scene.node;
  const Ring& ring = scene.ring;
  if (scene.is_sub() || hold.part.code != static_cast<std::uint8_t>(NonCyclic::kParameter) ||
      hold.part.type_code != kParameterRead || scene.answer().err || node.known.is_pending(hold.part.index)) {
    return Outcome::kSilent;
  }
  const auto value = static_cast<std::int32_t>(scene.answer().data);
  std::int64_t seen = 0;
  bool differs = false;
  Basis basis;
  if (hold.part.index == pr(7, 20)) {
    if (!ring.cycle_ns || cycle_of(value) == 0) return Outcome::kSilent;
    seen = ring.cycle_ns.value == 83'333    ? 0
           : ring.cycle_ns.value == 166'667 ? 1
           : ring.cycle_ns.value == 500'000 ? 3
                                            : 6;
    differs = cycle_of(value) != ring.cycle_ns.value;
    basis = ring.cycle_ns.basis;
  } else if (hold.part.index == pr(7, 21)) {
    if (!ring.ratio_decided || !ring.ratio || value < 1 || value > 2) return Outcome::kSilent;
    seen = ring.ratio.value;
    differs = value != seen;
    basis = ring.ratio.basis;
  } else if (hold.part.index == pr(7, 22)) {
    seen = node.wide ? 1 : 0;
    differs = (value & 1) != seen;
  } else {
    return Outcome::kSilent;
  }
  if (!differs) return Outcome::kPassed;
  return scene.raise({.arguments = {hold.part.index, value, seen},
                      .where = scene.bytes(kData3At, 4),
                      .related = {hold.start.frame, 0},
                      .basis = basis});
}

}  // namespace servotrace::rtex::checks
