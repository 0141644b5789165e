// SPDX-License-Identifier: MIT
// [[can]]: a DeviceNet bus of a scenario. captures/scenarios/devicenet-steps.md lists the words of its steps.
#include "captures/simulator/bus.hpp"
#include "captures/simulator/can_esb.hpp"
#include "captures/simulator/can_generic.hpp"
#include "captures/simulator/can_ns310.hpp"
#include "captures/simulator/can_world.hpp"

namespace servotrace::simulator {
namespace {

enum class Model : std::uint8_t { kNs310, kEsb, kGeneric };

void add_node(CanWorld& world, const toml::table& table) {
  TableReader reader(table, world.job.problems);
  const auto mac_id = static_cast<std::uint8_t>(reader.integer("mac_id", 0, 63));
  const Model model = reader.choice<Model>(
      "model", Model::kGeneric, {{"ns310", Model::kNs310}, {"esb", Model::kEsb}, {"generic", Model::kGeneric}});
  const auto serial = static_cast<std::uint32_t>(
      reader.integer("serial_number", 0x00310000 + static_cast<std::int64_t>(world.slaves.size()), 0, 0xFFFFFFFFLL));
  Scanner::Node& scanned = world.scanned(mac_id);
  scanned.mac_id = mac_id;
  switch (model) {
    case Model::kNs310:
      world.slaves.push_back(std::make_unique<Ns310>(world.bus, mac_id, serial));
      break;
    case Model::kEsb:
      world.slaves.push_back(std::make_unique<Esb>(world.bus, mac_id, serial));
      break;
    case Model::kGeneric: {
      Slave::Settings settings;
      settings.mac_id = mac_id;
      settings.identity.vendor_id = static_cast<std::uint16_t>(reader.integer("vendor_id", 700, 0, 0xFFFF));
      settings.identity.product_code = static_cast<std::uint16_t>(reader.integer("product_code", 7, 0, 0xFFFF));
      settings.identity.product_name = reader.text("product_name", "PLAIN SLAVE");
      settings.identity.serial_number = serial;
      settings.command_size = static_cast<std::uint8_t>(reader.integer("command_size", 2, 0, 64));
      settings.response_size = static_cast<std::uint8_t>(reader.integer("response_size", 2, 0, 64));
      world.slaves.push_back(std::make_unique<GenericSlave>(world.bus, settings));
      break;
    }
  }
  reader.done();
  const Slave::Settings& made = world.slaves.back()->settings();
  // The scanner's own image of the node; a second node of the same MAC ID leaves it as it is.
  if (scanned.command.empty()) {
    scanned.command.assign(made.command_size, 0);
    scanned.fragmented = made.command_size > 8;
    if (model == Model::kNs310) scanned.command[2] = scanned.command[3] = 0x20;  // axis instance 1
  }
}

void run_step(CanWorld& world, const toml::table& table) {
  TableReader step(table, world.job.problems);
  const std::string word = step.text("do");
  for (const std::span<const CanStep> steps : {link_steps(), fault_steps(), ns310_steps(), esb_steps()}) {
    for (const CanStep& row : steps) {
      if (row.word != word) continue;
      row.run(world, step);
      step.done();
      return;
    }
  }
  step.fail("do", "there is no step \"" + word + '"');
}

}  // namespace

void simulate_can(const BusJob& job) {
  TableReader reader(job.table, job.problems);
  const std::string name = reader.text("name", "can" + std::to_string(job.index));
  const auto bit_rate = static_cast<std::uint32_t>(reader.integer("bit_rate", 500'000, 10'000, 1'000'000));
  const auto master = static_cast<std::uint8_t>(reader.integer("master", 0, 0, 63));
  const DurationNs period_ns = reader.milliseconds("poll_ms", 10 * kMillisecondNs);
  const DurationNs delay_ns = reader.milliseconds("start_ms", 0);
  const std::vector<const toml::table*> nodes = reader.tables("nodes");
  const std::vector<const toml::table*> steps = reader.tables("steps");
  reader.done();
  if (period_ns < 500 * kMicrosecondNs) reader.fail("poll_ms", "\"poll_ms\" must be 0.5 or more");
  if (job.problems.any()) return;
  const std::uint32_t interface_id = job.recording.interface(LinkType::kCanSocketcan, name);
  CanWorld world(job, bit_rate, master, period_ns, delay_ns);
  for (const toml::table* node : nodes) add_node(world, *node);
  for (const toml::table* step : steps) {
    if (job.problems.any()) return;
    run_step(world, *step);
  }
  for (const RecordedFrame& entry : world.bus.recorded())
    job.recording.add(interface_id, entry.time_ns, socketcan_bytes(entry.frame));
}

}  // namespace servotrace::simulator
