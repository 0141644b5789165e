// SPDX-License-Identifier: MIT
// A MINAS-A5N on an RTEX ring, as SX-DSV02203 describes it: it takes a command block each communication cycle and
// fills the response block. What the manual leaves open (how long a parameter write takes, how fast the motor gains
// speed) is a plain number here, not a statement about real drives.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "captures/simulator/rtex_block.hpp"
#include "captures/simulator/rtex_motion.hpp"
#include "decoder/core/time.hpp"

namespace servotrace::simulator::ring {

// Communication cycle and updating ratio of the ring (2-5-1).
struct Timing {
  std::int64_t cycles_per_second = 2000;  // 12000, 6000, 2000 or 1000
  std::uint32_t cycle_ns = 500'000;       // as the record header carries it
  int ratio = 1;                          // communication cycles an updating cycle
  bool full_sync = false;                 // Pr7.22 bit 1

  DurationNs start_of(std::int64_t cycle) const { return cycle * kSecondNs / cycles_per_second; }
};

struct AlarmCode {
  std::uint8_t main = 0;
  std::uint8_t sub = 0;
};

struct Sensor {
  std::int32_t from = 0;  // command units; active from `from` up to `to`
  std::int32_t to = -1;
};

struct DriveConfig {
  std::uint8_t mac_id = 0;
  bool wide = false;  // 32-byte mode
  bool absolute = false;
  bool full_closed = false;
  std::int32_t position = 0;
  std::int32_t units_per_rev = 10'000;
  std::int32_t max_rpm = 6'000;
  std::int32_t max_torque = 3'000;  // 0.1 %
  DurationNs servo_on_ns = 4'000'000;
  DurationNs ready_ns = 3'000'000;  // from the first cyclic command to Servo_Ready
  std::map<std::uint16_t, std::int32_t> parameters;
  std::optional<Sensor> home;
  std::optional<Sensor> pot;
  std::optional<Sensor> not_;
  bool inputs_as_ext = true;  // EXT1..EXT3 instead of SI-MON1..3
  AlarmCode alarm;            // present from the start
  std::uint8_t warning = 0;   // present from the start
  std::string model = "MADHT1507NA1";
  std::string serial = "10090001";
};

// One channel of non-cyclic commands: main, or the sub-command of 32-byte mode.
struct DriveChannel {
  // The last command seen.
  int code = 0;
  int type = 0;
  int index = 0;
  std::int32_t setting = 0;
  // The process started last; its echo stays until the next one starts (3-3-4).
  int run_code = 0;
  int run_type = 0;
  int run_index = 0;
  std::int32_t run_setting = 0;
  std::int32_t result = 0;
  bool err = false;
  bool wng = false;
  bool busy = false;
  DurationNs busy_ns = 0;  // left, where time ends it
  int error = 0;           // command error of the present command
  bool executed = false;   // the present command was started
};

class A5nDrive {
 public:
  A5nDrive(DriveConfig config, Timing timing);

  // The response block this cycle carries: the counter of the command one cycle before, the code of the one two cycles
  // before (3-1). Call before the cycle's command is received.
  void respond(MutableBytes response) const;
  // This cycle's command block; nothing where the drive saw a CRC error.
  void receive(Bytes command);
  void receive_broken();

  const DriveConfig& config() const { return config_; }
  // Restarting after a software reset: it answers nothing until restart() (6-3-1).
  bool in_reset() const { return in_reset_; }
  void restart();

  // What happens to the drive from outside.
  void raise_alarm(AlarmCode code);
  void raise_warning(std::uint8_t code) { warning_ = code; }
  void set_input(unsigned bit, bool active);
  void set_main_power(bool on) { main_power_ = on; }
  void set_busy(DurationNs busy_ns) { next_busy_ns_ = busy_ns; }
  void fail_next(bool err, bool wng) { next_err_ = err, next_wng_ = wng; }
  void hold_echo(bool hold) { hold_echo_ = hold; }
  void block_motor(bool blocked) { blocked_ = blocked; }

  std::int32_t actual_position() const { return to_units(motor_.position); }
  bool servo_active() const { return servo_active_; }

 private:
  static std::int32_t to_units(std::int64_t micro);
  std::int32_t parameter(unsigned parameter_class, unsigned number, std::int32_t otherwise = 0) const;
  std::int32_t speed_in_unit(std::int64_t micro_per_second) const;  // by Pr7.25
  std::int64_t speed_from_unit(std::int64_t value) const;
  bool is_moving() const;
  bool extend_mode() const { return (parameter(7, 23) & 0x20) != 0; }
  bool profile_runs() const { return profile_.type != 0; }
  bool profile_is_exclusive() const;  // 12h, 13h, 31h to 33h

  // rtex_drive.cpp
  void process(Bytes command);
  int check_header(Bytes command);
  int check_mode(int cyclic);
  void enter_mode(int cyclic);
  void count_update(int counter);
  void update_servo(bool servo_on);
  void move(Bytes command);
  void move_profile();
  void follow(std::int64_t target);
  void watch_triggers(std::int64_t before);
  std::uint8_t input_byte() const;
  void refuse_after_stop(bool toward);
  bool feeds_toward_input(Bytes command) const;   // feedforward in the inhibited direction
  bool is_inhibited(std::int64_t command) const;  // its sign is that direction
  int inhibited_direction() const;                // 1 POT, -1 NOT, 0 neither or both

  // rtex_drive_commands.cpp
  void process_main(Bytes command, int cyclic);
  void process_sub(Bytes command);
  int check_command(DriveChannel& channel, int cyclic, bool sub, std::int32_t data3);
  int check_homing(const DriveChannel& channel, int cyclic) const;
  int check_alarm(const DriveChannel& channel) const;
  int check_parameter(const DriveChannel& channel) const;
  int check_profile(const DriveChannel& channel) const;
  void start_command(DriveChannel& channel, Bytes command);
  void finish_command(DriveChannel& channel);
  void start_homing(DriveChannel& channel);
  void start_profile(DriveChannel& channel, Bytes command);
  void leave_command(const DriveChannel& channel, int next_code);
  void run_channel(DriveChannel& channel);
  std::int32_t monitor(int type) const;
  std::string system_text(int type) const;
  std::int32_t command_result(const DriveChannel& channel) const;
  std::int32_t attribute_of_alarm(const DriveChannel& channel) const;
  static std::int32_t attribute_of_parameter(int index);
  void home_at(std::int64_t reference);
  void respond_main(MutableBytes response) const;
  void respond_sub(MutableBytes response) const;

  struct Profile {
    int type = 0;  // 0: none
    std::int64_t target = 0;
    std::int64_t speed = 0;
    int latch_source = 0;
    int phase = 0;
    bool latched = false;
  };
  struct Latch {
    bool waiting = false;
    bool complete = false;
    int source = 0;
    std::int32_t position = 0;
  };

  DriveConfig config_;
  Timing timing_;
  DurationNs step_ns_ = 0;  // between two processings
  std::map<std::uint16_t, std::int32_t> parameters_;

  // Data exchange.
  std::array<std::uint8_t, kWideBlock> received_{};  // the last block taken
  bool has_received_ = false;
  bool broken_ = false;
  int counter_echo_ = 0;
  std::int64_t cycle_ = 0;  // received so far

  // Command and response process.
  int code_echo_ = 0;
  int header_error_ = 0;  // 0011h, 0012h, 0021h, 002Eh
  bool sub_chk_error_ = false;
  int header_errors_running_ = 0;
  int update_counter_ = -1;  // of the command processed last
  int still_ = 0;            // processings since it moved
  int missed_updates_ = 0;   // Err86.2, where Pr7.38 is above 1
  int mode_ = kNoOperation;  // cyclic code in force
  DurationNs since_mode_change_ns_ = 0;
  DurationNs since_cyclic_ns_ = -1;  // since the first cyclic command, -1 before it
  DriveChannel main_;
  DriveChannel sub_;
  int sub_code_echo_ = 0;

  // Servo.
  bool servo_on_command_ = false;
  DurationNs servo_on_left_ns_ = 0;
  bool servo_active_ = false;
  bool main_power_ = true;
  Ramp motor_;                // actual
  std::int64_t command_ = 0;  // internal command position, micro units
  std::int64_t cp_from_ = 0;
  std::int64_t cp_to_ = 0;
  int cp_step_ = 0;
  int cp_counter_ = -1;
  bool cp_first_ = true;
  std::int64_t offset_ = 0;  // machine position minus actual position: what homing moved
  std::int32_t torque_ = 0;
  bool torque_limited_ = false;
  bool blocked_ = false;
  bool inhibited_ = false;          // the command goes on in the inhibited direction: 0046h
  bool stopping_at_input_ = false;  // in PP, after a positioning toward the input was cut off
  bool homing_complete_ = false;
  bool homing_lock_ = false;  // after Homing_Complete while 24h is held: servo-lock
  Profile profile_;
  std::array<Latch, 2> latches_{};
  bool hard_stop_ = false;
  bool smooth_stop_ = false;
  bool pause_ = false;
  bool homing_ctrl_ = false;

  std::uint8_t inputs_ = 0;
  std::uint8_t last_inputs_ = 0;
  AlarmCode alarm_;
  std::uint8_t warning_ = 0;
  std::vector<AlarmCode> history_;
  bool in_reset_ = false;
  std::optional<DurationNs> next_busy_ns_;
  bool next_err_ = false;
  bool next_wng_ = false;
  bool hold_echo_ = false;
};

}  // namespace servotrace::simulator::ring
