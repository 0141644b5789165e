// SPDX-License-Identifier: MIT
// servotrace simulate: makes a capture from a scenario.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "captures/simulator/scenario.hpp"
#include "replay/capture/pcapng_writer.hpp"
#include "replay/commands.hpp"
#include "replay/console.hpp"
#include "replay/exit_status.hpp"

namespace servotrace::replay {

Result<void> write_simulation(const simulator::Simulation& simulation, const std::filesystem::path& path) {
  Result<std::unique_ptr<PcapngWriter>> writer = PcapngWriter::create(path);
  if (!writer) return writer.error();
  for (const simulator::SimulatedInterface& entry : simulation.interfaces) {
    (*writer)->add_interface(entry.link_type, entry.name);
  }
  for (const simulator::SimulatedFrame& frame : simulation.frames) {
    (*writer)->write(frame.interface_id, frame.time_ns, frame.bytes, frame.original_length);
  }
  return (*writer)->finish();
}

int run_simulate(const Arguments& arguments) {
  CLI::App app("Makes a capture from a scenario: a master, drive models, and the fault that is put in.",
               "servotrace simulate");
  std::string scenario_path;
  std::string out_path;
  app.add_option("SCENARIO", scenario_path, "A scenario (.toml)")->required();
  app.add_option("-o,--output", out_path, "The capture to write (.pcapng)")->required()->type_name("FILE");
  app.footer(
      "The same scenario gives the same bytes on every machine.\n\n"
      "Example:\n  servotrace simulate captures/scenarios/rtex_clean.toml -o clean.pcapng");
  if (const std::optional<int> status = parse(app, arguments)) return *status;
  const Result<simulator::Scenario> scenario = simulator::read_scenario(scenario_path);
  if (!scenario) {
    complain(scenario.error());
    return kExitFailed;
  }
  const Result<simulator::Simulation> simulation = simulator::simulate(*scenario);
  if (!simulation) {
    complain(simulation.error());
    return kExitFailed;
  }
  if (const Result<void> written = write_simulation(*simulation, out_path); !written) {
    complain(written.error());
    return kExitFailed;
  }
  return kExitClean;
}

}  // namespace servotrace::replay
