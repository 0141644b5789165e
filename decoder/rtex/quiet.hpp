// SPDX-License-Identifier: MIT
// The short cut for blocks that say nothing new. Where command and response of a node repeat those before but for an
// Update_Counter that moves as it should and for the words that are measured or move the axis, every steady check would
// find what it found before: the block is compared word by word, counter and words are followed, the checks that read
// those words are run, and what the others would have counted is added when something else changes. A monitor command
// that comes or goes concerns the checks of its channel only.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "decoder/core/small_vector.hpp"
#include "decoder/rtex/events.hpp"
#include "decoder/rtex/views.hpp"

namespace servotrace::rtex {

struct ChannelState;
struct Node;

// Rows of kRules whose check passed.
using PassedRows = SmallVector<std::uint8_t, 64>;

// What the answers of a channel are judged by while they stay as they are.
struct SteadyAnswers {
  std::uint8_t same = 0;    // equal ones in a row that left the channel settled, saturated
  PassedRows passed;        // by the last one judged
  std::uint64_t times = 0;  // that they would have been again
};
inline constexpr std::uint8_t kSameAnswers = 2;  // from the third on they are counted only

// The non-cyclic parts of a block that are not those before.
struct ChangedParts {
  bool main = false, sub = false;
};

// Of a node.
struct Quiet {
  bool armed = false;                                    // the short cut may be taken
  bool raised = false;                                   // in the block being judged
  std::uint8_t command_streak = 0, response_streak = 0;  // equal blocks in a row, judged in full, saturated
  PassedRows command_passed, response_passed;            // by the last block judged in full
  std::array<SteadyAnswers, 2> answers;                  // of main and sub channel
  // While armed
  BlockWords command_mask = {}, response_mask = {};  // the bits that have to be those of before
  bool commands_watched = false;                     // a rule that reads words of a command may have something to say
  bool inputs_watched = false;                       // words of the response show the emergency stop input
  bool has_moved = true;                             // a word is another one, and no response was judged since
  // Taken since the last full judgement
  std::uint64_t commands = 0, responses = 0;
  std::uint64_t moves = 0, holds = 0;  // commands with the counter moved, and not moved
};

// Nothing of the channel, or of the node, waits for time to pass or for an answer.
bool is_settled(const ChannelState& channel);
bool is_settled(const Node& node);

// Equal blocks judged in full before the short cut: what one shows, the next but one has settled.
inline constexpr std::uint8_t kQuietStreak = 4;

// Checks whose outcome does not depend on time or on a count, only on what the short cut knows to be unchanged: the
// blocks and those before, the channels, what is known of the drive, the running ring. A rule that is not listed is
// judged on every block. No node is quiet in a homing or profile operation or where its drive reports an error; a count
// of TMG_CNT that says something wakes the record (timing.cpp).
struct SteadyRule {
  std::string_view id;
  Events reads_words = kNoEvent;  // at these it reads words that may change (steady_bits): judged on every block, too
};
inline constexpr auto kSteadyRules = std::to_array<SteadyRule>({
    {"RX101"},
    {"RX102"},
    {"RX103"},
    {"RX104"},
    {"RX105"},
    {"RX106"},
    {"RX107"},
    {"RX108"},
    {"RX110"},
    {"RX207"},
    {"RX208"},
    {"RX209"},
    {"RX113"},
    {"RX114"},
    {"RX306"},
    {"RX310", kActiveCommand},
    {"RX311"},
    {"RX312"},
    {"RX314", kActiveCommand},
    {"RX315"},
    {"RX407"},
    {"RX408"},
    {"RX410"},
    {"RX509"},
    {"RX510"},
    {"RX511"},
    {"RX512"},
    {"RX516"},
    {"RX521"},
    {"RX525"},
    {"RX527"},
    {"RX604"},
    {"RX703", kActiveCommand},
    {"RX705", kActiveCommand},
    {"RX706", kActiveCommand},
    {"RX901"},
    {"RX902"},
    {"RX903"},
    {"RX904"},
    {"RX905"},
    {"RX906"},
    {"RX907", kStatus},
    {"RX908"},
    {"RX909"},
});

// The events of a rule at which the short cut has to judge it.
consteval Events unsteady_events(std::string_view id, Events events) {
  for (const SteadyRule& rule : kSteadyRules) {
    if (rule.id == id) return events & rule.reads_words;
  }
  return events;
}

}  // namespace servotrace::rtex
