// SPDX-License-Identifier: MIT
// The non-cyclic handshake of a channel: what is held, what the drive still works on, what it proves.
#include <algorithm>

#include "decoder/rtex/engine.hpp"
#include "decoder/rtex/tracking.hpp"

namespace servotrace::rtex {
namespace {

bool extend_mode(const Node& node) { return node.known[Fact::kExtendMode].is(1); }

// What the command record is for the channel's handshake.
HandshakeEvent event_of(const Node& node, const CommandPart& part, const CommandPart& before) {
  if (node.command.is_nop() || part.code == 0) return HandshakeEvent::kStandardCode;
  if (!node.comparable) return HandshakeEvent::kSameCode;  // nothing to compare with
  if (node.previous.is_nop() || part.code != before.code) return HandshakeEvent::kNewCode;
  if (part.same_arguments(before)) return HandshakeEvent::kSameCode;
  return extend_mode(node) ? HandshakeEvent::kRestart : HandshakeEvent::kNewArguments;
}

// The statistics of a code; nullptr for the standard command and for codes the manual does not have.
Durations* duration_of(CommandDurations& durations, std::uint8_t code) {
  for (std::size_t i = 0; i < durations.size(); ++i) {
    if (kNonCyclicNames[i + 1].value == code) return &durations[i];
  }
  return nullptr;
}

}  // namespace

DurationNs busy_limit_ns(const Process& process, const Limits& limits) {
  const auto code = static_cast<NonCyclic>(process.code);
  const bool long_one =
      (code == NonCyclic::kAlarm && (process.type_code == kAlarmClear || process.type_code == kAlarmClearHistory ||
                                     process.type_code == kAlarmClearScale)) ||
      (code == NonCyclic::kParameter &&
       (process.type_code == kEepromWrite || process.type_code == kEepromWriteConventional)) ||
      (code == NonCyclic::kReset && process.type_code == kValidation) ||
      (code == NonCyclic::kHoming && process.type_code == 0x31);
  return milliseconds(long_one ? limits.busy_long_ms : limits.busy_ms);
}

bool has_no_busy_limit(const Process& process) {
  return process.code == static_cast<std::uint8_t>(NonCyclic::kHoming) && process.type_code >= 0x11 &&
         process.type_code <= 0x1D;
}

void Engine::begin_hold(Scene& scene, ChannelState& channel) {
  channel.hold = {};
  channel.hold.part = scene.part();
  channel.hold.start = scene.now;
  channel.hold.seen_start = true;
  channel.hold.every_response = true;
  channel.hold.not_started = channel.next_not_started;
  const Position position = actual_position(*scene.node);
  channel.hold.position_known = position.known;
  channel.hold.position = position.value;
  const CommandView& command = scene.node->command;
  channel.hold.stop_bits = command.hard_stop || command.smooth_stop || command.pause;
}

void Engine::step_command(Scene& scene, ChannelState& channel) {
  Node& node = *scene.node;
  const CommandPart part = scene.part();
  if (channel.state == Handshake::kUnknown && !node.comparable) {
    // The capture began or went on inside a command: what is held is known, not since when.
    channel.hold = {};
    channel.hold.part = part;
    channel.hold.start = scene.now;
  }
  const auto& row = kHandshake.next(channel.state, event_of(node, part, scene.previous_part()));
  channel.step = row.action;
  const bool begins = row.action == HandshakeStep::kBegin || row.action == HandshakeStep::kEarlyBegin ||
                      row.action == HandshakeStep::kChained;
  channel.next_not_started = false;
  if (row.action != HandshakeStep::kNone) run(scene, kHandshakeStep | (begins ? kStart : kNoEvent));
  const bool leaves = row.action == HandshakeStep::kLeft || row.action == HandshakeStep::kLeftBusy ||
                      (row.action == HandshakeStep::kEarly && row.to == Handshake::kStandard) ||
                      // Held since before a gap: that it is left is known, and a reset stops the ring all the same.
                      (channel.state == Handshake::kUnknown && row.to == Handshake::kStandard);
  if (leaves || begins) {
    if (channel.id == Channel::kMain) {
      if (is_homing_search(channel.hold.part)) channel.process.busy = false;
      const Hold& hold = channel.hold;
      if (leaves && hold.part.code == static_cast<std::uint8_t>(NonCyclic::kReset) &&
          hold.part.type_code == kSoftwareReset && (hold.echoed || !hold.every_response) && !hold.refused) {
        node.known.on_reset();
        node.format = node.known.format();
        node.ignore_stale = true;
        ring_.reset_sent = true;
      }
    }
  }
  if (row.action != HandshakeStep::kNone || row.to != channel.state)
    node.quiet.answers[channel.id == Channel::kSub ? 1 : 0].same = 0;
  channel.state = row.to;
  if (begins) {
    begin_hold(scene, channel);
  } else if (row.action == HandshakeStep::kEarly && row.to == Handshake::kSent) {
    // Changed before the echo: nobody knows which of the two the drive takes.
    channel.hold.part = part;
    channel.hold.not_started = true;
  }
}

// `same`: the answer is the one before, but for a monitored value.
void Engine::judge_answer(Scene& scene, ChannelState& channel, bool same) {
  SteadyAnswers& answers = scene.node->quiet.answers[channel.id == Channel::kSub ? 1 : 0];
  count_answers(answers);
  answers.passed.clear();
  scene.passed = &answers.passed;
  step_response(scene, channel);
  scene.passed = nullptr;
  const bool steady = same && is_settled(channel) && !scene.node->quiet.raised && answers.passed.dropped() == 0;
  answers.same = steady ? std::min<std::uint8_t>(answers.same + 1U, kSameAnswers) : std::uint8_t{0};
}

void Engine::step_response(Scene& scene, ChannelState& channel) {
  Node& node = *scene.node;
  const ResponseView& response = node.response;
  if (response.communication_error) return;
  const ResponsePart& answer = scene.answer();
  Process& process = channel.process;
  Events events = kAnswer;

  // Busy, as the catalogue defines it
  if (answer.answers()) {
    // Leaving a search ends it, though the echo, which lags, still shows it busy for a moment (7-2-1).
    const bool left_search = channel.state == Handshake::kStandard && answer.echo == channel.hold.part.code &&
                             is_homing_search(channel.hold.part);
    if (!answer.busy || left_search) {
      process.busy = false;
    } else if (!process.busy || process.code != answer.echo || process.type_code != answer.type_code) {
      process = {true, answer.echo, answer.type_code, scene.now};
    }
  } else if (answer.error && answer.echo != 0 && answer.error_code != 0x0101) {
    process.busy = false;
  }

  if (scene.now.cycle > channel.hold.start.cycle && in_progress(node).yes) channel.hold.in_progress = true;

  // The hold. Of its own first cycle the response cannot show it: the echo lags (3-1).
  Hold& hold = channel.hold;
  bool completed = false;
  const bool echoes = answer.echo != 0 && answer.echo == hold.part.code && scene.now.cycle > hold.start.cycle;
  if (channel.state != Handshake::kStandard) {
    const auto event = !echoes                        ? HandshakeEvent::kOtherEcho
                       : answer.busy && !answer.error ? HandshakeEvent::kEchoBusy
                                                      : HandshakeEvent::kEchoIdle;
    const auto& row = kHandshake.next(channel.state, event);
    channel.state = row.to;
    if (echoes) {
      if (!hold.echoed) {
        hold.echoed = true;
        hold.echo = scene.now;
        if (hold.seen_start) {
          if (Durations* const times = duration_of(node.echo_times, answer.echo); times != nullptr)
            add_time(*times, hold.start, scene.now);
        }
      }
      hold.refused = answer.error;
      const bool arguments = matches(hold.part, answer, scene.is_sub());
      hold.arguments_echoed = hold.arguments_echoed || arguments;
      hold.ended = answer.error || answer.err || response.alarm;
      hold.homing_complete = hold.homing_complete || (arguments && response.homing_complete);
      if (arguments && !answer.busy && !hold.complete) {
        hold.complete = completed = true;
        events |= kCompleted;
        if (hold.seen_start) {
          if (Durations* const times = duration_of(node.done_times, answer.echo); times != nullptr)
            add_time(*times, hold.start, scene.now);
        }
      }
      events |= kDeadline;
    }
  }
  judge_withheld(scene, channel);
  run(scene, events);
  track_answer(scene, completed);
}

// RX301 and RX305 on the assumption of the A4N-compatible start mode. A drive that executes the command proves the
// extend mode; one that has not within the echo limit did not.
void Engine::judge_withheld(Scene& scene, ChannelState& channel) {
  Withheld& withheld = channel.withheld;
  if (!withheld.waiting) return;
  const ResponsePart& answer = scene.answer();
  const bool in_time = elapsed_ns(withheld.at.time_ns, scene.now.time_ns) <= milliseconds(scene.limits().echo_ms);
  const bool write = !scene.is_sub() && withheld.part.code == static_cast<std::uint8_t>(NonCyclic::kParameter) &&
                     withheld.part.type_code == kParameterWrite;
  const bool executed = in_time && scene.now.cycle > withheld.at.cycle &&
                        matches(withheld.part, answer, scene.is_sub()) &&
                        (!write || static_cast<std::int32_t>(answer.data) == withheld.part.setting_data);
  if (!executed) return;
  withheld.waiting = false;
  Node& node = *scene.node;
  node.known.prove(Fact::kExtendMode, 1, scene.now.frame);
  node.format = node.known.format();
  if (withheld.arguments && channel.hold.part.code == withheld.part.code) channel.hold.part = withheld.part;
  channel.hold.not_started = false;
}

// Time went on: on every record, for every channel that waits for something.
void Engine::judge_deadlines(const Context& context) {
  if (!context.frame.has_time || ring_.of_record.awake == 0) return;  // what is quiet waits for nothing
  const Limits& limits = ring_.settings.limits;
  for (const auto& entry : ring_.all()) {
    if (entry == nullptr) continue;
    Node& node = *entry;
    for (ChannelState& channel : node.channels) {
      if (channel.id == Channel::kSub && !node.wide) break;
      if (!channel.withheld.waiting && !channel.process.busy) continue;
      Scene scene = ring_scene(context);
      scene.node = &node;
      scene.channel = &channel;
      Withheld& withheld = channel.withheld;
      if (withheld.waiting && elapsed_ns(withheld.at.time_ns, scene.now.time_ns) > milliseconds(limits.echo_ms)) {
        withheld.waiting = false;
        report(scene, withheld.arguments ? rule("RX305") : rule("RX301"), channel.owner,
               {.arguments = {withheld.before, withheld.part.code},
                .related = {withheld.at.frame, 0},
                .basis = {BasisKind::kAssumed, 0}});
        forget_collected();
      }
      if (channel.process.busy && !has_no_busy_limit(channel.process) && channel.state == Handshake::kStandard &&
          elapsed_ns(channel.process.since.time_ns, scene.now.time_ns) > busy_limit_ns(channel.process, limits)) {
        channel.process.busy = false;
      }
    }
  }
}

}  // namespace servotrace::rtex
