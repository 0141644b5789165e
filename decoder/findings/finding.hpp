// SPDX-License-Identifier: MIT
// A finding: numbers only. Text is made by whoever shows it (render/message.hpp).
#pragma once

#include <array>
#include <cstdint>

#include "decoder/core/time.hpp"
#include "decoder/findings/rule.hpp"

namespace servotrace {

// Index into the catalogue (findings/catalogue.hpp); made by rule("RX201"), which does not compile for an unknown id.
enum class RuleId : std::uint16_t {};

enum class Protocol : std::uint8_t { kNone, kRtex, kDevicenet };

enum class BusKind : std::uint8_t { kNone, kRing, kCan };

// A ring (number: the `ring` of the record header) or a CAN bus (number 0), on one capture interface.
struct BusRef {
  BusKind kind = BusKind::kNone;
  std::uint8_t number = 0;
  std::uint32_t interface_id = 0;
  constexpr bool operator==(const BusRef&) const = default;
};

enum class Channel : std::uint8_t { kNone, kMain, kSub, kPoll, kExplicit, kUnconnected };

inline constexpr std::int16_t kNoMacId = -1;

// Whose a finding or a segment is. Of the whole capture: everything at its default. Of a whole bus: mac_id kNoMacId.
struct NodeRef {
  BusRef bus;
  Protocol protocol = Protocol::kNone;
  std::int16_t mac_id = kNoMacId;
  std::uint8_t place = 0;  // RTEX: connection order, from 0
  Channel channel = Channel::kNone;
  constexpr bool operator==(const NodeRef&) const = default;
};

enum class BasisKind : std::uint8_t { kNone, kConfigured, kCapture, kAssumed };

// What decided the setting a finding rests on. `frame`: of kCapture, the frame that showed it.
struct Basis {
  BasisKind kind = BasisKind::kNone;
  std::uint64_t frame = 0;
};

// Bytes of the frame to highlight; length 0: the whole frame.
struct ByteRange {
  std::uint32_t offset = 0;
  std::uint32_t length = 0;
};

struct Cause {
  RuleId rule{};
  std::uint64_t frame = 0;  // 0: none
};

struct Finding {
  RuleId rule{};
  Severity severity = Severity::kNote;  // after lowering; settings may change it further
  Actor actor = Actor::kMaster;         // the rule's, or who did it this time (DN303)
  std::uint64_t frame = 0;              // the frame that proves it
  std::uint64_t last_frame = 0;         // of its episode
  std::uint32_t count = 1;              // of its episode
  TimeNs time_ns = 0;
  TimeNs last_time_ns = 0;
  NodeRef node;
  ByteRange where;
  std::array<std::uint64_t, 2> related = {};  // frames; 0: none
  std::array<std::int64_t, kMaxArguments> arguments = {};
  Cause cause;
  Basis basis;
};

}  // namespace servotrace
