// SPDX-License-Identifier: MIT
#include "decoder/rtex/tracking.hpp"

#include <algorithm>
#include <bit>

namespace servotrace::rtex {
namespace {

// The attribute in the answer to 040h (6-7-4). A and B cannot be told apart: both act at once.
Attribute attribute_in(std::uint32_t data) {
  std::array<std::uint8_t, 4> bytes = {};
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(data >> (8 * i));
  if (read(slot(kParameterAttributeData, "read_only"), bytes) != 0) return Attribute::kReadOnly;
  if (read(slot(kParameterAttributeData, "valid_at_reset"), bytes) == 0) return Attribute::kB;
  return read(slot(kParameterAttributeData, "valid_at_validation"), bytes) != 0 ? Attribute::kC : Attribute::kR;
}

void show(Scene& scene, const Field& field, std::int64_t value, std::string_view text = {}) {
  if (scene.context.dissection == nullptr) return;
  NodeRef ref = scene.node->ref;
  ref.channel = scene.channel->id;
  scene.context.dissection->derived.push_back(
      {.field = &field, .protocol = "rtex", .value = value, .text = text, .node = ref});
}

// A non-cyclic command, its first echo, and its answer.
void show_times(Scene& scene, bool completed) {
  const Hold& hold = scene.channel->hold;
  if (scene.context.dissection == nullptr || !hold.seen_start) return;
  const bool accepted = hold.echoed && hold.echo.frame == scene.now.frame;
  const bool refused = accepted && hold.refused;
  if (!accepted && !completed) return;
  const DurationNs after = elapsed_ns(hold.start.time_ns, scene.now.time_ns);
  NodeRef ref = scene.node->ref;
  ref.channel = scene.channel->id;
  const auto link = [&](LinkKind kind) {
    scene.context.dissection->links.push_back(
        {.kind = kind, .frame = hold.start.frame, .after_ns = after, .node = ref});
  };
  if (accepted && !refused) {
    link(LinkKind::kAcceptedIn);
    show(scene, kEchoTimeField, after);
  }
  if (completed || refused) {
    link(LinkKind::kRequestIn);
    show(scene, kCompletionTimeField, after);
  }
}

// Four characters of a system ID (6-4). A read begins with Index 0; it is complete with the NUL.
void track_system_id(Scene& scene, const CommandPart& part, const ResponsePart& answer) {
  const std::size_t place = system_id_place(part.type_code);
  if (place == kSystemIdCount || part.index >= SystemString::kParts) return;
  SystemString& string = scene.node->strings[place];
  if (part.index == 0) string.have = 0;
  string.have |= 1U << part.index;
  for (unsigned i = 0; i < 4; ++i)
    string.parts[4U * part.index + i] = static_cast<char>(answer.data >> (8 * i) & 0xFFU);
  const std::size_t read_to = 4 * static_cast<std::size_t>(std::countr_one(string.have));  // without a hole
  const std::string_view so_far(string.parts.data(), std::min(read_to, string.parts.size()));
  const std::size_t end = so_far.find('\0');
  if (end == std::string_view::npos) return;
  string.text = string.parts;
  string.length = end;
  string.frame = scene.now.frame;
  string.have = 0;
  show(scene, kSystemIds[place].field, 0, string.view());
}

// What the responses to 5xh and to the latch profiles show of the latches (6-5-4, 6-8-3).
void track_latch(Scene& scene, const ResponsePart& answer) {
  LatchState& latch = scene.node->latch;
  const Hold& hold = scene.channel->hold;
  const unsigned type = answer.type_code & 0xFFU;
  const bool homing = answer.is(NonCyclic::kHoming) && type >= 0x50;
  const bool profile = answer.is(NonCyclic::kProfile) && (type == 0x12 || type == 0x13);
  if (homing || profile) {
    const bool first_echo = hold.seen_start && hold.echo.frame == scene.now.frame && !answer.err;
    if (homing && first_echo && matches(hold.part, answer, false)) {
      if (type == 0x51 || type == 0x53) latch.started1 = true;
      if (type == 0x52 || type == 0x53) latch.started2 = true;
      if (type == 0x54 || type == 0x5C) latch.started1 = false;
      if (type == 0x58 || type == 0x5C) latch.started2 = false;
    }
    latch.shown1 = true;
    latch.complete1 = answer.latch_comp1;
    if (homing) {
      latch.shown2 = true;
      latch.complete2 = answer.latch_comp2;
    }
    if (latch.complete1) latch.started1 = false;
    if (latch.complete2) latch.started2 = false;
  } else if (answer.is(NonCyclic::kReset) || (answer.is(NonCyclic::kHoming) && type < 0x50)) {
    latch.started1 = latch.started2 = false;  // cancelled (6-5-4)
  }
}

// A completed parameter command (6-7).
void track_parameter(Scene& scene, const CommandPart& part, const ResponsePart& answer) {
  Node& node = *scene.node;
  const auto value = static_cast<std::int32_t>(answer.data);
  switch (part.type_code) {
    case kParameterRead:
      node.known.on_read(part.index, value, scene.now.frame);
      break;
    case kParameterWrite:
      if (!answer.err) node.known.on_write(part.index, value, node.known.attribute(part.index), scene.now.frame);
      break;
    case kParameterAttribute:
      if (!answer.err) node.known.on_attribute(part.index, attribute_in(answer.data));
      return;
    case kEepromWrite:
    case kEepromWriteConventional:
      if (!answer.err) node.known.on_eeprom_write();
      break;
    default:
      return;
  }
  node.format = node.known.format();
}

}  // namespace

void track_command(Scene& scene) {
  Node& node = *scene.node;
  const CommandView& command = node.command;
  if (command.is_nop()) return;
  const CommandPart& part = command.main;
  const bool profile_homing = command.is(NonCyclic::kProfile) && part.type_code >= 0x31 && part.type_code <= 0x33;
  const bool homing = command.is(NonCyclic::kHoming) && part.type_code < 0x50;
  if (homing || profile_homing || command.is(NonCyclic::kReset)) node.home_cleared = scene.now;
  if (node.servo_on_known && node.servo_on_sent != command.servo_on) node.servo_change_cycle = scene.now.cycle;
}

void show_handshake(Scene& scene) {
  const Handshake state = scene.channel->state;
  if (state == Handshake::kSent) show(scene, kHandshakeField, 1);
  if (state == Handshake::kBusy) show(scene, kHandshakeField, 2);
}

void track_answer(Scene& scene, bool completed) {
  Node& node = *scene.node;
  const CommandPart& part = scene.channel->hold.part;
  const ResponsePart& answer = scene.answer();
  show_times(scene, completed);
  if (completed && answer.is(NonCyclic::kSystemId) && !answer.err) track_system_id(scene, part, answer);
  if (scene.is_sub()) return;
  if (answer.is(NonCyclic::kProfile))
    node.profile = {true, static_cast<std::uint8_t>(answer.type_code), static_cast<std::uint8_t>(answer.index & 0xFU),
                    0};
  if (answer.is(NonCyclic::kAlarm)) track_alarm_code(scene);
  track_latch(scene, answer);
  if (!completed) return;
  const bool multi_turn = answer.is(NonCyclic::kHoming) && part.type_code == 0x31 && !answer.err;
  if (multi_turn) node.multi_turn_frame = scene.now.frame;
  if (answer.is(NonCyclic::kParameter)) track_parameter(scene, part, answer);
  if (answer.is(NonCyclic::kReset) && part.type_code == kValidation && !answer.err) {
    node.known.on_validation();
    node.format = node.known.format();
  }
}

void watch_values(Scene& scene) {
  scene.node->emergency = emergency_input(*scene.node);
  watch_following(scene);
}

void track_status(Scene& scene) {
  Node& node = *scene.node;
  if (node.status_undefined) return;
  AlarmState& state = node.alarms;
  if (node.response.alarm && !(state.known && state.alarm)) state.alarm_rise = scene.now;
  if (node.response.warning && !(state.known && state.warning)) state.warning_rise = scene.now;
  if (!node.response.alarm) state.alarm_open = false;
  if (!node.response.warning) state.warning_open = false;
  if (!node.response.torque_limited) {
    node.limited_since = {};
  } else if (node.limited_since.frame == 0) {
    node.limited_since = scene.now;
  }
  watch_values(scene);
  state.known = true;
  state.alarm = node.response.alarm;
  state.warning = node.response.warning;
}

void keep_status(ResponseView& response, const ResponseView& last, bool known) {
  static constexpr ResponseView kNone{};
  const ResponseView& from = known ? last : kNone;
  response.servo_active = from.servo_active;
  response.servo_ready = from.servo_ready;
  response.alarm = from.alarm;
  response.warning = from.warning;
  response.torque_limited = from.torque_limited;
  response.homing_complete = from.homing_complete;
  response.in_progress = from.in_progress;
  response.low_input = from.low_input;
  response.high_input = from.high_input;
  response.bit7_input = from.bit7_input;
  response.data1 = from.data1;
}

}  // namespace servotrace::rtex
