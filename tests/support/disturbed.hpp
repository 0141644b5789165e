// SPDX-License-Identifier: MIT
// A quiet ring to which something happens now and then: for what must be the same with a short cut and without it.
#pragma once

#include <cstdint>

#include "captures/simulator/scenario.hpp"

namespace servotrace::test {

// `whole`, the traffic of one ring, with four disturbances in its second half; the same seed gives the same ones.
simulator::Simulation disturbed(const simulator::Simulation& whole, std::uint32_t seed);

}  // namespace servotrace::test
