// SPDX-License-Identifier: MIT
// Profile operations while they run: RX511, RX512, RX516, RX521, RX525, RX527 (SX-DSV02203 6-8, 7-5).
#include "decoder/rtex/scene.hpp"

namespace servotrace::rtex::checks {
namespace {

// The profile command that is held goes on with the same operation.
bool goes_on(const Node& node) {
  if (!node.comparable || node.mode_changed) return false;
  if (!node.command.is(NonCyclic::kProfile) || !node.previous.is(NonCyclic::kProfile)) return false;
  const CommandPart& part = node.command.main;
  const CommandPart& before = node.previous.main;
  return part.type_code == before.type_code && part.latch_sel1() == before.latch_sel1();
}

bool is_relative(std::uint16_t type) { return type == 0x11 || type == 0x13; }
bool is_positioning(std::uint16_t type) { return type >= 0x10 && type <= 0x13; }

bool relative_target_changes(const Node& node) {
  return is_relative(node.command.main.type_code) && node.command.main.position != node.previous.main.position &&
         in_progress(node).yes;
}

}  // namespace

Outcome profile_update_ignored(Scene& scene) {
  const Node& node = *scene.node;
  const Known& extend = node.known[Fact::kExtendMode];
  if (!goes_on(node) || !extend.is(0) || node.main().hold.refused) return Outcome::kSilent;
  const CommandPart& part = node.command.main;
  const CommandPart& before = node.previous.main;
  const bool target = is_positioning(part.type_code) && part.position != before.position;
  const bool speed =
      (is_positioning(part.type_code) || part.type_code == 0x20) && part.setting_data != before.setting_data;
  const bool monitor = part.monitor_sel() != before.monitor_sel();
  if (!target && !speed && !monitor) return Outcome::kPassed;
  if (target && relative_target_changes(node)) return Outcome::kSilent;  // RX512
  const std::int64_t what = (target ? 1 : 0) | (speed ? 2 : 0) | (monitor ? 4 : 0);
  return scene.raise({.arguments = {part.type_code, what},
                      .where = target  ? scene.bytes(kData1At, 4)
                               : speed ? scene.bytes(kData3At, 4)
                                       : scene.bytes(11, 1),
                      .related = {node.previous_frame, node.main().hold.start.frame},
                      .basis = extend.basis});
}

Outcome profile_relative_changed(Scene& scene) {
  const Node& node = *scene.node;
  if (!goes_on(node) || !is_relative(node.command.main.type_code)) return Outcome::kSilent;
  if (!relative_target_changes(node)) return Outcome::kPassed;
  return scene.raise(
      {.arguments = {node.command.main.type_code, node.previous.main.position, node.command.main.position},
       .where = scene.bytes(kData1At, 4),
       .related = {node.previous_frame, node.response_frame},
       .basis = in_progress(node).basis});
}

Outcome software_limit(Scene& scene) {
  const Node& node = *scene.node;
  const ResponsePart& answer = scene.answer();
  const Hold& hold = scene.channel->hold;
  if (scene.is_sub() || !answer.is(NonCyclic::kProfile)) return Outcome::kSilent;
  const ResponsePart& before = node.previous_response.main;
  const auto bits = [](const ResponsePart& part) { return (part.psl ? 1 : 0) | (part.nsl ? 2 : 0); };
  int earlier = 3;  // not known: nothing rises
  if (hold.seen_start && hold.echoed && hold.echo.frame == scene.now.frame) {
    earlier = 0;
  } else if (node.response_comparable && before.is(NonCyclic::kProfile)) {
    earlier = bits(before);
  }
  int risen = bits(answer) & ~earlier;
  if (risen == 0) return bits(answer) == 0 ? Outcome::kPassed : Outcome::kSilent;
  const Known& swapped = node.known[Fact::kLimitsSwapped];
  if (swapped.is(1)) risen = (risen >> 1) | ((risen & 1) << 1);
  return scene.raise({.arguments = {swapped ? risen : 3, answer.type_code & 0xFF},
                      .where = scene.bytes(9, 1),
                      .related = {hold.start.frame, 0},
                      .basis = swapped.basis});
}

Outcome profile_not_resumed(Scene& scene) {
  const Node& node = *scene.node;
  if (!node.comparable || !node.command.is(NonCyclic::kProfile) || !node.previous.is(NonCyclic::kProfile))
    return Outcome::kSilent;
  const bool before = node.previous.hard_stop || node.previous.smooth_stop;
  const bool now = node.command.hard_stop || node.command.smooth_stop;
  if (!before || now) return Outcome::kSilent;
  if (!node.profile_watch.stopped) return Outcome::kPassed;
  return scene.raise({.arguments = {node.command.main.type_code},
                      .where = scene.bytes(3, 1),
                      .related = {node.profile_watch.stop_frame, 0},
                      .basis = in_progress(node).basis});
}

Outcome profile_never_ends(Scene& scene) {
  const Node& node = *scene.node;
  const Moment& since = node.profile_watch.endless_since;
  if (!node.command.is(NonCyclic::kProfile) || !scene.context.frame.has_time) return Outcome::kSilent;
  if (since.frame == 0) return Outcome::kPassed;
  const DurationNs lasting = elapsed_ns(since.time_ns, scene.now.time_ns);
  if (lasting <= milliseconds(1000)) return Outcome::kSilent;
  return scene.raise({.arguments = {node.main().hold.part.type_code, lasting},
                      .where = node.command.pause ? scene.bytes(3, 1) : scene.bytes(kData3At, 4),
                      .related = {since.frame, node.response_frame}});
}

Outcome profile_not_started(Scene& scene) {
  const Node& node = *scene.node;
  if (scene.is_sub() || !scene.context.frame.has_time) return Outcome::kSilent;
  Hold& hold = scene.channel->hold;
  if (hold.part.code != static_cast<std::uint8_t>(NonCyclic::kProfile) || !is_positioning(hold.part.type_code))
    return Outcome::kSilent;
  const bool started = in_progress(node).yes || hold.in_progress;
  if (started) return Outcome::kPassed;
  const bool judged = hold.seen_start && hold.echoed && !hold.refused && !hold.ended && !hold.not_started &&
                      !hold.stop_bits && !hold.late_start_judged && hold.position_known;
  if (!judged || !has_status(node) || !node.response.servo_active || node.known[Fact::kAcOff].certainly(1))
    return Outcome::kSilent;
  if (elapsed_ns(hold.echo.time_ns, scene.now.time_ns) <= milliseconds(scene.limits().echo_ms)) return Outcome::kSilent;
  hold.late_start_judged = true;
  const std::int64_t way =
      is_relative(hold.part.type_code) ? hold.part.position : apart(hold.part.position, hold.position);
  if (way <= scene.limits().servo_on_units && -way <= scene.limits().servo_on_units) return Outcome::kPassed;
  return scene.raise({.arguments = {hold.part.type_code, way, elapsed_ns(hold.echo.time_ns, scene.now.time_ns)},
                      .where = scene.bytes(2, 1),
                      .related = {hold.start.frame, hold.echo.frame},
                      .basis = node.known[Fact::kAcOff].basis});
}

}  // namespace servotrace::rtex::checks
