// SPDX-License-Identifier: MIT
// When a node is quiet, and what of its blocks is still followed then.
#include "decoder/rtex/quiet.hpp"

#include "decoder/rtex/engine.hpp"

namespace servotrace::rtex {
namespace {

constexpr Slot kCounter = slot(kCommand, "update_counter");
constexpr Slot kEcho = slot(kResponse, "update_counter_echo");
static_assert(kCounter.first_byte == kEcho.first_byte && kCounter.shift == kEcho.shift &&
              kCounter.width == kEcho.width);
constexpr unsigned kCounterShift = 8U * kCounter.first_byte + kCounter.shift;
constexpr std::uint64_t kCounterMask = (std::uint64_t{1} << kCounter.width) - 1;
constexpr std::uint64_t kBesidesCounter = ~(kCounterMask << kCounterShift);

std::uint8_t counter_of(std::uint64_t first_word) {
  return static_cast<std::uint8_t>(first_word >> kCounterShift & kCounterMask);
}

// Bits in which the block differs from `raw`, the counter left out.
[[gnu::always_inline]] inline std::uint64_t difference(Bytes block, const std::array<std::uint64_t, 4>& raw,
                                                       bool wide) {
  std::uint64_t differs = ((load_le64(block, 0) ^ raw[0]) & kBesidesCounter) | (load_le64(block, 8) ^ raw[1]);
  if (wide) differs |= (load_le64(block, 16) ^ raw[2]) | (load_le64(block, 24) ^ raw[3]);
  return differs;
}

// Nothing of the channel waits for time to pass or for an answer.
bool is_settled(const ChannelState& channel) {
  if (channel.process.busy || channel.withheld.waiting) return false;
  if (channel.state == Handshake::kStandard) return true;
  return channel.state == Handshake::kIdle && channel.hold.complete && channel.hold.arguments_echoed;
}

bool is_settled(const Node& node) {
  const CommandView& command = node.command;
  const ResponseView& response = node.response;
  if (!node.comparable || !node.response_comparable || command.is_nop() || node.mode_changed) return false;
  if (!node.synchronised || !node.mac_known || node.status_undefined || node.zero_response || node.ignore_stale)
    return false;
  if (!response.cr || response.communication_error || response.torque_limited) return false;
  // These note when they were last held.
  if (command.is(NonCyclic::kHoming) || command.is(NonCyclic::kProfile) || command.is(NonCyclic::kReset)) return false;
  const CounterState& counter = node.counter;
  constexpr std::uint32_t kLongRunning = 64;
  if (!counter.comparable || !counter.ever_moved || !counter.phase_known || counter.history_length < 16 ||
      counter.active_records < kLongRunning || counter.stuck_cycles != 0 || counter.start_pending ||
      counter.echo_pending) {
    return false;
  }
  return is_settled(node.channels[0]) && (!node.wide || is_settled(node.channels[1]));
}

}  // namespace

bool Engine::same_but_counter(Bytes block, const std::array<std::uint64_t, 4>& raw, BlockSize size) {
  return difference(block, raw, size == BlockSize::kWide) == 0;
}

bool Engine::ring_is_settled() const {
  return ring_.running && ring_.cycle_ns && ring_.ratio_decided && ring_.ratio && ring_.pair_judged &&
         !ring_.pair_is_bad && ring_.lag_decided && ring_.lag >= 0 && !ring_.sampled;
}

void Engine::end_full_command(Node& node, bool same) {
  Quiet& quiet = node.quiet;
  quiet.command_streak =
      !same || quiet.raised ? std::uint8_t{0} : std::min<std::uint8_t>(quiet.command_streak + 1U, kQuietStreak);
}

void Engine::end_full_response(Node& node, bool same) {
  Quiet& quiet = node.quiet;
  quiet.response_streak =
      !same || quiet.raised ? std::uint8_t{0} : std::min<std::uint8_t>(quiet.response_streak + 1U, kQuietStreak);
  quiet.armed = quiet.command_streak == kQuietStreak && quiet.response_streak == kQuietStreak && ring_is_settled() &&
                is_settled(node) && quiet.command_passed.dropped() + quiet.response_passed.dropped() == 0 &&
                !ring_.findings.is_open(node.owner, rule("RX108")) && !ring_.settings.judge_every_block;
}

// Something changes: counts what the checks of the quiet blocks would have counted, while the state is still theirs.
void Engine::wake(Node& node) {
  end_rest();
  Quiet& quiet = node.quiet;
  quiet.armed = false;
  Findings& findings = ring_.findings;
  if (quiet.commands != 0) {
    for (const std::uint8_t row : quiet.command_passed) findings.checked(id_of(row), quiet.commands);
    findings.checked(rule("RX201"), quiet.moves);
    findings.checked(rule("RX202"), quiet.moves);
    if (ring_.ratio.value == 2) findings.checked(rule("RX203"), quiet.moves);
    if (ring_.ratio.value == 2 && judges_between(node)) findings.checked(rule("RX212"), quiet.holds);
  }
  if (quiet.responses != 0) {
    for (const std::uint8_t row : quiet.response_passed) findings.checked(id_of(row), quiet.responses);
    findings.checked(rule("RX205"), quiet.responses);
  }
  quiet.commands = quiet.responses = quiet.moves = quiet.holds = 0;
}

void Engine::wake_all() {
  for (const auto& node : ring_.nodes) {
    if (node == nullptr) continue;
    wake(*node);
    node->quiet.command_streak = node->quiet.response_streak = 0;
  }
}

void Engine::follow_command(Node& node, std::uint64_t first_word, std::uint64_t frame) {
  CounterState& counter = node.counter;
  const std::uint8_t now = counter_of(first_word);
  const bool moves = now != node.command.counter;
  node.command_raw[0] = first_word;
  node.previous.counter = node.command.counter;
  node.command.counter = now;
  node.previous_frame = node.command_frame;
  node.command_frame = frame;
  counter.history = counter.history << 2U | now;
  ++node.quiet.commands;
  if (moves) {
    node.counter_moved_since_response = true;
    counter.still = 1;
    counter.last_move_frame = frame;
    ++node.quiet.moves;
  } else {
    ++counter.still;
    ++node.quiet.holds;
  }
}

void Engine::follow_response(Node& node, std::uint64_t first_word, std::uint64_t frame, std::int64_t cycle) {
  node.identical_response = first_word == node.response_raw[0];
  if (!node.identical_response) {
    node.same_responses = 0;
  } else if (node.counter_moved_since_response) {
    ++node.same_responses;
  }
  node.counter_moved_since_response = false;
  node.response_raw[0] = first_word;
  node.previous_response.counter = node.response.counter;
  node.response.counter = counter_of(first_word);
  node.response_frame = frame;
  node.response_cycle = cycle;
  ++node.quiet.responses;
}

bool Engine::quick_command(const Context& context, Node& node, Bytes block, std::uint32_t block_at) {
  if (difference(block, node.command_raw, node.wide) != 0) return false;
  const std::uint64_t first = load_le64(block, 0);
  const CounterState& counter = node.counter;
  const unsigned step = (counter_of(first) - node.command.counter) & 3U;
  const unsigned expected = ring_.ratio.value == 1 || counter.still == 2 ? 1 : 0;
  if (step != expected || counter.still > 2) return false;
  follow_command(node, first, context.frame.number);
  judge_unsteady(context, node, block_at, kCommandBlock | kActiveCommand);
  return true;
}

bool Engine::quick_response(const Context& context, Node& node, Bytes block, std::uint32_t block_at) {
  if (difference(block, node.response_raw, node.wide) != 0 || !ring_.cycle_has_command) return false;
  const std::uint64_t first = load_le64(block, 0);
  if (counter_of(first) != (node.counter.history >> (2U * static_cast<unsigned>(ring_.lag)) & 3U)) return false;
  const bool identical = first == node.response_raw[0];
  // It may be a stale one.
  if (identical && node.same_responses + (node.counter_moved_since_response ? 1 : 0) > 1) return false;
  follow_response(node, first, context.frame.number, ring_.cycle);
  judge_unsteady(context, node, block_at, kResponseBlock | kStatus | kAnswer);
  return true;
}

}  // namespace servotrace::rtex
