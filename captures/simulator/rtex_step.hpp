// SPDX-License-Identifier: MIT
// The steps a scenario's master takes, one after the other for each axis.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "captures/simulator/rtex_drive.hpp"
#include "captures/simulator/rtex_fault.hpp"

namespace servotrace::simulator::ring {

enum class Do : std::uint8_t {
  kWait,
  kSync,  // until every axis is here
  kServoOn,
  kServoOff,
  kMove,           // CP: the master generates the positions
  kJump,           // CP: the command position is another one at once
  kSpeed,          // CV
  kTorque,         // CT
  kMode,           // another cyclic code
  kStartProfile,   // PP: 17h
  kProfileUpdate,  // PP: another target or speed while 17h is held
  kProfileEnd,     // PP: waits for the end of the operation and goes back to 10h
  kCommand,        // any other non-cyclic command
  kControl,        // control bits
  kSendNop,
  kDrive  // something happens to the drive
};

// When the master goes back from a non-cyclic command to the standard command.
enum class Leave : std::uint8_t {
  kDone,     // Busy = 0 and the right echo (3-3-4 step 3)
  kEcho,     // on the echo of the command code
  kAllEcho,  // on the echo of every axis (6-3-1)
  kRunning,  // profile: not at all; the step ends when the operation runs
  kCycles,   // after a number of communication cycles
  kKeep      // not at all; the step ends at once
};

struct Request {
  bool sub = false;
  int code = 0;
  int type = 0;
  int index = 0;
  std::optional<std::int32_t> data3;
  Leave leave = Leave::kDone;
  std::int64_t cycles = 0;  // kCycles: held; else held on for so long after the condition came true
  bool chain = false;       // the next command begins without a standard command between
  bool settle = true;       // the step ends when the standard command is echoed
  bool reference = true;    // homing: the command position becomes the new reference (7-2-1 note 5)
};

// Control bits by name; absent ones stay.
struct ControlBit {
  Slot bit;
  bool value = false;
};

struct Step {
  Do what = Do::kWait;
  int axis = -1;  // MAC-ID; -1: every axis
  toml::source_region where;
  std::optional<DurationNs> at_ns;  // not before this time since the ring's start
  DurationNs for_ns = 0;
  std::int64_t cycles = 0;
  bool wait = true;
  bool relative = false;
  std::int64_t target = 0;
  std::int64_t speed = 0;  // command units a second; kSpeed and kProfileCommand: in the unit of Pr7.25
  std::int64_t rate = 1'000'000;
  int mode = kCp;
  bool hurry = false;     // kMode: without waiting for the 2 ms of 7-6-3
  bool together = false;  // kProfileCommand: with the change into PP in the same cycle
  std::optional<std::int64_t> first_value;
  Request request;
  std::vector<ControlBit> control;
  std::vector<Fault> faults;
  // What the drive does, kDrive and commands.
  std::optional<DurationNs> busy_ns;
  bool err = false;
  bool wng = false;
  std::optional<AlarmCode> alarm;
  std::optional<std::uint8_t> warning;
  std::optional<unsigned> input;
  bool active = true;
  std::optional<bool> main_power;
  std::optional<bool> blocked;
  DurationNs give_up_ns = 0;
};

// A step of the scenario may stand for several (a text read four characters at a time).
void read_step(const toml::table& table, Problems& problems, std::int64_t cycles_per_second, std::vector<Step>& steps);

// "7.23" to 0717h.
int read_parameter(TableReader& reader, std::string_view key);

}  // namespace servotrace::simulator::ring
