// SPDX-License-Identifier: MIT
// The short cuts for traffic that says nothing new change no finding and no count: everything is judged twice, with
// them and without.
#pragma once

#include "captures/simulator/scenario.hpp"
#include "decoder/pipeline/settings.hpp"

namespace servotrace::test {

// Expects the same findings, the same counts of every rule and the same statistics.
void expect_same(const simulator::Simulation& simulation, const Settings& settings = {});

}  // namespace servotrace::test
