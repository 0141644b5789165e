// SPDX-License-Identifier: MIT
#include "captures/simulator/rtex_master.hpp"

#include <algorithm>
#include <cstdlib>

namespace servotrace::simulator::ring {
namespace {

constexpr DurationNs kModeChangeGap = 2 * kMillisecondNs;  // 7-6-3
constexpr std::int64_t kMilli = 1000;
constexpr DurationNs kProfileStart = 20 * kMillisecondNs;  // a profile that has not started by then has nothing to do

constexpr bool is_homing_with_reference(const Request& request) {
  return !request.sub && request.code == kHomingCommand && request.type < 0x50;
}

}  // namespace

AxisMaster::AxisMaster(A5nDrive& drive, Timing timing, int first_mode)
    : drive_(drive),
      timing_(timing),
      update_ns_(timing.ratio * kSecondNs / timing.cycles_per_second),
      wide_(drive.config().wide),
      cyclic_(first_mode) {
  planned_.position = std::int64_t{drive.config().position} * kMicro;
  profile_target_ = drive.config().position;
}

void AxisMaster::observe(Bytes response) {
  if (!flag(response::kCr, response)) return;
  std::copy(response.begin(), response.end(), response_.begin());
  has_response_ = true;
}

bool AxisMaster::echoes_reset() const {
  return seen_value(response::kCodeEcho) == (cyclic_ << 4 | kResetCommand) && !seen(response::kCmdError);
}

const Step* AxisMaster::overdue(DurationNs now_ns) const {
  if (!current_ || !started_ || current_->what == Do::kWait || current_->what == Do::kSendNop) return nullptr;
  return now_ns - started_ns_ > current_->give_up_ns ? &*current_ : nullptr;
}

void AxisMaster::start_again() {
  code_ = sub_code_ = sent_code_ = sent_sub_code_ = kNormalCommand;
  control_ = {};
  has_response_ = false;
  moving_ = false;
  detached_ = false;
  planned_ = {};
  level_ = level_goal_ = 0;
}

void AxisMaster::update(RingState& ring) {
  advance();
  // Steps that take no time follow each other in one cycle.
  for (int guard = 0; guard < 1000; ++guard) {
    if (!current_) {
      if (steps_.empty()) return;
      current_ = steps_.front();
      steps_.pop_front();
      started_ = false;
    }
    if (!started_) {
      if (current_->at_ns && *current_->at_ns > ring.now_ns) return;
      started_ = true;
      started_ns_ = ring.now_ns;
      started_cycle_ = ring.cycle;
      for (Fault fault : current_->faults) {
        fault.first_cycle += ring.cycle;
        if (fault.axis < 0) fault.axis = drive_.config().mac_id;
        ring.faults.push_back(fault);
      }
      start(*current_, ring);
    }
    if (!finished(*current_, ring)) return;
    current_.reset();
  }
}

void AxisMaster::advance() {
  if (cyclic_ == kCp) {
    if (!seen(response::kServoActive)) {
      if (!detached_ && has_response_) planned_ = {seen_value(response::kData1) * kMicro, 0};
      if (!detached_) moving_ = false;
    } else {
      detached_ = false;
    }
    if (drift_ != 0) {
      planned_.to_speed(drift_ * kMicro, rate_, update_ns_);
    } else if (moving_) {
      planned_.toward(goal_, cruise_, rate_, rate_, update_ns_);
      if (planned_.rests_at(goal_)) moving_ = false;
    }
  } else if (cyclic_ == kCv || cyclic_ == kCt) {
    const std::int64_t left = level_goal_ - level_;
    level_ += level_step_ == 0 ? left : std::clamp(left, -level_step_, level_step_);
  }
}

void AxisMaster::start(const Step& step, RingState&) {
  switch (step.what) {
    case Do::kSync:
      ++syncs_reached_;
      break;
    case Do::kServoOn:
      if (!step.wait) put(command::kServoOn, control_, 1);
      break;
    case Do::kServoOff:
      put(command::kServoOn, control_, 0);
      break;
    case Do::kMove:
    case Do::kJump:
      goal_ = step.target * kMicro + (step.relative ? planned_.position : 0);
      cruise_ = step.speed * kMicro;
      rate_ = step.rate;
      moving_ = step.what == Do::kMove;
      if (!moving_) planned_ = {goal_, 0};
      detached_ = !seen(response::kServoActive);
      break;
    case Do::kSpeed:
    case Do::kTorque: {
      level_goal_ = step.target * kMilli;
      const std::int64_t updates = step.for_ns / update_ns_;
      level_step_ = updates == 0 ? 0 : std::max<std::int64_t>(std::abs(level_goal_ - level_) / updates, 1);
      break;
    }
    case Do::kStartProfile:
    case Do::kCommand:
      start_request(step);
      break;
    case Do::kProfileUpdate:
      profile_target_ = static_cast<std::int32_t>(step.target);
      data3_ = *step.request.data3;
      if (step.request.type != 0) type_ = step.request.type;
      break;
    case Do::kControl:
      for (const ControlBit& control : step.control) put(control.bit, control_, control.value ? 1 : 0);
      break;
    case Do::kSendNop:
      nop_ = true;
      break;
    case Do::kDrive:
      if (step.alarm) drive_.raise_alarm(*step.alarm);
      if (step.warning) drive_.raise_warning(*step.warning);
      if (step.input) drive_.set_input(*step.input, step.active);
      if (step.main_power) drive_.set_main_power(*step.main_power);
      if (step.blocked) drive_.block_motor(*step.blocked);
      break;
    case Do::kWait:
    case Do::kMode:
    case Do::kProfileEnd:
      break;
  }
}

void AxisMaster::start_request(const Step& step) {
  const Request& request = step.request;
  if (step.busy_ns) drive_.set_busy(*step.busy_ns);
  if (step.err || step.wng) drive_.fail_next(step.err, step.wng);
  const int sent = request.sub ? sent_sub_code_ : sent_code_;
  phase_ = sent == kNormalCommand || chained_ ? Phase::kHeld : Phase::kRestoring;
  chained_ = false;
  if (phase_ == Phase::kRestoring) code(request.sub) = kNormalCommand;
  if (!request.sub && phase_ == Phase::kRestoring) data3_ = 0;
  phase_cycle_ = -1;
  seen_running_ = false;
}

bool AxisMaster::is_answered(const Request& request) const {
  if (request.sub) {
    if (seen_value(response::kSubCodeEcho) != request.code) return false;
    if (seen(response::kSubCmdError)) return true;
    return seen_value(response::kSubTypeEcho) == request.type && seen_value(response::kSubIndexEcho) == request.index &&
           !seen(response::kSubBusy);
  }
  if (seen_value(response::kCodeEcho) != (cyclic_ << 4 | request.code)) return false;
  if (seen(response::kCmdError)) return true;
  const bool low_only = request.code == kHomingCommand || request.code == kProfileCommand;
  const std::int64_t type = seen_value(low_only ? response::kTypeLow : response::kType);
  const bool any_index = request.code == kAlarmCommand && request.type == 0x002 && request.index == 0;
  if (type != request.type || seen(response::kBusy)) return false;
  if (!any_index && seen_value(response::kIndexEcho) != request.index) return false;
  return !is_homing_with_reference(request) || seen(response::kHomingComplete);
}

// True when the handshake is over (3-3-4).
bool AxisMaster::run_request(const Step& step, const RingState& ring) {
  const Request& request = step.request;
  const bool is_profile = step.what == Do::kStartProfile;
  if (phase_ == Phase::kRestoring) {
    phase_ = Phase::kHeld;
    return false;
  }
  if (phase_ == Phase::kHeld && phase_cycle_ < 0) {
    phase_cycle_ = ring.cycle;
    code(request.sub) = request.code;
    (request.sub ? sub_type_ : type_) = request.type;
    (request.sub ? sub_index_ : index_) = request.index;
    if (!request.sub) data3_ = request.data3.value_or(0);
    if (is_profile) profile_target_ = static_cast<std::int32_t>(step.target);
    if (step.together) {
      cyclic_ = kPp;
      mode_changed_ns_ = ring.now_ns;
    }
    if (request.code == kHomingCommand && step.speed != 0) {
      drift_ = step.speed;
      rate_ = step.rate;
    }
    return request.leave == Leave::kKeep;
  }
  if (phase_ == Phase::kHeld) {
    seen_running_ = seen_running_ || seen(response::kInProgress);
    const bool echoed = request.sub ? seen_value(response::kSubCodeEcho) == request.code
                                    : seen_value(response::kCodeEcho) == (cyclic_ << 4 | request.code);
    bool over = false;
    switch (request.leave) {
      case Leave::kDone:
        over = is_answered(request);
        if (over && is_profile && !seen(response::kCmdError)) {
          const bool had_time = (ring.cycle - phase_cycle_) * timing_.cycle_ns > kProfileStart;
          over = !seen(response::kInProgress) && (seen_running_ || had_time);
        }
        break;
      case Leave::kEcho:
        over = echoed;
        break;
      case Leave::kAllEcho:
        over = ring.all_reset_echoed;
        break;
      case Leave::kRunning:
        over = is_answered(request) && seen_running_;
        break;
      case Leave::kCycles:
        over = ring.cycle - phase_cycle_ >= request.cycles;
        break;
      case Leave::kKeep:
        over = true;
        break;
    }
    if (!over) return false;
    phase_ = Phase::kHolding;
    phase_cycle_ = ring.cycle;
    if (is_homing_with_reference(request) && request.leave == Leave::kDone && !seen(response::kCmdError)) {
      drift_ = 0;
      moving_ = false;
      if (request.reference) planned_ = {std::int64_t{request.data3.value_or(0)} * kMicro, 0};
      if (request.reference) detached_ = !seen(response::kServoActive);
      return false;
    }
  }
  if (phase_ == Phase::kHolding) {
    const bool held_on = request.leave == Leave::kCycles || ring.cycle - phase_cycle_ >= request.cycles;
    if (!held_on) return false;
    if (request.leave == Leave::kRunning) return true;
    chained_ = request.chain;
    if (request.chain) return true;
    drift_ = 0;
    code(request.sub) = kNormalCommand;
    if (!request.sub) data3_ = 0;
    phase_ = Phase::kSettling;
    return !request.settle;
  }
  const bool standard = request.sub ? seen_value(response::kSubCodeEcho) == kNormalCommand
                                    : seen_value(response::kCodeEcho) == cyclic_ << 4;
  return standard;
}

bool AxisMaster::finished(const Step& step, RingState& ring) {
  switch (step.what) {
    case Do::kWait:
      return ring.now_ns - started_ns_ >= step.for_ns && ring.cycle - started_cycle_ >= step.cycles;
    case Do::kSync:
      return ring.slowest_sync >= syncs_reached_;
    case Do::kServoOn:
      if (!step.wait) return true;
      if (seen(response::kServoReady)) put(command::kServoOn, control_, 1);
      return seen(response::kServoActive);
    case Do::kServoOff:
      return !step.wait || !seen(response::kServoActive);
    case Do::kMove:
      return !step.wait || !moving_;
    case Do::kSpeed:
    case Do::kTorque:
      return level_ == level_goal_;
    case Do::kMode: {
      if (cyclic_ == step.mode) return seen_value(response::kCodeEcho) == cyclic_ << 4 || step.hurry;
      if (!step.hurry && ring.now_ns - mode_changed_ns_ < kModeChangeGap) return false;
      cyclic_ = step.mode;
      mode_changed_ns_ = ring.now_ns;
      moving_ = false;
      const std::int64_t actual = seen_value(response::kData1);
      planned_ = {step.first_value && cyclic_ == kCp ? *step.first_value * kMicro : actual * kMicro, 0};
      profile_target_ = static_cast<std::int32_t>(actual);
      level_goal_ = step.first_value ? *step.first_value * kMilli : 0;
      if (!step.first_value && cyclic_ == kCv) level_goal_ = seen_value(response::kData2) * kMilli;
      level_ = level_goal_;
      return false;
    }
    case Do::kStartProfile:
    case Do::kCommand:
      return run_request(step, ring);
    case Do::kProfileEnd:
      if (code_ == kProfileCommand) {
        if (seen(response::kInProgress)) return false;
        code_ = kNormalCommand;
        data3_ = 0;
      }
      return seen_value(response::kCodeEcho) == cyclic_ << 4;
    case Do::kSendNop:
      if (ring.cycle - started_cycle_ < step.cycles) return false;
      nop_ = false;
      return true;
    case Do::kJump:
    case Do::kProfileUpdate:
    case Do::kControl:
    case Do::kDrive:
      return true;
  }
  return true;
}

void AxisMaster::fill(MutableBytes block) {
  std::fill(block.begin(), block.end(), std::uint8_t{0});
  std::copy(control_.begin() + 2, control_.begin() + 4, block.begin() + 2);
  put(command::kMacId, block, drive_.config().mac_id);
  sent_code_ = code_;
  sent_sub_code_ = sub_code_;
  if (!nop_) put(command::kCode, block, cyclic_ << 4 | code_);
  std::int64_t data1 = planned_.position / kMicro;
  if (cyclic_ == kPp) data1 = profile_target_;
  if (cyclic_ == kCv || cyclic_ == kCt) data1 = level_ / kMilli;
  put(command::kData1, block, data1);
  if (code_ != kNormalCommand) {
    put(command::kTypeCode, block, type_);
    put(command::kIndex, block, index_);
  }
  put(command::kData3, block, data3_);
  if (!wide_) return;
  put(command::kSubChk, block, 1);
  put(command::kSubCode, block, sub_code_);
  if (sub_code_ != kNormalCommand) {
    put(command::kSubTypeCode, block, sub_type_);
    put(command::kSubIndex, block, sub_index_);
  }
}

}  // namespace servotrace::simulator::ring
