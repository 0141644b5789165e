// SPDX-License-Identifier: MIT
#include "decoder/rtex/session.hpp"

#include "decoder/rtex/engine.hpp"

namespace servotrace::rtex {

struct RingSession::Impl {
  Impl(const Settings& settings, const BusRef& bus, Findings& findings) : engine(settings, bus, findings) {}
  Engine engine;  // too large for the stack
};

RingSession::RingSession(const Settings& settings, const BusRef& bus, Findings& findings)
    : impl_(std::make_unique<Impl>(settings, bus, findings)) {}
RingSession::~RingSession() = default;
void RingSession::push(const Context& context, const RecordPlace& place) { impl_->engine.push(context, place); }
void RingSession::gap() { impl_->engine.gap(); }
void RingSession::finish(const Context& context) { impl_->engine.finish(context); }
void RingSession::summarise(BusSummary& summary) const { impl_->engine.summarise(summary); }

}  // namespace servotrace::rtex
