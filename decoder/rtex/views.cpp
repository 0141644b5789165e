// SPDX-License-Identifier: MIT
#include "decoder/rtex/views.hpp"

namespace servotrace::rtex {
namespace {

template <class T>
T get(Slot field, Bytes bytes) {
  return static_cast<T>(read(field, bytes));
}
bool bit(Slot field, Bytes bytes) { return read(field, bytes) != 0; }

}  // namespace

CommandView view_of_command(Bytes block, BlockSize size) {
  CommandView view;
  view.mac_id = get<std::uint8_t>(slot(kCommand, "mac_id"), block);
  view.counter = get<std::uint8_t>(slot(kCommand, "update_counter"), block);
  view.cr = bit(slot(kCommand, "cr"), block);
  view.cyclic = get<std::uint8_t>(slot(kCommand, "cyclic_command"), block);
  view.tmg_cnt = bit(slot(kCommand, "tmg_cnt"), block);
  view.servo_on = bit(slot(kCommand, "servo_on"), block);
  view.homing_ctrl = bit(slot(kCommand, "homing_ctrl"), block);
  view.pause = bit(slot(kCommand, "pause"), block);
  view.smooth_stop = bit(slot(kCommand, "smooth_stop"), block);
  view.hard_stop = bit(slot(kCommand, "hard_stop"), block);
  view.unused_bits = static_cast<std::uint16_t>(
      read(slot(kCommand, "unused_2_0"), block) | read(slot(kCommand, "unused_2_5"), block) << 5 |
      read(slot(kCommand, "unused_3_2"), block) << 10 | read(slot(kCommand, "unused_3_4"), block) << 12);
  view.data1 = get<std::int32_t>(slot(kCommandPosition, "command_position"), block.subspan(kData1At));
  view.data3 = load_le(block, kData3At, 4);
  const Bytes words = block.subspan(kData2At);
  view.main.code = get<std::uint8_t>(slot(kCommand, "non_cyclic_command"), block);
  view.main.type_code = get<std::uint16_t>(slot(kReset, "type_code"), words);
  view.main.index = get<std::uint16_t>(slot(kReset, "index"), words);
  if (view.data3_is_setting()) view.main.setting_data = static_cast<std::int32_t>(view.data3);
  if (view.main.code == static_cast<std::uint8_t>(NonCyclic::kProfile)) view.main.position = view.data1;
  if (size == BlockSize::kWide) {
    const Bytes sub = block.subspan(kSubHeaderAt);
    view.wide = true;
    view.sub_chk = bit(slot(kSubCommand, "sub_chk"), sub);
    view.sub_unused = get<std::uint8_t>(slot(kSubCommand, "unused_16_4"), sub);
    view.sub.code = get<std::uint8_t>(slot(kSubCommand, "command"), sub);
    view.sub.type_code = get<std::uint16_t>(slot(kSubCommand, "type_code"), sub);
    view.sub.index = get<std::uint16_t>(slot(kSubCommand, "index"), sub);
    view.sub.setting_data = static_cast<std::int32_t>(load_le(block, kSubData1At, 4));
    view.sub_data2 = load_le(block, kSubData2At, 4);
    view.sub_data3 = load_le(block, kSubData3At, 4);
  }
  return view;
}

ResponseView view_of_response(Bytes block, BlockSize size) {
  ResponseView view;
  view.mac_id = get<std::uint8_t>(slot(kResponse, "mac_id"), block);
  view.counter = get<std::uint8_t>(slot(kResponse, "update_counter_echo"), block);
  view.cr = bit(slot(kResponse, "cr"), block);
  view.communication_error = is_communication_error(block);
  if (size == BlockSize::kWide) {  // byte 16 of a communication error response is 8Fh (6-11)
    const Bytes sub = block.subspan(kSubHeaderAt);
    view.communication_error = view.communication_error && bit(slot(kSubResponse, "cmd_err"), sub) &&
                               read(slot(kSubResponse, "command_echo"), sub) == 15;
  }
  view.cyclic = get<std::uint8_t>(slot(kResponse, "cyclic_command_echo"), block);
  view.servo_active = bit(slot(kResponse, "servo_active"), block);
  view.servo_ready = bit(slot(kResponse, "servo_ready"), block);
  view.alarm = bit(slot(kResponse, "alarm"), block);
  view.warning = bit(slot(kResponse, "warning"), block);
  view.torque_limited = bit(slot(kResponse, "torque_limited"), block);
  view.homing_complete = bit(slot(kResponse, "homing_complete"), block);
  view.in_progress = bit(slot(kResponse, "in_progress"), block);
  view.low_input = bit(slot(kResponse, "not_pot"), block);
  view.high_input = bit(slot(kResponse, "pot_not"), block);
  view.bit7_input = bit(slot(kResponse, "si_mon5_e_stop"), block);
  view.data1 = static_cast<std::int32_t>(load_le(block, kData1At, 4));
  view.data2 = static_cast<std::int32_t>(load_le(block, kData2At, 4));
  view.data3 = static_cast<std::int32_t>(load_le(block, kData3At, 4));
  const Bytes words = block.subspan(kData2At);
  view.main.echo = get<std::uint8_t>(slot(kResponse, "non_cyclic_command_echo"), block);
  view.main.error = bit(slot(kResponse, "cmd_error"), block) && !view.communication_error;
  if (view.main.error) {
    view.main.error_code = get<std::uint16_t>(slot(kError, "error_code"), words);
  } else if (view.main.echo != 0) {
    const auto code = static_cast<NonCyclic>(view.main.echo);
    const bool short_type = code == NonCyclic::kHoming || code == NonCyclic::kProfile;
    view.main.type_code = short_type ? get<std::uint16_t>(slot(kHomingEcho, "type_code_echo"), words)
                                     : get<std::uint16_t>(slot(kMonitorEcho, "type_code_echo"), words);
    view.main.index = get<std::uint16_t>(slot(kMonitorEcho, "index_echo"), words);
    view.main.busy = bit(slot(kMonitorEcho, "busy"), words);
    view.main.wng = bit(slot(kMonitorEcho, "wng"), words);
    view.main.err = bit(slot(kMonitorEcho, "err"), words);
    if (short_type) {
      view.main.latch_comp1 = bit(slot(kHomingEcho, "latch_comp1"), words);
      view.main.latch_comp2 = code == NonCyclic::kHoming && bit(slot(kHomingEcho, "latch_comp2"), words);
    }
    if (code == NonCyclic::kProfile) {
      view.main.psl = bit(slot(kProfileEcho, "psl"), words);
      view.main.nsl = bit(slot(kProfileEcho, "nsl"), words);
    }
    view.main.data = load_le(block, kData3At, 4);
  }
  if (size == BlockSize::kWide) {
    const Bytes sub = block.subspan(kSubHeaderAt);
    view.wide = true;
    view.sub.echo = get<std::uint8_t>(slot(kSubResponse, "command_echo"), sub);
    view.sub.error = bit(slot(kSubResponse, "cmd_err"), sub) && !view.communication_error;
    if (view.sub.error) {
      view.sub.error_code = get<std::uint16_t>(slot(kSubError, "error_code"), sub);
    } else if (view.sub.echo != 0) {
      view.sub.type_code = get<std::uint16_t>(slot(kSubResponse, "type_code_echo"), sub);
      view.sub.index = get<std::uint16_t>(slot(kSubResponse, "index_echo"), sub);
      view.sub.busy = bit(slot(kSubResponse, "busy"), sub);
      view.sub.wng = bit(slot(kSubResponse, "wng"), sub);
      view.sub.err = bit(slot(kSubResponse, "err"), sub);
      view.sub.data = load_le(block, kSubData1At, 4);
    }
  }
  return view;
}

}  // namespace servotrace::rtex
