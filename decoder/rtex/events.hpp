// SPDX-License-Identifier: MIT
// What can happen to a ring, a node or a channel: the opportunities of the RX rules.
#pragma once

#include <cstdint>

#include "decoder/findings/rule.hpp"

namespace servotrace::rtex {

struct Scene;

// What a check found.
enum class Outcome : std::uint8_t {
  kSilent,  // no opportunity: what it needs is not known, or not now
  kPassed,  // an opportunity without the condition: an episode of it is over
  kRaised,
};

enum class Scope : std::uint8_t { kRing, kNode, kChannel };

// A set of events.
using Events = std::uint32_t;
inline constexpr Events kNoEvent = 0;
inline constexpr Events kCommandBlock = 1U << 0;   // a written command block
inline constexpr Events kActiveCommand = 1U << 1;  // the same, other than NOP
inline constexpr Events kResponseBlock = 1U << 2;  // a written response block, CRC error responses too
inline constexpr Events kStatus = 1U << 3;         // a response whose status bytes can be read
inline constexpr Events kAnswer = 1U << 4;         // of a channel: a response that was not a CRC error response
inline constexpr Events kCommandRecord = 1U << 5;
inline constexpr Events kResponseRecord = 1U << 6;
inline constexpr Events kHandshakeStep = 1U << 7;  // of a channel: a command starts, changes or ends
inline constexpr Events kStart = 1U << 8;          // of a channel: a non-cyclic command starts
inline constexpr Events kModeChange = 1U << 9;     // the cyclic code changes between modes
inline constexpr Events kServoOn = 1U << 10;       // Servo_On rises
inline constexpr Events kServoOff = 1U << 11;      // Servo_On falls
inline constexpr Events kCompleted = 1U << 12;     // of a channel: the first complete answer of a held command
inline constexpr Events kDeadline = 1U << 13;      // of a channel: time went on while a command is held
inline constexpr unsigned kEventCount = 14;

using Check = Outcome (*)(Scene&);

// A rule of this protocol: the catalogue's row, whose it is, and the function that judges it at its opportunities
// (none: the session reports it where records themselves tell).
struct RtexRule {
  Rule row;
  Scope scope = Scope::kNode;
  Events events = kNoEvent;
  Check check = nullptr;
};

}  // namespace servotrace::rtex
