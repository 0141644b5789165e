// SPDX-License-Identifier: MIT
#include "tests/support/recording.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "replay/capture/pcapng_writer.hpp"
#include "replay/capture/source.hpp"
#include "tests/support/paths.hpp"

namespace servotrace::test {

namespace fs = std::filesystem;

namespace {

// Wireshark's own dissector of exported PDUs stops with an assertion on tags it does not know, plugin or not: the 12
// bytes of the tags stay.
std::size_t mutable_from(LinkType type) { return type == LinkType::kWiresharkUpperPdu ? 12 : 0; }

}  // namespace

std::vector<fs::path> shipped_captures() {
  std::vector<fs::path> all;
  for (const auto& entry : fs::directory_iterator(source_dir() / "captures")) {
    if (entry.path().extension() == ".pcapng") all.push_back(entry.path());
  }
  std::sort(all.begin(), all.end());
  return all;
}

Recording read_recording(const fs::path& capture) {
  Recording result;
  result.name = capture.filename().string();
  Result<std::unique_ptr<replay::Source>> source = replay::open_capture(capture);
  if (!source) {
    ADD_FAILURE() << source.error().text();
    return result;
  }
  RawFrame frame;
  while ((*source)->next(frame) == replay::Source::Step::kFrame)
    result.frames.push_back(
        {frame.interface_id, frame.time_ns, {frame.bytes.begin(), frame.bytes.end()}, frame.original_length});
  for (const replay::InterfaceInfo& interface : (*source)->interfaces())
    result.interfaces.push_back({interface.link_type, interface.name});
  return result;
}

std::vector<Recording> simulated_recordings() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(source_dir() / "captures" / "scenarios")) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<Recording> all;
  for (const fs::path& file : files) {
    const auto scenario = simulator::read_scenario(file);
    if (!scenario || !scenario->settings.empty()) continue;
    auto simulation = simulator::simulate(*scenario);
    if (!simulation) continue;  // the scenarios' own test says so
    all.push_back({scenario->name, std::move(simulation->interfaces), std::move(simulation->frames)});
  }
  return all;
}

Recording mutated(const Recording& recording, std::uint32_t seed, std::uint32_t one_in) {
  Recording result = recording;
  std::mt19937 random(seed);
  for (simulator::SimulatedFrame& frame : result.frames) {
    const std::size_t first = mutable_from(recording.interfaces[frame.interface_id].link_type);
    for (std::size_t i = first; i < frame.bytes.size(); ++i) {
      if (random() % one_in == 0) frame.bytes[i] = static_cast<std::uint8_t>(random());
    }
  }
  return result;
}

Recording some_frames(const Recording& recording, std::size_t first, std::size_t count) {
  Recording result{recording.name, recording.interfaces, {}};
  const std::size_t size = recording.frames.size();
  const std::size_t begin = first < size ? first : 0;
  for (std::size_t i = begin; i < size && i < begin + count; ++i) result.frames.push_back(recording.frames[i]);
  return result;
}

void write_capture(const fs::path& path, const std::vector<Recording>& recordings) {
  auto created = replay::PcapngWriter::create(path);
  ASSERT_TRUE(created) << created.error().text();
  replay::PcapngWriter& writer = **created;
  std::uint32_t first = 0;
  for (const Recording& recording : recordings) {
    for (const simulator::SimulatedInterface& interface : recording.interfaces)
      writer.add_interface(interface.link_type, interface.name);
    for (const simulator::SimulatedFrame& frame : recording.frames)
      writer.write(first + frame.interface_id, frame.time_ns, frame.bytes, frame.original_length);
    first += static_cast<std::uint32_t>(recording.interfaces.size());
  }
  const Result<void> finished = writer.finish();
  ASSERT_TRUE(finished) << finished.error().text();
}

}  // namespace servotrace::test
