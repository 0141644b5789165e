// SPDX-License-Identifier: MIT
// Writes a Perfetto protobuf trace (https://ui.perfetto.dev): states as slices, process values as counters. Only the
// few message fields that are needed, written by hand.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "decoder/core/time.hpp"

namespace servotrace::replay {

class PerfettoWriter {
 public:
  // Appends to `out`, which may be emptied between calls.
  explicit PerfettoWriter(std::string& out) : out_(out) {}

  // Tracks must be declared before their events. `uuid` and `parent` are any numbers but 0; parent 0: none.
  void track(std::uint64_t uuid, std::uint64_t parent, std::string_view name);
  void counter_track(std::uint64_t uuid, std::uint64_t parent, std::string_view name, std::string_view unit);
  void begin_slice(std::uint64_t uuid, TimeNs time_ns, std::string_view name);
  void end_slice(std::uint64_t uuid, TimeNs time_ns);
  void counter(std::uint64_t uuid, TimeNs time_ns, double value);

 private:
  void packet(const std::string& content);
  void event(std::uint64_t uuid, TimeNs time_ns, unsigned type, std::string_view more);

  std::string& out_;
  // Kept from event to event, so that none allocates.
  std::string more_;
  std::string body_;
  std::string content_;
};

}  // namespace servotrace::replay
