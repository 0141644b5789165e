// SPDX-License-Identifier: MIT
// RX3, continued: Type_Codes, arguments, data words, and answers that do not come (SX-DSV02203 6-1 to 6-9, 7-7).
#include "decoder/rtex/scene.hpp"

namespace servotrace::rtex::checks {
namespace {

bool is(const CommandPart& part, NonCyclic code) { return part.code == static_cast<std::uint8_t>(code); }

bool has(std::span<const ValueName> names, std::int64_t value) { return find_value(names, value) != nullptr; }

// True where the command's list has the Type_Code; of a reserved command, too: that is RX306.
bool type_is_defined(const CommandPart& part, bool sub) {
  switch (static_cast<NonCyclic>(part.code)) {
    case NonCyclic::kReset:
      return has(kResetTypes, part.type_code);
    case NonCyclic::kSystemId:
      return sub ? has(kShortSystemIdTypes, part.type_code) : has(kSystemIdTypes, part.type_code);
    case NonCyclic::kHoming:
      return has(kHomingTypes, part.type_code);
    case NonCyclic::kAlarm:
      return has(kAlarmTypes, part.type_code);
    case NonCyclic::kParameter:
      return part.type_code <= 1 || has(kParameterTypes, part.type_code);  // 000h and 001h are RX606
    case NonCyclic::kProfile:
      return has(kProfileTypes, part.type_code);
    case NonCyclic::kMonitor:
      // The row of 07h is not legible where its conventional code stands: 107h is let pass.
      return sub ? has(kShortMonitorTypes, part.type_code)
                 : part.type_code == 0x107 || has(kMonitorTypes, part.type_code);
    default:
      return true;
  }
}

enum class Argument : std::uint8_t { kFine, kOutside, kUnknownMonitor };

Argument judge_arguments(const CommandPart& part, bool sub) {
  const auto monitor = [&] {
    return part.monitor_sel() == 0 || has(kShortMonitorTypes, part.monitor_sel()) ? Argument::kFine
                                                                                  : Argument::kUnknownMonitor;
  };
  const auto outside = [](bool condition) { return condition ? Argument::kOutside : Argument::kFine; };
  switch (static_cast<NonCyclic>(part.code)) {
    case NonCyclic::kReset:
      return outside(part.index != 0);
    case NonCyclic::kAlarm:
      if (part.type_code == kAlarmAttribute) return Argument::kFine;
      return outside(part.index > (part.type_code == kAlarmRead ? 14 : 0));
    case NonCyclic::kParameter:
      if (part.type_code == kParameterCount) return outside((part.index & 0xFFU) != 0);
      if (part.type_code == kEepromWrite || part.type_code == kEepromWriteConventional) return outside(part.index != 0);
      return Argument::kFine;
    case NonCyclic::kHoming: {
      if (part.type_code < 0x50) return Argument::kFine;
      const bool bad1 = (part.type_code == 0x51 || part.type_code == 0x53) && !has(kLatchTriggers, part.latch_sel1());
      const bool bad2 = (part.type_code == 0x52 || part.type_code == 0x53) && !has(kLatchTriggers, part.latch_sel2());
      return bad1 || bad2 ? Argument::kOutside : monitor();
    }
    case NonCyclic::kProfile: {
      const bool latch = part.type_code == 0x12 || part.type_code == 0x13;
      if ((part.index & 0xF0U) != 0 || (latch && !has(kLatchTriggers, part.latch_sel1()))) return Argument::kOutside;
      return monitor();
    }
    case NonCyclic::kMonitor:
      return outside(!monitor_index_ok(part.type_code, part.index));
    default:
      break;
  }
  static_cast<void>(sub);
  return Argument::kFine;
}

bool reads(const CommandPart& part) {
  if (is(part, NonCyclic::kSystemId) || is(part, NonCyclic::kMonitor)) return true;
  if (is(part, NonCyclic::kAlarm)) return part.type_code == kAlarmRead || part.type_code == kAlarmAttribute;
  return is(part, NonCyclic::kParameter) && (part.type_code == kParameterRead || part.type_code == kParameterCount ||
                                             part.type_code == kParameterAttribute);
}

// A data word that must be 0 where its feedforward parameter is 0. Where 0 is only assumed, the drive's answer decides.
Outcome judge_word(Scene& scene, std::uint32_t value, const Known& forward, ByteRange where) {
  if (!forward || forward.value != 0) return Outcome::kSilent;
  if (forward.certain() && scene.channel != nullptr) return Outcome::kSilent;  // judged at the command
  if (value == 0) return forward.certain() ? Outcome::kPassed : Outcome::kSilent;
  if (!forward.certain()) {
    if (scene.channel == nullptr || !scene.answer().error || !scene.node->comparable) return Outcome::kSilent;
    const std::uint16_t code = scene.answer().error_code;
    const bool answered = code == 0x0034 || (code == 0x0032 && !scene.is_sub() && scene.part().code == 0);
    if (!answered) return Outcome::kSilent;
  }
  return scene.raise({.arguments = {value},
                      .where = scene.channel == nullptr ? where
                               : scene.is_sub()         ? scene.bytes(16, 4)
                                                        : scene.bytes(8, 2),
                      .related = {scene.channel == nullptr ? 0 : scene.node->command_frame, 0},
                      .basis = forward.basis});
}

}  // namespace

Outcome non_cyclic_not_in_mode(Scene& scene) {
  if (scene.is_sub()) return Outcome::kSilent;
  const CommandView& command = scene.node->command;
  if (!command.is_mode()) return Outcome::kSilent;
  if (!command.is(NonCyclic::kProfile) || command.is(Cyclic::kPp)) return Outcome::kPassed;
  return scene.raise({.arguments = {command.main.code, command.cyclic}, .where = scene.bytes(1, 1)});
}

Outcome type_code_undefined(Scene& scene) {
  const CommandPart& part = scene.part();
  if (type_is_defined(part, scene.is_sub())) return Outcome::kPassed;
  return scene.raise({.arguments = {part.type_code, part.code},
                      .where = scene.is_sub() ? scene.bytes(17, 1) : scene.bytes(8, 2),
                      .as_note = is(part, NonCyclic::kMonitor)});
}

Outcome argument_out_of_range(Scene& scene) {
  const CommandPart& part = scene.part();
  if (!type_is_defined(part, scene.is_sub())) return Outcome::kSilent;
  const Argument judged = judge_arguments(part, scene.is_sub());
  if (judged == Argument::kFine) return Outcome::kPassed;
  return scene.raise({.arguments = {part.index, part.code, part.type_code},
                      .where = scene.is_sub() ? scene.bytes(18, 2) : scene.bytes(10, 2),
                      .as_note = judged == Argument::kUnknownMonitor});
}

Outcome data3_not_zero(Scene& scene) {
  if (scene.is_sub()) return Outcome::kSilent;
  const CommandView& command = scene.node->command;
  if (command.is_nop() || command.data3_is_setting()) return Outcome::kSilent;
  return judge_word(scene, command.data3, scene.node->known[Fact::kForward1], scene.bytes(kData3At, 4));
}

Outcome sub_data_not_zero(Scene& scene) {
  const CommandView& command = scene.node->command;
  if (!command.wide || command.is_nop() || (scene.channel != nullptr && !scene.is_sub())) return Outcome::kSilent;
  const Outcome second =
      judge_word(scene, command.sub_data2, scene.node->known[Fact::kForward2], scene.bytes(kSubData2At, 4));
  if (second == Outcome::kRaised) return second;
  const Outcome third =
      judge_word(scene, command.sub_data3, scene.node->known[Fact::kForward3], scene.bytes(kSubData3At, 4));
  return third == Outcome::kSilent ? second : third;
}

Outcome echo_missing(Scene& scene) {
  const ChannelState& channel = *scene.channel;
  const Hold& hold = channel.hold;
  if (!scene.context.frame.has_time || !scene.node->synchronised || !scene.ring.running) return Outcome::kSilent;
  if (channel.state != Handshake::kSent) return hold.echoed ? Outcome::kPassed : Outcome::kSilent;
  if (!hold.seen_start || !hold.every_response || hold.not_started) return Outcome::kSilent;
  const DurationNs waited = elapsed_ns(hold.start.time_ns, scene.now.time_ns);
  if (waited <= milliseconds(scene.limits().echo_ms)) return Outcome::kSilent;
  return scene.raise({.arguments = {hold.part.code, waited}, .where = scene.code(), .related = {hold.start.frame, 0}});
}

Outcome busy_long(Scene& scene) {
  const Process& process = scene.channel->process;
  if (!scene.context.frame.has_time || !scene.answer().answers()) return Outcome::kSilent;
  if (!process.busy || has_no_busy_limit(process)) return Outcome::kPassed;
  const DurationNs waited = elapsed_ns(process.since.time_ns, scene.now.time_ns);
  if (waited <= busy_limit_ns(process, scene.limits())) return Outcome::kSilent;
  return scene.raise({.arguments = {process.code, process.type_code, waited},
                      .where = scene.is_sub() ? scene.bytes(16, 1) : scene.bytes(9, 1),
                      .related = {process.since.frame, 0}});
}

Outcome result_not_read(Scene& scene) {
  const ChannelState& channel = *scene.channel;
  const Hold& hold = channel.hold;
  const bool left = channel.step == HandshakeStep::kLeft || channel.step == HandshakeStep::kLeftBusy ||
                    channel.step == HandshakeStep::kChained;
  if (!left) return Outcome::kSilent;
  if (!reads(hold.part) || !hold.seen_start || !hold.every_response || hold.not_started || hold.refused ||
      scene.node->mode_changed) {
    return Outcome::kSilent;
  }
  // Left while Busy, seen to be so: that act is RX304.
  if (channel.step == HandshakeStep::kLeftBusy && scene.node->response_chain) return Outcome::kSilent;
  if (hold.complete) return Outcome::kPassed;
  return scene.raise({.arguments = {hold.part.code, hold.part.type_code},
                      .where = scene.code(),
                      .related = {hold.start.frame, hold.echo.frame}});
}

Outcome echo_arguments(Scene& scene) {
  const ChannelState& channel = *scene.channel;
  const Hold& hold = channel.hold;
  if (!scene.context.frame.has_time || !scene.node->synchronised || !scene.ring.running) return Outcome::kSilent;
  if (channel.state != Handshake::kBusy && channel.state != Handshake::kIdle) return Outcome::kSilent;
  if (hold.arguments_echoed) return Outcome::kPassed;
  if (!hold.seen_start || !hold.every_response || hold.not_started || hold.refused || channel.withheld.waiting ||
      scene.node->identical_response) {
    return Outcome::kSilent;
  }
  const DurationNs waited = elapsed_ns(hold.echo.time_ns, scene.now.time_ns);
  if (waited <= milliseconds(scene.limits().echo_ms)) return Outcome::kSilent;
  return scene.raise(
      {.arguments = {hold.part.type_code, hold.part.index, scene.answer().type_code, scene.answer().index},
       .where = scene.is_sub() ? scene.bytes(17, 3) : scene.bytes(8, 4),
       .related = {hold.start.frame, hold.echo.frame}});
}

}  // namespace servotrace::rtex::checks
