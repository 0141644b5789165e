// SPDX-License-Identifier: MIT
// The short cut for blocks that say nothing new. Where command and response of a node repeat those before but for an
// Update_Counter that moves as it should, every steady check would find what it found before: the block is compared
// word by word, the counter is followed, and what the checks would have counted is added when something changes.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

#include "decoder/core/small_vector.hpp"

namespace servotrace::rtex {

// Rows of kRules whose check passed.
using PassedRows = SmallVector<std::uint8_t, 64>;

// Of a node.
struct Quiet {
  bool armed = false;                                    // the short cut may be taken
  bool raised = false;                                   // in the block being judged
  std::uint8_t command_streak = 0, response_streak = 0;  // equal blocks in a row, judged in full, saturated
  PassedRows command_passed, response_passed;            // by the last block judged in full
  // Taken since the last full judgement
  std::uint64_t commands = 0, responses = 0;
  std::uint64_t moves = 0, holds = 0;  // commands with the counter moved, and not moved
};

// Equal blocks judged in full before the short cut: what one shows, the next but one has settled.
inline constexpr std::uint8_t kQuietStreak = 4;

// Checks whose outcome does not depend on time or on a count, only on what the short cut knows to be unchanged: the
// blocks and those before, the channels, what is known of the drive, the running ring. A rule that is not listed is
// judged on every block. No node is quiet in a profile operation; a count of TMG_CNT that says something wakes the
// record (timing.cpp).
inline constexpr std::array kSteadyRules = {
    std::string_view{"RX101"}, std::string_view{"RX102"}, std::string_view{"RX103"}, std::string_view{"RX104"},
    std::string_view{"RX105"}, std::string_view{"RX106"}, std::string_view{"RX107"}, std::string_view{"RX108"},
    std::string_view{"RX110"}, std::string_view{"RX207"}, std::string_view{"RX208"}, std::string_view{"RX209"},
    std::string_view{"RX113"}, std::string_view{"RX114"}, std::string_view{"RX306"}, std::string_view{"RX310"},
    std::string_view{"RX311"}, std::string_view{"RX312"}, std::string_view{"RX314"}, std::string_view{"RX315"},
    std::string_view{"RX407"}, std::string_view{"RX408"}, std::string_view{"RX410"}, std::string_view{"RX509"},
    std::string_view{"RX510"}, std::string_view{"RX511"}, std::string_view{"RX512"}, std::string_view{"RX516"},
    std::string_view{"RX521"}, std::string_view{"RX525"}, std::string_view{"RX527"}, std::string_view{"RX604"},
    std::string_view{"RX703"}, std::string_view{"RX705"}, std::string_view{"RX706"}, std::string_view{"RX901"},
    std::string_view{"RX902"}, std::string_view{"RX903"}, std::string_view{"RX904"}, std::string_view{"RX905"},
    std::string_view{"RX906"}, std::string_view{"RX907"}, std::string_view{"RX908"}, std::string_view{"RX909"},
};

consteval bool is_steady(std::string_view id) {
  return std::find(kSteadyRules.begin(), kSteadyRules.end(), id) != kSteadyRules.end();
}

}  // namespace servotrace::rtex
