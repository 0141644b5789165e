// SPDX-License-Identifier: MIT
#include "tests/support/scenarios.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "decoder/findings/catalogue.hpp"
#include "decoder/pipeline/pipeline.hpp"
#include "decoder/render/message.hpp"
#include "decoder/render/value.hpp"
#include "replay/settings/settings.hpp"
#include "tests/support/paths.hpp"

namespace servotrace::test {

std::vector<std::filesystem::path> scenario_files() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(source_dir() / "captures" / "scenarios")) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

simulator::Scenario load_scenario(const std::filesystem::path& path) {
  Result<simulator::Scenario> scenario = simulator::read_scenario(path);
  if (scenario) return *scenario;
  ADD_FAILURE() << scenario.error().text();
  return {};
}

simulator::Simulation simulate_scenario(const simulator::Scenario& scenario) {
  Result<simulator::Simulation> simulation = simulator::simulate(scenario);
  if (simulation) return *simulation;
  ADD_FAILURE() << simulation.error().text();
  return {};
}

Settings settings_of(const simulator::Scenario& scenario) {
  Result<replay::FileSettings> settings = replay::parse_settings(scenario.settings, scenario.origin + " [settings]");
  if (settings) return settings->decoder;
  ADD_FAILURE() << settings.error().text();
  return {};
}

RawFrame raw_frame(const simulator::Simulation& simulation, std::size_t index) {
  const simulator::SimulatedFrame& frame = simulation.frames[index];
  return {.number = index + 1,
          .time_ns = frame.time_ns,
          .link_type = simulation.interfaces[frame.interface_id].link_type,
          .interface_id = frame.interface_id,
          .bytes = frame.bytes,
          .original_length = frame.original_length};
}

Pipeline judged(const simulator::Simulation& simulation, const Settings& settings) {
  Pipeline pipeline(settings);
  for (std::size_t i = 0; i < simulation.frames.size(); ++i) pipeline.push(raw_frame(simulation, i));
  pipeline.finish();
  return pipeline;
}

std::vector<CheckedFinding> check(const simulator::Simulation& simulation, const Settings& settings) {
  const Pipeline pipeline = judged(simulation, settings);
  std::vector<CheckedFinding> result;
  for (const Finding& finding : pipeline.findings().all()) {
    const std::string id(rule_row(finding.rule).id);
    std::string text = "frame " + std::to_string(finding.frame) + ' ' + std::string(name_of(finding.severity)) + ' ' +
                       id + " mac_id " + std::to_string(finding.node.mac_id);
    const std::string_view channel = name_of(finding.node.channel);
    if (!channel.empty()) text += ' ' + std::string(channel);
    text += " x" + std::to_string(finding.count) + ": " + message(finding);
    result.push_back({finding, id, text});
  }
  return result;
}

}  // namespace servotrace::test
