// SPDX-License-Identifier: MIT
// When a node is quiet, and what of its blocks is still followed then.
#include "decoder/rtex/quiet.hpp"

#include <algorithm>

#include "decoder/rtex/block_bits.hpp"
#include "decoder/rtex/engine.hpp"

namespace servotrace::rtex {
namespace {

using namespace bits;

// Whatever its channels do.
bool is_running_well(const Node& node) {
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
  return counter.comparable && counter.ever_moved && counter.phase_known && counter.history_length >= 16 &&
         counter.active_records >= kLongRunning && counter.stuck_cycles == 0 && !counter.start_pending &&
         !counter.echo_pending;
}

// The non-cyclic part at hand neither changes nor shows anything but monitor values.
bool only_monitors(const Node& node) {
  const auto& [main, sub] = node.channels;
  const ResponseView& response = node.response;
  return is_monitor_or_none(node.command.main.code) && is_monitor_or_none(node.command.sub.code) &&
         is_monitor_or_none(response.main.echo) && is_monitor_or_none(response.sub.echo) && !response.main.error &&
         !response.sub.error && !main.withheld.waiting && !sub.withheld.waiting;
}

// What has to stay as it is: of a command all but what moves the axis and feedforward (RX212 and the rules that
// reads_words names look at them), of a response all but what is measured.
BlockWords steady_bits(const Node& node, const CommandView& command) {
  if (only_monitors(node)) return kOpenCommand;
  return {kFirst, command.data3_is_setting() ? kAll : kFirst, kAll, 0};
}
BlockWords steady_bits(const Node& node, const ResponseView& response) {
  if (only_monitors(node)) return kOpenResponse;
  const auto bits = [](const ResponsePart& part, std::uint64_t standard) {
    if (part.error) return kAll;
    return part.echo == 0 ? standard : is_monitor(part.echo) ? kFirst : kAll;
  };
  return {kFirst, bits(response.main, 0), bits(response.sub, kFirst), 0};
}

// Whether a command can tell watch_command or one of the rules that read its words anything, as long as the headers and
// what is known of the drive stay the same: RX310 and RX314, RX703, RX705, RX706.
bool watches_commands(const Node& node) {
  const auto is_certain = [&node](Fact fact) { return node.known[fact].certain(); };
  return is_certain(Fact::kForward1) || is_certain(Fact::kForward2) || is_certain(Fact::kForward3) ||
         (node.settings != nullptr && node.settings->max_speed) || node.inhibit.direction != 0 || node.off.known ||
         !node.response.servo_active;
}

bool channels_are_settled(const Node& node) {
  return is_settled(node.channels[0]) && (!node.wide || is_settled(node.channels[1]));
}

}  // namespace

bool is_settled(const ChannelState& channel) {
  if (channel.process.busy || channel.withheld.waiting) return false;
  if (channel.state == Handshake::kStandard) return true;
  return channel.state == Handshake::kIdle && channel.hold.complete && channel.hold.arguments_echoed;
}

bool is_settled(const Node& node) { return is_running_well(node) && channels_are_settled(node); }

bool Engine::ring_is_settled() const {
  return ring_.running && ring_.cycle_ns && ring_.ratio_decided && ring_.ratio && ring_.pair_judged &&
         !ring_.pair_is_bad && ring_.lag_decided && ring_.lag >= 0 && !ring_.sampled;
}

// After a block judged in full: notes whether it says something to the rules of the ring, and to a ring at rest.
void Engine::note_news(const Node& node, const BlockWords& before, const BlockWords& now) {
  const std::uint64_t changed = changes(before, now)[0] & ~mask_of(kCode);
  if ((changed & ~kFirst) != 0) ring_.of_record.restless = true;
  const bool tells = (changed & kFirst) != 0 || node.quiet.raised || !is_running_well(node) || !only_monitors(node) ||
                     !ring_is_settled();
  if (tells) ++ring_.of_record.telling;
}

void Engine::end_full_command(Node& node, const BlockWords& before, const BlockWords& now) {
  Quiet& quiet = node.quiet;
  const bool same = !any(changes(before, now), steady_bits(node, node.command));
  quiet.command_streak =
      !same || quiet.raised ? std::uint8_t{0} : std::min<std::uint8_t>(quiet.command_streak + 1U, kQuietStreak);
  note_news(node, before, now);
}

void Engine::end_full_response(Node& node, const BlockWords& before, const BlockWords& now) {
  Quiet& quiet = node.quiet;
  const bool same = !any(changes(before, now), steady_bits(node, node.response));
  quiet.response_streak =
      !same || quiet.raised ? std::uint8_t{0} : std::min<std::uint8_t>(quiet.response_streak + 1U, kQuietStreak);
  quiet.armed = quiet.command_streak == kQuietStreak && quiet.response_streak == kQuietStreak && ring_is_settled() &&
                is_running_well(node) && (only_monitors(node) || channels_are_settled(node)) &&
                quiet.command_passed.dropped() + quiet.response_passed.dropped() == 0 &&
                !ring_.findings.is_open(node.owner, rule("RX108")) && !ring_.settings.judge_every_block;
  if (quiet.armed) {
    quiet.command_mask = steady_bits(node, node.command);
    quiet.response_mask = steady_bits(node, node.response);
    quiet.commands_watched = watches_commands(node);
    quiet.inputs_watched = emergency_input(node).known;
    quiet.has_moved = true;
  }
  note_news(node, before, now);
}

// What the checks of the quiet blocks would have counted, while the state is still theirs.
void Engine::count_quiet(Node& node) {
  Quiet& quiet = node.quiet;
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
  for (SteadyAnswers& answers : quiet.answers) count_answers(answers);
}

void Engine::count_answers(SteadyAnswers& answers) {
  if (answers.times == 0) return;
  for (const std::uint8_t row : answers.passed) ring_.findings.checked(id_of(row), answers.times);
  answers.times = 0;
}

// Something changes.
void Engine::wake(Node& node) {
  end_rest();
  node.quiet.armed = false;
  count_quiet(node);
}

void Engine::wake_all() {
  end_rest();
  forget_collected();
  for (const auto& node : ring_.nodes) {
    if (node == nullptr) continue;
    wake(*node);
    node->quiet.command_streak = node->quiet.response_streak = 0;
  }
}

}  // namespace servotrace::rtex
