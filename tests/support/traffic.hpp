// SPDX-License-Identifier: MIT
// Long stretches of ordinary traffic, made by the simulators: for the benchmarks and for what must hold in the long
// run.
#pragma once

#include <filesystem>
#include <string>

#include "captures/simulator/scenario.hpp"

namespace servotrace::test {

struct RtexTraffic {
  int axes = 1;
  double cycle_us = 500;    // 83.333, 166.667, 500 or 1000
  bool wide = false;        // 32-byte blocks
  int cycles = 1000;        // communication cycles after the start, about
  bool handshakes = false;  // a non-cyclic command on every axis all the time
  bool moving = false;      // every axis goes to and fro in cyclic position mode; both: the axes by turns
};

// Scenarios as text. Nothing in them is wrong.
std::string rtex_traffic(const RtexTraffic& traffic);
// An NS310 and an ESB, polled; every hundredth poll an explicit request.
std::string devicenet_traffic(int polls);

// Fails the running test, or throws outside one, where the text is wrong.
simulator::Simulation make_traffic(const std::string& scenario);
void write_capture(const simulator::Simulation& simulation, const std::filesystem::path& path);

}  // namespace servotrace::test
