// SPDX-License-Identifier: MIT
// The non-cyclic side of the drive model: when a command starts (3-3-4, 3-3-5), what it does and what it answers
// (chapter 6).
#include <algorithm>
#include <cstdlib>
#include <utility>

#include "captures/simulator/rtex_drive.hpp"

namespace servotrace::simulator::ring {
namespace {

// How long the model is busy; the manual prints no times but "approx. 10 s at most" for an alarm clear (6-6-1).
constexpr DurationNs kParameterWriteNs = 2'000'000;
constexpr DurationNs kEepromWriteNs = 60'000'000;
constexpr DurationNs kAlarmClearNs = 10'000'000;
constexpr DurationNs kValidationNs = 40'000'000;
constexpr DurationNs kMultiTurnNs = 15'000'000;

constexpr int kParameterClasses = 9;     // 0..8
constexpr int kParametersInClass8 = 20;  // 6-7-3
constexpr int kParametersInClass = 100;  // at most, elsewhere: the number has two digits

constexpr bool is_latch(int type) { return type >= 0x50 && type <= 0x5F; }
constexpr bool is_initialising(int type) { return (type >= 0x11 && type <= 0x1D) || type == 0x31; }

// 7-7-1: where Command_Data3 is Setting_Data.
constexpr bool takes_setting(int code, int type) {
  return code == kProfileCommand || (code == kHomingCommand && (type == 0x21 || type == 0x22)) ||
         (code == kParameterCommand && type == 0x011);
}

constexpr bool is_supported(int code) {
  return code <= kSystemIdCommand || (code >= kHomingCommand && code <= kProfileCommand) || code == kMonitorCommand;
}

constexpr bool is_known_latch_source(int source) { return source <= 3 || (source >= 9 && source <= 11); }

constexpr bool is_32_bit(int index) {
  switch (index) {
    case 0x0008:
    case 0x070B:
    case 0x070C:
    case 0x070D:
    case 0x070F:
    case 0x080A:
    case 0x080D:
    case 0x080E:
      return true;
    default:
      return false;
  }
}

bool is_known_alarm_attribute(int index) { return (index & 0xFF) >= 10 && (index & 0xFF) < 100; }

bool can_clear(AlarmCode alarm) {
  // 8-1: what the manual's tables call not clearable.
  return !(alarm.main == 82 || alarm.main == 98 || (alarm.main == 84 && alarm.sub == 3) ||
           (alarm.main == 86 && alarm.sub == 2));
}

}  // namespace

void A5nDrive::process_main(Bytes command, int cyclic) {
  DriveChannel& channel = main_;
  const int code = static_cast<int>(get(command::kNonCyclic, command));
  // Homing and profile keep bits 3-0 of byte 9 for themselves.
  const int type = static_cast<int>(get(command::kTypeCode, command)) &
                   (code == kHomingCommand || code == kProfileCommand ? 0xFF : 0xFFF);
  const int index = static_cast<int>(get(command::kIndex, command));
  const auto data3 = static_cast<std::int32_t>(get(command::kData3, command));
  const bool setting = takes_setting(code, type);
  const bool code_changed = code != channel.code;
  const bool arguments_changed =
      code != kNormalCommand && !code_changed &&
      (type != channel.type || index != channel.index || (setting && data3 != channel.setting));
  const int previous = channel.code;
  if (code_changed) leave_command(channel, code);
  channel.code = code;
  const int old_type = channel.type;
  channel.type = type;
  channel.index = index;
  channel.setting = data3;
  if (in_reset_) return;
  if (code == kNormalCommand) {
    channel.error = data3 != 0 && parameter(7, 35) == 0 ? 0x0032 : 0;
    channel.executed = false;
    return;
  }
  const bool from_standard = code_changed && previous == kNormalCommand;
  const bool extended = extend_mode() && code != kProfileCommand && (code_changed || arguments_changed);
  if (from_standard || extended) {
    channel.executed = false;
    channel.error = channel.busy ? 0x0101 : check_command(channel, cyclic, false, data3);
    if (channel.error == 0) start_command(channel, command);
    // 6-10-2: these errors bring Err91.1 with them (8-1-10).
    if (channel.error == 0x002E || channel.error == 0x0059) raise_alarm({91, 1});
    return;
  }
  if (code_changed) {
    channel.executed = false;
    channel.error = 0;
    return;
  }
  if (code == kProfileCommand && channel.executed && profile_runs()) {
    if (type != old_type) {
      channel.error = 0x0104;
      raise_alarm({91, 1});
    } else if (extend_mode() && channel.error == 0) {
      profile_.speed = speed_from_unit(data3);
      const std::int64_t target = get(command::kData1, command) * kMicro;
      if (profile_.type == 0x10) profile_.target = target;
      channel.run_setting = data3;
    }
  }
}

// 7-7-3: velocity feedforward acts in CP, torque feedforward in CP, PP and CV.
bool A5nDrive::feeds_toward_input(Bytes command) const {
  const auto toward = [&](unsigned number, Slot word) {
    const int choice = parameter(7, number);
    const bool acts = choice == 1 ? mode_ == kCp : choice == 2 && (mode_ == kCp || mode_ == kPp || mode_ == kCv);
    return acts && is_inhibited(get(word, command));
  };
  if (!takes_setting(main_.code, main_.type) && toward(35, command::kData3)) return true;
  return command.size() >= 32 && (toward(36, command::kSubData2) || toward(37, command::kSubData3));
}

void A5nDrive::process_sub(Bytes command) {
  DriveChannel& channel = sub_;
  const int code = static_cast<int>(get(command::kSubCode, command));
  const int type = static_cast<int>(get(command::kSubTypeCode, command));
  const int index = static_cast<int>(get(command::kSubIndex, command));
  const bool code_changed = code != channel.code;
  const bool arguments_changed = code != kNormalCommand && (type != channel.type || index != channel.index);
  const bool from_standard = code_changed && channel.code == kNormalCommand;
  const bool extended = extend_mode() && (code_changed || arguments_changed);
  channel.code = code;
  channel.type = type;
  channel.index = index;
  const bool feedforward_wrong = (get(command::kSubData2, command) != 0 && parameter(7, 36) == 0) ||
                                 (get(command::kSubData3, command) != 0 && parameter(7, 37) == 0);
  if (code == kNormalCommand) {
    channel.error = feedforward_wrong ? 0x0034 : 0;
    channel.executed = false;
  } else if (from_standard || extended) {
    channel.executed = false;
    channel.error = feedforward_wrong ? 0x0034 : (channel.busy ? 0x0101 : check_command(channel, mode_, true, 0));
    if (channel.error == 0) start_command(channel, command);
  } else if (code_changed) {
    channel.executed = false;
    channel.error = 0;
  }
}

// The command error that answers a command, 0 where it is taken (6-10).
int A5nDrive::check_command(DriveChannel& channel, int cyclic, bool sub, std::int32_t data3) {
  const int code = channel.code;
  if (!is_supported(code)) return 0x0022;
  if (sub && code != kSystemIdCommand && code != kMonitorCommand) return 0x0022;
  if (code == kProfileCommand && cyclic != kPp) return 0x0022;
  if (!sub && data3 != 0 && parameter(7, 35) == 0 && !takes_setting(code, channel.type)) return 0x0032;
  switch (code) {
    case kResetCommand:
      if (channel.type != 0x001 && channel.type != 0x011) return 0x0031;
      if (channel.index != 0) return 0x0032;
      return channel.type == 0x011 && servo_active_ ? 0x0045 : 0;
    case kSystemIdCommand:
      if (system_text(channel.type) == "?") return 0x0031;
      return sub && channel.type > 0x34 ? 0x0031 : 0;
    case kHomingCommand:
      return check_homing(channel, cyclic);
    case kAlarmCommand:
      return check_alarm(channel);
    case kParameterCommand:
      return check_parameter(channel);
    case kProfileCommand:
      return check_profile(channel);
    default:
      return 0;
  }
}

int A5nDrive::check_homing(const DriveChannel& channel, int cyclic) const {
  const int type = channel.type;
  const bool position_set = type == 0x21 || type == 0x22;
  const bool to_trigger = type >= 0x11 && type <= 0x1D;
  const bool latch = type == 0x50 || (type >= 0x51 && type <= 0x54) || type == 0x58 || type == 0x5C;
  if (!position_set && !to_trigger && !latch && type != 0x31) return 0x0031;
  if (profile_is_exclusive()) return 0x0059;
  if (profile_runs() && is_initialising(type)) return 0x0059;
  if ((cyclic == kCv || cyclic == kCt) && (to_trigger || position_set)) return 0x002E;
  if (to_trigger && cyclic != kCp) return 0x0022;
  if (to_trigger && config_.absolute) return 0x0052;
  if (position_set && config_.absolute) return 0x0053;
  if (to_trigger && !servo_active_) return 0x0057;
  if (type == 0x31) {
    if (config_.full_closed) return 0x0055;
    if (!config_.absolute) return 0x0051;
    return servo_active_ ? 0x0056 : 0;
  }
  if (latch) {
    const int first = channel.index & 0x0F;
    const int second = channel.index >> 4 & 0x0F;
    const bool first_wrong = (type & 0x01) != 0 && !is_known_latch_source(first);
    const bool second_wrong = (type & 0x02) != 0 && !is_known_latch_source(second);
    return first_wrong || second_wrong ? 0x0032 : 0;
  }
  return 0;
}

int A5nDrive::check_alarm(const DriveChannel& channel) const {
  switch (channel.type) {
    case 0x000:
      return channel.index > 14 ? 0x0032 : 0;
    case 0x001:
      if (channel.index != 0) return 0x0032;
      if (warning_ != 0) return 0;
      return alarm_.main != 0 && !can_clear(alarm_) ? 0x0042 : 0;
    case 0x002:
      return channel.index == 0 || is_known_alarm_attribute(channel.index) ? 0 : 0x0032;
    case 0x011:
      return channel.index != 0 ? 0x0032 : 0;
    case 0x021:
      if (channel.index != 0) return 0x0032;
      return 0x0043;
    default:
      return 0x0031;
  }
}

int A5nDrive::check_parameter(const DriveChannel& channel) const {
  const int parameter_class = channel.index >> 8;
  const int number = channel.index & 0xFF;
  const bool exists =
      parameter_class < kParameterClasses && number < (parameter_class == 8 ? kParametersInClass8 : kParametersInClass);
  const bool is_protected = (parameter(7, 23) & 0x01) != 0;
  switch (channel.type) {
    case 0x010:
    case 0x040:
      return exists ? 0 : 0x0032;
    case 0x011:
      if (!exists) return 0x0032;
      return is_protected ? 0x0201 : 0;
    case 0x030:
      return number != 0 || parameter_class >= kParameterClasses ? 0x0032 : 0;
    case 0x081:
    case 0x101:
      if (channel.index != 0) return 0x0032;
      return is_protected ? 0x0201 : 0;
    default:
      return 0x0031;
  }
}

int A5nDrive::check_profile(const DriveChannel& channel) const {
  const int type = channel.type;
  const bool positioning = type >= 0x10 && type <= 0x13;
  if (!positioning && type != 0x20 && !(type >= 0x31 && type <= 0x33)) return 0x0031;
  if ((channel.index & 0xF0) != 0) return 0x0032;
  if ((type == 0x12 || type == 0x13) && !is_known_latch_source(channel.index & 0x0F)) return 0x0032;
  if (positioning && channel.setting < 0) return 0x0032;
  if (type >= 0x31 && config_.absolute) return 0x0052;
  if (profile_runs() && type != profile_.type) return 0x0104;
  return 0;
}

void A5nDrive::start_command(DriveChannel& channel, Bytes command) {
  channel.executed = true;
  channel.run_code = channel.code;
  channel.run_type = channel.type;
  channel.run_index = channel.index;
  channel.run_setting = channel.setting;
  channel.result = 0;
  channel.err = std::exchange(next_err_, false);
  channel.wng = std::exchange(next_wng_, false);
  channel.busy_ns = 0;
  switch (channel.code) {
    case kResetCommand:
      if (channel.type == 0x011) channel.busy_ns = kValidationNs;
      break;
    case kHomingCommand:
      start_homing(channel);
      if (channel.type == 0x31) channel.busy_ns = kMultiTurnNs;
      break;
    case kAlarmCommand:
      if (channel.type == 0x001 || channel.type == 0x011) channel.busy_ns = kAlarmClearNs;
      break;
    case kParameterCommand:
      if (channel.type == 0x011) channel.busy_ns = kParameterWriteNs;
      if (channel.type == 0x081 || channel.type == 0x101) channel.busy_ns = kEepromWriteNs;
      break;
    case kProfileCommand:
      start_profile(channel, command);
      break;
    default:
      break;
  }
  if (next_busy_ns_) channel.busy_ns = *next_busy_ns_;
  next_busy_ns_.reset();
  const bool waits_for_trigger = channel.code == kHomingCommand && channel.type >= 0x11 && channel.type <= 0x1D;
  channel.busy = waits_for_trigger || channel.busy_ns > 0;
  if (!channel.busy) finish_command(channel);
}

void A5nDrive::start_homing(DriveChannel& channel) {
  const int type = channel.type;
  if (is_latch(type)) {
    for (std::size_t i = 0; i < latches_.size(); ++i) {
      const int mask = static_cast<int>(i) + 1;
      if ((type & mask) != 0) latches_[i] = {true, false, channel.index >> (4 * static_cast<int>(i)) & 0x0F, 0};
      if ((type & mask << 2) != 0) latches_[i] = {};
    }
    return;
  }
  homing_complete_ = false;
  latches_ = {};
  if (type != 0x31) profile_ = {};
  // 6-5-1: POT and NOT end a homing only where they are no drive inhibit inputs.
  if (type >= 0x14 && type <= 0x17 && parameter(5, 4, 1) != 1) raise_alarm({38, 2});
}

void A5nDrive::start_profile(DriveChannel& channel, Bytes command) {
  const std::int64_t data1 = get(command::kData1, command) * kMicro;
  profile_.type = channel.type;
  profile_.speed = speed_from_unit(channel.setting);
  profile_.latch_source = channel.index & 0x0F;
  profile_.latched = false;
  profile_.phase = 0;
  const bool relative = channel.type == 0x11 || channel.type == 0x13;
  profile_.target = relative ? command_ + data1 : data1;
  if (channel.type == 0x12 || channel.type == 0x13) latches_[0] = {};
  if (channel.type >= 0x31) homing_complete_ = false;
  if (!servo_active_) profile_ = {};
}

void A5nDrive::leave_command(const DriveChannel& channel, int next_code) {
  if (channel.code == kResetCommand && channel.type == 0x001 && channel.executed && next_code == kNormalCommand)
    in_reset_ = true;
  if (channel.code == kHomingCommand) {
    homing_lock_ = false;
    if (main_.busy && main_.run_code == kHomingCommand && main_.run_type >= 0x11 && main_.run_type <= 0x1D)
      main_.busy = false;
  }
}

void A5nDrive::run_channel(DriveChannel& channel) {
  if (!channel.busy || channel.busy_ns <= 0) return;
  channel.busy_ns -= step_ns_;
  if (channel.busy_ns > 0) return;
  channel.busy = false;
  finish_command(channel);
}

// What the command changes, once it is done.
void A5nDrive::finish_command(DriveChannel& channel) {
  if (channel.err) return;
  const int type = channel.run_type;
  switch (channel.run_code) {
    case kResetCommand:
      if (type == 0x011) {
        offset_ += config_.absolute ? 0 : motor_.position;
        if (!config_.absolute) motor_.position = command_ = 0;
        homing_complete_ = config_.absolute;
        latches_ = {};
      }
      break;
    case kHomingCommand:
      if (type == 0x21) {
        offset_ += motor_.position - std::int64_t{channel.run_setting} * kMicro;
        motor_.position = command_ = cp_from_ = cp_to_ = std::int64_t{channel.run_setting} * kMicro;
      } else if (type == 0x22) {
        const std::int64_t shift = std::int64_t{channel.run_setting} * kMicro - command_;
        offset_ -= shift;
        motor_.position += shift;
        command_ += shift;
        cp_from_ = cp_to_ = command_;
      }
      if (!is_latch(type)) {
        homing_complete_ = true;
        homing_lock_ = type == 0x21 || type == 0x22;
      }
      break;
    case kAlarmCommand:
      if (type == 0x001) {
        warning_ = 0;
        if (can_clear(alarm_)) alarm_ = {};
      }
      if (type == 0x011) history_.clear();
      break;
    case kParameterCommand: {
      if (type != 0x011) break;
      std::int32_t value = channel.run_setting;
      if (!is_32_bit(channel.run_index)) value = std::clamp(value, -32'768, 32'767);
      if (channel.run_index == 0x000D) value = std::clamp(value, 0, 500);  // Pr0.13, 1st torque limit
      channel.wng = channel.wng || value != channel.run_setting;
      parameters_[static_cast<std::uint16_t>(channel.run_index)] = value;
      break;
    }
    default:
      break;
  }
}

// 6-9-1; values this model has no use for read 0.
std::int32_t A5nDrive::monitor(int type) const {
  switch (type) {
    case 0x01:
    case 0x101:
      return to_units(command_ - motor_.position);
    case 0x02:
    case 0x102:
      return 1 << 20;
    case 0x04:
    case 0x104:
    case 0x08:
      return to_units(command_);
    case 0x05:
    case 0x105:
    case 0x0C:
      return speed_in_unit(motor_.speed);
    case 0x06:
    case 0x106:
      return torque_;
    case 0x07:
      return to_units(motor_.position);
    case 0x09:
      return latches_[0].position;
    case 0x0A:
      return latches_[1].position;
    case 0x12:
    case 0x112:
      return std::abs(torque_) / 2;
    case 0x21:
    case 0x25:
      return input_byte();
    case 0x62:
      return 41;
    case 0x69:
      return main_power_ ? 282 : 0;
    default:
      return 0;
  }
}

// The characters behind a System ID Type_Code (6-4-1); "?" for one that is undefined.
std::string A5nDrive::system_text(int type) const {
  switch (type) {
    case 0x01:
    case 0x010:
      return "Panasonic";
    case 0x05:
    case 0x050:
      return "1";
    case 0x12:
    case 0x120:
      return config_.model;
    case 0x13:
    case 0x130:
      return config_.serial;
    case 0x14:
    case 0x140:
      return "1.01";
    case 0x15:
    case 0x150:
      return "101111";
    case 0x22:
    case 0x220:
      return "MSME022G1A";
    case 0x23:
    case 0x230:
      return "10090021";
    case 0x06:
    case 0x060:
    case 0x31:
    case 0x310:
    case 0x32:
    case 0x320:
    case 0x34:
    case 0x340:
      return "";
    default:
      return "?";
  }
}

std::int32_t A5nDrive::command_result(const DriveChannel& channel) const {
  const auto code_of = [&](AlarmCode alarm) {
    const bool with_sub = (parameter(7, 23) & 0x02) != 0;
    return alarm.main | (with_sub ? alarm.sub << 8 : 0);
  };
  switch (channel.run_code) {
    case kSystemIdCommand: {
      const std::string text = system_text(channel.run_type);
      std::uint32_t word = 0;
      for (unsigned i = 0; i < 4; ++i) {
        const std::size_t place = static_cast<std::size_t>(channel.run_index) * 4 + i;
        if (place < text.size()) word |= std::uint32_t{static_cast<std::uint8_t>(text[place])} << (8 * i);
      }
      return static_cast<std::int32_t>(word);
    }
    case kHomingCommand:
      if (is_latch(channel.run_type)) return monitor(channel.run_index >> 8);
      return channel.run_type == 0x21 || channel.run_type == 0x22 ? channel.run_setting : 0;
    case kAlarmCommand:
      if (channel.run_type == 0x002)
        return alarm_.main == 0 && channel.run_index == 0 ? 0 : attribute_of_alarm(channel);
      if (channel.run_type == 0x000 && channel.run_index > 0) {
        const auto place = static_cast<std::size_t>(channel.run_index - 1);
        return place < history_.size() ? code_of(history_[place]) : 0;
      }
      return code_of(alarm_) | warning_ << 16;
    case kParameterCommand:
      if (channel.run_type == 0x010 || channel.run_type == 0x011)
        return parameter(static_cast<unsigned>(channel.run_index) >> 8U,
                         static_cast<unsigned>(channel.run_index) & 0xFFU);
      if (channel.run_type == 0x030) return channel.run_index >> 8 == 8 ? kParametersInClass8 : 0;
      if (channel.run_type == 0x040) return attribute_of_parameter(channel.run_index);
      return 0;
    case kProfileCommand:
      return monitor(channel.run_index >> 8);
    case kMonitorCommand:
      return monitor(channel.run_type);
    default:
      return 0;
  }
}

// 6-6-3: bit 6 of byte 12, the alarm cannot be cleared.
std::int32_t A5nDrive::attribute_of_alarm(const DriveChannel& channel) const {
  const AlarmCode asked{static_cast<std::uint8_t>(channel.run_index),
                        static_cast<std::uint8_t>(channel.run_index >> 8)};
  return can_clear(channel.run_index == 0 ? alarm_ : asked) ? 0 : 0x40;
}

// 6-7-4.
std::int32_t A5nDrive::attribute_of_parameter(int index) {
  constexpr int kAtInit = 0x10;
  constexpr int kConfigurable = 0x1000;
  constexpr int k32Bit = 0x8000;
  int bits = is_32_bit(index) ? k32Bit : 0;
  if (index == 0x0008) bits |= kAtInit | kConfigurable;                     // attribute C
  if (index >= 0x0714 && index <= 0x0716) bits |= kAtInit;                  // Pr7.20 to Pr7.22: attribute R
  if (index >= 0x0723 && index <= 0x0725) bits |= kAtInit | kConfigurable;  // Pr7.35 to Pr7.37: C
  return bits;
}

void A5nDrive::respond_main(MutableBytes response) const {
  if (broken_) {  // 6-11
    put(response::kCmdError, response, 1);
    put(response::kCodeEcho, response, 0x7F);
    return;
  }
  put(response::kCodeEcho, response, code_echo_);
  const DriveChannel& channel = main_;
  const int own = channel.error != 0 ? channel.error : (inhibited_ ? 0x0046 : 0);
  const int error = header_error_ != 0 ? header_error_ : own;
  if (error != 0) {
    put(response::kCmdError, response, 1);
    put(response::kErrorCode, response, error);
    return;
  }
  if (channel.code == kNormalCommand || sub_chk_error_) {
    const int second = parameter(7, 30);
    const int third = parameter(7, 31);
    put(response::kData2, response, monitor(second == 0 ? 0x05 : second));
    put(response::kData3, response, monitor(third == 0 ? 0x06 : third));
    return;
  }
  put(response::kType, response, channel.run_type);
  if (channel.run_code == kHomingCommand) {
    put(response::kLatchComp1, response, latches_[0].complete ? 1 : 0);
    put(response::kLatchComp2, response, latches_[1].complete ? 1 : 0);
  } else if (channel.run_code == kProfileCommand) {
    const std::int64_t left = std::abs(profile_.target - command_);
    const bool positioning = channel.run_type >= 0x10 && channel.run_type <= 0x13;
    const bool near = positioning && left <= std::int64_t{parameter(7, 15, 100)} * kMicro;
    const int limits = homing_complete_ ? parameter(7, 10, 3) : 3;
    const bool beyond_positive = (limits & 1) == 0 && actual_position() > parameter(7, 11, INT32_MAX);
    const bool beyond_negative = (limits & 2) == 0 && actual_position() < parameter(7, 12, INT32_MIN);
    const bool swapped = (parameter(7, 23) & 0x80) != 0;
    put(response::kLatchComp1, response, latches_[0].complete ? 1 : 0);
    put(response::kNear, response, near ? 1 : 0);
    put(swapped ? response::kPslSwapped : response::kPsl, response, beyond_positive ? 1 : 0);
    put(swapped ? response::kNslSwapped : response::kNsl, response, beyond_negative ? 1 : 0);
  }
  put(response::kBusy, response, channel.busy ? 1 : 0);
  put(response::kWng, response, !channel.busy && channel.wng ? 1 : 0);
  put(response::kErr, response, !channel.busy && channel.err ? 1 : 0);
  const bool present_alarm = channel.run_code == kAlarmCommand && channel.run_type == 0x002 && channel.run_index == 0;
  put(response::kIndexEcho, response, present_alarm ? alarm_.main | alarm_.sub << 8 : channel.run_index);
  put(response::kData3, response, command_result(channel));
}

void A5nDrive::respond_sub(MutableBytes response) const {
  const int second = parameter(7, 33);
  const int third = parameter(7, 34);
  put(response::kSubData2, response, second == 0 ? 0 : monitor(second));
  put(response::kSubData3, response, third == 0 ? 0 : monitor(third));
  if (broken_) {  // 6-11
    put(response::kSubCmdError, response, 1);
    put(response::kSubCodeEcho, response, 0xF);
    return;
  }
  put(response::kSubCodeEcho, response, sub_code_echo_);
  const int error = sub_chk_error_ ? 0x0012 : sub_.error;
  if (error != 0) {
    put(response::kSubCmdError, response, 1);
    put(response::kSubErrorCode, response, error);
    return;
  }
  if (sub_.code == kNormalCommand) {
    const int first = parameter(7, 32);
    put(response::kSubData1, response, first == 0 ? 0 : monitor(first));
    return;
  }
  put(response::kSubTypeEcho, response, sub_.run_type & 0xFF);
  put(response::kSubBusy, response, sub_.busy ? 1 : 0);
  put(response::kSubWng, response, !sub_.busy && sub_.wng ? 1 : 0);
  put(response::kSubErr, response, !sub_.busy && sub_.err ? 1 : 0);
  put(response::kSubIndexEcho, response, sub_.run_index);
  put(response::kSubData1, response, command_result(sub_));
}

}  // namespace servotrace::simulator::ring
