// SPDX-License-Identifier: MIT
// Runs the steps of a DeviceNet scenario and hands out its frames as people write them: "42E#004B03010300".
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "captures/simulator/scenario.hpp"

namespace servotrace::test {

struct SeenFrame {
  TimeNs time_ns = 0;
  std::string text;
};

inline std::string frame_text(const std::vector<std::uint8_t>& bytes) {
  char part[16];
  const unsigned long word = static_cast<unsigned long>(bytes[0]) << 24U | static_cast<unsigned long>(bytes[1]) << 16U |
                             static_cast<unsigned long>(bytes[2]) << 8U | bytes[3];
  std::snprintf(part, sizeof part, "%03lX#", word);
  std::string text = part;
  for (std::size_t i = 0; i < bytes[4]; ++i) {
    std::snprintf(part, sizeof part, "%02X", bytes[8 + i]);
    text += part;
  }
  return text;
}

// `can`: the keys of one [[can]] table.
inline std::vector<SeenFrame> frames_of(const std::string& can) {
  Result<simulator::Scenario> scenario = simulator::parse_scenario("title = \"t\"\n[[can]]\n" + can, "test.toml");
  EXPECT_TRUE(scenario) << scenario.error().text();
  if (!scenario) return {};
  Result<simulator::Simulation> simulation = simulator::simulate(*scenario);
  EXPECT_TRUE(simulation) << simulation.error().text();
  std::vector<SeenFrame> frames;
  if (!simulation) return frames;
  for (const simulator::SimulatedFrame& frame : simulation->frames)
    frames.push_back({frame.time_ns, frame_text(frame.bytes)});
  return frames;
}

inline std::vector<std::string> texts_of(const std::string& can) {
  std::vector<std::string> texts;
  for (const SeenFrame& frame : frames_of(can)) texts.push_back(frame.text);
  return texts;
}

inline bool contains(const std::vector<std::string>& texts, const std::string& text) {
  return std::find(texts.begin(), texts.end(), text) != texts.end();
}

}  // namespace servotrace::test
