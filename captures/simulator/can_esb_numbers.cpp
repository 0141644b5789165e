// SPDX-License-Identifier: MIT
// The numbers of 5.4 and the transactions of 5.2 and 5.3 of the ESB: what a request does, and whether it succeeds.
#include <algorithm>
#include <utility>

#include "captures/simulator/can_esb.hpp"

namespace servotrace::simulator {
namespace {

constexpr DurationNs kReadNs = 3 * kMillisecondNs;
constexpr DurationNs kWriteNs = 12 * kMillisecondNs;    // with backup in EEPROM
constexpr DurationNs kSystemNs = 400 * kMillisecondNs;  // 320, 321
constexpr DurationNs kTuningNs = 4 * kSecondNs;         // 300 to 302

constexpr std::int32_t kFar = 99'999'999;

// Tables 5-3 to 5-5: number, initial value and range without decimal point.
struct Row {
  std::uint16_t number;
  std::int32_t initial;
  std::int32_t minimum;
  std::int32_t maximum;
};
constexpr Row kRows[] = {
    {1, 100, 10, 1000},
    {2, 10, 1, 2550},
    {3, 10, 1, 2550},
    {4, 100, 10, 6300},
    {5, 100, 10, 6300},
    {6, 1, 0, 1},
    {7, 50, 0, 100},
    {8, 100, 0, 100},
    {9, 0, 0, 1000},
    {10, 5, 0, 1000},
    {20, 0, 0, 300},
    {21, 0, 0, 500},
    {22, 0, 0, 500},
    {23, 0, 0, 500},
    {24, 0, 0, 500},
    {25, 25, 10, 500},
    {26, 0, 0, 4095},
    {27, 1000, 0, 1000},
    {28, 0, 0, 10'000},
    {29, 0, 0, 2047},
    {40, 50'000, 1, kFar},
    {41, 100, 0, kFar},
    {42, 0, 0, 1000},
    {43, 10, -1000, 1000},
    {44, 2730, 1, 5461},
    {45, 100, 0, 1000},
    {46, 409'600, 204'800, 819'200},
    {50, 1000, 1, kFar},
    {62, -3, -3, 1},
    {80, 0, 0, 1},
    {81, 0, 0, 1},
    {82, 1, 0, 1},
    {100, 1, 1, 1},
    {101, 0, 0, 1},
    {102, 0, -kFar, kFar},
    {103, 0, -kFar, kFar},
    {104, 0, 0, 819'199},
    {120, 10'000, 1, 30'000},
    {121, 100, 1, 128'000},
    {122, 1000, 1, 30'000},
    {123, 100, 1, 128'000},
    {124, 2000, 1, 30'000},
    {125, 100, 1, 128'000},
    {126, 100, 1, 2000},
    {127, 0, 0, 128'000},
    {131, 100, 0, 200},
    {140, 4, 1, 6},
    {141, 0, 0, 2},
    {142, 1, 0, 1},
    {143, 0, -802'816, 802'816},
    {160, 700, 24, 1048},
    {161, 50, 0, 100},
    {162, 50, 0, 100},
    {163, 0, 0, 1},
    {164, 2048, 0, 4095},
    {180, 0, 0, 0x53},
    {181, 0, 0, 4},
    {182, 0, 0, 2},
    {190, 0, 0, 1},
    {191, 20, 0, 300},
    {192, 20, 0, 300},
    {200, 0, 0, 1},
    {220, 0, 0, 50'000},
    {221, 0, 0, 30},
    {240, 3, 3, 3},
    {241, 0, 0, 128'000},
    {260, 0, 0, 1000},
    {261, 0, 0, 102'400},
    {262, 0, 0, 1},
    {263, 0, 0, 300},
    {264, 0, 0, 1000},
    {265, 0, 0, 1000},
    {266, 0, 0, 1000},
    {267, 100, 1, kFar},
    {268, 100, 1, kFar},
    {269, 0, -kFar, kFar},
    {270, 0, -kFar, kFar},
    {271, 0, -kFar, kFar},
    {272, 0, -kFar, kFar},
    {280, 0, 0, 2},
    {281, 2, 1, 3},
    {282, 2, 1, 2},
    {283, 2, 0, 2},
    {284, 2, 0, 2},
    {285, 2, 0, 2},
};

const Row* find_row(std::int32_t number) {
  for (const Row& row : kRows) {
    if (row.number == number) return &row;
  }
  return nullptr;
}

// The range of a positioning by its last two digits (Tables 5-7, 5-9).
bool target_in_range(std::int16_t number, std::int32_t data) {
  switch (number % 100) {
    case 0:
    case 1:
    case 2:
    case 3:
      return data >= 0 && data <= 35'999;
    case 4:
    case 5:
    case 6:
    case 7:
      return data >= 0 && data <= 819'199;
    case 8:
    case 9:
      return data >= -9'999'999 && data <= 9'999'999;
    case 10:
      return data >= -kFar && data <= kFar;
    case 11:
      return data >= 0 && data <= kFar;
    default:
      return false;
  }
}

bool is_program_command(std::int16_t number) {
  return (number >= 600 && number <= 611) || number == 620 || number == 640 || number == 641;
}

// Table 5-2.
bool option_allowed(std::int16_t command, std::int16_t option) {
  if (command >= 600 && command <= 607) return option >= 661;
  if (command >= 608 && command <= 611) return true;
  return command == 620 && option == 661;
}

bool option_in_range(std::int16_t option, std::int32_t data) {
  switch (option) {
    case 660:
      return data == 0 || (data >= 2 && data <= 99);
    case 661:
      return data >= 0 && data <= 2;
    case 662:
      return data >= 0 && data <= 30'000;
    default:
      return data >= 0 && data <= 128'000;
  }
}

}  // namespace

std::int32_t Esb::parameter(std::uint16_t number) const {
  if (const auto found = parameters_.find(number); found != parameters_.end()) return found->second;
  const Row* row = find_row(number);
  return row == nullptr ? 0 : row->initial;
}

void Esb::begin_transaction() {
  const std::int16_t number = last_.number;
  DurationNs takes_ns = last_.write ? kWriteNs : kReadNs;
  if (last_.write && number >= 300 && number <= 302) takes_ns = kTuningNs;
  if (last_.write && (number == 320 || number == 321)) takes_ns = kSystemNs;
  if (last_.write && number >= 400) takes_ns = kReadNs;
  takes_ns = std::exchange(next_processing_ns, std::nullopt).value_or(takes_ns);
  processing_ = true;
  const Input input = last_;
  bus().after(takes_ns, [this, input, turn = ++turn_] {
    if (turn != turn_ || !processing_) return;
    catch_up();
    result_ = process(input);
    finish_transaction();
  });
}

void Esb::finish_transaction() {
  processing_ = false;
  acknowledge_ = true;
  if (next_result) result_.success = *std::exchange(next_result, std::nullopt);
  if (next_number) result_.number = *std::exchange(next_number, std::nullopt);
}

Esb::Result Esb::process(const Input& input) {
  const Result failed{false, input.number, input.data};
  if (session_ == Session::kEdit) return process_program(input);
  if (session_ == Session::kRead) {
    if (input.write && input.number == 502) {
      session_ = Session::kNone;
      return {true, input.number, input.data};
    }
    if (input.write || input.number != 820) return failed;
    if (listing_.empty()) return {true, -1, 0};
    const Result next = listing_.front();
    listing_.erase(listing_.begin());
    return next;
  }
  return input.write ? write_number(input.number, input.data) : read_number(input.number);
}

Esb::Result Esb::process_program(const Input& input) {
  const Result failed{false, input.number, input.data};
  if (!input.write) return failed;
  Program& program = programs_[session_channel_];
  if (input.number == 502) {
    session_ = Session::kNone;
  } else if (is_program_command(input.number)) {
    const bool fits = input.number == 620   ? true
                      : input.number == 640 ? input.data >= 0 && input.data <= 63
                      : input.number == 641 ? input.data >= 3 && input.data <= 1000
                                            : target_in_range(input.number, input.data);
    if (!fits) return failed;
    if (edit_begins_) program.clear();
    edit_begins_ = false;
    program.push_back({input.number, input.data, {}});
  } else if (input.number >= 660 && input.number <= 663) {
    if (program.empty() || !option_allowed(program.back().number, input.number) ||
        !option_in_range(input.number, input.data)) {
      return failed;
    }
    if (input.data == 0) {
      program.back().options.erase(input.number);
    } else {
      program.back().options[input.number] = input.data;
    }
  } else {
    return failed;
  }
  return {true, input.number, input.data};
}

Esb::Result Esb::read_number(std::int16_t number) {
  if (find_row(number) != nullptr) return {true, number, parameter(static_cast<std::uint16_t>(number))};
  if (number == 800 || (number >= 840 && number <= 850)) return {true, number, monitor(number)};
  return {false, number, 0};
}

Esb::Result Esb::write_number(std::int16_t number, std::int32_t data) {
  const Result failed{false, number, data};
  const Result done{true, number, data};
  if (const Row* row = find_row(number)) {
    const bool brake_timer = number == 191 || number == 192;
    if (!brake_timer && (data < row->minimum || data > row->maximum)) return failed;
    parameters_[static_cast<std::uint16_t>(number)] = data;
    if (number == 101) homed_ = false;
    return done;
  }
  if (number >= 400 && number <= 411) {
    if (!target_in_range(number, data) || !can_start() || axis_.moving() || work_ != Work::kNone) return failed;
    work_ = Work::kCommand;
    position(number, data, parameter(120), parameter(121));
    return done;
  }
  if (number >= 500 && number <= 503 && number != 502 && (data < 0 || data > 63)) return failed;
  switch (number) {
    case 300:
    case 301:
    case 302:
    case 321:
      return done;
    case 320:
      if (data < 0 || data > 3) return failed;
      parameters_.clear();
      return done;
    case 330:
      return data == 0 || data == 1 ? done : failed;
    case 412:
      return data >= 0 && data <= 63 && start_program(static_cast<std::uint8_t>(data)) ? done : failed;
    case 420:
      return start_home() ? done : failed;
    case 500:
      session_ = Session::kEdit;
      edit_begins_ = true;
      session_channel_ = static_cast<std::uint8_t>(data);
      return done;
    case 501:
      session_ = Session::kRead;
      listing_.clear();
      for (const Line& line : programs_[static_cast<std::size_t>(data)]) {
        listing_.push_back({true, line.number, line.data});
        for (const auto& [option, value] : line.options) listing_.push_back({true, option, value});
      }
      return done;
    case 502:
      return done;
    case 503:
      programs_[static_cast<std::size_t>(data)] = {};
      return done;
    default:
      return failed;
  }
}

// Tables 5-10 to 5-13. Positions in pulses of a turn; the error counter is empty: the axis follows without error.
std::int32_t Esb::monitor(std::int16_t number) const {
  constexpr std::int64_t kTurn = 819'200;
  const std::int64_t place = (axis_.position() % kTurn + kTurn) % kTurn;
  const std::int32_t busy = work_ != Work::kNone || axis_.moving() ? 1 : 0;
  const std::int32_t still = axis_.moving() ? 0 : 1;
  const std::int32_t ready = alarm_ == nullptr || alarm_->drdy ? 1 : 0;
  switch (number) {
    case 800:
      return alarm_ == nullptr || alarm_->bit < 0 ? 0 : static_cast<std::int32_t>(std::uint32_t{1} << alarm_->bit);
    case 840:
    case 841:
      return (last_.svon ? 1 << 11 : 0) | (emergency() ? 1 << 10 : 0) | (over_minus_ ? 1 << 5 : 0) |
             (over_plus_ ? 1 << 4 : 0) | ready << 3 | (last_.svon ? 1 << 2 : 0) | still << 1 | (at_home_ ? 1 : 0);
    case 842:
      return last_.channel << 7 | (last_.run ? 1 << 6 : 0) | (last_.stp ? 1 << 5 : 0) | still << 2;
    case 843:
      return (last_.jog ? 1 << 12 : 0) | (last_.dir ? 1 << 11 : 0) | (last_.run ? 1 << 10 : 0) |
             (last_.hos ? 1 << 9 : 0) | (last_.stp ? 1 << 8 : 0) | (last_.ord ? 1 << 6 : 0) | ready << 5 | still << 3 |
             (at_home_ ? 1 << 1 : 0) | (homed_ ? 1 : 0);
    case 844:
      return (last_.emst ? 1 << 16 : 0) | (last_.svon ? 1 << 15 : 0) | (last_.run ? 1 << 14 : 0) |
             (last_.jog ? 1 << 8 : 0) | ready << 7 | still << 5 | busy << 4 | (homed_ ? 1 << 2 : 0);
    case 845:
      return last_.channel << 11 | (last_.run ? 1 << 10 : 0) | running_channel_ << 4 | still << 3 | busy << 2;
    case 847:
      return static_cast<std::int32_t>(place);
    case 848:
      return static_cast<std::int32_t>(place * 36'000 / kTurn);
    case 849:
      return static_cast<std::int32_t>(place % 16'384);
    case 850:
      return axis_.moving() ? 125 : 20;
    default:
      return 0;
  }
}

}  // namespace servotrace::simulator
