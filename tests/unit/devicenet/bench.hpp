// SPDX-License-Identifier: MIT
// A pipeline fed with hand-built CAN frames of one bus, and its findings as short words.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "decoder/pipeline/pipeline.hpp"
#include "tests/support/bytes.hpp"

namespace servotrace::devicenet::test {

// A SocketCAN record (link type 227): identifier big-endian with its flags, length, three bytes, data.
std::vector<std::uint8_t> can_record(std::uint32_t identifier, const std::vector<std::uint8_t>& data);

class Bench {
 public:
  explicit Bench(Settings settings = assumed()) : pipeline_(settings) {}

  static Settings assumed() {
    Settings settings;
    settings.devicenet.assumed = true;
    return settings;
  }
  static Settings with_profile(std::uint8_t mac_id, std::string profile) {
    Settings settings = assumed();
    settings.devicenet.nodes.push_back({.mac_id = mac_id, .name = "axis", .profile = std::move(profile)});
    return settings;
  }

  // Pushes a frame `after_ms` after the one before. Identifiers may carry the SocketCAN flags (80000000h extended,
  // 40000000h remote, 20000000h error).
  Bench& frame(std::uint32_t identifier, std::string_view hex_data, double after_ms = 1.0);
  // A node that starts: two seconds of capture (frame 1), then two checks a second apart (frames 2 and 3).
  Bench& start(unsigned mac_id);
  // Allocation by master 1 of node `mac_id`, answered (two frames).
  Bench& allocate(unsigned mac_id, unsigned choice = 3);
  // One poll pair (two frames).
  Bench& poll(unsigned mac_id, std::string_view command, std::string_view response, double after_ms = 10.0);
  Bench& gap(std::uint64_t count = 1);
  Bench& finish();

  // "DN205@7" of each finding so far, in their order; severity other than the rule's own behind it: "DN207@3 note".
  // Those of the capture and of drive profiles are left out.
  std::vector<std::string> findings() const;
  const Finding& last() const { return pipeline_.findings().all().back(); }
  std::span<const Finding> all() const { return pipeline_.findings().all(); }
  std::uint64_t number() const { return number_; }
  const Dissection& dissection() const { return dissection_; }
  Summary summary() const { return pipeline_.summary(); }
  Pipeline& pipeline() { return pipeline_; }

 private:
  Pipeline pipeline_;
  Dissection dissection_;
  std::vector<std::uint8_t> bytes_;
  std::uint64_t number_ = 0;
  TimeNs now_ns_ = 1'700'000'000 * kSecondNs;
};

// What the dissection says of a derived field; -1 where it is not there.
std::int64_t derived_value(const Dissection& dissection, std::string_view key);
std::string derived_text(const Dissection& dissection, std::string_view key);
// The value of a field of the first segment that has it; -1 where none has.
std::int64_t field_value(const Dissection& dissection, std::string_view layout_key, std::string_view field_key);

std::vector<std::string> words(std::span<const Finding> findings);

}  // namespace servotrace::devicenet::test
