// SPDX-License-Identifier: MIT
// The questions the checks share: what is in progress, what moves, what a value means.
#include "decoder/rtex/scene.hpp"

namespace servotrace::rtex {

Outcome Scene::raise(Report report) {
  report.rule = rule;
  report.owner = owner;
  const bool fresh = ring.findings.raise(context.frame, report);
  (node != nullptr ? node->quiet.raised : ring.record_raised) = true;
  const Actor actor = rule_row(rule).actor;
  if (actor == Actor::kMaster || actor == Actor::kNetwork) remember(fresh);
  return Outcome::kRaised;
}

// The finding a later report of the drive may answer: of an episode its first frame and its latest time.
void Scene::remember(bool fresh) {
  auto& judged = node != nullptr ? node->judged : ring.judged;
  if (!fresh) {
    for (Judged& entry : judged) {
      if (entry.rule == rule && entry.owner == owner) {
        entry.time_ns = now.time_ns;
        return;
      }
    }
  }
  if (judged.full()) {
    for (std::size_t i = 1; i < judged.size(); ++i) judged[i - 1] = judged[i];
    judged.back() = {rule, owner, now.frame, now.time_ns};
  } else {
    judged.push_back({rule, owner, now.frame, now.time_ns});
  }
}

Cause Scene::cause_among(std::span<const RuleId> rules, DurationNs within_ns, TimeNs when) const {
  const Judged* latest = nullptr;
  const auto look_in = [&](std::span<const Judged> judged) {
    for (const Judged& entry : judged) {
      const DurationNs before = elapsed_ns(entry.time_ns, when);
      if (before < 0 || before > within_ns || (latest != nullptr && entry.frame < latest->frame)) continue;
      for (const RuleId candidate : rules) {
        if (candidate == entry.rule) latest = &entry;
      }
    }
  };
  if (node != nullptr) look_in({node->judged.begin(), node->judged.size()});
  look_in({ring.judged.begin(), ring.judged.size()});
  return latest == nullptr ? Cause{} : Cause{latest->rule, latest->frame};
}

Basis weaker(const Basis& left, const Basis& right) {
  if (left.kind == BasisKind::kAssumed || right.kind == BasisKind::kAssumed) return {BasisKind::kAssumed, 0};
  if (left.kind == BasisKind::kCapture) return left;
  if (right.kind == BasisKind::kCapture) return right;
  return left.kind == BasisKind::kConfigured ? left : right;
}

Answer in_progress(const Node& node) {
  const Known& ac_off = node.known[Fact::kAcOff];
  if (!node.have_response || node.status_undefined || ac_off.certainly(1)) return {};
  if (!node.response.in_progress) return {};
  // Servo_Active = 1 and AC_OFF do not go together: the bit is In_Progress.
  if (node.response.servo_active) return {true, {}};
  return {true, ac_off.basis};
}

Speed actual_speed(const Node& node) {
  const ResponseView& response = node.response;
  if (!node.have_response || response.communication_error || response.main.error || response.main.echo != 0) return {};
  const Known& chosen = node.known[Fact::kMonitor2];
  const Known& unit = node.known[Fact::kSpeedUnit];
  if (!chosen || !unit || (chosen.value != 0 && chosen.value != 0x05)) return {};
  return {true, response.data2, unit.value == 1, weaker(chosen.basis, unit.basis)};
}

Position actual_position(const Node& node) {
  if (!node.have_response || node.status_undefined) return {};
  const Known& chosen = node.known[Fact::kMonitor1];
  if (!chosen || (chosen.value != 0 && chosen.value != 0x07)) return {};
  if (chosen.certain()) return {true, node.response.data1, chosen.basis};
  if (!node.following.proven) return {};
  return {true, node.response.data1, {BasisKind::kCapture, node.following.frame}};
}

Answer moves(const Ring& ring, const Node& node) {
  if (!node.have_response || !node.response.servo_active || node.status_undefined) return {};
  if (node.mode_known && node.mode == static_cast<std::uint8_t>(Cyclic::kPp)) {
    const Answer progress = in_progress(node);
    if (progress.yes) return progress;
  }
  return speed_moves(ring, node);
}

Answer speed_moves(const Ring& ring, const Node& node) {
  if (!node.have_response || !node.response.servo_active || node.status_undefined) return {};
  const Speed speed = actual_speed(node);
  if (speed.known) {
    const auto& limit = ring.settings.limits.moving_speed;
    const std::int64_t magnitude = speed.value < 0 ? -std::int64_t{speed.value} : std::int64_t{speed.value};
    if (!speed.in_units) return {magnitude > limit.value_or(30), speed.basis};
    if (limit) return {magnitude > *limit, speed.basis};
  }
  const std::int64_t band = ring.settings.limits.dead_band_units;
  const Position position = actual_position(node);
  if (band > 0 && position.known && node.response_comparable) {
    const std::int64_t step = std::int64_t{position.value} - node.previous_response.data1;
    return {step > band || step < -band, position.basis};
  }
  return {};
}

std::int64_t cycles_in(const Ring& ring, DurationNs duration_ns) {
  if (!ring.cycle_ns || ring.cycle_ns.value <= 0) return 0;
  // The cycles are thirds and halves of a millisecond in whole nanoseconds: round to the nearest.
  return (duration_ns + ring.cycle_ns.value / 2) / ring.cycle_ns.value;
}

bool is_homing_search(const CommandPart& part) {
  return part.code == static_cast<std::uint8_t>(NonCyclic::kHoming) && part.type_code >= 0x11 && part.type_code <= 0x1D;
}

bool is_homing(const CommandPart& part) {
  return part.code == static_cast<std::uint8_t>(NonCyclic::kHoming) &&
         (is_homing_search(part) || part.type_code == 0x21 || part.type_code == 0x22 || part.type_code == 0x31);
}

bool matches(const CommandPart& part, const ResponsePart& answer, bool sub) {
  if (!answer.answers() || answer.echo != part.code) return false;
  const auto code = static_cast<NonCyclic>(part.code);
  const bool short_type = !sub && (code == NonCyclic::kHoming || code == NonCyclic::kProfile);
  const std::uint16_t mask = short_type ? 0xFF : 0xFFF;
  if ((part.type_code & mask) != (answer.type_code & mask)) return false;
  if (!sub && code == NonCyclic::kAlarm && part.type_code == kAlarmAttribute && part.index == 0) return true;
  return part.index == answer.index;
}

bool starts(const Scene& scene, NonCyclic code) {
  return !scene.is_sub() && scene.part().code == static_cast<std::uint8_t>(code);
}
bool starts(const Scene& scene, NonCyclic code, std::uint16_t type_code) {
  return starts(scene, code) && scene.part().type_code == type_code;
}

bool has_status(const Node& node) { return node.have_response && !node.status_undefined; }

std::uint8_t profile_in_progress(const Node& node) {
  return node.profile.known && in_progress(node).yes ? node.profile.type_code : 0;
}
bool is_latch_or_homing_profile(std::uint8_t profile) {
  return profile == 0x12 || profile == 0x13 || (profile >= 0x31 && profile <= 0x33);
}

Outcome raise_start(Scene& scene, Report report) {
  if (report.where.length == 0) report.where = scene.bytes(8, 4);
  if (report.related[0] == 0) report.related[0] = scene.node->response_frame;
  if (report.arguments[0] == 0) report.arguments[0] = scene.part().type_code;
  return scene.raise(report);
}

EmergencyInput emergency_input(const Node& node) {
  const ResponseView& response = node.response;
  const auto in_map = [](std::uint32_t data) {
    std::array<std::uint8_t, 4> bytes = {};
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(data >> (8 * i));
    return read(slot(kBitMaps[0].layouts[0], "input_e_stop"), bytes) != 0;
  };
  if (!has_status(node)) return {};
  if (node.settings != nullptr && node.settings->input_second_meaning[7] == true) return {true, response.bit7_input};
  for (const ResponsePart* part : {&response.main, &response.sub}) {
    if (part->is(NonCyclic::kMonitor) && part->type_code == kLogicalInputs && !part->busy)
      return {true, in_map(part->data)};
  }
  const auto chosen = [&](Fact fact) { return node.known[fact].certainly(kLogicalInputs); };
  if (chosen(Fact::kMonitor1)) return {true, in_map(static_cast<std::uint32_t>(response.data1))};
  if (response.communication_error || response.main.error || response.main.echo != 0) return node.emergency;
  if (chosen(Fact::kMonitor2)) return {true, in_map(static_cast<std::uint32_t>(response.data2))};
  if (chosen(Fact::kMonitor3)) return {true, in_map(static_cast<std::uint32_t>(response.data3))};
  return node.emergency;
}

}  // namespace servotrace::rtex
