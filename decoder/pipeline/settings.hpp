// SPDX-License-Identifier: MIT
// Settings of the decoder: what servotrace.toml says (replay/settings reads it), as plain values. Every optional that
// is empty is learnt from the capture or stays unknown.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "decoder/core/time.hpp"

namespace servotrace {

struct RtexAxisSettings {
  std::optional<std::uint8_t> ring;
  std::uint8_t mac_id = 0;  // 0..31
  std::string name;
  std::optional<std::uint8_t> data_size;             // 16 or 32 bytes
  std::optional<bool> full_closed;                   // Pr0.01
  std::optional<bool> absolute;                      // position system
  std::map<std::uint16_t, std::int32_t> parameters;  // class << 8 | number (0717h: Pr7.23) to value
  // Response byte 3, bits 3..7: true where the input carries its second meaning (bit 7: E-STOP instead of SI-MON5).
  std::array<std::optional<bool>, 8> input_second_meaning = {};
  std::optional<std::int64_t> max_speed;  // command units a second, above 0
};

struct RtexSettings {
  std::optional<DurationNs> communication_cycle_ns;  // one of 83333, 166667, 500000, 1000000
  std::optional<std::uint8_t> command_update_ratio;  // 1 or 2
  std::optional<bool> full_sync;                     // Pr7.22 bit 1
  std::uint16_t user_link_type = 147;                // 147..162
  std::uint16_t ethertype = 0x88B5;
  std::uint16_t udp_port = 35224;
  std::vector<RtexAxisSettings> axes;
};

struct DevicenetNodeSettings {
  std::uint8_t mac_id = 0;  // 0..63
  std::string name;
  std::string profile;  // "yaskawa-ns310", "nsk-esb", "generic", or empty
};

struct DevicenetSettings {
  bool assumed = false;  // --devicenet: 11-bit CAN is DeviceNet without further evidence
  std::vector<DevicenetNodeSettings> nodes;
};

// Every limit the catalogue names; in the unit of its name.
struct Limits {
  std::int64_t echo_ms = 100;
  std::int64_t busy_ms = 1000;
  std::int64_t busy_long_ms = 15000;
  std::int64_t communication_errors = 3;
  std::int64_t jitter_percent = 50;
  std::int64_t timeout_cycles = 5;
  std::int64_t servo_on_units = 1000;
  std::int64_t inhibit_units = 1000;
  std::optional<std::int64_t> moving_speed;  // r/min; 30 where unset, none where Pr7.25 = 1
  std::int64_t dead_band_units = 0;
  std::int64_t mode_change_velocity_percent = 20;
  std::int64_t torque_limited_ms = 100;
  std::int64_t eeprom_writes_per_hour = 10;
  std::int64_t explicit_response_ms = 1000;
  std::int64_t epr_factor = 4;
  std::int64_t poll_echo_count = 3;
  std::int64_t prm_ack_ms = 1000;
  std::int64_t prm_ack_long_ms = 60000;
  std::int64_t start_seen_ms = 200;
  std::int64_t handshake_ms = 100;
  std::int64_t fragment_ms = 2000;
  std::int64_t fragment_ack_ms = 1000;
  std::int64_t first_io_ms = 10000;
  std::int64_t flash_writes_per_hour = 10;
};

struct Settings {
  RtexSettings rtex;
  DevicenetSettings devicenet;
  Limits limits;
  std::uint32_t max_findings = 100;  // kept for each rule and owner
  bool judge_every_block = false;    // take no short cut for blocks that say nothing new: tests compare the two

  // The settings of an axis, or nullptr. An entry without a ring holds for every ring.
  const RtexAxisSettings* axis(std::uint8_t ring, std::int16_t mac_id) const {
    const RtexAxisSettings* any_ring = nullptr;
    for (const RtexAxisSettings& entry : rtex.axes) {
      if (entry.mac_id != mac_id) continue;
      if (entry.ring == ring) return &entry;
      if (!entry.ring) any_ring = &entry;
    }
    return any_ring;
  }
  const DevicenetNodeSettings* node(std::int16_t mac_id) const {
    for (const DevicenetNodeSettings& entry : devicenet.nodes) {
      if (entry.mac_id == mac_id) return &entry;
    }
    return nullptr;
  }
};

}  // namespace servotrace
