// SPDX-License-Identifier: MIT
#include "decoder/devicenet/session.hpp"

namespace servotrace::devicenet {

struct BusSession::Impl {
  bool devicenet = false;
};

BusSession::BusSession(const Settings& settings, const BusRef&, Findings&) : impl_(std::make_unique<Impl>()) {
  impl_->devicenet = settings.devicenet.assumed;
}
BusSession::~BusSession() = default;
void BusSession::push(const Context&, const can::Frame&) {}
void BusSession::assume() { impl_->devicenet = true; }
bool BusSession::is_devicenet() const { return impl_->devicenet; }
void BusSession::gap() {}
void BusSession::finish(const Context&) {}
void BusSession::summarise(BusSummary&) const {}

}  // namespace servotrace::devicenet
