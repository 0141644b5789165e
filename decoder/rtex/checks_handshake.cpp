// SPDX-License-Identifier: MIT
// RX3: the non-cyclic handshake (SX-DSV02203 3-3-4, 3-3-5, 6-1).
#include "decoder/rtex/scene.hpp"

namespace servotrace::rtex::checks {
namespace {

bool is(const CommandPart& part, NonCyclic code) { return part.code == static_cast<std::uint8_t>(code); }

// A command left or changed by a mode change is only the RX4 finding.
bool left_to_mode(const Scene& scene) { return scene.node->mode_changed; }

bool is_profile(const Scene& scene, const CommandPart& part) {
  return !scene.is_sub() && is(part, NonCyclic::kProfile);
}

}  // namespace

// Started from another non-cyclic command. Extend mode allows it but for profile 17h, which starts from 10h only.
Outcome not_from_standard(Scene& scene) {
  ChannelState& channel = *scene.channel;
  if (left_to_mode(scene)) return Outcome::kSilent;
  if (channel.step == HandshakeStep::kEarlyBegin) return Outcome::kSilent;  // RX302
  if (channel.step != HandshakeStep::kChained) return channel.withheld.waiting ? Outcome::kSilent : Outcome::kPassed;
  if (channel.process.busy) return Outcome::kSilent;  // RX303
  const CommandPart& part = scene.part();
  const Known& extend = scene.node->known[Fact::kExtendMode];
  const bool into_profile = is_profile(scene, part);
  if (!into_profile && (!extend || extend.is(1))) return extend ? Outcome::kPassed : Outcome::kSilent;
  channel.next_not_started = true;
  if (!into_profile && !extend.certain()) {
    if (!channel.withheld.waiting) channel.withheld = {true, false, part, channel.hold.part.code, scene.now};
    return Outcome::kSilent;
  }
  return scene.raise({.arguments = {channel.hold.part.code, part.code},
                      .where = scene.code(),
                      .related = {channel.hold.start.frame, 0},
                      .basis = into_profile ? Basis{} : extend.basis});
}

Outcome not_held_until_echo(Scene& scene) {
  const ChannelState& channel = *scene.channel;
  const Hold& hold = channel.hold;
  if (left_to_mode(scene)) return Outcome::kSilent;
  if (channel.step == HandshakeStep::kLeft || channel.step == HandshakeStep::kLeftBusy ||
      channel.step == HandshakeStep::kChained) {
    return hold.seen_start ? Outcome::kPassed : Outcome::kSilent;
  }
  if (channel.step != HandshakeStep::kEarly && channel.step != HandshakeStep::kEarlyBegin) return Outcome::kSilent;
  if (!hold.seen_start || !hold.every_response || !scene.node->synchronised || !scene.ring.running)
    return Outcome::kSilent;
  return scene.raise({.arguments = {hold.part.code, scene.now.cycle - hold.start.cycle},
                      .where = scene.is_sub() ? scene.bytes(16, 8) : scene.code(),
                      .related = {hold.start.frame, 0}});
}

Outcome started_while_busy(Scene& scene) {
  ChannelState& channel = *scene.channel;
  if (left_to_mode(scene)) return Outcome::kSilent;
  if (!channel.process.busy) return Outcome::kPassed;
  channel.next_not_started = true;
  return scene.raise({.arguments = {scene.part().code, channel.process.code},
                      .where = scene.code(),
                      .related = {channel.process.since.frame, 0}});
}

Outcome left_while_busy(Scene& scene) {
  const ChannelState& channel = *scene.channel;
  const CommandPart& part = channel.hold.part;
  if (left_to_mode(scene)) return Outcome::kSilent;
  if (channel.step == HandshakeStep::kLeft) return Outcome::kPassed;
  if (channel.step != HandshakeStep::kLeftBusy) return Outcome::kSilent;
  if (!scene.node->response_chain) return Outcome::kSilent;             // the response that showed Busy = 0 may be lost
  const bool homing = !scene.is_sub() && is(part, NonCyclic::kHoming);  // RX503
  const bool reset = !scene.is_sub() && is(part, NonCyclic::kReset) && part.type_code == kSoftwareReset;  // by design
  if (homing || reset || channel.hold.refused) return Outcome::kPassed;
  return scene.raise({.arguments = {part.code}, .where = scene.code(), .related = {channel.process.since.frame, 0}});
}

Outcome argument_change_ignored(Scene& scene) {
  ChannelState& channel = *scene.channel;
  if (left_to_mode(scene)) return Outcome::kSilent;
  if (channel.step == HandshakeStep::kLeft) return channel.withheld.waiting ? Outcome::kSilent : Outcome::kPassed;
  if (channel.step != HandshakeStep::kArgumentsIgnored) return Outcome::kSilent;
  const CommandPart& part = scene.part();
  const CommandPart& before = scene.previous_part();
  // Of a profile, target, speed and monitor are RX511; Type_Code and latch input in motion are RX510.
  if (is_profile(scene, part)) {
    const bool operation = part.type_code != before.type_code || part.latch_sel1() != before.latch_sel1();
    if (!operation || in_progress(*scene.node).yes) return Outcome::kSilent;
  }
  const Known& extend = scene.node->known[Fact::kExtendMode];
  if (!extend || extend.is(1)) return Outcome::kSilent;
  if (!extend.certain()) {
    if (!channel.withheld.waiting) channel.withheld = {true, true, part, part.code, scene.now};
    return Outcome::kSilent;
  }
  return scene.raise({.arguments = {part.code, part.code},
                      .where = scene.arguments(),
                      .related = {channel.hold.start.frame, 0},
                      .basis = extend.basis});
}

Outcome non_cyclic_undefined(Scene& scene) {
  if (scene.channel == nullptr) return Outcome::kSilent;
  const std::uint8_t code = scene.part().code;
  const bool defined =
      scene.is_sub() ? find_value(kSubCommandNames, code) != nullptr : find_value(kNonCyclicNames, code) != nullptr;
  if (defined) return Outcome::kPassed;
  return scene.raise({.arguments = {code, scene.is_sub() ? 1 : 0}, .where = scene.code()});
}

}  // namespace servotrace::rtex::checks
