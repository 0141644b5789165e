// SPDX-License-Identifier: MIT
// Everything on one simulated DeviceNet: the bus, its scanner, the slaves, and what a scenario does to frames on their
// way. The steps of a scenario act on it.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "captures/simulator/bus.hpp"
#include "captures/simulator/can_scanner.hpp"
#include "captures/simulator/can_slave.hpp"
#include "decoder/core/slot.hpp"

namespace servotrace::simulator {

class Ns310;
class Esb;

// Frames a scenario changes or loses.
struct Tampering {
  std::uint32_t identifier = 0;
  std::optional<std::uint8_t> fragment;  // only I/O fragments of this count
  unsigned skip = 0;                     // matching frames left alone first
  unsigned count = 1;                    // frames changed then
  Fate fate = Fate::kSent;
  std::optional<std::size_t> byte;  // of the frame's data
  std::uint8_t set = 0;
  std::uint8_t clear = 0;
  std::optional<std::uint8_t> length;
};

struct CanWorld {
  CanWorld(const BusJob& bus_job, std::uint32_t bit_rate, std::uint8_t master_mac_id, DurationNs period_ns,
           DurationNs delay_ns);
  CanWorld(const CanWorld&) = delete;
  CanWorld& operator=(const CanWorld&) = delete;

  const BusJob& job;
  CanBus bus;
  Scanner scanner;
  std::vector<std::unique_ptr<Slave>> slaves;  // may hold two of one MAC ID
  std::vector<Tampering> tamperings;

  // The first slave of this MAC ID, or nullptr.
  Slave* slave(std::uint8_t mac_id);
  // The node a step names, or the first one. Reports an unknown one, and then hands out the first.
  std::uint8_t node(TableReader& reader);
  Ns310* ns310(TableReader& reader);  // nullptr, and a problem, where the node is none
  Esb* esb(TableReader& reader);
  Scanner::Node& scanned(std::uint8_t mac_id) { return scanner.node(mac_id); }
  // Polls until `signal` of the node's response is `wanted`, `limit` polls at most. False where it never was.
  bool poll_until(std::uint8_t mac_id, Slot signal, std::int64_t wanted, unsigned limit);

 private:
  Fate pass(CanFrame& frame);
};

// A word a step's `do` may be.
struct CanStep {
  std::string_view word;
  void (*run)(CanWorld& world, TableReader& step);
};
std::span<const CanStep> link_steps();   // can_steps_link.cpp
std::span<const CanStep> fault_steps();  // can_steps_faults.cpp
std::span<const CanStep> ns310_steps();  // can_steps_ns310.cpp
std::span<const CanStep> esb_steps();    // can_steps_esb.cpp

}  // namespace servotrace::simulator
