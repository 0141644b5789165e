// SPDX-License-Identifier: MIT
// What a check is handed: the state of ring, node and channel at the block being judged, and a way to report.
#pragma once

#include "decoder/rtex/ring.hpp"
#include "decoder/rtex/rules.hpp"

namespace servotrace::rtex {

// The catalogue's id of the row at `place` of kRules.
inline RuleId id_of(std::size_t place) {
  static constexpr auto kFirst = static_cast<std::uint16_t>(rule("RX101"));
  return static_cast<RuleId>(kFirst + place);
}

struct Scene {
  Ring& ring;
  const Context& context;
  Node* node = nullptr;
  ChannelState* channel = nullptr;
  std::uint32_t block_at = 0;  // offset of the node's block in the frame
  RuleId rule{};               // of the check that runs
  OwnerId owner{};
  Moment now;
  PassedRows* passed = nullptr;  // where the rows that pass are noted

  const Limits& limits() const { return ring.settings.limits; }
  // Bytes of the block, for highlighting.
  ByteRange bytes(std::uint32_t first, std::uint32_t count) const { return {block_at + first, count}; }
  bool is_sub() const { return channel != nullptr && channel->id == Channel::kSub; }
  // The argument bytes of the channel.
  ByteRange arguments() const { return is_sub() ? bytes(17, 7) : bytes(8, 8); }
  ByteRange code() const { return is_sub() ? bytes(16, 1) : bytes(1, 1); }
  const CommandPart& part() const { return is_sub() ? node->command.sub : node->command.main; }
  const CommandPart& previous_part() const { return is_sub() ? node->previous.sub : node->previous.main; }
  const ResponsePart& answer() const { return is_sub() ? node->response.sub : node->response.main; }

  // Reports the check's rule at this frame; rule and owner are filled in.
  Outcome raise(Report report);
  void remember(bool fresh);
  // The latest fault among `rules` on this node or its ring that is not older than `within_ns` at `when`.
  Cause cause_among(std::span<const RuleId> rules, DurationNs within_ns, TimeNs when) const;
  Cause cause_among(std::span<const RuleId> rules, DurationNs within_ns) const {
    return cause_among(rules, within_ns, now.time_ns);
  }
};

// --- questions the checks share (questions.cpp) ---------------------------------------------------------------------
// In_Progress = 1, and known to be that.
struct Answer {
  bool yes = false;
  Basis basis;
};
Answer in_progress(const Node& node);
// The catalogue's "moves".
Answer moves(const Ring& ring, const Node& node);
Answer speed_moves(const Ring& ring, const Node& node);  // by speed or position alone
// The actual speed of the last response, where it is shown and its unit is r/min or command units as Pr7.25 says.
struct Speed {
  bool known = false;
  std::int32_t value = 0;
  bool in_units = false;
  Basis basis;
};
Speed actual_speed(const Node& node);
// The actual position of the last response.
struct Position {
  bool known = false;
  std::int32_t value = 0;
  Basis basis;
};
Position actual_position(const Node& node);
// How far `to` lies from `from`, over the wraparound of 32 bits where that is shorter.
constexpr std::int64_t apart(std::int32_t to, std::int32_t from) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(to) - static_cast<std::uint32_t>(from));
}
// The weaker of two.
Basis weaker(const Basis& left, const Basis& right);
// Communication cycles that make up `duration_ns`; 0 where the cycle is not known.
std::int64_t cycles_in(const Ring& ring, DurationNs duration_ns);
bool is_homing(const CommandPart& part);         // 11h to 1Dh, 21h, 22h, 31h: a homing command other than latch
bool is_homing_search(const CommandPart& part);  // 11h to 1Dh
// RX312: how long a process may stay Busy.
DurationNs busy_limit_ns(const Process& process, const Limits& limits);
bool has_no_busy_limit(const Process& process);
bool matches(const CommandPart& part, const ResponsePart& answer, bool sub);
// The command of the main channel that starts.
bool starts(const Scene& scene, NonCyclic code);
bool starts(const Scene& scene, NonCyclic code, std::uint16_t type_code);
bool has_status(const Node& node);                      // the status bits of the last response can be read
std::uint8_t profile_in_progress(const Node& node);     // its Type_Code, 0 where none is
bool is_latch_or_homing_profile(std::uint8_t profile);  // 12h, 13h, 31h to 33h
// The emergency stop input, where byte 3 or monitor 21h of the last response shows it (4-3-4, 6-9-5).
EmergencyInput emergency_input(const Node& node);
// Reports the command that starts: its argument bytes, the last response, its Type_Code, where nothing else is given.
Outcome raise_start(Scene& scene, Report report = {});

}  // namespace servotrace::rtex
