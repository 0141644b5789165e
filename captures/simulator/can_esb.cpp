// SPDX-License-Identifier: MIT
#include "captures/simulator/can_esb.hpp"

#include <cassert>
#include <cstdlib>
#include <utility>

#include "decoder/core/slot.hpp"
#include "decoder/profiles/nsk_esb/layouts.hpp"

namespace servotrace::simulator {
namespace {

using namespace esb;

constexpr std::int64_t kPulsesPerTurn = 819'200;
constexpr std::int64_t kHundredthsPerTurn = 36'000;
constexpr std::int64_t kStopDeceleration = 40'000'000;  // MD = 0: stop immediately
constexpr std::int64_t kSensorWidth = 8'000;            // pulses
constexpr std::int16_t kJump = 640;
constexpr std::int16_t kDivision = 660;
constexpr std::int16_t kTimer = 641;
constexpr std::uint16_t kProgramHome = 141;
constexpr std::int32_t kExecuteNext = 1;
constexpr std::int32_t kWaitForRun = 2;

template <class Value>
void put(Slot place, ByteVector& bytes, Value value) {
  const bool fitted = write(place, bytes, static_cast<std::int64_t>(value));
  assert(fitted);
  (void)fitted;
}

std::int64_t within_turn(std::int64_t position) {
  const std::int64_t rest = position % kPulsesPerTurn;
  return rest < 0 ? rest + kPulsesPerTurn : rest;
}

// Table 4-12 at the initial settings of EP, TO, HT, PE, AE, OU; the word of 800 from Table 5-10.
constexpr EsbAlarm kAlarms[] = {
    {"E2", false, false, false, -1, true, false}, {"F0", false, false, false, 0, false, false},
    {"F1", true, true, true, 1, false, true},     {"F2", true, true, true, 2, false, false},
    {"F3", true, true, true, 3, false, false},    {"F4", true, false, false, 4, false, false},
    {"F5", true, true, true, 5, false, true},     {"F8", true, true, true, -1, false, true},
    {"C2", true, false, true, 10, false, true},   {"C3", false, false, false, 11, true, false},
    {"A0", false, false, false, 16, true, false}, {"A1", false, false, false, 17, true, false},
    {"A3", false, false, false, 19, true, true},  {"A4", false, true, false, 20, true, true},
    {"A5", true, false, true, 21, false, false},  {"A8", true, true, false, -1, false, false},
    {"P0", false, false, false, 24, true, false}, {"P1", false, false, false, 25, true, false},
    {"P2", false, false, false, 26, true, false}, {"P3", false, false, false, 27, true, false},
};

}  // namespace

const EsbAlarm* find_esb_alarm(std::string_view name) {
  for (const EsbAlarm& alarm : kAlarms) {
    if (alarm.name == name) return &alarm;
  }
  return nullptr;
}

// The manual prints neither vendor nor product code: these stand for a drive nobody recognises by its identity.
Esb::Esb(CanBus& can, std::uint8_t mac_id, std::uint32_t serial_number)
    : Slave(can, {.mac_id = mac_id,
                  .identity = {.vendor_id = 999,
                               .device_type = 0,
                               .product_code = 1,
                               .major = 1,
                               .minor = 1,
                               .serial_number = serial_number,
                               .product_name = "ESB DRIVER UNIT"},
                  .command_size = kMessageSize,
                  .response_size = kMessageSize,
                  .poll_latency_ns = 600 * kMicrosecondNs}) {
  axis_.set_position(40'960);  // a twentieth of a turn from the home position
  Esb::restart();
}

void Esb::restart() {
  ticked_ns_ = now_ns();
  axis_.halt();
  last_ = {};
  work_ = Work::kNone;
  session_ = Session::kNone;
  acknowledge_ = processing_ = false;
  ++turn_;
  result_ = {};
  waits_for_run_ = false;
}

void Esb::lose_master() {
  catch_up();
  stop_motion();
  last_.svon = false;
}

void Esb::raise_alarm(const EsbAlarm& alarm) {
  catch_up();
  alarm_ = &alarm;
  if (alarm.servo_off) {
    axis_.halt();
    stop_motion();
  } else {
    stop_motion();
  }
}

void Esb::clear_alarm() { alarm_ = nullptr; }

void Esb::set_emergency_input(bool active) {
  catch_up();
  emergency_input_ = active;
  if (active) stop_motion();
}

void Esb::set_over_travel(bool plus, bool minus) {
  catch_up();
  over_plus_ = plus;
  over_minus_ = minus;
  if ((plus && axis_.speed() > 0) || (minus && axis_.speed() < 0)) stop_motion();
}

Esb::Input Esb::parse(Bytes bytes) {
  const auto bit = [&](Slot place) { return read(place, bytes) != 0; };
  Input input;
  input.emst = bit(slot(kInput, "emst"));
  input.svon = bit(slot(kInput, "svon"));
  input.run = bit(slot(kInput, "run"));
  input.stp = bit(slot(kInput, "stp"));
  input.clr = bit(slot(kInput, "clr"));
  input.ioff = bit(slot(kInput, "ioff"));
  input.hos = bit(slot(kInput, "hos"));
  input.ord = bit(slot(kInput, "ord"));
  input.jog = bit(slot(kInput, "jog"));
  input.dir = bit(slot(kInput, "dir"));
  input.request = bit(slot(kInput, "prm_req"));
  input.write = bit(slot(kInput, "prm_ope"));
  input.channel = static_cast<std::uint8_t>(read(slot(kInput, "prg"), bytes));
  input.number = static_cast<std::int16_t>(read(slot(kInput, "prm_set_no"), bytes));
  input.data = static_cast<std::int32_t>(read(slot(kInput, "prm_set_data"), bytes));
  return input;
}

bool Esb::can_start() const {
  const bool ready = alarm_ == nullptr || alarm_->drdy;
  return ready && last_.svon && !last_.stp && !emergency();
}

void Esb::stop_motion() {
  if (work_ == Work::kHome) homed_ = false;  // a home return interrupted (4.4.6)
  work_ = Work::kNone;
  waits_for_run_ = false;
  axis_.stop(kStopDeceleration);
}

void Esb::take_command(Bytes bytes) {
  catch_up();
  const Input before = std::exchange(last_, parse(bytes));
  if (last_.emst && !before.emst) stop_motion();
  if (!last_.svon && before.svon) {
    stop_motion();
    axis_.halt();
  }
  if (last_.stp && !before.stp) stop_motion();
  if (last_.clr && !before.clr && alarm_ != nullptr && alarm_->cleared_by_clr) alarm_ = nullptr;
  if (last_.run && !before.run && !ignore_run) {
    if (waits_for_run_) {
      waits_for_run_ = false;
      go_on();
    } else {
      start_program(last_.channel);
    }
  }
  if (last_.hos && !before.hos) start_home();
  const std::int64_t jog_speed = scaled_speed(parameter(122)) * (last_.dir ? -1 : 1);
  if (last_.jog && !before.jog && can_start() && !axis_.moving()) {
    work_ = Work::kJog;
    at_home_ = false;
    axis_.acceleration = axis_.deceleration = std::int64_t{parameter(123)} * 8192;
    axis_.turn(jog_speed);
  } else if (work_ == Work::kJog && last_.jog && last_.dir != before.dir) {
    axis_.turn(jog_speed);
  } else if (work_ == Work::kJog && !last_.jog && before.jog) {
    axis_.turn(0);
  }
  if (last_.request && !before.request) begin_transaction();
  if (!last_.request && before.request) {
    ++turn_;  // a request taken back before its end is forgotten
    processing_ = false;
    hold_until_ns_ = now_ns() + std::exchange(acknowledge_hold_ns, 0);
    if (hold_until_ns_ == now_ns()) acknowledge_ = false;
  }
}

// s^-1 in ten thousandths to pulses a second, with the override in force at the start (7.1.1).
std::int64_t Esb::scaled_speed(std::int32_t velocity) const {
  const std::int64_t plain = std::int64_t{velocity} * kPulsesPerTurn / 10'000;
  return last_.ord ? plain * parameter(131) / 100 : plain;
}

// 400-411, and 600-611 of a program.
bool Esb::position(std::int16_t number, std::int32_t data, std::int32_t velocity, std::int32_t acceleration,
                   Division division) {
  const int kind = number % 100;
  const std::int64_t now = axis_.position();
  const bool degrees = kind <= 3 || kind == 8 || kind == 9;
  const std::int64_t pulses = degrees ? data * kPulsesPerTurn / kHundredthsPerTurn : std::int64_t{data};
  std::int64_t distance = 0;
  if (kind >= 8) {
    // The parts of a divided positioning make up its whole distance exactly.
    const std::int64_t part = pulses * (division.part + 1) / division.parts - pulses * division.part / division.parts;
    distance = (kind == 9 || kind == 11) && last_.dir ? -part : part;
  } else {
    const std::int64_t ahead = within_turn(pulses - now);
    switch (kind % 4) {
      case 0:
        distance = ahead <= kPulsesPerTurn / 2 ? ahead : ahead - kPulsesPerTurn;
        break;
      case 1:
        distance = ahead;
        break;
      case 2:
        distance = ahead - kPulsesPerTurn;
        break;
      default:
        distance = last_.dir ? ahead - kPulsesPerTurn : ahead;
        break;
    }
  }
  at_home_ = false;
  axis_.acceleration = axis_.deceleration = std::int64_t{acceleration} * 8192;
  axis_.move_to(now + distance, scaled_speed(velocity));  // at OV = 0 the motor does not turn
  return true;
}

bool Esb::start_home() {
  if (!can_start() || axis_.moving()) return false;
  work_ = Work::kHome;
  const std::int64_t rest = within_turn(axis_.position());
  const std::int64_t distance = parameter(142) == 0 ? kPulsesPerTurn - rest : rest == 0 ? -kPulsesPerTurn : -rest;
  axis_.acceleration = axis_.deceleration = std::int64_t{parameter(125)} * 8192;
  at_home_ = false;
  axis_.move_to(axis_.position() + distance, scaled_speed(parameter(124)));
  return true;
}

bool Esb::start_program(std::uint8_t channel) {
  if (!can_start() || axis_.moving() || work_ != Work::kNone) return false;
  work_ = Work::kProgram;
  waits_for_run_ = false;
  homes_first_ = parameter(kProgramHome) == 2 || (parameter(kProgramHome) == 1 && !homed_);
  return go_to(channel);
}

// An empty channel is a program error (F5).
bool Esb::go_to(std::int64_t channel) {
  command_started_ = false;
  if (channel < static_cast<std::int64_t>(programs_.size()) && !programs_[static_cast<std::size_t>(channel)].empty()) {
    running_channel_ = static_cast<std::uint8_t>(channel);
    running_line_ = 0;
    return true;
  }
  alarm_ = find_esb_alarm("F5");
  work_ = Work::kNone;
  return false;
}

void Esb::go_on() {
  if (running_line_ + 1 < programs_[running_channel_].size()) {
    ++running_line_;
    command_started_ = false;
  } else {
    go_to(running_channel_ + 1);
  }
}

std::int32_t Esb::Line::option(std::int16_t number_of_it, std::int32_t otherwise) const {
  const auto found = options.find(number_of_it);
  return found == options.end() ? otherwise : found->second;
}

void Esb::move_home() {
  const std::int64_t rest = within_turn(axis_.position());
  axis_.acceleration = axis_.deceleration = std::int64_t{parameter(125)} * 8192;
  axis_.move_to(axis_.position() - rest, scaled_speed(parameter(124)));
}

void Esb::run_command() {
  Line& line = programs_[running_channel_][running_line_];
  command_started_ = true;
  timer_ms_ = 0;
  if (homes_first_ || line.number == 620) {
    move_home();
  } else if (line.number == kTimer) {
    timer_ms_ = std::int64_t{line.data} * 10;  // one decimal place of 100 ms
  } else if (line.number != kJump) {
    // The manual names the division and its range (Table 5-9): here every start goes one part of the distance.
    const std::int32_t parts = line.option(kDivision, 1);
    position(line.number, line.data, line.option(662, parameter(120)), line.option(663, parameter(121)),
             {parts, line.parts_done % parts});
    line.parts_done = (line.parts_done + 1) % parts;
  }
}

void Esb::tick_program() {
  if (waits_for_run_) return;
  if (!command_started_) {
    run_command();
    return;
  }
  if (timer_ms_ > 0) {
    --timer_ms_;
    return;
  }
  if (axis_.moving()) return;
  const Program& program = programs_[running_channel_];
  const Line& line = program[running_line_];
  if (homes_first_ || line.number == 620) {
    homed_ = true;
    at_home_ = true;
  }
  if (homes_first_) {
    homes_first_ = false;
    command_started_ = false;
    return;
  }
  const std::int32_t sequence = line.option(661, 0);
  if (line.number == kJump) {
    go_to(line.data);
  } else if (sequence == kWaitForRun) {
    waits_for_run_ = true;  // the channel shown is still this one (4.4.9)
  } else if (line.number == kTimer || sequence == kExecuteNext || running_line_ + 1 < program.size()) {
    go_on();
  } else {
    work_ = Work::kNone;
  }
}

void Esb::catch_up() {
  while (ticked_ns_ + kMillisecondNs <= now_ns()) {
    ticked_ns_ += kMillisecondNs;
    tick();
  }
}

void Esb::tick() {
  axis_.tick();
  if (work_ == Work::kProgram) {
    tick_program();
  } else if (work_ != Work::kNone && !axis_.moving()) {
    if (work_ == Work::kHome) {
      homed_ = true;
      at_home_ = true;
    }
    work_ = Work::kNone;
  }
  if (acknowledge_ && !last_.request && ticked_ns_ >= hold_until_ns_) acknowledge_ = false;
}

ByteVector Esb::make_response() {
  catch_up();
  ByteVector bytes(kMessageSize, 0);
  const bool busy = work_ != Work::kNone || axis_.moving();
  const bool drdy = emergency() || alarm_ == nullptr || alarm_->drdy;
  const bool servo_on = last_.svon && drdy && !(alarm_ != nullptr && alarm_->servo_off);
  const std::int64_t to_go = std::abs(axis_.target() - axis_.position());
  put(slot(kOutput, "drdy"), bytes, drdy);
  put(slot(kOutput, "over"), bytes, alarm_ != nullptr && alarm_->over);
  put(slot(kOutput, "ipos"), bytes, servo_on && !axis_.moving());
  put(slot(kOutput, "busy"), bytes, busy);
  put(slot(kOutput, "brk"), bytes, servo_on && !emergency() && (alarm_ == nullptr || alarm_->brk));
  put(slot(kOutput, "hcmp"), bytes, homed_);
  put(slot(kOutput, "home"), bytes, at_home_ && !axis_.moving());
  put(slot(kOutput, "spd"), bytes, std::abs(axis_.speed()) < std::int64_t{parameter(263)} * kPulsesPerTurn / 100);
  put(slot(kOutput, "ack_prg"), bytes, work_ == Work::kProgram ? running_channel_ : last_.channel);
  put(slot(kOutput, "emsta"), bytes, emergency());
  put(slot(kOutput, "otpa"), bytes, over_plus_);
  put(slot(kOutput, "otma"), bytes, over_minus_);
  const std::int64_t place = within_turn(axis_.position());
  put(slot(kOutput, "hlsa"), bytes, place < kSensorWidth || place > kPulsesPerTurn - kSensorWidth);
  const bool positioned = axis_.mode() == MotionAxis::Mode::kPosition || axis_.mode() == MotionAxis::Mode::kStill;
  put(slot(kOutput, "neara"), bytes, servo_on && positioned && to_go <= parameter(267));
  put(slot(kOutput, "nearb"), bytes, servo_on && positioned && to_go <= parameter(268));
  put(slot(kOutput, "prm_ack"), bytes, acknowledge_);
  put(slot(kOutput, "prm_sts"), bytes, acknowledge_ && result_.success);
  put(slot(kOutput, "prm_get_no"), bytes, result_.number);
  put(slot(kOutput, "prm_get_data"), bytes, result_.data);
  return bytes;
}

ExplicitReply Esb::serve(const ExplicitRequest&) { return ExplicitReply::error(status::kObjectDoesNotExist); }

}  // namespace servotrace::simulator
