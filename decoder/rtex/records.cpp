// SPDX-License-Identifier: MIT
// The order of records, the communication cycle, and when a ring runs: CP103, RX108 (whole ring), RX111, RX112, RX115.
#include <cstdlib>

#include "decoder/pipeline/rules.hpp"
#include "decoder/rtex/derived.hpp"
#include "decoder/rtex/engine.hpp"

namespace servotrace::rtex {
namespace {

constexpr DurationNs kCycles[] = {83'333, 166'667, 500'000, 1'000'000};  // 2-5-1
constexpr std::uint32_t kMeasuredIntervals = 32;
constexpr std::uint32_t kTimeoutRecords = 32;
constexpr std::uint32_t kHalf = 0x80000000U;  // a sequence difference from here on goes back

// The nearest of the four cycles, where it is within 2 %; else 0.
DurationNs nearest_cycle(DurationNs measured_ns) {
  for (const DurationNs cycle : kCycles) {
    const DurationNs off = measured_ns - cycle;
    if (off <= cycle / 50 && off >= -(cycle / 50)) return cycle;
  }
  return 0;
}

}  // namespace

// --- header ---------------------------------------------------------------------------------------------------------

void Engine::take_header(const Context& context, const RecordHeader& header) {
  const bool changed = ring_.have_header &&
                       (header.node_count != ring_.node_count || header.wide_nodes != ring_.wide_nodes ||
                        (header.cycle_valid && ring_.header_cycle_ns != 0 && header.cycle_ns != ring_.header_cycle_ns));
  if (changed) {
    restart_ring(context);
    if (ring_.cycle_ns.basis.kind == BasisKind::kCapture) ring_.cycle_ns = {};
  }
  ring_.have_header = true;
  ring_.node_count = header.node_count;
  ring_.wide_nodes = header.wide_nodes;
  if (!header.cycle_valid) return;
  ring_.header_cycle_ns = header.cycle_ns;
  if (ring_.cycle_ns) return;
  const DurationNs cycle = nearest_cycle(header.cycle_ns);
  if (cycle != 0) ring_.cycle_ns = {cycle, {BasisKind::kCapture, context.frame.number}};
}

// --- order ----------------------------------------------------------------------------------------------------------

bool Engine::same_as_last(const RecordHeader& header, Bytes record) const {
  std::uint32_t at = header.header_length;
  for (unsigned i = 0; i < header.node_count; ++i) {
    const Node* node = ring_.nodes[i].get();
    if (node == nullptr) return false;
    const auto& raw = header.response ? node->response_raw : node->command_raw;
    const std::size_t words = header.size(i) == BlockSize::kWide ? 4 : 2;
    for (std::size_t word = 0; word < words; ++word) {
      if (load_le64(record, at + 8 * word) != raw[word]) return false;
    }
    at += static_cast<std::uint32_t>(header.size(i));
  }
  return true;
}

Engine::Order Engine::take_sequence(const Context& context, const RecordHeader& header, Bytes record) {
  const bool response = header.response;
  if (!header.sequence_valid || ring_.sampled) {
    // Nothing numbers the records: a command begins a cycle.
    if (header.sequence_valid && ring_.sequence_known && header.sequence - ring_.sequence < kHalf)
      ring_.cycle += header.sequence - ring_.sequence;
    else if (!response)
      ++ring_.cycle;
    ring_.sequence = header.sequence;
    ring_.sequence_known = header.sequence_valid;
    ring_.cycle_has_command = ring_.cycle_has_command || !response;
    return Order::kNext;
  }
  const std::uint32_t ahead = header.sequence - ring_.sequence;
  const bool known = ring_.sequence_known;
  bool& seen = response ? ring_.cycle_has_response : ring_.cycle_has_command;
  if (known && ahead == 0 && seen) {
    end_rest();
    if (same_as_last(header, record)) return Order::kDuplicate;
    lose_records(context, capture::kLostBack, header.sequence);
    stop_ring();
  } else if (known && ahead >= kHalf) {
    if (ring_.gap_reported) {
      restart_comparisons();
    } else {
      lose_records(context, capture::kLostBack, header.sequence);
    }
    restart_ring(context);
    ++ring_.cycle;
    ring_.cycle_has_command = ring_.cycle_has_response = false;
  } else if (known && (ahead > 1 || (response && ahead == 1))) {
    // Of each cycle in between both records, of the last one what was not seen, of this one its command.
    const std::int64_t lost = (ring_.cycle_has_response ? 0 : 1) + 2 * (std::int64_t{ahead} - 1) + (response ? 1 : 0);
    if (ring_.gap_reported) {
      restart_comparisons();
    } else {
      lose_records(context, capture::kLostJump, lost);
    }
    ring_.cycle += ahead;
    ring_.cycle_has_command = ring_.cycle_has_response = false;
    ring_.missing_responses = 0;
  } else if (known && ahead == 1) {
    next_cycle(context);
  }
  if (known) ring_.findings.checked(rule("CP103"));
  ring_.gap_reported = false;
  ring_.sequence = header.sequence;
  ring_.sequence_known = true;
  (response ? ring_.cycle_has_response : ring_.cycle_has_command) = true;
  if (response && ring_.missing_responses != 0) {
    if (ring_.missing_responses == 1) {
      ring_.findings.raise(context.frame, {.rule = rule("CP103"),
                                           .owner = ring_.capture_owner,
                                           .arguments = {capture::kLostResponse, 1},
                                           .related = {ring_.missing_from, 0}});
    } else {
      ring_.findings.calm(ring_.owner, rule("RX108"));
    }
    ring_.missing_responses = 0;
  }
  return Order::kNext;
}

// A command whose number is that of the cycle before + 1.
void Engine::next_cycle(const Context& context) {
  if (ring_.cycle_has_command && !ring_.cycle_has_response && !ring_.gap_reported) {
    ring_.awaiting_start = false;
    if (++ring_.missing_responses == 1) ring_.missing_from = ring_.last_command.frame;
    if (ring_.missing_responses >= 2 && ring_.running) {
      Scene scene = ring_scene(context);
      report(scene, rule("RX108"), ring_.owner, {.related = {ring_.missing_from, ring_.last_response_frame}});
      ring_.findings.checked(rule("RX108"));
    }
    for (const auto& node : ring_.all()) {
      if (node == nullptr) continue;
      wake(*node);
      node->quiet.response_streak = 0;
      node->response_comparable = false;
      node->response_chain = false;
      node->same_responses = 0;
      for (ChannelState& channel : node->channels) channel.hold.every_response = false;
    }
  }
  ++ring_.cycle;
  ring_.cycle_has_command = ring_.cycle_has_response = false;
}

void Engine::lose_records(const Context& context, std::int64_t kind, std::int64_t argument) {
  ring_.findings.raise(context.frame,
                       {.rule = rule("CP103"), .owner = ring_.capture_owner, .arguments = {kind, argument}});
  restart_comparisons();
}

void Engine::gap() {
  restart_comparisons();
  ring_.gap_reported = true;  // by whoever lost them
}

void Engine::restart_comparisons() {
  end_rest();
  forget_collected();
  ring_.missing_responses = 0;
  ring_.last_command_follows = false;
  ring_.timeout_pending = false;
  ring_.timing.known = false;
  ring_.first_interval_time = 0;
  ring_.intervals = 0;
  ring_.record_quiet = false;
  for (const auto& node : ring_.nodes) {
    if (node == nullptr) continue;
    wake(*node);
    node->quiet.command_streak = node->quiet.response_streak = 0;
    node->command_chain = node->response_chain = false;
    node->comparable = node->response_comparable = false;
    node->mode_known = false;
    node->mode_changed_before = false;
    node->same_responses = 0;
    node->communication_errors = 0;
    node->counter.comparable = node->counter.phase_known = node->counter.echo_pending = false;
    node->counter.history_length = 0;
    node->counter.nop_records = 0;
    node->counter.nop_moved = false;
    node->counter.still = 0;
    node->latch = {};  // it may have completed, or been cancelled
    node->following.has_base = false;
    node->inhibit = {};
    node->off = {};
    node->profile_watch = {};
    node->emergency = {};
    node->multi_turn_frame = 0;
    node->known.on_lost();
    node->limited_since = {};
    for (ChannelState& channel : node->channels) {
      // A reset may have been let go in the gap: the drives restart.
      if (channel.id == Channel::kMain && channel.hold.part.code == static_cast<std::uint8_t>(NonCyclic::kReset) &&
          channel.hold.part.type_code == kSoftwareReset && !channel.hold.refused) {
        ring_.running = false;
        ring_.awaiting_start = true;
      }
      const auto& row = kHandshake.next(channel.state, HandshakeEvent::kLost);
      channel.state = row.to;
      channel.hold = {};
      channel.process = {};
      channel.withheld = {};
    }
  }
}

// --- time -----------------------------------------------------------------------------------------------------------

void Engine::take_command_record(const Context& context, const RecordHeader& header, bool all_nop) {
  const bool timed = context.frame.has_time && header.sequence_valid && !ring_.sampled;
  if (all_nop && !ring_.last_all_nop) {
    // The ring begins again: after a reset, or after a pause that lost records hide.
    const bool paused = !(timed && ring_.last_command_follows) && ring_.cycle_ns && ring_.last_command.frame != 0 &&
                        elapsed_ns(ring_.last_command.time_ns, context.frame.time_ns) >
                            ring_.settings.limits.timeout_cycles * ring_.cycle_ns.value;
    if (!ring_.running || paused) stop_ring();
    ring_.awaiting_start = false;
  }
  ring_.last_all_nop = all_nop;
  if (timed && ring_.last_command_follows) {
    const DurationNs interval = elapsed_ns(ring_.last_command.time_ns, context.frame.time_ns);
    ring_.cycle_times.add(interval);
    if (context.dissection != nullptr) {
      context.dissection->derived.push_back({.field = &kCycleTimeField,
                                             .protocol = "rtex",
                                             .value = interval,
                                             .node = NodeRef{.bus = ring_.bus, .protocol = Protocol::kRtex}});
    }
    if (ring_.cycle_ns && interval >= 0) ring_.cycle_deviations.add(std::abs(interval - ring_.cycle_ns.value));
    if (!ring_.cycle_ns) {
      if (ring_.intervals == 0) ring_.first_interval_time = ring_.last_command.time_ns;
      if (++ring_.intervals == kMeasuredIntervals) {
        const DurationNs whole = elapsed_ns(ring_.first_interval_time, context.frame.time_ns);
        const DurationNs cycle = nearest_cycle(whole / kMeasuredIntervals);
        if (cycle != 0) ring_.cycle_ns = {cycle, {BasisKind::kCapture, context.frame.number}};
        ring_.intervals = 0;
      }
    }
    if (ring_.cycle_ns && interval > ring_.settings.limits.timeout_cycles * ring_.cycle_ns.value)
      ring_.awaiting_start = false;
    judge_timeout(context, all_nop);
    if (ring_.running) judge_interval(context, interval);
  }
  ring_.last_command_follows = timed;
  if (!ring_.ever_lost) return;
  // RX115: lost with a servo on. Servo_On = 0 to every drive settles it, a start of the ring without it does not.
  if (all_nop) restart_ring(context);
}

void Engine::judge_interval(const Context& context, DurationNs interval_ns) {
  const DurationNs cycle = ring_.cycle_ns.value;
  if (!ring_.cycle_ns || ring_.time_resolution_ns > cycle / 4 || interval_ns < 0) return;  // backwards: CP102
  const Limits& limits = ring_.settings.limits;
  Scene scene = ring_scene(context);
  const Basis basis = ring_.cycle_ns.basis;
  ring_.findings.checked(rule("RX112"));
  if (interval_ns > limits.timeout_cycles * cycle) {
    if (ring_.shared_carrier) {
      if (!ring_.timeout_pending) {
        ring_.timeout_pending = true;
        ring_.timeout_records = 0;
        ring_.timeout_from = ring_.last_command;
        ring_.timeout_at = scene.now;
        ring_.timeout_interval_ns = interval_ns;
      }
      return;
    }
    report(scene, rule("RX112"), ring_.owner,
           {.arguments = {interval_ns, cycle, limits.timeout_cycles},
            .related = {ring_.last_command.frame, 0},
            .basis = basis});
    lose_ring(context);
    return;
  }
  ring_.findings.calm(ring_.owner, rule("RX112"));
  ring_.findings.checked(rule("RX111"));
  const DurationNs off = interval_ns > cycle ? interval_ns - cycle : cycle - interval_ns;
  if (off > limits.jitter_percent * cycle / 100) {
    report(scene, rule("RX111"), ring_.owner,
           {.arguments = {interval_ns, cycle},
            .related = {ring_.last_command.frame, 0},
            .basis = basis,
            .as_note = ring_.shared_carrier});
  } else {
    ring_.findings.calm(ring_.owner, rule("RX111"));
  }
}

// RX112 over Ethernet or UDP: the recorder's own pauses are made up by the records behind them.
void Engine::judge_timeout(const Context& context, bool all_nop) {
  if (!ring_.timeout_pending) return;
  if (all_nop) {
    ring_.timeout_pending = false;
    restart_ring(context);
    return;
  }
  if (++ring_.timeout_records < kTimeoutRecords) return;
  ring_.timeout_pending = false;
  const DurationNs cycle = ring_.cycle_ns.value;
  const DurationNs late = elapsed_ns(ring_.timeout_from.time_ns, context.frame.time_ns) - (kTimeoutRecords + 1) * cycle;
  const std::int64_t limit = ring_.settings.limits.timeout_cycles;
  if (late <= (limit - 1) * cycle) return;
  Scene scene = ring_scene(context);
  report(scene, rule("RX112"), ring_.owner,
         {.arguments = {ring_.timeout_interval_ns, cycle, limit},
          .related = {ring_.timeout_from.frame, ring_.timeout_at.frame},
          .basis = ring_.cycle_ns.basis});
  lose_ring(context);
}

// --- running --------------------------------------------------------------------------------------------------------

// The ring was lost (RX112, RX108 of every node): what comes is a new run.
void Engine::lose_ring(const Context& context) {
  bool servo_on = false;
  for (const auto& node : ring_.all()) servo_on = servo_on || (node != nullptr && node->servo_on_sent);
  ring_.ever_lost = servo_on;
  ring_.lost_frame = context.frame.number;
  stop_ring();
}

// The ring is initialised again: all NOP, another header, or the sequence went back.
void Engine::restart_ring(const Context& context) {
  if (ring_.ever_lost) {
    ring_.ever_lost = false;
    Scene scene = ring_scene(context);
    report(scene, rule("RX115"), ring_.owner, {.related = {ring_.lost_frame, 0}});
  }
  stop_ring();
}

// A software reset and the new start behind it keep what a reset does not settle (RX520).
void Engine::stop_ring(bool by_reset) {
  std::array<std::uint64_t, kMaxNodes> multi_turn = {};
  for (std::size_t i = 0; i < kMaxNodes; ++i) {
    if (ring_.nodes[i] != nullptr && (by_reset || !ring_.running)) multi_turn[i] = ring_.nodes[i]->multi_turn_frame;
  }
  restart_comparisons();
  ring_.running = false;
  ring_.reset_reported = false;
  for (const auto& entry : ring_.nodes) {
    if (entry == nullptr) continue;
    Node& node = *entry;
    node.have_command = node.have_response = false;
    node.command_written = node.response_written = false;
    node.answered = node.synchronised = node.status_undefined = false;
    node.mode_commanded = false;
    node.servo_on_known = false;
    node.alarms.was_known = node.alarms.was_known || node.alarms.known;
    node.mac_judged = false;
    node.alarms.was_alarm = node.alarms.known ? node.alarms.alarm : node.alarms.was_alarm;
    node.alarms.was_warning = node.alarms.known ? node.alarms.warning : node.alarms.was_warning;
    node.alarms.known = false;
    node.profile = {};
    node.counter = {};
    node.multi_turn_frame = multi_turn[node.place];
  }
}

void Engine::end_command_record(const Context& context) {
  if (ring_.ever_lost) {
    bool all_off = true;
    for (const auto& node : ring_.all()) all_off = all_off && node != nullptr && !node->servo_on_sent;
    if (all_off) ring_.ever_lost = false;
  }
  count_timing(context);
  judge_command_record(context);
  learn_ratio(context);
  if (ring_.reset_sent) {
    ring_.reset_sent = false;
    stop_ring(true);
    ring_.awaiting_start = true;
  }
}

void Engine::end_response_record(const Context& context) {
  learn_lag(context);
  Scene scene = ring_scene(context);
  run(scene, kResponseRecord);
  // Every node's response is missing: the ring is lost.
  if (!ring_.running || ring_.node_count == 0) return;
  for (const auto& node : ring_.all()) {
    if (node == nullptr || !node->answered || !ring_.findings.is_open(node->owner, rule("RX108"))) return;
  }
  if (!ring_.ever_lost) {
    bool servo_on = false;
    for (const auto& node : ring_.all()) servo_on = servo_on || node->servo_on_sent;
    ring_.ever_lost = servo_on;
    ring_.lost_frame = context.frame.number;
  }
}

}  // namespace servotrace::rtex
