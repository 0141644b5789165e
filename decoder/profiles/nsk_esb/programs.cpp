// SPDX-License-Identifier: MIT
#include "decoder/profiles/nsk_esb/programs.hpp"

namespace servotrace::esb {
namespace {

constexpr std::int16_t kDivision = 660;
constexpr std::int16_t kSequence = 661;
constexpr std::int16_t kHomeReturn = 620;
constexpr std::int16_t kJump = 640;

}  // namespace

void Programs::write(Channel& channel, Step step) {
  if (is_program_command(step.number)) {
    channel.steps.clear();
    channel.steps.push_back(step);
    return;
  }
  SmallVector<Step, 8> kept;
  bool replaced = false;
  for (const Step& old : channel.steps) {
    if (old.number != step.number) {
      kept.push_back(old);
    } else if (step.data != 0) {
      kept.push_back(step);
      replaced = true;
    }
  }
  if (!replaced && step.data != 0) kept.push_back(step);
  channel.steps = kept;
}

Programs::Start Programs::start_of(std::uint8_t number) const {
  for (std::size_t hops = 0; hops < kChannels; ++hops) {
    const Channel& at = channel(number);
    if (!at.known) return Start::kUnknown;
    if (at.steps.empty()) return Start::kOther;
    const Step& command = at.steps[0];
    if (command.number == kHomeReturn) return Start::kHomesFirst;
    if (command.number >= 600 && command.number <= 607) return Start::kAbsolute;
    if (command.number == kJump) {
      number = static_cast<std::uint8_t>(command.data & 0x3F);
      continue;
    }
    // An incremental move or a timer: what follows in sequence counts too.
    const Step* sequence = at.find(kSequence);
    if (sequence == nullptr || sequence->data != 1 || number + 1U >= kChannels) return Start::kOther;
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
  bool first = true;
  for (const Step& step : channel.steps) {
    if (step.number == kDivision || step.number == kSequence) continue;  // they stand behind the command
    if (!first) text << ", ";
    append_step(text, step.number, step.data);
    if (first) {
      if (const Step* division = channel.find(kDivision)) text << "/" << std::int64_t{division->data};
      if (const Step* sequence = channel.find(kSequence)) text << (sequence->data == 1 ? "*" : "&");
    }
    first = false;
  }
}

}  // namespace servotrace::esb
