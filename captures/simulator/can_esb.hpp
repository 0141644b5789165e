// SPDX-License-Identifier: MIT
// A Megatorque ESB driver unit with DeviceNet (NSK ESB manual): the ten bytes each way of 4.2, the parameter handshake
// of 5.2, internal programs of 5.3, the numbers of 5.4. Written from the manual, independently of the decoder's
// sessions.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "captures/simulator/can_axis.hpp"
#include "captures/simulator/can_slave.hpp"

namespace servotrace::simulator {

// A row of Table 4-12: which outputs an alarm shows at its initial setting, and its bit in the word of monitor 800.
struct EsbAlarm {
  std::string_view name;  // "F1"
  bool drdy = false;
  bool over = false;
  bool brk = false;
  int bit = -1;  // -1: the word has none
  bool servo_off = false;
  bool cleared_by_clr = false;
};
const EsbAlarm* find_esb_alarm(std::string_view name);

class Esb : public Slave {
 public:
  Esb(CanBus& bus, std::uint8_t mac_id, std::uint32_t serial_number);

  // What happens around the drive.
  void raise_alarm(const EsbAlarm& alarm);
  void clear_alarm();                     // its cause is gone
  void set_emergency_input(bool active);  // of CN2
  void set_over_travel(bool plus, bool minus);
  void set_homed(bool homed) { homed_ = homed; }
  void set_parameter(std::uint16_t number, std::int32_t value) { parameters_[number] = value; }
  std::int32_t parameter(std::uint16_t number) const;

  // Faults put in by a scenario.
  std::optional<bool> next_result;               // PRM_STS of the next transaction
  std::optional<std::int16_t> next_number;       // PRM_GET_NO of it
  std::optional<DurationNs> next_processing_ns;  // how long it takes
  DurationNs acknowledge_hold_ns = 0;            // PRM_ACK stays so long after PRM_REQ fell, once
  bool ignore_run = false;

 protected:
  void take_command(Bytes command) override;
  ByteVector make_response() override;
  ExplicitReply serve(const ExplicitRequest& request) override;
  void restart() override;
  void lose_master() override;

 private:
  struct Input {
    bool emst = false, svon = false, run = false, stp = false, clr = false, ioff = false, hos = false, ord = false;
    bool jog = false, dir = false, request = false, write = false;
    std::uint8_t channel = 0;
    std::int16_t number = 0;
    std::int32_t data = 0;
  };
  // A line of a channel: a command and its optional codes. The lines of a channel follow each other; behind the last
  // one sequence code * goes on with the next channel, & does so at the next RUN.
  struct Line {
    std::int16_t number = 0;
    std::int32_t data = 0;
    std::map<std::int16_t, std::int32_t> options;
    std::int32_t parts_done = 0;  // of a divided positioning (660)
    std::int32_t option(std::int16_t number_of_it, std::int32_t otherwise) const;
  };
  using Program = std::vector<Line>;
  struct Result {
    bool success = false;
    std::int16_t number = 0;
    std::int32_t data = 0;
  };
  enum class Session : std::uint8_t { kNone, kEdit, kRead };
  enum class Work : std::uint8_t { kNone, kCommand, kHome, kJog, kProgram };

  static Input parse(Bytes bytes);
  void catch_up();
  void tick();
  void tick_program();
  bool emergency() const { return last_.emst || emergency_input_; }
  bool can_start() const;
  void stop_motion();
  std::int64_t scaled_speed(std::int32_t velocity) const;
  // `part` of `parts`: division of indexing points (660), one part a start.
  struct Division {
    std::int64_t parts = 1;
    std::int64_t part = 0;
  };
  bool position(std::int16_t number, std::int32_t data, std::int32_t velocity, std::int32_t acceleration,
                Division division = {1, 0});
  bool start_home();
  bool start_program(std::uint8_t channel);
  void run_command();
  bool go_to(std::int64_t channel);
  void go_on();  // with the next line, or the next channel
  void move_home();

  void begin_transaction();
  void finish_transaction();
  Result process(const Input& input);
  Result process_program(const Input& input);
  Result read_number(std::int16_t number);
  Result write_number(std::int16_t number, std::int32_t data);
  std::int32_t monitor(std::int16_t number) const;

  MotionAxis axis_;
  TimeNs ticked_ns_ = 0;
  Input last_;
  std::map<std::uint16_t, std::int32_t> parameters_;
  const EsbAlarm* alarm_ = nullptr;
  bool emergency_input_ = false;
  bool over_plus_ = false;
  bool over_minus_ = false;
  bool homed_ = true;
  bool at_home_ = false;
  Work work_ = Work::kNone;
  std::uint8_t running_channel_ = 0;
  std::size_t running_line_ = 0;
  bool homes_first_ = false;  // PH: a home return goes before the program
  bool command_started_ = false;
  bool waits_for_run_ = false;
  std::int64_t timer_ms_ = 0;
  std::array<Program, 64> programs_;
  Session session_ = Session::kNone;
  std::uint8_t session_channel_ = 0;
  bool edit_begins_ = false;     // its first command replaces what the channel held
  std::vector<Result> listing_;  // what 820 has still to return
  bool acknowledge_ = false;
  bool processing_ = false;
  Result result_;
  std::uint64_t turn_ = 0;  // of transactions, so that an old one's end does not touch a new one
  TimeNs hold_until_ns_ = 0;
};

}  // namespace servotrace::simulator
