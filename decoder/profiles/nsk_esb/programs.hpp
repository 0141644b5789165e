// SPDX-License-Identifier: MIT
// The internal programs of the ESB (ESB 5.3, 5.4.5): what the capture shows of each of the 64 channels, written or read
// out, and the listing of a channel in the manual's notation.
#pragma once

#include <array>
#include <cstdint>

#include "decoder/core/small_vector.hpp"
#include "decoder/core/text.hpp"
#include "decoder/profiles/nsk_esb/numbers.hpp"

namespace servotrace::esb {

inline constexpr std::size_t kChannels = 64;
// Steps kept of a channel. The manual gives no number; a longer program is not known as a whole.
inline constexpr std::size_t kMaxSteps = 48;

// A program command with its data, or an optional code of it.
struct Step {
  std::int16_t number = 0;
  std::int32_t data = 0;
};

struct Channel {
  bool known = false;       // all of it is in `steps` (an empty channel has none)
  bool doubted = false;     // records were lost since: it may have been written anew
  std::uint64_t frame = 0;  // that showed it
  SmallVector<Step, kMaxSteps> steps;

  bool is_certain() const { return known && !doubted; }
  // True where a line of it waits for RUN (661 = 2).
  bool waits_for_run() const;
};

inline constexpr bool is_program_command(std::int64_t number) {
  const Number* row = find_number(number);
  return row != nullptr && row->group == Group::kProgram;
}
inline constexpr bool is_optional_code(std::int64_t number) {
  const Number* row = find_number(number);
  return row != nullptr && row->group == Group::kOption;
}
// Table 5-2: whether the optional code may follow the program command.
constexpr bool option_allowed(std::int64_t command, std::int64_t option) {
  if (command >= 600 && command <= 607) return option >= 661 && option <= 663;
  if (command >= 608 && command <= 611) return option >= 660 && option <= 663;
  return command == 620 && option == 661;
}

class Programs {
 public:
  Channel& channel(std::uint8_t number) { return channels_[number % kChannels]; }
  const Channel& channel(std::uint8_t number) const { return channels_[number % kChannels]; }
  void forget() { channels_ = {}; }
  void doubt() {
    for (Channel& channel : channels_) channel.doubted = true;
  }

  // A program command begins a line; an optional code replaces its like in the last line, or deletes it with 0.
  static void write(Channel& channel, Step step);

  // What a start of `number` does, as far as the capture shows it. kUnknown where a channel on the way is not known.
  enum class Start : std::uint8_t { kUnknown, kHomesFirst, kAbsolute, kOther };
  Start start_of(std::uint8_t number) const;

 private:
  std::array<Channel, kChannels> channels_{};
};

using Listing = Text<1024>;
// "CH5: AD/PL9000&, CV1.5000, CA10.00"; lines are parted by "; "; "CH5: (empty)".
void append_listing(Listing& text, std::uint8_t number, const Channel& channel);
// One number with its data, "VG45.0"; a number without a mnemonic by its name.
void append_step(Listing& text, std::int64_t number, std::int64_t data);

}  // namespace servotrace::esb
