// SPDX-License-Identifier: MIT
// The state machines of a node: its start (Duplicate MAC ID check) and its poll connection.
#pragma once

#include "decoder/core/machine.hpp"
#include "decoder/devicenet/can_id.hpp"

namespace servotrace::devicenet {

// The start of a node: two Duplicate MAC ID requests, one second apart, then on line.
enum class StartState : std::uint8_t { kUnknown, kFirstCheck, kChecked, kOnLine, kDuplicate, kCount };
enum class StartEvent : std::uint8_t {
  kOwnCheck,  // its own Duplicate MAC ID request (a challenger's is none)
  kAnswered,  // another node answered the request
  kTransmit,  // it sends anything else
  kGap,       // records were lost
  kCount
};
enum class StartAction : std::uint8_t { kNone, kShortCheck /* DN103 */ };

inline constexpr Machine<StartState, StartEvent, StartAction> kStartMachine{
    "DeviceNet node start",
    {"unknown", "first check sent", "checked", "on line", "duplicate"},
    {"own check", "check answered", "transmits", "records lost"},
    {{
        {StartState::kUnknown, StartEvent::kOwnCheck, StartState::kFirstCheck, StartAction::kNone, kLinkSection},
        {StartState::kUnknown, StartEvent::kAnswered, StartState::kUnknown, StartAction::kNone, kLinkSection},
        {StartState::kUnknown, StartEvent::kTransmit, StartState::kOnLine, StartAction::kNone, kLinkSection},
        {StartState::kUnknown, StartEvent::kGap, StartState::kUnknown, StartAction::kNone, kLinkSection},
        {StartState::kFirstCheck, StartEvent::kOwnCheck, StartState::kChecked, StartAction::kNone, kLinkSection},
        {StartState::kFirstCheck, StartEvent::kAnswered, StartState::kDuplicate, StartAction::kNone, kLinkSection},
        {StartState::kFirstCheck, StartEvent::kTransmit, StartState::kOnLine, StartAction::kShortCheck, kLinkSection},
        {StartState::kFirstCheck, StartEvent::kGap, StartState::kUnknown, StartAction::kNone, kLinkSection},
        {StartState::kChecked, StartEvent::kOwnCheck, StartState::kChecked, StartAction::kNone, kLinkSection},
        {StartState::kChecked, StartEvent::kAnswered, StartState::kDuplicate, StartAction::kNone, kLinkSection},
        {StartState::kChecked, StartEvent::kTransmit, StartState::kOnLine, StartAction::kNone, kLinkSection},
        {StartState::kChecked, StartEvent::kGap, StartState::kUnknown, StartAction::kNone, kLinkSection},
        {StartState::kOnLine, StartEvent::kOwnCheck, StartState::kFirstCheck, StartAction::kNone, kLinkSection},
        {StartState::kOnLine, StartEvent::kAnswered, StartState::kOnLine, StartAction::kNone, kLinkSection},
        {StartState::kOnLine, StartEvent::kTransmit, StartState::kOnLine, StartAction::kNone, kLinkSection},
        {StartState::kOnLine, StartEvent::kGap, StartState::kOnLine, StartAction::kNone, kLinkSection},
        {StartState::kDuplicate, StartEvent::kOwnCheck, StartState::kFirstCheck, StartAction::kNone, kLinkSection},
        {StartState::kDuplicate, StartEvent::kAnswered, StartState::kDuplicate, StartAction::kNone, kLinkSection},
        {StartState::kDuplicate, StartEvent::kTransmit, StartState::kOnLine, StartAction::kNone, kLinkSection},
        {StartState::kDuplicate, StartEvent::kGap, StartState::kDuplicate, StartAction::kNone, kLinkSection},
    }}};

// The poll connection of a node. Nothing is reported out of kUnknown.
enum class PollState : std::uint8_t {
  kUnknown,
  kNotAllocated,  // the capture shows the node's start or a release
  kRefused,
  kConfiguring,  // allocated; polls may be left unanswered
  kEstablished,
  kTimedOut,
  kCount
};
enum class PollEvent : std::uint8_t {
  kStart,       // the node started
  kAllocation,  // allocated with the poll choice
  kRefusal,     // allocation with the poll choice refused (02, 09)
  kReleased,    // released with the poll choice
  kPacketRate,  // its expected packet rate was set
  kCommand,
  kResponse,
  kTimeout,  // the watchdog's time passed
  kReset,    // the device was reset by a service
  kCount
};
enum class PollAction : std::uint8_t {
  kNone,
  kExpectResponse,
  kNotAllocated,  // DN201
  kTimedOut,      // DN204
};

inline constexpr Machine<PollState, PollEvent, PollAction> kPollMachine{
    "DeviceNet poll connection",
    {"unknown", "not allocated", "refused", "configuring", "established", "timed out"},
    {"node starts", "allocated", "refused", "released", "packet rate set", "poll command", "poll response",
     "watchdog time passes", "device reset"},
    {{
        {PollState::kUnknown, PollEvent::kStart, PollState::kNotAllocated, PollAction::kNone, kLinkSection},
        {PollState::kUnknown, PollEvent::kAllocation, PollState::kConfiguring, PollAction::kNone, kLinkSection},
        {PollState::kUnknown, PollEvent::kRefusal, PollState::kRefused, PollAction::kNone, kLinkSection},
        {PollState::kUnknown, PollEvent::kReleased, PollState::kNotAllocated, PollAction::kNone, kLinkSection},
        {PollState::kUnknown, PollEvent::kPacketRate, PollState::kEstablished, PollAction::kNone, kLinkSection},
        {PollState::kUnknown, PollEvent::kCommand, PollState::kUnknown, PollAction::kNone, kLinkSection},
        {PollState::kUnknown, PollEvent::kResponse, PollState::kEstablished, PollAction::kNone, kLinkSection},
        {PollState::kUnknown, PollEvent::kTimeout, PollState::kUnknown, PollAction::kNone, kLinkSection},
        {PollState::kUnknown, PollEvent::kReset, PollState::kUnknown, PollAction::kNone, kLinkSection},
        {PollState::kNotAllocated, PollEvent::kStart, PollState::kNotAllocated, PollAction::kNone, kLinkSection},
        {PollState::kNotAllocated, PollEvent::kAllocation, PollState::kConfiguring, PollAction::kNone, kLinkSection},
        {PollState::kNotAllocated, PollEvent::kRefusal, PollState::kRefused, PollAction::kNone, kLinkSection},
        {PollState::kNotAllocated, PollEvent::kReleased, PollState::kNotAllocated, PollAction::kNone, kLinkSection},
        {PollState::kNotAllocated, PollEvent::kPacketRate, PollState::kEstablished, PollAction::kNone, kLinkSection},
        {PollState::kNotAllocated, PollEvent::kCommand, PollState::kNotAllocated, PollAction::kNotAllocated,
         kLinkSection},
        {PollState::kNotAllocated, PollEvent::kResponse, PollState::kEstablished, PollAction::kNone, kLinkSection},
        {PollState::kNotAllocated, PollEvent::kTimeout, PollState::kNotAllocated, PollAction::kNone, kLinkSection},
        {PollState::kNotAllocated, PollEvent::kReset, PollState::kNotAllocated, PollAction::kNone, kLinkSection},
        {PollState::kRefused, PollEvent::kStart, PollState::kNotAllocated, PollAction::kNone, kLinkSection},
        {PollState::kRefused, PollEvent::kAllocation, PollState::kConfiguring, PollAction::kNone, kLinkSection},
        {PollState::kRefused, PollEvent::kRefusal, PollState::kRefused, PollAction::kNone, kLinkSection},
        {PollState::kRefused, PollEvent::kReleased, PollState::kNotAllocated, PollAction::kNone, kLinkSection},
        {PollState::kRefused, PollEvent::kPacketRate, PollState::kEstablished, PollAction::kNone, kLinkSection},
        {PollState::kRefused, PollEvent::kCommand, PollState::kRefused, PollAction::kNotAllocated, kLinkSection},
        {PollState::kRefused, PollEvent::kResponse, PollState::kEstablished, PollAction::kNone, kLinkSection},
        {PollState::kRefused, PollEvent::kTimeout, PollState::kRefused, PollAction::kNone, kLinkSection},
        {PollState::kRefused, PollEvent::kReset, PollState::kUnknown, PollAction::kNone, kLinkSection},
        {PollState::kConfiguring, PollEvent::kStart, PollState::kNotAllocated, PollAction::kNone, kLinkSection},
        {PollState::kConfiguring, PollEvent::kAllocation, PollState::kConfiguring, PollAction::kNone, kLinkSection},
        {PollState::kConfiguring, PollEvent::kRefusal, PollState::kConfiguring, PollAction::kNone, kLinkSection},
        {PollState::kConfiguring, PollEvent::kReleased, PollState::kNotAllocated, PollAction::kNone, kLinkSection},
        {PollState::kConfiguring, PollEvent::kPacketRate, PollState::kEstablished, PollAction::kNone, kLinkSection},
        {PollState::kConfiguring, PollEvent::kCommand, PollState::kConfiguring, PollAction::kNone, kLinkSection},
        {PollState::kConfiguring, PollEvent::kResponse, PollState::kEstablished, PollAction::kNone, kLinkSection},
        {PollState::kConfiguring, PollEvent::kTimeout, PollState::kTimedOut, PollAction::kTimedOut, kLinkSection},
        {PollState::kConfiguring, PollEvent::kReset, PollState::kUnknown, PollAction::kNone, kLinkSection},
        {PollState::kEstablished, PollEvent::kStart, PollState::kNotAllocated, PollAction::kNone, kLinkSection},
        {PollState::kEstablished, PollEvent::kAllocation, PollState::kConfiguring, PollAction::kNone, kLinkSection},
        {PollState::kEstablished, PollEvent::kRefusal, PollState::kEstablished, PollAction::kNone, kLinkSection},
        {PollState::kEstablished, PollEvent::kReleased, PollState::kNotAllocated, PollAction::kNone, kLinkSection},
        {PollState::kEstablished, PollEvent::kPacketRate, PollState::kEstablished, PollAction::kNone, kLinkSection},
        {PollState::kEstablished, PollEvent::kCommand, PollState::kEstablished, PollAction::kExpectResponse,
         kLinkSection},
        {PollState::kEstablished, PollEvent::kResponse, PollState::kEstablished, PollAction::kNone, kLinkSection},
        {PollState::kEstablished, PollEvent::kTimeout, PollState::kTimedOut, PollAction::kTimedOut, kLinkSection},
        {PollState::kEstablished, PollEvent::kReset, PollState::kUnknown, PollAction::kNone, kLinkSection},
        {PollState::kTimedOut, PollEvent::kStart, PollState::kNotAllocated, PollAction::kNone, kLinkSection},
        {PollState::kTimedOut, PollEvent::kAllocation, PollState::kConfiguring, PollAction::kNone, kLinkSection},
        {PollState::kTimedOut, PollEvent::kRefusal, PollState::kTimedOut, PollAction::kNone, kLinkSection},
        {PollState::kTimedOut, PollEvent::kReleased, PollState::kNotAllocated, PollAction::kNone, kLinkSection},
        {PollState::kTimedOut, PollEvent::kPacketRate, PollState::kEstablished, PollAction::kNone, kLinkSection},
        {PollState::kTimedOut, PollEvent::kCommand, PollState::kTimedOut, PollAction::kNone, kLinkSection},
        {PollState::kTimedOut, PollEvent::kResponse, PollState::kEstablished, PollAction::kNone, kLinkSection},
        {PollState::kTimedOut, PollEvent::kTimeout, PollState::kTimedOut, PollAction::kNone, kLinkSection},
        {PollState::kTimedOut, PollEvent::kReset, PollState::kUnknown, PollAction::kNone, kLinkSection},
    }}};

}  // namespace servotrace::devicenet
