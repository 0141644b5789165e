// SPDX-License-Identifier: MIT
// Scenarios: readable TOML files that say what a master does, which fault is put in, and which findings are expected;
// and the simulation that turns one into frames. The same scenario gives the same bytes on every machine.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "decoder/core/result.hpp"
#include "decoder/link/raw_frame.hpp"

namespace servotrace::simulator {

// A finding the scenario must raise: all of them, and no others, may appear.
struct ExpectedFinding {
  std::string rule;            // "RX201"
  int mac_id = -1;             // -1: of a whole bus or the capture
  bool any_node = true;        // false where the scenario names mac_id
  std::string channel;         // "" any, "main", "sub", "poll", "explicit", "unconnected"
  std::uint32_t findings = 1;  // how many
  std::string severity;        // "" any
  std::string cause;           // rule it must name as its cause; "" any
};

struct Scenario {
  std::string name;                 // file name without .toml
  std::string title;                // one line
  std::string description;          // what happens, for the captures' README
  std::vector<std::string> rules;   // rules this scenario is about: those it raises, and
  std::vector<std::string> silent;  // those it comes as close to as possible without raising
  std::vector<ExpectedFinding> expect;
  std::string settings;  // TOML text in the shape of servotrace.toml; may be empty
  bool shipped = false;  // made into captures/<name>.pcapng
  std::string source;    // the whole TOML text
  std::string origin;    // for messages
};

struct SimulatedInterface {
  LinkType link_type = LinkType::kWiresharkUpperPdu;
  std::string name;
};

struct SimulatedFrame {
  std::uint32_t interface_id = 0;
  TimeNs time_ns = 0;
  std::vector<std::uint8_t> bytes;
  std::uint32_t original_length = 0;
};

struct Simulation {
  std::vector<SimulatedInterface> interfaces;
  std::vector<SimulatedFrame> frames;  // in the order of recording: by time, except where a scenario's recorder errs
};

// Reads a scenario. `origin` names it in messages (origin:line:column). The tables of the buses are checked by
// simulate().
Result<Scenario> parse_scenario(std::string_view text, std::string origin);
Result<Scenario> read_scenario(const std::filesystem::path& path);
Result<Simulation> simulate(const Scenario& scenario);

}  // namespace servotrace::simulator
