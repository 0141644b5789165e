// SPDX-License-Identifier: MIT
#include "captures/simulator/bus.hpp"

namespace servotrace::simulator {

void simulate_ring(const BusJob& job) { job.problems.add(job.table.source(), "this kind of bus is not simulated"); }

}  // namespace servotrace::simulator
