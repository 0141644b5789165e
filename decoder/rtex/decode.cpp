// SPDX-License-Identifier: MIT
#include "decoder/rtex/decode.hpp"

#include <iterator>

namespace servotrace::rtex {
namespace {

const Layout& data1(std::uint8_t cyclic, const BlockFormat& format) {
  switch (static_cast<Cyclic>(cyclic)) {
    case Cyclic::kPp:
      return kTargetPosition;
    case Cyclic::kCp:
      return kCommandPosition;
    case Cyclic::kCv:
      return format.speed_in_units ? kCommandSpeedUnits : kCommandSpeed;
    case Cyclic::kCt:
      return kCommandTorque;
    case Cyclic::kNop:
      break;
  }
  return kRawData1;
}

// Pr7.23 bits 3 and 8 name three bits of the header.
const Layout& response_header(const BlockFormat& format) {
  if (!format.status_known) return kResponse;
  return kResponseForms[(format.inhibit_swapped ? 1 : 0) + (format.ac_off ? 2 : 0)];
}

const Layout& arguments(std::uint8_t non_cyclic, std::uint16_t type_code) {
  switch (static_cast<NonCyclic>(non_cyclic)) {
    case NonCyclic::kNormal:
      return kRawData2;
    case NonCyclic::kReset:
      return kReset;
    case NonCyclic::kSystemId:
      return kSystemId;
    case NonCyclic::kHoming:
      return kHoming;
    case NonCyclic::kAlarm:
      return type_code == kAlarmAttribute ? kAlarmAttributeCommand : kAlarm;
    case NonCyclic::kParameter:
      return kParameter;
    case NonCyclic::kProfile:
      return kProfile;
    case NonCyclic::kMonitor:
      return kMonitor;
  }
  return kRawData2;
}

// A data word that holds feedforward, or `otherwise`.
const Layout& feedforward(std::uint8_t choice, bool sub, const BlockFormat& format, const Layout& otherwise) {
  const unsigned channel = sub ? 1 : 0;
  if (choice == 1) return format.speed_in_units ? kVelocityForwardUnits[channel] : kVelocityForward[channel];
  if (choice == 2) return kTorqueForward[channel];
  return otherwise;
}

const Layout& parameter_layout(std::uint16_t index, const Layout& otherwise) {
  if (index == pr(7, 22)) return kPr722;
  if (index == pr(7, 23)) return kPr723;
  if (index == pr(7, 24)) return kPr724;
  if (index >= pr(7, 29) && index < pr(7, 29) + std::size(kChoices)) return kChoices[index - pr(7, 29)];
  return otherwise;
}

const Layout& data3(std::uint8_t non_cyclic, std::uint16_t type_code, Bytes block, const BlockFormat& format) {
  if (!has_setting_data(non_cyclic, type_code)) return feedforward(format.feedforward[0], false, format, kRawData3);
  if (non_cyclic == static_cast<std::uint8_t>(NonCyclic::kProfile))
    return format.speed_in_units ? kTargetSpeedUnits : kTargetSpeed;
  if (non_cyclic == static_cast<std::uint8_t>(NonCyclic::kParameter))
    return parameter_layout(static_cast<std::uint16_t>(read(slot(kParameter, "parameter"), block.subspan(kData2At))),
                            kSettingData);
  return kSettingData;
}

// The layout of a monitored value, raw where its code has no name.
const Layout& monitored(std::uint16_t type_code, bool sub, const BlockFormat& format, const Layout& otherwise) {
  const Layout* const layout = monitor_layout(type_code, sub, format.speed_in_units);
  return layout == nullptr ? otherwise : *layout;
}

// Response_Data1, 2 or 3 (`place` 0 to 2) as Pr7.29 to Pr7.31 choose; 0 is APOS, ASPD, TRQ (4-3-1).
const Layout& response_data(unsigned place, const BlockFormat& format) {
  static constexpr std::uint8_t kDefaults[] = {0x07, 0x05, 0x06};
  static constexpr const Layout* kRaw[] = {&kRawResponse1, &kRawResponse2, &kRawResponse3};
  const std::uint8_t chosen = format.monitor[place] == 0 ? kDefaults[place] : format.monitor[place];
  return monitored(chosen, false, format, *kRaw[place]);
}

const Layout& echo(NonCyclic non_cyclic, std::uint16_t type_code, const BlockFormat& format) {
  switch (non_cyclic) {
    case NonCyclic::kReset:
      return kResetEcho;
    case NonCyclic::kSystemId:
      return kSystemIdEcho;
    case NonCyclic::kHoming:
      return kHomingEcho;
    case NonCyclic::kAlarm:
      return type_code == kAlarmAttribute ? kAlarmAttributeEcho : kAlarmEcho;
    case NonCyclic::kParameter:
      return kParameterEcho;
    case NonCyclic::kProfile:
      return format.limits_swapped ? kProfileEchoSwapped : kProfileEcho;
    case NonCyclic::kMonitor:
      return kMonitorEcho;
    case NonCyclic::kNormal:
      break;
  }
  return kRawResponse2;
}

// Monitor_Data of a non-cyclic response; `words`: bytes 8-11.
const Layout& monitor_data(NonCyclic non_cyclic, std::uint16_t type_code, Bytes words, const BlockFormat& format) {
  switch (non_cyclic) {
    case NonCyclic::kSystemId:
      return kCharacters[0];
    case NonCyclic::kHoming: {
      const auto homing = type_code & 0xFFU;
      if (homing == 0x21 || homing == 0x22) return kPositionEcho;
      if (homing >= 0x50)
        return monitored(static_cast<std::uint16_t>(read(slot(kHomingEcho, "monitor_sel_echo"), words)), false, format,
                         kRawMonitor[0]);
      return kRawMonitor[0];
    }
    case NonCyclic::kAlarm:
      return type_code == kAlarmAttribute ? kAlarmAttributeData : kAlarmCode;
    case NonCyclic::kParameter:
      if (type_code == kParameterCount) return kParameterCountData;
      if (type_code == kParameterAttribute) return kParameterAttributeData;
      if (type_code == kParameterRead || type_code == kParameterWrite)
        return parameter_layout(static_cast<std::uint16_t>(read(slot(kParameterEcho, "parameter_echo"), words)),
                                kParameterValue);
      return kRawMonitor[0];
    case NonCyclic::kProfile:
      return monitored(static_cast<std::uint16_t>(read(slot(kProfileEcho, "monitor_sel_echo"), words)), false, format,
                       kRawMonitor[0]);
    case NonCyclic::kMonitor:
      return monitored(type_code, false, format, kRawMonitor[0]);
    default:
      return kRawMonitor[0];
  }
}

void add(BlockLayouts& list, const Layout& layout) { list.words[list.count++] = &layout; }

void add_sub_command(BlockLayouts& list, Bytes block, const BlockFormat& format) {
  switch (read(slot(kSubCommand, "command"), block.subspan(kSubHeaderAt))) {
    case 2:
      add(list, kSubSystemId);
      break;
    case 10:
      add(list, kSubMonitor);
      break;
    default:
      add(list, kSubCommand);
  }
  add(list, kSubData1);
  add(list, feedforward(format.feedforward[1], true, format, kSubData2));
  add(list, feedforward(format.feedforward[2], true, format, kSubData3));
}

void add_sub_response(BlockLayouts& list, Bytes block, bool communication_error, const BlockFormat& format) {
  const Bytes header = block.subspan(kSubHeaderAt);
  const auto type_code = static_cast<std::uint16_t>(read(slot(kSubResponse, "type_code_echo"), header));
  if (read(slot(kSubResponse, "cmd_err"), header) != 0) {
    add(list, communication_error ? kSubResponse : kSubError);
    add(list, kSubZero1);
  } else {
    switch (read(slot(kSubResponse, "command_echo"), header)) {
      case 0:
        add(list, kSubResponse);
        add(list, format.monitor[3] == 0 ? kSubRaw1 : monitored(format.monitor[3], true, format, kSubRaw1));
        break;
      case 2:
        add(list, kSubSystemIdEcho);
        add(list, kCharacters[1]);
        break;
      case 10:
        add(list, kSubMonitorEcho);
        add(list, monitored(type_code, true, format, kRawMonitor[1]));
        break;
      default:
        add(list, kSubResponse);
        add(list, kSubRaw1);
    }
  }
  add(list, format.monitor[4] == 0 ? kSubRaw2 : monitored(format.monitor[4], true, format, kSubRaw2));
  add(list, format.monitor[5] == 0 ? kSubRaw3 : monitored(format.monitor[5], true, format, kSubRaw3));
}

}  // namespace

BlockLayouts layouts_of_command(Bytes block, BlockSize size, const BlockFormat& format) {
  BlockLayouts list;
  if (block.size() < static_cast<std::size_t>(size)) return list;
  const auto cyclic = static_cast<std::uint8_t>(read(slot(kCommand, "cyclic_command"), block));
  const auto non_cyclic = static_cast<std::uint8_t>(read(slot(kCommand, "non_cyclic_command"), block));
  const Bytes words = block.subspan(kData2At);
  const auto type_code = static_cast<std::uint16_t>(read(slot(kReset, "type_code"), words));
  add(list, kCommand);
  add(list, data1(cyclic, format));
  add(list, cyclic == 0 ? kRawData2 : arguments(non_cyclic, type_code));
  add(list, cyclic == 0 ? kRawData3 : data3(non_cyclic, type_code, block, format));
  if (size == BlockSize::kWide) add_sub_command(list, block, format);
  return list;
}

BlockLayouts layouts_of_response(Bytes block, BlockSize size, const BlockFormat& format) {
  BlockLayouts list;
  if (block.size() < static_cast<std::size_t>(size)) return list;
  const bool communication_error = is_communication_error(block);
  const auto non_cyclic = static_cast<std::uint8_t>(read(slot(kResponse, "non_cyclic_command_echo"), block));
  add(list, response_header(format));
  add(list, response_data(0, format));
  if (communication_error) {
    add(list, kCommunicationError);
    add(list, kZero3);
  } else if (read(slot(kResponse, "cmd_error"), block) != 0) {
    add(list, kError);
    add(list, kZero3);
  } else if (non_cyclic == 0) {
    add(list, response_data(1, format));
    add(list, response_data(2, format));
  } else {
    const Bytes words = block.subspan(kData2At);
    const auto type_code = static_cast<std::uint16_t>(read(slot(kMonitorEcho, "type_code_echo"), words));
    add(list, echo(static_cast<NonCyclic>(non_cyclic), type_code, format));
    add(list, monitor_data(static_cast<NonCyclic>(non_cyclic), type_code, words, format));
  }
  if (size == BlockSize::kWide) add_sub_response(list, block, communication_error, format);
  return list;
}

void decode_block(const BlockLayouts& layouts, std::uint32_t offset, const NodeRef& node, Direction direction,
                  Dissection& dissection) {
  for (std::size_t i = 0; i < layouts.count; ++i) {
    NodeRef owner = node;
    owner.channel = i < 4 ? Channel::kMain : Channel::kSub;
    dissection.add({.layout = layouts.words[i],
                    .offset = offset + static_cast<std::uint32_t>(4 * i),
                    .length = 4,
                    .node = owner,
                    .direction = direction});
  }
}

}  // namespace servotrace::rtex
