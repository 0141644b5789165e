// SPDX-License-Identifier: MIT
// A ring's session: everything known about one RTEX ring, from its records in order.
#pragma once

#include <memory>

#include "decoder/link/rtex_record.hpp"
#include "decoder/pipeline/context.hpp"
#include "decoder/pipeline/summary.hpp"

namespace servotrace::rtex {

class RingSession {
 public:
  RingSession(const Settings& settings, const BusRef& bus, Findings& findings);
  ~RingSession();
  RingSession(const RingSession&) = delete;
  RingSession& operator=(const RingSession&) = delete;

  // A whole, well-formed record.
  void push(const Context& context, const RecordPlace& place);
  // Records of this ring were lost (truncated record, drop count, file border): comparisons restart.
  void gap();
  // The end of the capture; `context.frame` is the last frame.
  void finish(const Context& context);
  void summarise(BusSummary& summary) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace servotrace::rtex
