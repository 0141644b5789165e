// SPDX-License-Identifier: MIT
// Live traffic of a network interface through libpcap.
#pragma once

#include <memory>
#include <string>

#include "replay/capture/source.hpp"

namespace servotrace::replay {

class LiveSource : public Source {
 public:
  // Makes next() return kEnd soon, from any thread or a signal handler.
  virtual void stop() = 0;
};

struct LiveOptions {
  std::string interface;  // "can0", "eth1"
  std::string filter;     // libpcap's filter language; empty: everything
};

// Needs the right to capture (root, or CAP_NET_RAW). next() waits for traffic.
Result<std::unique_ptr<LiveSource>> open_live(const LiveOptions& options);

}  // namespace servotrace::replay
