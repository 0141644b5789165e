// SPDX-License-Identifier: MIT
// TMG_CNT: RX207 to RX209, and the full-synchronous mode that a right count shows (SX-DSV02203 4-2-1-1).
#include "decoder/rtex/engine.hpp"

namespace servotrace::rtex {
namespace {

constexpr std::uint32_t kShown = 4;  // toggles, or irregularities, that decide the mode

// Whether the ring runs in full-synchronous mode: the ring's setting, or what every drive is known to be set to.
Learnt mode_of(const Ring& ring) {
  if (ring.full_sync) return ring.full_sync;
  Learnt mode{0, {BasisKind::kAssumed, 0}};
  bool first = true;
  for (const auto& node : ring.all()) {
    if (node == nullptr) return {0, {BasisKind::kAssumed, 0}};
    const Known& known = node->known[Fact::kFullSync];
    if (!known.certain() || (!first && known.value != mode.value)) return {0, {BasisKind::kAssumed, 0}};
    mode = {known.value, known.basis};
    first = false;
  }
  return mode;
}

}  // namespace

// Before the ring's checks of a command record.
void Engine::count_timing(const Context& context) {
  TimingCount& timing = ring_.timing;
  timing.verdict = TimingCount::Verdict::kNone;
  if (ring_.of_record.telling == 0 && timing.known && ring_.record_quiet) {  // every header is as it was
    step_timing(context, timing.value);
    if (!ring_.record_quiet) end_rest();  // the rules of the record look at the nodes
    return;
  }
  timing.is_used = mode_of(ring_).value == 1;
  timing.differing = 0;
  timing.any_set = false;
  unsigned active = 0;
  unsigned set = 0;
  for (const auto& node : ring_.all()) {
    if (node == nullptr || !node->command_written || node->command_frame != context.frame.number ||
        node->command.is_nop()) {
      continue;
    }
    ++active;
    if (node->command.tmg_cnt) ++set;
  }
  const std::int64_t period = cycles_in(ring_, milliseconds(2));
  if (active == 0 || period == 0) {
    timing.known = false;
    return;
  }
  timing.any_set = set != 0;
  const bool value = 2 * set == active ? timing.value : 2 * set > active;
  for (const auto& node : ring_.all()) {
    if (node != nullptr && node->command_frame == context.frame.number && !node->command.is_nop() &&
        node->command.tmg_cnt != value) {
      timing.differing |= 1U << node->place;
    }
  }
  if (!timing.known) {
    timing.known = true;
    timing.in_phase = false;
    timing.value = value;
    timing.toggled = ring_.cycle;
    timing.toggle_frame = context.frame.number;
    return;
  }
  step_timing(context, value);
}

void Engine::step_timing(const Context& context, bool value) {
  TimingCount& timing = ring_.timing;
  const std::int64_t period = cycles_in(ring_, milliseconds(2));
  timing.passed = ring_.cycle - timing.toggled;
  const bool toggles = value != timing.value;
  timing.value = value;
  if (toggles) {
    if (timing.in_phase)
      timing.verdict = timing.passed == period ? TimingCount::Verdict::kInTime : TimingCount::Verdict::kEarly;
    timing.in_phase = true;
  } else if (timing.passed >= period) {
    timing.in_phase = false;  // the next toggle is late: it sets the phase, nothing more
    if (!timing.is_used && !timing.any_set) {
      timing.toggled = ring_.cycle;  // nobody counts
      return;
    }
    timing.verdict = TimingCount::Verdict::kLate;
  } else {
    return;
  }
  ring_.record_quiet = false;  // there is something to judge
  timing.toggled = ring_.cycle;
  if (toggles) timing.toggle_frame = context.frame.number;
  learn_timing(context);
}

void Engine::learn_timing(const Context& context) {
  TimingCount& timing = ring_.timing;
  if (timing.verdict == TimingCount::Verdict::kInTime && timing.differing == 0) {
    timing.bad = 0;
    if (++timing.good >= kShown && !ring_.full_sync && !timing.semi_decided)
      ring_.full_sync = {1, {BasisKind::kCapture, context.frame.number}};
  } else if (timing.verdict != TimingCount::Verdict::kNone) {
    timing.good = 0;
    timing.semi_decided = timing.semi_decided || (++timing.bad >= kShown && timing.any_set);
  }
}

namespace checks {

Outcome tmg_cnt_period(Scene& scene) {
  const TimingCount& timing = scene.ring.timing;
  const Learnt mode = mode_of(scene.ring);
  if (mode.value != 1 || timing.verdict == TimingCount::Verdict::kNone) return Outcome::kSilent;
  if (timing.differing != 0) return Outcome::kSilent;  // RX208
  if (timing.verdict == TimingCount::Verdict::kInTime) return Outcome::kPassed;
  return scene.raise({.arguments = {timing.passed, timing.verdict == TimingCount::Verdict::kLate ? 1 : 0,
                                    cycles_in(scene.ring, milliseconds(2))},
                      .related = {timing.toggle_frame == scene.now.frame ? 0 : timing.toggle_frame, 0},
                      .basis = mode.basis});
}

Outcome tmg_cnt_axes(Scene& scene) {
  const TimingCount& timing = scene.ring.timing;
  const Learnt mode = mode_of(scene.ring);
  if (mode.value != 1 || !timing.known) return Outcome::kSilent;
  if (timing.differing == 0) return Outcome::kPassed;
  std::int64_t nodes = 0;
  for (const auto& node : scene.ring.all()) {
    if (node != nullptr && (timing.differing >> node->place & 1U) != 0)
      nodes |= std::int64_t{1} << (node->ref.mac_id < 0 ? node->place : node->ref.mac_id);
  }
  return scene.raise({.arguments = {nodes}, .basis = mode.basis});
}

Outcome tmg_cnt_unused(Scene& scene) {
  const TimingCount& timing = scene.ring.timing;
  const Learnt mode = mode_of(scene.ring);
  if (mode.value != 0) return Outcome::kSilent;
  // On the assumption alone a count that may still prove right is waited for.
  const bool decided = mode.basis.kind != BasisKind::kAssumed || timing.semi_decided;
  if (!timing.any_set) return Outcome::kPassed;
  if (!decided) return Outcome::kSilent;
  return scene.raise({.basis = mode.basis});
}

}  // namespace checks
}  // namespace servotrace::rtex
