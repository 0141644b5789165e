// SPDX-License-Identifier: MIT
// The handshake of PRM_REQ and PRM_ACK (ESB 5.2.1, figures 5-1 and 5-2; 4.4.14) as a state machine.
#pragma once

#include "decoder/core/machine.hpp"

namespace servotrace::esb {

enum class Handshake : std::uint8_t {
  kUnknown,    // a capture starts anywhere
  kIdle,       // PRM_REQ = 0, PRM_ACK = 0
  kRequested,  // 1, 0
  kConfirmed,  // 1, 1
  kReleased,   // 0, 1
  kCount
};
enum class HandshakeEvent : std::uint8_t {
  kRequestRises,
  kRequestFalls,
  kRequestChanges,  // number, operation or written data, under PRM_REQ = 1
  kConfirmRises,
  kConfirmFalls,
  kLimitPasses,  // for PRM_ACK to rise, or to fall
  kCount
};
enum class HandshakeAction : std::uint8_t {
  kNone,
  kBegin,        // a transaction begins
  kRestart,      // NK101: it begins before the last one is over
  kDrop,         // NK102
  kChange,       // NK103
  kMissing,      // NK104
  kStuck,        // NK105
  kResult,       // the answer: NK106, NK107
  kRelease,      // the master has taken the answer
  kFinish,       // idle again
  kUnrequested,  // an answer to nothing that is known: no rule
};

namespace detail {
inline constexpr std::string_view kHandshakeSection = "ESB 5.2.1, 4.4.14";
using HandshakeRow = Transition<Handshake, HandshakeEvent, HandshakeAction>;
constexpr HandshakeRow on(Handshake from, HandshakeEvent event, Handshake to,
                          HandshakeAction action = HandshakeAction::kNone) {
  return {from, event, to, action, kHandshakeSection};
}
using S = Handshake;
using E = HandshakeEvent;
using A = HandshakeAction;
}  // namespace detail

inline constexpr Machine<Handshake, HandshakeEvent, HandshakeAction> kHandshake{
    "PRM_REQ / PRM_ACK",
    {"Unknown", "Idle", "Requested", "Confirmed", "Released"},
    {"PRM_REQ rises", "PRM_REQ falls", "request changes", "PRM_ACK rises", "PRM_ACK falls", "limit passes"},
    {{
        detail::on(detail::S::kUnknown, detail::E::kRequestRises, detail::S::kUnknown),
        detail::on(detail::S::kUnknown, detail::E::kRequestFalls, detail::S::kUnknown),
        detail::on(detail::S::kUnknown, detail::E::kRequestChanges, detail::S::kUnknown),
        detail::on(detail::S::kUnknown, detail::E::kConfirmRises, detail::S::kUnknown),
        detail::on(detail::S::kUnknown, detail::E::kConfirmFalls, detail::S::kUnknown),
        detail::on(detail::S::kUnknown, detail::E::kLimitPasses, detail::S::kUnknown),
        detail::on(detail::S::kIdle, detail::E::kRequestRises, detail::S::kRequested, detail::A::kBegin),
        detail::on(detail::S::kIdle, detail::E::kRequestFalls, detail::S::kIdle),
        detail::on(detail::S::kIdle, detail::E::kRequestChanges, detail::S::kIdle),
        detail::on(detail::S::kIdle, detail::E::kConfirmRises, detail::S::kReleased, detail::A::kUnrequested),
        detail::on(detail::S::kIdle, detail::E::kConfirmFalls, detail::S::kIdle),
        detail::on(detail::S::kIdle, detail::E::kLimitPasses, detail::S::kIdle),
        detail::on(detail::S::kRequested, detail::E::kRequestRises, detail::S::kRequested),
        detail::on(detail::S::kRequested, detail::E::kRequestFalls, detail::S::kIdle, detail::A::kDrop),
        detail::on(detail::S::kRequested, detail::E::kRequestChanges, detail::S::kRequested, detail::A::kChange),
        detail::on(detail::S::kRequested, detail::E::kConfirmRises, detail::S::kConfirmed, detail::A::kResult),
        detail::on(detail::S::kRequested, detail::E::kConfirmFalls, detail::S::kRequested),
        detail::on(detail::S::kRequested, detail::E::kLimitPasses, detail::S::kRequested, detail::A::kMissing),
        detail::on(detail::S::kConfirmed, detail::E::kRequestRises, detail::S::kConfirmed),
        detail::on(detail::S::kConfirmed, detail::E::kRequestFalls, detail::S::kReleased, detail::A::kRelease),
        detail::on(detail::S::kConfirmed, detail::E::kRequestChanges, detail::S::kConfirmed),
        detail::on(detail::S::kConfirmed, detail::E::kConfirmRises, detail::S::kConfirmed),
        detail::on(detail::S::kConfirmed, detail::E::kConfirmFalls, detail::S::kUnknown),
        detail::on(detail::S::kConfirmed, detail::E::kLimitPasses, detail::S::kConfirmed),
        detail::on(detail::S::kReleased, detail::E::kRequestRises, detail::S::kUnknown, detail::A::kRestart),
        detail::on(detail::S::kReleased, detail::E::kRequestFalls, detail::S::kReleased),
        detail::on(detail::S::kReleased, detail::E::kRequestChanges, detail::S::kReleased),
        detail::on(detail::S::kReleased, detail::E::kConfirmRises, detail::S::kReleased),
        detail::on(detail::S::kReleased, detail::E::kConfirmFalls, detail::S::kIdle, detail::A::kFinish),
        detail::on(detail::S::kReleased, detail::E::kLimitPasses, detail::S::kReleased, detail::A::kStuck),
    }}};

// The state that two levels alone show.
constexpr Handshake handshake_of(bool request, bool confirm) {
  return request ? (confirm ? Handshake::kConfirmed : Handshake::kRequested)
                 : (confirm ? Handshake::kReleased : Handshake::kIdle);
}

}  // namespace servotrace::esb
