// SPDX-License-Identifier: MIT
#include "decoder/devicenet/session.hpp"

#include "decoder/devicenet/bus.hpp"

namespace servotrace::devicenet {

struct BusSession::Impl {
  Bus bus;
};

BusSession::BusSession(const Settings& settings, const BusRef& bus, Findings& findings)
    : impl_(new Impl{Bus(settings, bus, findings)}) {}
BusSession::~BusSession() = default;
bool BusSession::push(const Context& context, const can::Frame& frame) {
  impl_->bus.push(context, frame);
  return impl_->bus.is_devicenet();
}
bool BusSession::push_plain(const Context& context, const can::Frame& frame) {
  impl_->bus.push_plain(context, frame);
  return impl_->bus.is_devicenet();
}
void BusSession::assume() { impl_->bus.assume(); }
bool BusSession::is_devicenet() const { return impl_->bus.is_devicenet(); }
void BusSession::gap() { impl_->bus.gap(); }
void BusSession::finish(const Context& context) { impl_->bus.finish(context); }
void BusSession::summarise(BusSummary& summary) const { impl_->bus.summarise(summary); }

}  // namespace servotrace::devicenet
