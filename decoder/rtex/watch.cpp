// SPDX-License-Identifier: MIT
// What several commands together do: the command position against the actual one, toward an active drive inhibit, on
// and on without an end. Judged by checks_position.cpp and checks_profile.cpp.
#include "decoder/rtex/tracking.hpp"

namespace servotrace::rtex {
namespace {

constexpr std::int64_t kFollowUnits = 1000;        // the catalogue's proof that Response_Data1 is the actual position
constexpr DurationNs kStillNs = milliseconds(20);  // a command that has not changed for so long has stopped
constexpr std::int64_t kStillWithoutCycle = 40;    // cycles, where their time is not known

std::int64_t magnitude(std::int64_t value) { return value < 0 ? -value : value; }
bool is_profile_homing(const CommandView& command) {
  return command.is(NonCyclic::kProfile) && command.main.type_code >= 0x31 && command.main.type_code <= 0x33;
}

// The drive inhibit input that is active, from the last response (4-3-4).
void find_inhibit(Node& node, std::int64_t cycle) {
  const Known& setup = node.known[Fact::kInhibitSetup];
  const Known& swapped = node.known[Fact::kInhibitSwapped];
  const Known& inverted = node.known[Fact::kInhibitInverted];
  int direction = 0;
  if (has_status(node) && node.response.servo_active && setup.certainly(0) && swapped && inverted) {
    const bool low = node.response.low_input != (inverted.value == 1);
    const bool high = node.response.high_input != (inverted.value == 1);
    if (low != high) direction = high != (swapped.value == 1) ? 1 : -1;
  }
  if (direction == node.inhibit.direction) return;
  node.inhibit = {};
  node.inhibit.direction = direction;
  node.inhibit.frame = node.response_frame;
  node.inhibit.changed = cycle;
  node.inhibit.basis = weaker(setup.basis, weaker(swapped.basis, inverted.basis));
}

void watch_inhibit_position(Scene& scene) {
  Node& node = *scene.node;
  InhibitWatch& watch = node.inhibit;
  const std::int32_t position = node.command.data1;
  if (!node.comparable || !node.previous.is(Cyclic::kCp)) {
    watch.stopped = watch.toward = false;
    watch.changed = scene.now.cycle;
    return;
  }
  const std::int64_t step = apart(position, node.previous.data1) * watch.direction;
  if (!watch.stopped) {
    const std::int64_t needed = cycles_in(scene.ring, kStillNs);
    const bool stood = scene.now.cycle - watch.changed > (needed == 0 ? kStillWithoutCycle : needed);
    watch.stopped = step < 0 || stood;
    watch.reference = step < 0 ? position : node.previous.data1;
    if (step != 0) watch.changed = scene.now.cycle;
    if (!watch.stopped) return;
  }
  if (apart(position, watch.reference) * watch.direction < 0) watch.reference = position;
  watch.toward = apart(position, watch.reference) * watch.direction > scene.limits().inhibit_units;
}

// 17h begins: where to, as far as it can be told.
bool starts_toward(const Node& node) {
  const CommandPart& part = node.command.main;
  std::int64_t way = 0;
  if (part.type_code == 0x10 || part.type_code == 0x12) {
    const Position position = actual_position(node);
    if (position.known) way = apart(part.position, position.value);
  } else if (part.type_code == 0x11 || part.type_code == 0x13) {
    way = part.position;
  } else if (part.type_code == 0x20) {
    way = part.setting_data;
  }
  return way * node.inhibit.direction > 0;
}

void watch_inhibit(Scene& scene) {
  Node& node = *scene.node;
  find_inhibit(node, scene.now.cycle);
  InhibitWatch& watch = node.inhibit;
  const CommandView& command = node.command;
  if (watch.direction == 0) return;
  if (is_homing(command.main) || is_profile_homing(command)) {
    watch.stopped = watch.toward = false;
    watch.changed = scene.now.cycle;
    return;
  }
  switch (static_cast<Cyclic>(command.cyclic)) {
    case Cyclic::kCp:
      watch_inhibit_position(scene);
      break;
    case Cyclic::kCv:
    case Cyclic::kCt:
      watch.stopped = watch.stopped || std::int64_t{command.data1} * watch.direction <= 0;
      watch.toward = watch.stopped && std::int64_t{command.data1} * watch.direction > 0;
      break;
    case Cyclic::kPp: {
      const bool begins = command.is(NonCyclic::kProfile) && node.comparable && !node.previous.is(NonCyclic::kProfile);
      if (begins) {
        watch.toward = !node.response.in_progress && starts_toward(node);
      } else if (!command.is(NonCyclic::kProfile)) {
        watch.toward = false;
      }
      break;
    }
    case Cyclic::kNop:
      break;
  }
}

void watch_off(Scene& scene) {
  Node& node = *scene.node;
  OffWatch& off = node.off;
  off.moves_now = false;
  const Position position = actual_position(node);
  const bool watched = has_status(node) && !node.response.servo_active && position.known && node.comparable &&
                       node.response_chain && node.command.is(Cyclic::kCp) && node.previous.is(Cyclic::kCp) &&
                       node.command.main.code != static_cast<std::uint8_t>(NonCyclic::kHoming);
  if (!watched) {
    off.known = false;
    return;
  }
  const std::int64_t distance = magnitude(apart(node.command.data1, position.value));
  if (!off.known || distance <= off.least) {
    const Moment since = off.known ? off.since : scene.now;
    // The first frame of a standstill, so that a quiet block taken by the short cut changes nothing.
    const bool stands = off.known && distance == off.least && node.command.data1 == off.at_least;
    const std::uint64_t frame = stands ? off.frame_least : scene.now.frame;
    off = {.known = true,
           .least = distance,
           .at_least = node.command.data1,
           .frame_least = frame,
           .moves = 0,
           .since = since,
           .moves_now = false};
    return;
  }
  off.moves_now = distance > magnitude(apart(node.previous.data1, position.value));
  if (off.moves_now) ++off.moves;
}

void watch_profile(Scene& scene) {
  Node& node = *scene.node;
  const CommandView& command = node.command;
  Hold& hold = node.main().hold;
  if (!command.is(NonCyclic::kProfile)) {
    node.profile_watch = {};
    return;
  }
  const bool stops = command.hard_stop || command.smooth_stop;
  const bool stopped_before = node.comparable && (node.previous.hard_stop || node.previous.smooth_stop);
  if (stops && node.comparable && !stopped_before) {
    node.profile_watch.stopped = in_progress(node).yes;
    node.profile_watch.stop_frame = scene.now.frame;
  }
  if (stops || command.pause) hold.stop_bits = true;
  const std::uint16_t type = hold.part.type_code;
  const bool endless = hold.part.code == command.main.code && hold.echoed && !hold.refused && !stops &&
                       ((type >= 0x10 && type <= 0x13) || type == 0x20) &&
                       (command.pause || hold.part.setting_data == 0) && in_progress(node).yes;
  if (!endless) {
    node.profile_watch.endless_since = {};
  } else if (node.profile_watch.endless_since.frame == 0) {
    node.profile_watch.endless_since = scene.now;
  }
}

}  // namespace

void watch_command(Scene& scene) {
  if (scene.node->command.is_nop()) return;
  watch_inhibit(scene);
  watch_off(scene);
  watch_profile(scene);
}

void watch_following(Scene& scene) {
  Node& node = *scene.node;
  Following& following = node.following;
  if (following.proven || node.known[Fact::kMonitor1].certain()) return;
  const bool watched = has_status(node) && node.response.servo_active && node.response_chain && node.have_command &&
                       node.command_chain && node.command.is(Cyclic::kCp) && !is_homing(node.command.main);
  if (!watched) {
    following.has_base = false;
    return;
  }
  const std::int32_t command = node.command.data1;
  const std::int32_t position = node.response.data1;
  if (!following.has_base) {
    following = {true, command, position, false, 0};
    return;
  }
  const std::int64_t moved = magnitude(apart(command, following.base_command));
  if (moved <= kFollowUnits) return;
  following.proven = 2 * magnitude(apart(position, command)) <= moved &&
                     2 * magnitude(apart(position, following.base_position)) >= moved;
  following.frame = scene.now.frame;
}

}  // namespace servotrace::rtex
