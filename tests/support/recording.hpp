// SPDX-License-Identifier: MIT
// Frames of several recordings in one capture file: starting a program once for all of them costs less than once for
// each. Every recording has interfaces of its own, so what one shows does not touch the others.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "captures/simulator/scenario.hpp"

namespace servotrace::test {

struct Recording {
  std::string name;
  std::vector<simulator::SimulatedInterface> interfaces;
  std::vector<simulator::SimulatedFrame> frames;
};

// Of captures/*.pcapng, in the order of their names.
std::vector<std::filesystem::path> shipped_captures();
Recording read_recording(const std::filesystem::path& capture);
// Of every scenario that has no settings of its own.
std::vector<Recording> simulated_recordings();

// The recording with one byte in `one_in` changed (not in the tags of exported PDUs); the same seed changes the same
// bytes.
Recording mutated(const Recording& recording, std::uint32_t seed, std::uint32_t one_in);
// The recording cut to `count` frames, from the one at `first` on or from its begin where it is shorter.
Recording some_frames(const Recording& recording, std::size_t first, std::size_t count);

void write_capture(const std::filesystem::path& path, const std::vector<Recording>& recordings);

}  // namespace servotrace::test
