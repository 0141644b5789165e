// SPDX-License-Identifier: MIT
// A simulation as a capture, without a file in between.
#pragma once

#include "captures/simulator/scenario.hpp"
#include "replay/capture/source.hpp"

namespace servotrace::replay {

class SimulatedSource : public Source {
 public:
  // `simulation` must outlive the source.
  explicit SimulatedSource(const simulator::Simulation& simulation) : simulation_(simulation) {
    format_ = "simulation";
    for (const simulator::SimulatedInterface& entry : simulation.interfaces) {
      interfaces_.push_back({.link_type = entry.link_type, .name = entry.name});
    }
  }

  Step next(RawFrame& frame) override {
    if (next_ == simulation_.frames.size()) return Step::kEnd;
    const simulator::SimulatedFrame& from = simulation_.frames[next_++];
    frame = {.number = next_,
             .time_ns = from.time_ns,
             .link_type = simulation_.interfaces[from.interface_id].link_type,
             .interface_id = from.interface_id,
             .bytes = from.bytes,
             .original_length = from.original_length};
    return Step::kFrame;
  }

 private:
  const simulator::Simulation& simulation_;
  std::size_t next_ = 0;
};

}  // namespace servotrace::replay
