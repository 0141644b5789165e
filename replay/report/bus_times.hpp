// SPDX-License-Identifier: MIT
// How regular the buses of a capture were, and how full: histograms of what comes again, and the bits of CAN.
#pragma once

#include <cstdint>
#include <vector>

#include "decoder/link/raw_frame.hpp"
#include "decoder/pipeline/dissection.hpp"
#include "replay/report/model.hpp"

namespace servotrace::report {

class BusTimes {
 public:
  void add(const RawFrame& frame, const Dissection& dissection);
  void finish(Model& model);

 private:
  enum class What : std::uint8_t { kCommandRecord, kPoll, kPollResponse, kExplicitResponse };
  struct Load {
    BusLoad load;
    TimeNs window_ns = 0;  // where the present window begins
    std::uint64_t window_bits = 0;
  };
  struct Intervals {
    BusRef bus;
    What what{};
    TimeNs last_ns = 0;
    bool has_last = false;
    std::vector<DurationNs> first;  // until the scale is chosen
    Histogram histogram;
  };

  void add_cycle(const RawFrame& frame, const Dissection& dissection);
  void add_times(const Dissection& dissection);
  void add_load(const RawFrame& frame, const Dissection& dissection);
  Intervals* intervals_of(const BusRef& bus, What what);
  static void add_interval(Intervals& intervals, DurationNs interval);
  static void scale(Intervals& intervals);

  std::vector<Intervals> intervals_;
  std::vector<Load> loads_;
};

}  // namespace servotrace::report
