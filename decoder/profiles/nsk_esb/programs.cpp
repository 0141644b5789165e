// SPDX-License-Identifier: MIT
#include "decoder/profiles/nsk_esb/programs.hpp"

namespace servotrace::esb {
namespace {

constexpr std::int16_t kDivision = 660;
constexpr std::int16_t kSequence = 661;
constexpr std::int16_t kHomeReturn = 620;
constexpr std::int16_t kJump = 640;

}  // namespace

bool Channel::waits_for_run() const {
  for (const Step& step : steps) {
    if (step.number == kSequence && step.data == 2) return true;
  }
  return false;
}

void Programs::write(Channel& channel, Step step) {
  if (is_program_command(step.number)) {
    channel.steps.push_back(step);
    return;
  }
  std::size_t line = channel.steps.size();  // the last line begins here
  while (line > 0 && !is_program_command(channel.steps[line - 1].number)) --line;
  SmallVector<Step, kMaxSteps> kept;
  for (std::size_t i = 0; i < channel.steps.size(); ++i) {
    if (i < line || channel.steps[i].number != step.number) kept.push_back(channel.steps[i]);
  }
  if (step.data != 0) kept.push_back(step);
  channel.steps = kept;
}

Programs::Start Programs::start_of(std::uint8_t number) const {
  for (std::size_t hops = 0; hops < kChannels; ++hops) {
    const Channel& at = channel(number);
    if (!at.is_certain()) return Start::kUnknown;
    std::int32_t sequence = 0;
    bool jumps = false;
    for (const Step& step : at.steps) {
      if (step.number == kHomeReturn) return Start::kHomesFirst;
      if (step.number >= 600 && step.number <= 607) return Start::kAbsolute;
      if (is_program_command(step.number)) sequence = 0;
      if (step.number == kSequence) sequence = step.data;
      if (step.number == kJump) {
        number = static_cast<std::uint8_t>(step.data & 0x3F);
        jumps = true;
        break;
      }
    }
    if (jumps) continue;
    // Incremental moves and timers alone: the next channel counts where the last line goes on to it.
    if (sequence != 1 || number + 1U >= kChannels) return Start::kOther;
    ++number;
  }
  return Start::kOther;
}

void append_step(Listing& text, std::int64_t number, std::int64_t data) {
  const Number* row = find_number(number);
  if (row == nullptr) {
    text << "(" << number << ") " << data;
    return;
  }
  if (row->mnemonic.empty()) {
    text << row->name;
    if (row->has_data) text << " ";
  } else {
    text << row->mnemonic;
  }
  if (row->has_data) text.decimal(data, row->decimals);
}

void append_listing(Listing& text, std::uint8_t number, const Channel& channel) {
  text << "CH" << std::int64_t{number} << ": ";
  if (channel.steps.empty()) {
    text << "(empty)";
    return;
  }
  for (std::size_t i = 0; i < channel.steps.size(); ++i) {
    const Step& step = channel.steps[i];
    if (step.number == kDivision || step.number == kSequence) continue;  // they stand behind their command
    const bool command = is_program_command(step.number);
    if (i > 0) text << (command ? "; " : ", ");
    append_step(text, step.number, step.data);
    if (!command) continue;
    std::int32_t division = 0;
    std::int32_t sequence = 0;
    for (std::size_t j = i + 1; j < channel.steps.size() && !is_program_command(channel.steps[j].number); ++j) {
      if (channel.steps[j].number == kDivision) division = channel.steps[j].data;
      if (channel.steps[j].number == kSequence) sequence = channel.steps[j].data;
    }
    if (division != 0) text << "/" << std::int64_t{division};
    if (sequence != 0) text << (sequence == 1 ? "*" : "&");
  }
}

}  // namespace servotrace::esb
