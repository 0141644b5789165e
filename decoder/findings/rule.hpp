// SPDX-License-Identifier: MIT
// A rule row: everything the program and its documents say about a rule. The row is the only place where it is said.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "decoder/core/layout.hpp"

namespace servotrace {

enum class Severity : std::uint8_t { kNote, kWarning, kError };
enum class Actor : std::uint8_t { kMaster, kDrive, kNetwork, kCapture };

// When a condition that is found again is a finding again.
enum class Repeat : std::uint8_t {
  kEach,      // every time
  kEpisode,   // once until an opportunity passes without it; the finding counts and keeps its last frame
  kOnceNode,  // once an owner (a node's channel, a ring, a bus), counted
};

enum class Hosts : std::uint8_t {
  kBoth,         // plugin and command line
  kOfflineOnly,  // only what a whole file shows: the command line
};

// How an integer argument is printed in a message.
enum class ArgumentFormat : std::uint8_t {
  kDecimal,
  kHex2,          // 1Fh
  kHex4,          // 002Eh
  kHex8,          // FFFFFC18h
  kName,          // the name in `names`, else the number
  kHex2Name,      // 31h (name)
  kHex4Name,      // 002Eh (name)
  kHex8Name,      // 00000002h (name)
  kDecimalName,   // 3 (name)
  kParameter,     // 0717h as Pr7.23
  kMainSub,       // 5602h as 86.2 (name)
  kExactly,       // 5602h as ", exactly 86.2 (name)"; nothing below 0
  kMilliseconds,  // nanoseconds, printed in ms with three places
  kMicroseconds,  // nanoseconds, printed in us with one place
  kBits,          // a set of places or MAC IDs: "1, 4, 7"
  kFlags,         // the names of the bits set, bit n by value n of `names`: "F1, F3"; "none"
};

struct Argument {
  ArgumentFormat format = ArgumentFormat::kDecimal;
  std::span<const ValueName> names = {};
};

inline constexpr std::size_t kMaxArguments = 4;

struct Rule {
  std::string_view id;    // "RX201"
  std::string_view slug;  // "update-counter-stuck"
  Severity severity = Severity::kNote;
  Actor actor = Actor::kMaster;
  std::string_view title;    // what is wrong, a line without a full stop
  std::string_view message;  // {0}..{3} stand for the arguments, {0|cycle} for a number of cycles; no full stop
  std::array<Argument, kMaxArguments> arguments = {};
  std::string_view section;  // manual and section
  // The codes a report of the drive can name, each with what the manual says of it as explanation.
  Argument codes = {};
  std::string_view why;  // why it matters, what follows
  std::string_view fix;  // what to do about it
  Repeat repeat = Repeat::kEpisode;
  Hosts hosts = Hosts::kBoth;
  bool lowered_when_assumed = false;  // one severity lower, and once a node, where it rests on an assumption
  bool needs_every_cycle = false;     // silent on sampled RTEX records
};

constexpr std::string_view name_of(Severity severity) {
  constexpr std::string_view kNames[] = {"note", "warning", "error"};
  return kNames[static_cast<unsigned>(severity)];
}
constexpr std::string_view name_of(Actor actor) {
  constexpr std::string_view kNames[] = {"master", "drive", "network", "capture"};
  return kNames[static_cast<unsigned>(actor)];
}
constexpr Severity lowered(Severity severity) {
  return severity == Severity::kNote ? severity : static_cast<Severity>(static_cast<unsigned>(severity) - 1U);
}

// A piece of a message: text as it stands, or the place of an argument, "{0}", with the noun it counts, "{0|cycle}".
struct MessagePart {
  std::size_t length = 0;  // in the message; 0: it is malformed here
  bool is_argument = false;
  std::size_t argument = 0;
  std::string_view text;  // as it stands, or the noun: an s follows it where the argument is not 1
};
// Precondition: message is not empty.
constexpr MessagePart first_part(std::string_view message) {
  const std::size_t brace = message.find_first_of("{}");
  if (brace != 0) {
    const std::string_view text = message.substr(0, brace);
    return {.length = text.size(), .text = text};
  }
  const std::size_t end = message.find('}');
  if (message[0] == '}' || end == std::string_view::npos || end < 2 || message[1] < '0' || message[1] > '9') return {};
  if (end > 2 && (message[2] != '|' || end == 3)) return {};
  return {.length = end + 1,
          .is_argument = true,
          .argument = static_cast<std::size_t>(message[1] - '0'),
          .text = end == 2 ? std::string_view() : message.substr(3, end - 3)};
}

// True where the row is complete: id of two letters and three digits, no empty text, a message whose arguments exist.
constexpr bool well_formed(const Rule& rule) {
  if (rule.id.size() != 5) return false;
  for (std::size_t i = 0; i < 5; ++i) {
    const char c = rule.id[i];
    if (i < 2 ? c < 'A' || c > 'Z' : c < '0' || c > '9') return false;
  }
  if (rule.slug.empty() || rule.title.empty() || rule.message.empty() || rule.section.empty() || rule.why.empty() ||
      rule.fix.empty()) {
    return false;
  }
  for (std::string_view rest = rule.message; !rest.empty();) {
    const MessagePart part = first_part(rest);
    if (part.length == 0 || (part.is_argument && part.argument >= kMaxArguments)) return false;
    rest.remove_prefix(part.length);
  }
  return true;
}

}  // namespace servotrace
