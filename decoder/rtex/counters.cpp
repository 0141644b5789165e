// SPDX-License-Identifier: MIT
// Update_Counter: the updating ratio and the echo lag are learnt, then RX201 to RX205, RX210, RX211 judge the count.
#include "decoder/rtex/engine.hpp"

namespace servotrace::rtex {
namespace {

constexpr std::uint32_t kWindow = 32;  // records or cycles something is learnt from
constexpr unsigned kLags = 4;

bool is_pair(DurationNs cycle_ns, std::int64_t ratio) {  // 2-5-1
  switch (cycle_ns) {
    case 83'333:
      return ratio == 2;
    case 166'667:
    case 1'000'000:
      return ratio == 1;
    default:
      return ratio == 1 || ratio == 2;
  }
}

constexpr ByteRange kCounterByte{0, 1};

}  // namespace

// A written command block; the node's handshake has been judged.
void Engine::count_command(Scene& scene) {
  Node& node = *scene.node;
  CounterState& counter = node.counter;
  const CommandView& command = node.command;
  const std::uint8_t now = command.counter;
  const bool moved = node.comparable && now != node.previous.counter;
  node.counter_moved_since_response = node.counter_moved_since_response || moved;
  if (command.is_nop()) {
    counter.nop_moved = counter.nop_moved || (counter.nop_records > 0 && now != counter.nop_counter);
    counter.nop_counter = now;
    ++counter.nop_records;
    counter.comparable = counter.phase_known = false;
    counter.history_length = 0;
    return;
  }
  counter.history = counter.history << 2U | now;
  if (counter.history_length < 16) ++counter.history_length;
  if (counter.active_records < 0xFFFFFFFFU) ++counter.active_records;
  if (!node.comparable || node.previous.is_nop()) {
    if (counter.active_records == 1 && counter.nop_records > 0) {
      ring_.findings.checked(rule("RX204"));
      counter.start_pending = !counter.nop_moved && now != 1;
      counter.start = scene.now;
      counter.start_counter = now;
    }
    counter.ever_moved = counter.ever_moved || moved;
    counter.phase_known = moved;
    counter.still = 1;
    counter.stuck_cycles = 0;
    counter.comparable = true;
  } else {
    judge_step(scene, node.previous.counter);
  }
  judge_start(scene);
}

void Engine::judge_step(Scene& scene, std::uint8_t before) {
  Node& node = *scene.node;
  CounterState& counter = node.counter;
  const std::uint8_t now = node.command.counter;
  const unsigned step = (now - before) & 3U;
  const auto miss = [&](RuleId which, Report given) {
    ++counter.misses;
    given.where = scene.bytes(kCounterByte.offset, kCounterByte.length);
    given.related = {node.previous_frame, 0};
    given.basis = ring_.ratio.basis;
    report(scene, which, node.owner, given);
    judge_misses(scene);
  };
  const bool judged = ring_.ratio_decided && ring_.ratio && !ring_.pair_is_bad && !ring_.sampled;
  const bool first_move = step != 0 && !counter.ever_moved;
  if (step != 0) counter.ever_moved = true;
  ++counter.window_records;
  if (step != 0) ++counter.window_moves;

  if (judged && ring_.ratio.value == 1 && counter.ever_moved && !first_move) {
    ring_.findings.checked(rule("RX201"));
    ring_.findings.checked(rule("RX202"));
    if (step == 0) {
      ++counter.stuck_cycles;
      miss(rule("RX201"), {.arguments = {now, counter.stuck_cycles}});
    } else {
      counter.stuck_cycles = 0;
      ring_.findings.calm(node.owner, rule("RX201"));
    }
    if (step >= 2) {
      miss(rule("RX202"), {.arguments = {before, now}});
    } else {
      ring_.findings.calm(node.owner, rule("RX202"));
    }
  }
  if (judged && ring_.ratio.value == 2) {
    if (step == 0) {
      if (counter.still >= 2 && counter.still % 2 == 0) {
        ring_.findings.checked(rule("RX201"));
        miss(rule("RX201"), {.arguments = {now, (counter.still + 1) / 2}});
      } else {
        judge_between(scene);
      }
    } else {
      ring_.findings.checked(rule("RX201"));
      ring_.findings.calm(node.owner, rule("RX201"));
      if (counter.phase_known) {
        ring_.findings.checked(rule("RX203"));
        if (counter.still == 1) {
          report(scene, rule("RX203"), node.owner,
                 {.arguments = {before, now},
                  .where = scene.bytes(kCounterByte.offset, kCounterByte.length),
                  .related = {node.previous_frame, counter.last_move_frame},
                  .basis = ring_.ratio.basis});
        } else {
          ring_.findings.calm(node.owner, rule("RX203"));
        }
      }
      if (!(counter.phase_known && counter.still == 1)) {
        ring_.findings.checked(rule("RX202"));
        if (step >= 2) {
          miss(rule("RX202"), {.arguments = {before, now}});
        } else {
          ring_.findings.calm(node.owner, rule("RX202"));
        }
      }
    }
  }
  if (step != 0) {
    counter.still = 1;
    counter.phase_known = true;
    counter.last_move_frame = scene.now.frame;
  } else {
    ++counter.still;
  }
}

// RX204 waits for the first move, and RX211 for the window: a counter that is not used is neither stuck nor late.
void Engine::judge_start(Scene& scene) {
  Node& node = *scene.node;
  CounterState& counter = node.counter;
  const bool at_two = ring_.ratio_decided && ring_.ratio.value == 2;
  if (counter.start_pending && (counter.ever_moved || at_two)) {
    counter.start_pending = false;
    report(scene, rule("RX204"), node.owner,
           {.arguments = {counter.start_counter},
            .where = scene.bytes(kCounterByte.offset, kCounterByte.length),
            .related = {counter.start.frame, 0}});
  }
  if (!counter.ever_moved && !at_two && ring_.ratio_decided && counter.active_records > kWindow &&
      !counter.unused_reported) {
    counter.start_pending = false;
    counter.unused_reported = true;
    ring_.findings.checked(rule("RX211"));
    report(scene, rule("RX211"), node.owner,
           {.arguments = {node.command.counter},
            .where = scene.bytes(kCounterByte.offset, kCounterByte.length),
            .basis = ring_.ratio.basis});
  }
}

// RX206: the misses this capture shows against Pr7.38 and Pr7.28.
void Engine::judge_misses(Scene& scene) {
  Node& node = *scene.node;
  CounterState& counter = node.counter;
  const auto judge = [&](Fact fact, std::int64_t parameter, bool& warned) {
    const Known& limit = node.known[fact];
    if (!limit.certain() || limit.value <= 1) return;
    ring_.findings.checked(rule("RX206"));
    if (warned || counter.misses <= static_cast<std::uint32_t>(limit.value)) return;
    warned = true;
    report(scene, rule("RX206"), node.owner,
           {.arguments = {counter.misses, parameter, limit.value},
            .where = scene.bytes(kCounterByte.offset, kCounterByte.length),
            .basis = limit.basis,
            .variant = parameter});
  };
  judge(Fact::kCounterError, pr(7, 38), counter.warned_error);
  const Known& mask = node.known[Fact::kWarningMask];
  const bool masked = mask.certain() && (static_cast<std::uint32_t>(mask.value) >> 11U & 1U) == 0;
  if (!masked) judge(Fact::kCounterWarning, pr(7, 28), counter.warned_warning);
}

bool Engine::judges_between(const Node& node) {
  const CommandView& command = node.command;
  if (!command.is(Cyclic::kCp) || !node.previous.is(Cyclic::kCp) || is_homing(command.main)) return false;
  return node.have_response && !node.status_undefined && node.response.servo_active && node.counter.phase_known;
}

// RX212: the position changes inside an updating cycle.
void Engine::judge_between(Scene& scene) {
  Node& node = *scene.node;
  const CommandView& command = node.command;
  if (!judges_between(node)) return;
  ring_.findings.checked(rule("RX212"));
  if (command.data1 == node.previous.data1) {
    ring_.findings.calm(node.owner, rule("RX212"));
    return;
  }
  report(scene, rule("RX212"), node.owner,
         {.arguments = {node.previous.data1, command.data1},
          .where = scene.bytes(kData1At, 4),
          .related = {node.previous_frame, 0},
          .basis = ring_.ratio.basis});
}

// --- learning -------------------------------------------------------------------------------------------------------

void Engine::learn_ratio(const Context& context) {
  if (ring_.node_count == 0) return;
  if (ring_.ratio_decided && (ring_.pair_judged || !ring_.ratio || !ring_.cycle_ns)) return;
  bool all_active = true;
  for (const auto& node : ring_.all())
    all_active = all_active && node != nullptr && node->have_command && !node->command.is_nop();
  if (!ring_.ratio_decided && all_active && ++ring_.ratio_records > kWindow) decide_ratio(context);
  // The pair of 2-5-1, once both are known and the ring has left NOP.
  if (ring_.pair_judged || !all_active || !ring_.ratio_decided || !ring_.ratio || !ring_.cycle_ns) return;
  ring_.pair_judged = true;
  Scene scene = ring_scene(context);
  ring_.findings.checked(rule("RX210"));
  if (is_pair(ring_.cycle_ns.value, ring_.ratio.value)) return;
  ring_.pair_is_bad = true;
  report(scene, rule("RX210"), ring_.owner,
         {.arguments = {ring_.cycle_ns.value, ring_.ratio.value},
          .basis = weaker(ring_.cycle_ns.basis, ring_.ratio.basis)});
}

void Engine::decide_ratio(const Context& context) {
  std::uint64_t moves = 0;
  std::uint64_t records = 0;
  for (const auto& node : ring_.all()) {
    if (node->counter.window_moves == 0) continue;  // not used on this node
    moves += node->counter.window_moves;
    records += node->counter.window_records;
  }
  ring_.ratio_decided = true;
  const Basis seen{BasisKind::kCapture, context.frame.number};
  if (records > 0 && 4 * moves >= 3 * records) {
    ring_.ratio = {1, seen};
  } else if (records > 0 && 3 * moves >= records && 8 * moves <= 5 * records) {
    ring_.ratio = {2, seen};
  } else if (ring_.cycle_ns.value == 83'333) {
    ring_.ratio = {2, ring_.cycle_ns.basis};
  } else if (ring_.cycle_ns.value == 166'667 || ring_.cycle_ns.value == 1'000'000) {
    ring_.ratio = {1, ring_.cycle_ns.basis};
  }
}

void Engine::learn_lag(const Context& context) {
  if (ring_.lag_decided || !ring_.cycle_has_command || ring_.sampled) return;
  bool counted = false;
  for (const auto& node : ring_.all()) {
    if (node == nullptr || !node->have_response || node->response_frame != context.frame.number) continue;
    const CounterState& counter = node->counter;
    if (!counter.ever_moved || counter.history_length < kLags || node->response.communication_error) continue;
    counted = true;
    ++ring_.lag_blocks;
    for (unsigned lag = 0; lag < kLags; ++lag) {
      if (node->response.counter != (counter.history >> (2 * lag) & 3U)) ++ring_.lag_mismatches[lag];
    }
  }
  if (!counted || ++ring_.lag_records < kWindow) return;
  ring_.lag_decided = true;
  ring_.lag_frame = context.frame.number;
  std::uint32_t fewest = ring_.lag_mismatches[1];
  ring_.lag = 1;
  for (unsigned lag = 0; lag < kLags; ++lag) {
    if (ring_.lag_mismatches[lag] < fewest) {
      fewest = ring_.lag_mismatches[lag];
      ring_.lag = static_cast<std::int32_t>(lag);
    }
  }
  if (4 * fewest > ring_.lag_blocks) ring_.lag = -1;
}

void Engine::judge_echo(Scene& scene, bool identical) {
  Node& node = *scene.node;
  CounterState& counter = node.counter;
  if (!ring_.running || !node.synchronised || ring_.lag < 0 || !ring_.cycle_has_command || ring_.sampled ||
      counter.history_length <= static_cast<unsigned>(ring_.lag) || node.response.communication_error ||
      node.zero_response || !node.response.cr) {
    counter.echo_pending = false;
    return;
  }
  ring_.findings.checked(rule("RX205"));
  const auto wanted = static_cast<std::uint8_t>(counter.history >> (2 * static_cast<unsigned>(ring_.lag)) & 3U);
  const std::uint8_t echo = node.response.counter;
  if (ring_.findings.is_open(node.owner, rule("RX108"))) {
    counter.echo_pending = false;  // a stale response
    return;
  }
  const auto raise = [&](std::uint8_t seen, std::uint8_t sent, std::uint64_t related) {
    report(scene, rule("RX205"), node.owner,
           {.arguments = {seen, sent, ring_.lag},
            .where = scene.bytes(kCounterByte.offset, kCounterByte.length),
            .related = {related, 0},
            .basis = {BasisKind::kCapture, ring_.lag_frame}});
  };
  if (identical && (echo != wanted || counter.echo_pending)) {
    if (!counter.echo_pending) {
      counter.echo_pending = true;
      counter.echo_at = scene.now;
      counter.echo_wanted = wanted;
      counter.echo_seen = echo;
    }
    return;
  }
  if (counter.echo_pending) {
    counter.echo_pending = false;
    raise(counter.echo_seen, counter.echo_wanted, counter.echo_at.frame);
  }
  if (echo != wanted) {
    raise(echo, wanted, node.command_frame);
  } else {
    ring_.findings.calm(node.owner, rule("RX205"));
  }
}

}  // namespace servotrace::rtex
