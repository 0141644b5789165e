// SPDX-License-Identifier: MIT
#include "tests/support/traffic.hpp"

#include <stdexcept>

#include "replay/capture/pcapng_writer.hpp"

namespace servotrace::test {
namespace {

void append_moves(std::string& text, const RtexTraffic& traffic, const std::string& axis) {
  // Ways of some hundred cycles: speed and acceleration follow from the cycle, so that a short period repeats.
  const int speed = static_cast<int>(4e9 / 60 / traffic.cycle_us);
  const int acceleration = static_cast<int>(speed * 1e6 / 30 / traffic.cycle_us);
  for (int i = 0; i < traffic.cycles / 300; ++i) {
    text += "[[ring.step]]\ndo = \"move\"\nto = " + std::to_string(i % 2 == 0 ? 16'000 : 0) +
            "\nspeed = " + std::to_string(speed) + "\nacceleration = " + std::to_string(acceleration) + "\n" + axis;
  }
}

void append_monitors(std::string& text, const RtexTraffic& traffic, const std::string& axis) {
  constexpr int kCyclesOfOne = 4;  // command, echo, back, echo
  for (int i = 0; i < traffic.cycles / kCyclesOfOne; ++i)
    text += "[[ring.step]]\ndo = \"monitor\"\ntype = " + std::to_string(1 + i % 2) + "\n" + axis;
}

}  // namespace

std::string rtex_traffic(const RtexTraffic& traffic) {
  std::string text = "title = \"traffic\"\n[[ring]]\ncycle_us = ";
  char cycle[32];
  std::snprintf(cycle, sizeof cycle, "%.3f", traffic.cycle_us);
  text += cycle;
  text += "\n";
  for (int i = 0; i < traffic.axes; ++i) {
    text += "[[ring.axis]]\nmac_id = " + std::to_string(i) + "\n";
    if (traffic.wide) text += "data_size = 32\n";
  }
  const auto step = [&text](const std::string& keys) { text += "[[ring.step]]\n" + keys; };
  step("do = \"servo_on\"\n");
  if (traffic.handshakes && traffic.moving) {  // the axes by turns
    for (int i = 0; i < traffic.axes; ++i)
      (i % 2 == 0 ? append_moves : append_monitors)(text, traffic, "axis = " + std::to_string(i) + "\n");
  } else if (traffic.handshakes) {
    append_monitors(text, traffic, {});
  } else if (traffic.moving) {
    append_moves(text, traffic, {});
  } else {
    step("do = \"wait\"\ncycles = " + std::to_string(traffic.cycles) + "\n");
  }
  return text;
}

std::string devicenet_traffic(int polls) {
  std::string text =
      "title = \"traffic\"\n[[can]]\npoll_ms = 5\n"
      "nodes = [{ mac_id = 5, model = \"ns310\" }, { mac_id = 9, model = \"esb\" }]\nsteps = [\n"
      "{ do = \"connect\", node = 5 }, { do = \"connect\", node = 9 },\n"
      "{ do = \"enable\", node = 5 }, { do = \"servo_on\", node = 9 },\n";
  constexpr int kBetween = 100;
  for (int i = 0; i < polls; i += kBetween) {
    text += "{ do = \"poll\", node = 5, cycles = " + std::to_string(kBetween) + " },\n";
    text += "{ do = \"get_attribute\", node = 5, class = 0x25, attribute = 8 },\n";
  }
  return text + "]\n";
}

simulator::Simulation make_traffic(const std::string& scenario) {
  auto parsed = simulator::parse_scenario(scenario, "traffic");
  if (!parsed) throw std::runtime_error(parsed.error().text());
  auto simulation = simulator::simulate(*parsed);
  if (!simulation) throw std::runtime_error(simulation.error().text());
  return std::move(simulation.value());
}

void write_capture(const simulator::Simulation& simulation, const std::filesystem::path& path) {
  auto writer = replay::PcapngWriter::create(path);
  if (!writer) throw std::runtime_error(writer.error().text());
  for (const simulator::SimulatedInterface& interface : simulation.interfaces)
    (*writer)->add_interface(interface.link_type, interface.name);
  for (const simulator::SimulatedFrame& frame : simulation.frames)
    (*writer)->write(frame.interface_id, frame.time_ns, frame.bytes, frame.original_length);
  const auto finished = (*writer)->finish();
  if (!finished) throw std::runtime_error(finished.error().text());
}

}  // namespace servotrace::test
