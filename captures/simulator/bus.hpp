// SPDX-License-Identifier: MIT
// What a bus simulator is: it reads its table of the scenario and records frames. Each bus runs on its own; the
// recordings are merged by time.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "captures/simulator/scenario.hpp"
#include "captures/simulator/table_reader.hpp"

namespace servotrace::simulator {

// Every simulation begins here (2026-01-05 08:00:00 UTC): no clock is read.
inline constexpr TimeNs kSimulationStartNs = 1'767'600'000'000'000'000;

// Collects the frames of all buses.
class Recording {
 public:
  // The interface of this name and link type; made on first sight. Buses that name the same one share it.
  std::uint32_t interface(LinkType link_type, std::string_view name);
  // Records a frame that passed at `time_ns`.
  void add(std::uint32_t interface_id, TimeNs time_ns, Bytes bytes) {
    add_stamped(interface_id, time_ns, time_ns, bytes, static_cast<std::uint32_t>(bytes.size()));
  }
  // The same with the timestamp the recorder wrote instead of the true time, and with the length on the wire where
  // only a part was captured. Frames stand in the file in the order of their true times.
  void add_stamped(std::uint32_t interface_id, TimeNs time_ns, TimeNs stamp_ns, Bytes bytes,
                   std::uint32_t original_length);

  // By true time; of equal times, the order in which they were added.
  Simulation finish();

 private:
  struct Entry {
    TimeNs order_ns = 0;
    SimulatedFrame frame;
  };
  std::vector<SimulatedInterface> interfaces_;
  std::vector<Entry> entries_;
};

// One bus of a scenario. `table` and what it refers to live until the call returns.
struct BusJob {
  const toml::table& table;
  Problems& problems;     // where errors go; frames recorded after one are thrown away
  Recording& recording;   // where frames go
  TimeNs start_ns = 0;    // of the scenario; a bus may start later
  std::size_t index = 0;  // of buses of this kind, in the order of the file
};

void simulate_ring(const BusJob& job);  // [[ring]]: rtex_ring.cpp
void simulate_can(const BusJob& job);   // [[can]]: can_bus.cpp
void simulate_raw(const BusJob& job);   // [[raw]]: raw_interface.cpp

}  // namespace servotrace::simulator
