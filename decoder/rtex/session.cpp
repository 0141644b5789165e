// SPDX-License-Identifier: MIT
#include "decoder/rtex/session.hpp"

namespace servotrace::rtex {

struct RingSession::Impl {};

RingSession::RingSession(const Settings&, const BusRef&, Findings&) : impl_(std::make_unique<Impl>()) {}
RingSession::~RingSession() = default;
void RingSession::push(const Context&, const RecordPlace&) {}
void RingSession::gap() {}
void RingSession::finish(const Context&) {}
void RingSession::summarise(BusSummary&) const {}

}  // namespace servotrace::rtex
