// SPDX-License-Identifier: MIT
// Makes the captures of the benchmarks: the simulators make a stretch of traffic, and a period of it is repeated, with
// time and sequence going on, until there are as many frames as asked for.
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "decoder/link/rtex_record.hpp"
#include "replay/capture/pcapng_writer.hpp"
#include "tests/support/traffic.hpp"

namespace servotrace::test {
namespace {

struct Kind {
  const char* name;
  RtexTraffic traffic;
};
constexpr int kSimulatedCycles = 4096;
constexpr Kind kKinds[] = {
    {"rtex_1_axis", {.axes = 1, .cycle_us = 83.333, .cycles = kSimulatedCycles}},
    {"rtex_5_axes", {.axes = 5, .cycle_us = 83.333, .cycles = kSimulatedCycles}},
    {"rtex_8_axes", {.axes = 8, .cycle_us = 500, .cycles = kSimulatedCycles}},
    {"rtex_32_axes", {.axes = 32, .cycle_us = 500, .cycles = kSimulatedCycles}},
    {"rtex_16_wide_axes", {.axes = 16, .cycle_us = 1000, .wide = true, .cycles = kSimulatedCycles}},
};

Bytes record_of(const simulator::SimulatedFrame& frame) {
  const Bytes bytes = frame.bytes;
  const rtex::RecordPlace place = rtex::find_record(
      {.link_type = LinkType::kWiresharkUpperPdu, .bytes = bytes, .original_length = frame.original_length}, {});
  if (place.carrier == rtex::Carrier::kNone || place.malformed) throw std::runtime_error("a frame without a record");
  return bytes.subspan(place.offset, place.length);
}

// Blocks of two records are the same; their sequence is not compared.
bool same_blocks(const simulator::SimulatedFrame& left, const simulator::SimulatedFrame& right) {
  const Bytes one = record_of(left).subspan(rtex::kRecord.size);
  const Bytes other = record_of(right).subspan(rtex::kRecord.size);
  return std::equal(one.begin(), one.end(), other.begin(), other.end());
}

// A stretch whose end joins its beginning, behind the start of the ring and before its end.
struct Stretch {
  std::size_t first = 0;   // its first record
  std::size_t length = 0;  // records; 0: none was found
};

Stretch find_stretch(const std::vector<simulator::SimulatedFrame>& frames) {
  constexpr std::size_t kJoint = 64;                      // records that must be the same at both ends
  constexpr std::size_t kStart = 512;                     // until the ring runs and every servo is on
  constexpr std::size_t kLongest = 8 * 1024, kStep = 16;  // whole periods of every counter
  for (std::size_t length = kLongest; length > 2 * kJoint; length -= kStep) {
    if (frames.size() < kStart + length + 2 * kJoint) continue;
    for (std::size_t at = frames.size() - length - 2 * kJoint; at > kStart; at -= 2) {
      bool joins = true;
      for (std::size_t i = 0; joins && i < kJoint; ++i) joins = same_blocks(frames[at + i], frames[at + length + i]);
      if (joins) return {at, length};
    }
  }
  return {};
}

void append_repeated(simulator::Simulation& simulation, std::size_t wanted) {
  auto& frames = simulation.frames;
  if (frames.size() >= wanted) {
    frames.resize(wanted);
    return;
  }
  const auto [first, length] = find_stretch(frames);
  if (length == 0) throw std::runtime_error("no period found to repeat");
  frames.resize(first + length);
  const DurationNs took_ns = frames[first + length - 2].time_ns - frames[first - 2].time_ns;
  constexpr Slot kSequence = slot(rtex::kRecord, "sequence");
  frames.reserve(wanted);
  while (frames.size() < wanted) {
    simulator::SimulatedFrame next = frames[frames.size() - length];
    next.time_ns += took_ns;
    const Bytes record = record_of(next);
    const auto offset = static_cast<std::size_t>(record.data() - next.bytes.data());
    const auto sequence = static_cast<std::uint32_t>(read(kSequence, record)) + static_cast<std::uint32_t>(length / 2);
    if (!write(kSequence, MutableBytes(next.bytes).subspan(offset), sequence)) throw std::runtime_error("no sequence");
    frames.push_back(std::move(next));
  }
}

simulator::Simulation make(std::string name, std::size_t frames) {
  if (name == "devicenet") {
    constexpr std::size_t kFramesAPoll = 4;  // two nodes, request and response
    simulator::Simulation simulation = make_traffic(devicenet_traffic(static_cast<int>(frames / kFramesAPoll) + 100));
    if (simulation.frames.size() > frames) simulation.frames.resize(frames);
    return simulation;
  }
  const auto take_ending = [&name](std::string_view ending) {
    if (!name.ends_with(ending)) return false;
    name.resize(name.size() - ending.size());
    return true;
  };
  const bool handshakes = take_ending("_handshake");
  const bool moving = take_ending("_moving");
  for (const Kind& kind : kKinds) {
    if (name != kind.name) continue;
    RtexTraffic traffic = kind.traffic;
    traffic.handshakes = handshakes;
    traffic.moving = moving;
    if (moving) traffic.cycles *= 4;  // its period is longer
    simulator::Simulation simulation = make_traffic(rtex_traffic(traffic));
    append_repeated(simulation, frames);
    return simulation;
  }
  throw std::runtime_error("unknown kind of traffic '" + name + "'");
}

}  // namespace
}  // namespace servotrace::test

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: servotrace_bench_inputs KIND FRAMES FILE.pcapng\n");
    return 2;
  }
  try {
    const auto frames = static_cast<std::size_t>(std::strtoull(argv[2], nullptr, 10));
    servotrace::test::write_capture(servotrace::test::make(argv[1], frames), argv[3]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "servotrace_bench_inputs: %s\n", error.what());
    return 2;
  }
  return 0;
}
