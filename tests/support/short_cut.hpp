// SPDX-License-Identifier: MIT
// The short cuts for traffic that says nothing new change no finding and no count: everything is judged twice, with
// them and without.
#pragma once

#include "captures/simulator/scenario.hpp"
#include "decoder/pipeline/settings.hpp"

namespace servotrace::test {

// Expects the same findings, counts of every rule and statistics, and the same values and links beside each frame.
void expect_same(const simulator::Simulation& simulation, const Settings& settings = {});

}  // namespace servotrace::test
