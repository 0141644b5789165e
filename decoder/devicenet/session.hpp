// SPDX-License-Identifier: MIT
// A CAN bus's session: whether it is DeviceNet, and then its nodes, connections and messages.
#pragma once

#include <memory>

#include "decoder/link/socketcan.hpp"
#include "decoder/pipeline/context.hpp"
#include "decoder/pipeline/summary.hpp"

namespace servotrace::devicenet {

class BusSession {
 public:
  BusSession(const Settings& settings, const BusRef& bus, Findings& findings);
  ~BusSession();
  BusSession(const BusSession&) = delete;
  BusSession& operator=(const BusSession&) = delete;

  // A whole CAN frame (error, remote and extended frames too). True where the bus is DeviceNet.
  bool push(const Context& context, const can::Frame& frame);
  // The same for a data frame of 11 bits that nobody looks at.
  bool push_plain(const Context& context, const can::Frame& frame);
  // The bus is DeviceNet by configuration (settings say so too): needs no evidence.
  void assume();
  bool is_devicenet() const;
  // Records of this bus were lost: nothing is blamed on a missing frame.
  void gap();
  // The end of the capture; `context.frame` is the last frame.
  void finish(const Context& context);
  void summarise(BusSummary& summary) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace servotrace::devicenet
