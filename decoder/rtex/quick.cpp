// SPDX-License-Identifier: MIT
// A quiet node's blocks: what is followed of them, and the checks that are run.
#include "decoder/rtex/block_bits.hpp"
#include "decoder/rtex/engine.hpp"
#include "decoder/rtex/tracking.hpp"

namespace servotrace::rtex {

using namespace bits;

namespace {

template <class Number>
Number first_of(std::uint64_t word) {
  return static_cast<Number>(word & kFirst);
}
template <class Number>
Number second_of(std::uint64_t word) {
  return static_cast<Number>(word >> 32U);
}

void follow_words(CommandView& command, const BlockWords& words) {
  command.data1 = second_of<std::int32_t>(words[0]);
  command.data3 = second_of<std::uint32_t>(words[1]);
  command.sub_data2 = first_of<std::uint32_t>(words[3]);
  command.sub_data3 = second_of<std::uint32_t>(words[3]);
}

void follow_words(ResponseView& response, const BlockWords& words) {
  response.data1 = second_of<std::int32_t>(words[0]);
  response.data2 = first_of<std::int32_t>(words[1]);
  response.data3 = second_of<std::int32_t>(words[1]);
  if (is_monitor(response.main.echo)) response.main.data = second_of<std::uint32_t>(words[1]);
  if (is_monitor(response.sub.echo)) response.sub.data = second_of<std::uint32_t>(words[2]);
}

// How far the commands held are.
void show_handshakes(Scene& scene) {
  for (ChannelState& channel : scene.node->channels) {
    if (channel.id == Channel::kSub && !scene.node->wide) continue;
    scene.channel = &channel;
    show_handshake(scene);
  }
}

// A time limit runs.
bool waits(const ChannelState& channel) { return channel.process.busy || channel.withheld.waiting; }

}  // namespace

bool Engine::quick_command(const Context& context, Node& node, Bytes block, std::uint32_t block_at) {
  const BlockWords words = words_of(block);
  const BlockWords changed = changes(words, node.command_raw);
  if (any(changed, node.quiet.command_mask)) return false;
  const bool main_changes = ((changed[0] & mask_of(kCode)) | (changed[1] & kFirst)) != 0;
  const bool sub_changes = changed[2] != 0;
  const bool moves = ((changed[0] | changed[1]) & ~kFirst) != 0 || changed[3] != 0;
  if ((main_changes && !is_monitor_or_none(code_of(words[0]))) ||
      (sub_changes && !is_monitor_or_none(sub_code_of(words[2])))) {
    return false;
  }
  const unsigned step = (counter_of(words[0]) - node.command.counter) & 3U;
  const unsigned expected = ring_.ratio.value == 1 || node.counter.still == 2 ? 1 : 0;
  if (step != expected || node.counter.still > 2 || (step == 0 && moves)) return false;  // or RX212
  node.command_raw = words;
  node.previous = node.command;
  if (main_changes || sub_changes) {
    node.command = view_of_command(block, node.wide ? BlockSize::kWide : BlockSize::kNarrow);
  } else if (moves) {
    follow_words(node.command, words);
  }
  if (moves) node.quiet.has_moved = ring_.of_record.restless = true;
  follow_counter(node, counter_of(words[0]), step != 0, context.frame.number);

  if (!main_changes && !sub_changes && !node.quiet.commands_watched && context.dissection == nullptr) {
    note_waits(node);
    return true;
  }
  Scene scene = quick_scene(context, node, block_at);
  watch_command(scene);
  run_unsteady(scene, kActiveCommand);
  if (main_changes) step_quickly(scene, node.main());
  if (sub_changes) step_quickly(scene, node.sub());
  if (context.dissection != nullptr) show_handshakes(scene);
  end_quick(node);
  return true;
}

void Engine::follow_counter(Node& node, std::uint8_t now, bool moves, std::uint64_t frame) {
  CounterState& counter = node.counter;
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

void Engine::step_quickly(Scene& scene, ChannelState& channel) {
  scene.channel = &channel;
  step_command(scene, channel);
}

bool Engine::quick_response(const Context& context, Node& node, Bytes block, std::uint32_t block_at) {
  const BlockWords words = words_of(block);
  const BlockWords changed = changes(words, node.response_raw);
  if (any(changed, node.quiet.response_mask) || !ring_.cycle_has_command) return false;
  const std::uint8_t main_echo = code_of(words[0]);
  const std::uint8_t sub_echo = sub_code_of(words[2]);
  const ChangedParts parts = {(changed[0] & mask_of(kCode)) != 0 || (main_echo != 0 && (changed[1] & kFirst) != 0),
                              sub_code_of(changed[2]) != 0 || (sub_echo != 0 && (changed[2] & kFirst) != 0)};
  if ((parts.main && !is_monitor_or_none(main_echo)) || (parts.sub && !is_monitor_or_none(sub_echo))) return false;
  const std::uint8_t counter = counter_of(words[0]);
  if (counter != (node.counter.history >> (2U * static_cast<unsigned>(ring_.lag)) & 3U)) return false;
  const bool identical = words == node.response_raw;
  // It may be a stale one.
  if (identical && node.same_responses + (node.counter_moved_since_response ? 1 : 0) > 1) return false;
  node.same_responses = identical ? node.same_responses + (node.counter_moved_since_response ? 1 : 0) : 0;
  node.identical_response = identical;
  node.counter_moved_since_response = false;
  node.previous_response = node.response;
  if (parts.main || parts.sub) {
    node.response = view_of_response(block, node.wide ? BlockSize::kWide : BlockSize::kNarrow);
  } else if (any(changed, kEveryBit)) {
    node.quiet.has_moved = ring_.of_record.restless = true;
    follow_words(node.response, words);
  }
  node.response_raw = words;
  node.response.counter = counter;
  node.response_frame = context.frame.number;
  node.response_cycle = ring_.cycle;
  ++node.quiet.responses;
  judge_quick_response(context, node, block_at, parts);
  return true;
}

void Engine::judge_quick_response(const Context& context, Node& node, std::uint32_t block_at, ChangedParts parts) {
  Quiet& quiet = node.quiet;
  auto& [main, sub] = quiet.answers;
  const bool main_is_judged = parts.main || main.same != kSameAnswers;
  const bool sub_is_judged = node.wide && (parts.sub || sub.same != kSameAnswers);
  if (!main_is_judged) ++main.times;
  if (node.wide && !sub_is_judged) ++sub.times;
  const bool follows = quiet.has_moved && !node.following.proven && !node.known[Fact::kMonitor1].certain();
  if (!main_is_judged && !sub_is_judged && !follows && !quiet.inputs_watched) return;
  Scene scene = quick_scene(context, node, block_at);
  quiet.inputs_watched = quiet.inputs_watched || ((parts.main || parts.sub) && emergency_input(node).known);
  if (quiet.inputs_watched) run_unsteady(scene, kStatus);
  if (main_is_judged) answer_quickly(scene, node.main(), !parts.main);
  if (sub_is_judged) answer_quickly(scene, node.sub(), !parts.sub);
  watch_values(scene);
  quiet.has_moved = false;
  end_quick(node);
}

void Engine::answer_quickly(Scene& scene, ChannelState& channel, bool same) {
  scene.channel = &channel;
  judge_answer(scene, channel, same);
  scene.channel = nullptr;
}

Scene Engine::quick_scene(const Context& context, Node& node, std::uint32_t block_at) {
  Scene scene = ring_scene(context);
  scene.node = &node;
  scene.block_at = block_at;
  node.quiet.raised = false;
  return scene;
}

void Engine::note_waits(const Node& node) {
  if (waits(node.channels[0]) || waits(node.channels[1])) ++ring_.of_record.awake;  // judge_deadlines
}

void Engine::end_quick(Node& node) {
  note_waits(node);
  if (!node.quiet.raised) return;
  ring_.of_record.restless = true;
  wake(node);
}

}  // namespace servotrace::rtex
