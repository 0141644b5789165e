// SPDX-License-Identifier: MIT
#include "captures/simulator/rtex_drive.hpp"

#include <algorithm>
#include <cstdlib>

namespace servotrace::simulator::ring {
namespace {

constexpr std::int64_t kMotorRate = 4'000'000;        // command units a second squared the motor can do
constexpr DurationNs kHeaderErrorLimit = 10'000'000;  // of Err86.0 and Err86.1; the manual prints no number (8-1-7)
constexpr DurationNs kModeChangeLimit = 2'000'000;    // 7-6-3
constexpr std::int64_t kTurningRpm = 30;              // 4-2-3-1

}  // namespace

A5nDrive::A5nDrive(DriveConfig config, Timing timing)
    : config_(std::move(config)), timing_(timing), parameters_(config_.parameters) {
  // At 0.0833 ms the drive processes every second cycle (3-1-4).
  step_ns_ = timing_.cycles_per_second == 12'000 ? 2 * std::int64_t{timing_.cycle_ns} : timing_.cycle_ns;
  motor_.position = command_ = std::int64_t{config_.position} * kMicro;
  homing_complete_ = config_.absolute;
  servo_on_left_ns_ = config_.servo_on_ns;
  if (config_.alarm.main != 0) raise_alarm(config_.alarm);
  warning_ = config_.warning;
}

void A5nDrive::restart() {
  A5nDrive fresh(config_, timing_);
  fresh.parameters_ = parameters_;
  fresh.config_.alarm = {};
  fresh.alarm_ = {};
  fresh.warning_ = 0;
  fresh.history_ = history_;
  // The rotor stays where it is; an incremental drive counts from 0 again.
  fresh.offset_ = motor_.position + offset_;
  fresh.motor_.position = fresh.command_ = 0;
  if (config_.absolute) {
    fresh.motor_.position = fresh.command_ = motor_.position;
    fresh.offset_ = offset_;
  }
  *this = std::move(fresh);
}

std::int32_t A5nDrive::to_units(std::int64_t micro) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::uint64_t>(micro / kMicro)));
}

std::int32_t A5nDrive::parameter(unsigned parameter_class, unsigned number, std::int32_t otherwise) const {
  const auto found = parameters_.find(static_cast<std::uint16_t>(parameter_class << 8U | number));
  if (found != parameters_.end()) return found->second;
  if (parameter_class != 7) return otherwise;
  // The manual prints no factory settings: these are as the ring runs (2-5-1, 2-5-2).
  switch (number) {
    case 20:
      return timing_.cycles_per_second == 12'000  ? 0
             : timing_.cycles_per_second == 6'000 ? 1
             : timing_.cycles_per_second == 2'000 ? 3
                                                  : 6;
    case 21:
      return timing_.ratio;
    case 22:
      return (config_.wide ? 1 : 0) | (timing_.full_sync ? 2 : 0);
    default:
      return otherwise;
  }
}

std::int32_t A5nDrive::speed_in_unit(std::int64_t micro_per_second) const {
  const std::int64_t units = micro_per_second / kMicro;
  return static_cast<std::int32_t>(parameter(7, 25) == 1 ? units : units * 60 / config_.units_per_rev);
}

std::int64_t A5nDrive::speed_from_unit(std::int64_t value) const {
  const std::int64_t limit = std::int64_t{config_.max_rpm} * config_.units_per_rev / 60;
  const std::int64_t units = parameter(7, 25) == 1 ? value : value * config_.units_per_rev / 60;
  return std::clamp(units, -limit, limit) * kMicro;
}

bool A5nDrive::is_moving() const { return std::abs(motor_.speed / kMicro * 60 / config_.units_per_rev) >= kTurningRpm; }

bool A5nDrive::profile_is_exclusive() const {
  return profile_.type == 0x12 || profile_.type == 0x13 || profile_.type >= 0x31;
}

void A5nDrive::raise_alarm(AlarmCode code) {
  if (alarm_.main != 0) return;
  alarm_ = code;
  history_.insert(history_.begin(), code);
}

void A5nDrive::set_input(unsigned bit, bool active) {
  const auto mask = static_cast<std::uint8_t>(1U << bit);
  inputs_ = static_cast<std::uint8_t>(active ? inputs_ | mask : inputs_ & ~mask);
}

void A5nDrive::receive(Bytes command) {
  if (in_reset_) return;
  const bool process_now = timing_.cycles_per_second != 12'000 || cycle_ % 2 == 1;
  if (has_received_ && process_now) process(Bytes(received_).first(config_.wide ? kWideBlock : kBlock));
  std::copy(command.begin(), command.end(), received_.begin());
  has_received_ = true;
  broken_ = false;
  counter_echo_ = static_cast<int>(get(command::kUpdateCounter, command));
  ++cycle_;
}

// The block of the cycle before still counts for the process, and stays what the next one works on (6-11).
void A5nDrive::receive_broken() {
  if (in_reset_) return;
  if (has_received_) process(Bytes(received_).first(config_.wide ? kWideBlock : kBlock));
  broken_ = true;
  ++cycle_;
}

int A5nDrive::check_header(Bytes command) {
  if (get(command::kCyclic, command) > kCt) return 0x0021;
  if (get(command::kMacId, command) != config_.mac_id) return 0x0011;
  if (flag(command::kCr, command)) return 0x0012;
  return 0;
}

int A5nDrive::check_mode(int cyclic) {
  const bool small_cycle = timing_.cycles_per_second >= 6'000;
  if (config_.full_closed && (cyclic == kCv || cyclic == kCt || small_cycle)) return 0x002E;
  if (small_cycle && (cyclic == kPp || config_.wide)) return 0x002E;
  if (mode_ == kNoOperation || cyclic == mode_) return 0;
  if (since_mode_change_ns_ < kModeChangeLimit || main_.busy || profile_is_exclusive()) return 0x002E;
  return 0;
}

void A5nDrive::enter_mode(int cyclic) {
  if (cyclic == mode_) return;
  if (mode_ != kNoOperation) since_mode_change_ns_ = 0;
  mode_ = cyclic;
  profile_ = {};
  cp_counter_ = -1;
  cp_first_ = true;
}

void A5nDrive::process(Bytes command) {
  since_mode_change_ns_ += step_ns_;
  if (since_cyclic_ns_ >= 0) since_cyclic_ns_ += step_ns_;
  if (!hold_echo_) {
    code_echo_ = static_cast<int>(get(command::kCode, command));
    if (config_.wide) sub_code_echo_ = static_cast<int>(get(command::kSubCode, command));
  }
  const int cyclic = static_cast<int>(get(command::kCyclic, command));
  header_error_ = check_header(command);
  sub_chk_error_ = config_.wide && cyclic != kNoOperation && !flag(command::kSubChk, command);
  if (header_error_ != 0 || sub_chk_error_) {
    const DurationNs running_ns = ++header_errors_running_ * step_ns_;
    if (running_ns >= kHeaderErrorLimit && since_cyclic_ns_ >= config_.ready_ns)
      raise_alarm({86, static_cast<std::uint8_t>(header_error_ == 0x0021 ? 1 : 0)});
  } else {
    header_errors_running_ = 0;
  }
  const bool usable = header_error_ == 0 && !sub_chk_error_ && cyclic != kNoOperation;
  if (usable) {
    if (since_cyclic_ns_ < 0) since_cyclic_ns_ = 0;
    count_update(static_cast<int>(get(command::kUpdateCounter, command)));
    header_error_ = check_mode(cyclic);
    if (header_error_ != 0) {
      raise_alarm({91, 1});
    } else {
      enter_mode(cyclic);
      servo_on_command_ = flag(command::kServoOn, command);
      hard_stop_ = flag(command::kHardStop, command);
      smooth_stop_ = flag(command::kSmoothStop, command);
      pause_ = flag(command::kPause, command);
      homing_ctrl_ = flag(command::kHomingCtrl, command);
      if (!hold_echo_) process_main(command, cyclic);
      if (config_.wide) process_sub(command);
    }
  } else if (header_error_ == 0 && cyclic == kNoOperation) {
    main_.code = kNormalCommand;
    main_.error = 0;
  }
  run_channel(main_);
  if (config_.wide) run_channel(sub_);
  update_servo(servo_on_command_);
  move(usable && header_error_ == 0 ? command : Bytes());
}

// 8-1-8: updates that did not come, or not one after the other, are counted; the manual names no way back.
void A5nDrive::count_update(int counter) {
  const int limit = parameter(7, 38);
  const int moved = (counter - update_counter_) & 3;
  const int longest = step_ns_ > timing_.cycle_ns ? 1 : timing_.ratio;
  still_ = moved == 0 ? still_ + 1 : 0;
  const bool missed = update_counter_ >= 0 && (still_ == longest || moved > 1);
  if (still_ == longest) still_ = 0;
  update_counter_ = counter;
  if (!missed || limit <= 1 || since_cyclic_ns_ < config_.ready_ns) return;
  if (++missed_updates_ > limit) raise_alarm({86, 2});
}

void A5nDrive::update_servo(bool servo_on) {
  const bool ready = main_power_ && alarm_.main == 0 && since_cyclic_ns_ >= config_.ready_ns;
  if (servo_on && main_.busy && main_.run_code == kResetCommand) raise_alarm({27, 7});
  if (!servo_on || !ready) {
    servo_active_ = false;
    servo_on_left_ns_ = config_.servo_on_ns;
    return;
  }
  if (servo_active_ || is_moving()) return;
  servo_on_left_ns_ -= step_ns_;
  if (servo_on_left_ns_ > 0) return;
  servo_active_ = true;
  command_ = motor_.position;
}

// The motor follows the internal command position one step later.
void A5nDrive::follow(std::int64_t target) {
  const std::int64_t before = motor_.position;
  if (!blocked_) motor_.position = command_;
  motor_.speed = (motor_.position - before) * 1000 / step_ns_ * 1'000'000;
  command_ = target;
  torque_limited_ = blocked_ && command_ != motor_.position;
  torque_ = torque_limited_ ? config_.max_torque : (motor_.speed == 0 ? 0 : (motor_.speed > 0 ? 52 : -52));
}

void A5nDrive::move(Bytes command) {
  const std::int64_t before = motor_.position + offset_;
  if (!servo_active_ || mode_ == kNoOperation) inhibited_ = false;
  if (!servo_active_) {
    profile_ = {};
    motor_.to_speed(0, kMotorRate, step_ns_);
    command_ = motor_.position;
    torque_ = 0;
    torque_limited_ = false;
    cp_first_ = true;
    watch_triggers(before);
    return;
  }
  const bool fresh = !command.empty();
  const std::int64_t data1 = fresh ? get(command::kData1, command) : 0;
  switch (mode_) {
    case kCp: {
      const int counter = fresh ? static_cast<int>(get(command::kUpdateCounter, command)) : cp_counter_;
      if (fresh && (counter != cp_counter_ || cp_first_)) {
        // Wraps like the 32-bit command position (7-1-4-2).
        const auto step = static_cast<std::int32_t>(static_cast<std::uint32_t>(data1) -
                                                    static_cast<std::uint32_t>(to_units(command_)));
        cp_counter_ = counter;
        cp_from_ = command_;
        cp_to_ = command_ + std::int64_t{step} * kMicro - command_ % kMicro;
        cp_step_ = 0;
        inhibited_ = step != 0 && (step > 0 ? 1 : -1) == inhibited_direction();
        if (inhibited_) cp_to_ = cp_from_;
        const std::int64_t limit = std::int64_t{config_.max_rpm} * config_.units_per_rev / 50;  // a second
        const bool too_fast = std::abs(std::int64_t{step}) * timing_.cycles_per_second / timing_.ratio > limit;
        if (too_fast && !inhibited_ && !homing_lock_) raise_alarm({27, 4});
        cp_first_ = false;
      }
      const int steps = step_ns_ > timing_.cycle_ns ? 1 : timing_.ratio;
      if (cp_step_ < steps) ++cp_step_;
      follow(homing_lock_ ? command_ : cp_from_ + (cp_to_ - cp_from_) * cp_step_ / steps);
      break;
    }
    case kCv:
      if (fresh) cp_to_ = speed_from_unit(data1);
      refuse_after_stop(is_inhibited(cp_to_));
      motor_.to_speed(is_inhibited(cp_to_) ? 0 : cp_to_, kMotorRate, step_ns_);
      command_ = motor_.position;
      torque_ = motor_.speed == 0 ? 0 : (motor_.speed > 0 ? 48 : -48);
      break;
    case kCt: {
      if (fresh)
        torque_ = static_cast<std::int32_t>(std::clamp<std::int64_t>(data1, -config_.max_torque, config_.max_torque));
      refuse_after_stop(is_inhibited(torque_));
      if (is_inhibited(torque_)) torque_ = 0;
      // 0.1 % of torque for 60 command units a second squared, against friction that grows with the speed.
      const std::int64_t limit =
          speed_from_unit(parameter(7, 25) == 1 ? std::int64_t{config_.units_per_rev} * 50 : 3000);
      const std::int64_t wanted = std::clamp(std::int64_t{torque_} * 100 * kMicro, -limit, limit);
      motor_.to_speed(wanted, 60'000, step_ns_);
      command_ = motor_.position;
      break;
    }
    case kPp:
      move_profile();
      command_ = motor_.position;
      torque_ = motor_.speed == 0 ? 0 : (motor_.speed > 0 ? 50 : -50);
      break;
    default:
      break;
  }
  // 7-7-4: such a feedforward is refused after the stop, and counts as 0.
  if (fresh && motor_.speed == 0 && feeds_toward_input(command)) inhibited_ = true;
  watch_triggers(before);
}

// 6-10-2: 0046h comes after the stop at the input.
void A5nDrive::refuse_after_stop(bool toward) { inhibited_ = toward && (inhibited_ || motor_.speed == 0); }

bool A5nDrive::is_inhibited(std::int64_t command) const {
  return command != 0 && (command > 0 ? 1 : -1) == inhibited_direction();
}

// Drive inhibit acts where Pr5.04 says so; here only where the scenario does, too.
int A5nDrive::inhibited_direction() const {
  if (parameter(5, 4, 1) != 0) return 0;
  const bool swapped = (parameter(7, 23) & 0x08) != 0;
  const unsigned active = input_byte() & 3U;
  if (active == 0 || active == 3) return 0;
  return (active == 2) != swapped ? 1 : -1;
}

void A5nDrive::move_profile() {
  const std::int64_t up = std::int64_t{std::max(parameter(8, 1, 100), 1)} * 10'000;
  const std::int64_t down = std::int64_t{std::max(parameter(8, 4, 100), 1)} * 10'000;
  // 0046h: a positioning or a jog toward the input ends there; started at rest or while stopping at it, it is refused,
  // as long as its command stays (6-10-2).
  if (profile_.type >= 0x10 && profile_.type <= 0x20) {
    const std::int64_t way = profile_.type == 0x20 ? profile_.speed : profile_.target - motor_.position;
    const bool toward = is_inhibited(way);
    inhibited_ = toward && (stopping_at_input_ || motor_.speed == 0);
    stopping_at_input_ = toward;
    if (toward) profile_ = {};
  } else if (profile_.type != 0 || main_.code != kProfileCommand) {
    inhibited_ = false;
  }
  if (motor_.speed == 0) stopping_at_input_ = false;
  if (hard_stop_) motor_.speed = 0;
  if (profile_.type == 0 || hard_stop_ || smooth_stop_ || pause_) {
    motor_.to_speed(0, down, step_ns_);
    const bool ends = hard_stop_ || (smooth_stop_ && motor_.speed == 0);
    if (ends) profile_ = {};
    return;
  }
  const std::int64_t sign = parameter(8, 12) == 1 && profile_.type != 0x32 ? -1 : 1;
  const std::int64_t fast = sign * speed_from_unit(std::max(parameter(8, 13, 300), 1));
  const std::int64_t slow = sign * speed_from_unit(std::max(parameter(8, 14, 60), 1));
  switch (profile_.type) {
    case 0x20:
      motor_.to_speed(profile_.speed, std::abs(profile_.speed) > std::abs(motor_.speed) ? up : down, step_ns_);
      return;
    case 0x31:
    case 0x32:
      // To the sensor, back off it, slowly on it again; 31h goes on to the Z phase (7-5-7, 7-5-8).
      if (profile_.phase == 0) motor_.to_speed(fast, up, step_ns_);
      if (profile_.phase == 1) motor_.to_speed(-slow, down, step_ns_);
      if (profile_.phase >= 2 && profile_.phase < 4) motor_.to_speed(slow, down, step_ns_);
      break;
    case 0x33:
      if (profile_.phase < 4) motor_.to_speed(slow, up, step_ns_);
      if (profile_.phase == 0) profile_.phase = 3;
      break;
    default:
      motor_.toward(profile_.target, profile_.speed, up, down, step_ns_);
      if (motor_.rests_at(profile_.target)) profile_ = {};
      return;
  }
  if (profile_.phase == 4) {
    motor_.toward(0, std::abs(slow), up, down, step_ns_);
    if (motor_.rests_at(0)) {
      profile_ = {};
      homing_complete_ = true;
    }
  }
}

std::uint8_t A5nDrive::input_byte() const {
  const auto active = [&](const std::optional<Sensor>& sensor) {
    const std::int64_t at_units = (motor_.position + offset_) / kMicro;
    return sensor && at_units >= sensor->from && at_units <= sensor->to;
  };
  unsigned result = inputs_;
  const bool swapped = (parameter(7, 23) & 0x08) != 0;
  if (active(config_.home)) result |= 1U << 2U;
  if (active(config_.pot)) result |= swapped ? 1U : 2U;
  if (active(config_.not_)) result |= swapped ? 2U : 1U;
  return static_cast<std::uint8_t>(result);
}

// Z phases, sensors and inputs that were passed between the machine positions `before` and now.
void A5nDrive::watch_triggers(std::int64_t before) {
  const std::int64_t now = motor_.position + offset_;
  const std::int64_t turn = std::int64_t{config_.units_per_rev} * kMicro;
  const auto turns = [turn](std::int64_t position) { return (position - ((position % turn) + turn) % turn) / turn; };
  const bool z_phase = turns(before) != turns(now);
  const std::uint8_t inputs = input_byte();
  const auto rose = [&](unsigned bit) { return (inputs & ~last_inputs_ & 1U << bit) != 0; };
  const auto fell = [&](unsigned bit) { return (last_inputs_ & ~inputs & 1U << bit) != 0; };
  const auto fires = [&](int source) {
    if (source == 0) return z_phase;
    return source < 8 ? rose(static_cast<unsigned>(source + 2)) : fell(static_cast<unsigned>(source - 6));
  };
  for (Latch& latch : latches_) {
    if (!latch.waiting || !fires(latch.source)) continue;
    latch.waiting = false;
    latch.complete = true;
    latch.position = to_units(motor_.position);
  }
  if ((profile_.type == 0x12 || profile_.type == 0x13) && !profile_.latched && fires(profile_.latch_source)) {
    profile_.latched = true;
    latches_[0] = {false, true, profile_.latch_source, to_units(motor_.position)};
    profile_.target = motor_.position + std::int64_t{parameter(8, 10)} * kMicro;
  }
  if (profile_.type >= 0x31) {
    const bool home = (inputs & 4U) != 0;
    if (profile_.phase == 0 && home) profile_.phase = 1;
    if (profile_.phase == 1 && !home && fell(2)) profile_.phase = 2;
    if (profile_.phase == 2 && rose(2)) {
      profile_.phase = profile_.type == 0x32 ? 4 : 3;
      if (profile_.phase == 4) home_at(0);
    } else if (profile_.phase == 3 && z_phase) {
      profile_.phase = 4;
      home_at(0);
    }
  }
  if (main_.busy && main_.run_code == kHomingCommand && main_.run_type >= 0x11 && main_.run_type <= 0x1D &&
      homing_ctrl_) {
    // 11h Z phase; then pairs of rising and falling: HOME, POT, NOT, EXT1 to EXT3 (6-5-1).
    static constexpr unsigned kBits[] = {2, 1, 0, 3, 4, 5};
    const int pair = main_.run_type - 0x12;
    const bool hit = main_.run_type == 0x11 ? z_phase : pair % 2 == 0 ? rose(kBits[pair / 2]) : fell(kBits[pair / 2]);
    if (hit) {
      home_at(0);
      main_.busy = false;
      homing_complete_ = true;
      homing_lock_ = true;
      motor_.speed = 0;
    }
  }
  last_inputs_ = inputs;
}

// The present place gets the position `reference` (micro units).
void A5nDrive::home_at(std::int64_t reference) {
  offset_ += motor_.position - reference;
  motor_.position = reference;
  command_ = reference;
  cp_from_ = cp_to_ = reference;
}

void A5nDrive::respond(MutableBytes response) const {
  std::fill(response.begin(), response.end(), std::uint8_t{0});
  if (in_reset_ || !(has_received_ || broken_)) return;
  put(response::kCr, response, 1);
  put(response::kMacId, response, config_.mac_id);
  put(response::kCounterEcho, response, counter_echo_);
  put(response::kServoActive, response, servo_active_ ? 1 : 0);
  put(response::kServoReady, response, main_power_ && alarm_.main == 0 && since_cyclic_ns_ >= config_.ready_ns ? 1 : 0);
  put(response::kAlarm, response, alarm_.main != 0 ? 1 : 0);
  put(response::kWarning, response, warning_ != 0 ? 1 : 0);
  put(response::kTorqueLimited, response, torque_limited_ ? 1 : 0);
  put(response::kHomingComplete, response, homing_complete_ ? 1 : 0);
  const bool ac_off = (parameter(7, 23) & 0x100) != 0;
  put(response::kInProgress, response, (ac_off ? !main_power_ : profile_runs()) ? 1 : 0);
  put(response::kInPosition, response,
      std::abs(command_ - motor_.position) <= 10 * kMicro && motor_.speed == 0 ? 1 : 0);
  put(response::kInputs, response, input_byte());
  const int select = parameter(7, 29);
  put(response::kData1, response, monitor(select == 0 ? 0x07 : select));
  respond_main(response);
  if (config_.wide) respond_sub(response);
}

}  // namespace servotrace::simulator::ring
