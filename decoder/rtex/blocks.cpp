// SPDX-License-Identifier: MIT
// A node's blocks: what changed since the one before, and which events that is.
#include <utility>

#include "decoder/rtex/engine.hpp"
#include "decoder/rtex/tracking.hpp"

namespace servotrace::rtex {
namespace {

bool is_zero(const BlockWords& raw) { return (raw[0] | raw[1] | raw[2] | raw[3]) == 0; }

}  // namespace

void Engine::name_node(Node& node, std::uint8_t mac_id, bool actual) {
  if (node.ref.mac_id == mac_id && node.mac_known == actual) return;
  if (node.mac_known && !actual) return;
  const bool another = node.mac_known && node.actual_mac != mac_id;
  if (another) {  // another drive at this place: what was learnt was the other's
    node.known = Knowledge{};
    node.following = {};
    node.multi_turn_frame = 0;
    node.strings = {};
    node.settings = nullptr;
  }
  node.mac_known = actual;
  if (actual) node.actual_mac = mac_id;
  node.ref.mac_id = mac_id;
  ring_.findings.set_node(node.owner, node.ref);
  for (ChannelState& channel : node.channels) {
    NodeRef ref = node.ref;
    ref.channel = channel.id;
    ring_.findings.set_node(channel.owner, ref);
  }
  const RtexAxisSettings* settings = ring_.settings.axis(ring_.bus.number, mac_id);
  if (settings != nullptr && settings != node.settings) node.known.configure(*settings);
  node.settings = settings;
  node.format = node.known.format();
}

void Engine::push_command(const Context& context, Node& node, Bytes block, std::uint32_t block_at, BlockSize size) {
  ++ring_.of_record.awake;
  wake(node);
  const BlockWords before = node.command_raw;
  const BlockWords raw = words_of(block);
  node.command_raw = raw;
  if (!node.command_written && is_zero(raw)) {  // not yet written
    ++ring_.of_record.telling;
    return;
  }
  node.command_written = true;
  node.comparable = node.have_command && node.command_chain;
  if (node.comparable) {
    node.previous = node.command;
    node.previous_frame = node.command_frame;
  }
  node.command = view_of_command(block, size);
  node.have_command = node.command_chain = true;
  node.command_frame = context.frame.number;
  const CommandView& command = node.command;
  if (!node.mac_known) name_node(node, command.mac_id, false);

  Scene scene = ring_scene(context);
  scene.node = &node;
  scene.block_at = block_at;
  if (node.quiet.command_streak + 1U >= kQuietStreak) scene.passed = &node.quiet.command_passed;
  node.quiet.command_passed.clear();
  node.quiet.raised = false;
  Events events = kCommandBlock;
  node.mode_changed = command.is_mode() && node.mode_known && node.mode != command.cyclic;
  node.mode_before = node.mode;
  if (command.is_mode()) {
    node.mode = command.cyclic;
    node.mode_known = true;
  }
  if (!command.is_nop()) {
    events |= kActiveCommand;
    if (node.servo_on_known && command.servo_on != node.servo_on_sent)
      events |= command.servo_on ? kServoOn : kServoOff;
  }
  if (node.mode_changed) events |= kModeChange;
  watch_command(scene);
  run(scene, events);
  for (ChannelState& channel : node.channels) {
    if (channel.id == Channel::kSub && !command.wide) continue;
    scene.channel = &channel;
    if (!command.is_nop()) run(scene, kActiveCommand);
    PassedRows* const passed = std::exchange(scene.passed, nullptr);  // a step is none of what stays
    step_command(scene, channel);
    scene.passed = passed;
    show_handshake(scene);
  }
  scene.channel = nullptr;
  count_command(scene);
  track_command(scene);
  if (node.mode_changed) {
    node.mode_changed_before = true;
    node.mode_change_cycle = ring_.cycle;
    node.mode_change_frame = context.frame.number;
  }
  if (command.is_mode()) node.mode_commanded = true;
  if (!command.is_nop()) {
    node.servo_on_sent = command.servo_on;
    node.servo_on_known = true;
  }
  end_full_command(node, before, raw);
}

void Engine::push_response(const Context& context, Node& node, Bytes block, std::uint32_t block_at, BlockSize size) {
  ++ring_.of_record.awake;
  wake(node);
  const BlockWords before = node.response_raw;
  const BlockWords raw = words_of(block);
  const bool identical = node.have_response && raw == before;
  const bool stale = node.ignore_stale && raw == before;  // what a drive wrote before its reset
  if (!stale) {
    node.ignore_stale = false;
    node.response_raw = raw;
  }
  if (stale || (!node.response_written && is_zero(raw))) {  // or not yet written
    ++ring_.of_record.telling;
    return;
  }
  node.response_written = true;
  node.zero_response = is_zero(raw);
  node.response_comparable = node.have_response && node.response_chain;
  if (node.response_comparable) node.previous_response = node.response;
  ResponseView response = view_of_response(block, size);
  // While an attribute C validation is Busy, bytes 2 to 7 mean nothing: the last that did stay.
  node.status_undefined =
      response.main.is(NonCyclic::kReset) && response.main.type_code == kValidation && response.main.busy;
  if (node.status_undefined) keep_status(response, node.response, node.have_response);
  node.identical_response = identical && node.response_comparable;
  if (!node.identical_response) {
    node.same_responses = 0;
  } else if (node.counter_moved_since_response) {
    ++node.same_responses;
  }
  node.counter_moved_since_response = false;
  node.response = response;
  node.have_response = node.response_chain = true;
  node.response_frame = context.frame.number;
  node.response_cycle = ring_.cycle;
  if (response.cr) {
    node.answered = true;
    if (!response.communication_error || !node.mac_known) name_node(node, response.mac_id, true);
  }
  if (!node.status_undefined && response.cr && response.servo_ready) node.synchronised = true;
  node.communication_errors = response.communication_error ? node.communication_errors + 1 : 0;

  Scene scene = ring_scene(context);
  scene.node = &node;
  scene.block_at = block_at;
  if (node.quiet.response_streak + 1U >= kQuietStreak) scene.passed = &node.quiet.response_passed;
  node.quiet.response_passed.clear();
  node.quiet.raised = false;
  Events events = kResponseBlock;
  if (response.cr && !node.status_undefined) events |= kStatus;
  run(scene, events);
  scene.passed = nullptr;
  judge_echo(scene, node.identical_response);
  for (ChannelState& channel : node.channels) {
    if (channel.id == Channel::kSub && !response.wide) continue;
    scene.channel = &channel;
    if (!response.cr) continue;
    const ResponseView& last = node.previous_response;
    judge_answer(scene, channel,
                 node.response_comparable && scene.answer().is_again(scene.is_sub() ? last.sub : last.main));
  }
  scene.channel = nullptr;
  if (response.cr) track_status(scene);
  end_full_response(node, before, raw);
}

}  // namespace servotrace::rtex
