// SPDX-License-Identifier: MIT
// The scenarios under captures/scenarios, simulated and checked.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "captures/simulator/scenario.hpp"
#include "decoder/findings/finding.hpp"
#include "decoder/pipeline/pipeline.hpp"
#include "decoder/pipeline/settings.hpp"

namespace servotrace::test {

// captures/scenarios/*.toml, by name.
std::vector<std::filesystem::path> scenario_files();
// Fail the test (and return something empty) where the file is broken.
simulator::Scenario load_scenario(const std::filesystem::path& path);
simulator::Simulation simulate_scenario(const simulator::Scenario& scenario);
Settings settings_of(const simulator::Scenario& scenario);

struct CheckedFinding {
  Finding finding;
  std::string rule;
  std::string text;  // for messages
};

// Frame `index`, as a reader hands it over; it views the simulation.
RawFrame raw_frame(const simulator::Simulation& simulation, std::size_t index);
// All frames through one pipeline, then finish().
Pipeline judged(const simulator::Simulation& simulation, const Settings& settings);
// What that finds.
std::vector<CheckedFinding> check(const simulator::Simulation& simulation, const Settings& settings);

}  // namespace servotrace::test
