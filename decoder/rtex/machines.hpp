// SPDX-License-Identifier: MIT
// The handshake of a non-cyclic command as a table (SX-DSV02203 3-3-4, 3-3-5), the same for main and sub channel.
#pragma once

#include "decoder/core/machine.hpp"

namespace servotrace::rtex {

enum class Handshake : std::uint8_t {
  kUnknown,   // the capture began, or records were lost, inside a command
  kStandard,  // x0h or NOP: the reference
  kSent,      // a non-cyclic command is sent, its code not echoed yet
  kBusy,      // echoed, the last response showed Busy = 1
  kIdle,      // echoed, the last response showed Busy = 0, or an error
  kCount
};

enum class HandshakeEvent : std::uint8_t {
  kStandardCode,  // command: x0h or NOP
  kNewCode,       // command: another non-cyclic code than before
  kSameCode,      // command: code and arguments as before
  kNewArguments,  // command: the same code, other arguments, A4N-compatible start mode: not executed
  kRestart,       // command: the same code, other arguments, extend mode: executed
  kEchoBusy,      // response: echoes the held code, Busy = 1
  kEchoIdle,      // response: echoes the held code, Busy = 0 or CMD_Error = 1
  kOtherEcho,     // response: echoes another code
  kLost,          // records were lost, or the ring started anew
  kCount
};

enum class HandshakeStep : std::uint8_t {
  kNone,
  kBegin,             // a command starts
  kEarly,             // code or arguments change before the echo (RX302)
  kEarlyBegin,        // the same, and another command starts
  kLeft,              // back to the standard command, completed
  kLeftBusy,          // back to the standard command while Busy = 1 (RX304)
  kChained,           // another command without the standard command between (RX301, RX303)
  kArgumentsIgnored,  // other arguments of a held command (RX305)
  kAccepted,          // the first echo
};

namespace detail {
using HandshakeMachine = Machine<Handshake, HandshakeEvent, HandshakeStep>;
consteval HandshakeMachine make_handshake() {
  using S = Handshake;
  using E = HandshakeEvent;
  using A = HandshakeStep;
  constexpr std::string_view kStart = "SX-DSV02203 3-3-4";
  constexpr std::string_view kBasic = "SX-DSV02203 3-3-4-1";
  constexpr std::string_view kExtend = "SX-DSV02203 3-3-5";
  return {"non-cyclic handshake",
          {"unknown", "standard command", "sent", "busy", "idle"},
          {"standard code", "new code", "same code", "new arguments (A4N-compatible)", "new arguments (extend)",
           "echo, Busy = 1", "echo, Busy = 0", "echo of another code", "records lost"},
          {{
              {S::kUnknown, E::kStandardCode, S::kStandard, A::kNone, kStart},
              {S::kUnknown, E::kNewCode, S::kSent, A::kBegin, kStart},
              {S::kUnknown, E::kSameCode, S::kUnknown, A::kNone, kStart},
              {S::kUnknown, E::kNewArguments, S::kUnknown, A::kNone, kStart},
              {S::kUnknown, E::kRestart, S::kSent, A::kBegin, kExtend},
              {S::kUnknown, E::kEchoBusy, S::kBusy, A::kAccepted, kBasic},
              {S::kUnknown, E::kEchoIdle, S::kIdle, A::kAccepted, kBasic},
              {S::kUnknown, E::kOtherEcho, S::kUnknown, A::kNone, kStart},
              {S::kUnknown, E::kLost, S::kUnknown, A::kNone, kStart},
              {S::kStandard, E::kStandardCode, S::kStandard, A::kNone, kStart},
              {S::kStandard, E::kNewCode, S::kSent, A::kBegin, kStart},
              {S::kStandard, E::kSameCode, S::kStandard, A::kNone, kStart},
              {S::kStandard, E::kNewArguments, S::kStandard, A::kNone, kStart},
              {S::kStandard, E::kRestart, S::kStandard, A::kNone, kExtend},
              {S::kStandard, E::kEchoBusy, S::kStandard, A::kNone, kBasic},
              {S::kStandard, E::kEchoIdle, S::kStandard, A::kNone, kBasic},
              {S::kStandard, E::kOtherEcho, S::kStandard, A::kNone, kBasic},
              {S::kStandard, E::kLost, S::kUnknown, A::kNone, kStart},
              {S::kSent, E::kStandardCode, S::kStandard, A::kEarly, kStart},
              {S::kSent, E::kNewCode, S::kSent, A::kEarlyBegin, kStart},
              {S::kSent, E::kSameCode, S::kSent, A::kNone, kStart},
              {S::kSent, E::kNewArguments, S::kSent, A::kEarly, kStart},
              {S::kSent, E::kRestart, S::kSent, A::kEarlyBegin, kExtend},
              {S::kSent, E::kEchoBusy, S::kBusy, A::kAccepted, kBasic},
              {S::kSent, E::kEchoIdle, S::kIdle, A::kAccepted, kBasic},
              {S::kSent, E::kOtherEcho, S::kSent, A::kNone, kBasic},
              {S::kSent, E::kLost, S::kUnknown, A::kNone, kStart},
              {S::kBusy, E::kStandardCode, S::kStandard, A::kLeftBusy, kStart},
              {S::kBusy, E::kNewCode, S::kSent, A::kChained, kStart},
              {S::kBusy, E::kSameCode, S::kBusy, A::kNone, kStart},
              {S::kBusy, E::kNewArguments, S::kBusy, A::kArgumentsIgnored, kStart},
              {S::kBusy, E::kRestart, S::kSent, A::kBegin, kExtend},
              {S::kBusy, E::kEchoBusy, S::kBusy, A::kNone, kBasic},
              {S::kBusy, E::kEchoIdle, S::kIdle, A::kNone, kBasic},
              {S::kBusy, E::kOtherEcho, S::kBusy, A::kNone, kBasic},
              {S::kBusy, E::kLost, S::kUnknown, A::kNone, kStart},
              {S::kIdle, E::kStandardCode, S::kStandard, A::kLeft, kStart},
              {S::kIdle, E::kNewCode, S::kSent, A::kChained, kStart},
              {S::kIdle, E::kSameCode, S::kIdle, A::kNone, kStart},
              {S::kIdle, E::kNewArguments, S::kIdle, A::kArgumentsIgnored, kStart},
              {S::kIdle, E::kRestart, S::kSent, A::kBegin, kExtend},
              {S::kIdle, E::kEchoBusy, S::kBusy, A::kNone, kBasic},
              {S::kIdle, E::kEchoIdle, S::kIdle, A::kNone, kBasic},
              {S::kIdle, E::kOtherEcho, S::kIdle, A::kNone, kBasic},
              {S::kIdle, E::kLost, S::kUnknown, A::kNone, kStart},
          }}};
}
}  // namespace detail

inline constexpr detail::HandshakeMachine kHandshake = detail::make_handshake();

}  // namespace servotrace::rtex
