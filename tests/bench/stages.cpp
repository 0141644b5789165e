// SPDX-License-Identifier: MIT
// What a frame costs, stage by stage, on traffic of every kind: the file read by libpcap and by us, the link layer on
// top, the whole pipeline on top of that. Each run reports nanoseconds and allocations a frame; the table at the end
// gives the ratio of each stage to libpcap, measured in the same run.
#include <benchmark/benchmark.h>
#include <pcap/pcap.h>

#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "decoder/link/rtex_record.hpp"
#include "decoder/link/socketcan.hpp"
#include "decoder/pipeline/pipeline.hpp"
#include "replay/capture/source.hpp"
#include "tests/support/counting_new.hpp"
#include "tests/support/traffic.hpp"

namespace servotrace::test {
namespace {

namespace fs = std::filesystem;

struct Capture {
  std::string name;
  std::string scenario;
  fs::path path;
};

std::vector<Capture>& captures() {
  static std::vector<Capture> all = [] {
    constexpr int kRecords = 100'000;  // a ring's cycle is two
    std::vector<Capture> list = {
        {"devicenet_1M", devicenet_traffic(250'000), {}},
        {"rtex_1_axis_83us", rtex_traffic({.axes = 1, .cycle_us = 83.333, .cycles = kRecords}), {}},
        {"rtex_5_axes_83us", rtex_traffic({.axes = 5, .cycle_us = 83.333, .cycles = kRecords}), {}},
        {"rtex_32_axes_500us", rtex_traffic({.axes = 32, .cycle_us = 500, .cycles = kRecords / 4}), {}},
        {"rtex_16_wide_1000us", rtex_traffic({.axes = 16, .cycle_us = 1000, .wide = true, .cycles = kRecords / 4}), {}},
        {"rtex_5_axes_handshakes",
         rtex_traffic({.axes = 5, .cycle_us = 83.333, .cycles = kRecords / 4, .handshakes = true}),
         {}},
        {"rtex_32_axes_handshakes",
         rtex_traffic({.axes = 32, .cycle_us = 500, .cycles = kRecords / 8, .handshakes = true}),
         {}},
    };
    for (Capture& capture : list) {
      capture.path = fs::temp_directory_path() / ("servotrace-bench-" + capture.name + ".pcapng");
      std::fprintf(stderr, "making %s\n", capture.path.c_str());
      if (!fs::exists(capture.path)) write_capture(make_traffic(capture.scenario), capture.path);
    }
    return list;
  }();
  return all;
}

// Nanoseconds a frame by capture and stage, for the table.
std::map<std::string, std::map<std::string, double>>& results() {
  static std::map<std::string, std::map<std::string, double>> all;
  return all;
}

// Runs `read`, which returns how many frames it saw, over the file again and again; the fastest pass counts.
template <class Read>
void measure(benchmark::State& state, const Capture& capture, const char* stage, Read read) {
  double best = 1e18;
  std::uint64_t frames = 0;
  std::uint64_t allocations = 0;
  for (auto iteration : state) {
    const std::uint64_t before = allocation_count;
    const auto start = std::chrono::steady_clock::now();
    frames = read(capture.path);
    const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - start;
    allocations = allocation_count - before;
    if (frames > 0) best = std::min(best, took.count() / static_cast<double>(frames));
  }
  state.counters["frames"] = static_cast<double>(frames);
  state.counters["ns_a_frame"] = best;
  state.counters["allocations_a_frame"] =
      frames == 0 ? 0 : static_cast<double>(allocations) / static_cast<double>(frames);
  results()[capture.name][stage] = best;
}

std::uint64_t libpcap_loop(const fs::path& path) {
  char message[PCAP_ERRBUF_SIZE] = {};
  pcap_t* const handle = pcap_open_offline(path.c_str(), message);
  if (handle == nullptr) return 0;
  pcap_pkthdr* header = nullptr;
  const u_char* bytes = nullptr;
  std::uint64_t frames = 0;
  while (pcap_next_ex(handle, &header, &bytes) == 1) ++frames;
  pcap_close(handle);
  return frames;
}

template <class Use>
std::uint64_t for_each_frame(const fs::path& path, Use use) {
  auto source = replay::open_capture(path);
  if (!source) return 0;
  RawFrame frame;
  std::uint64_t frames = 0;
  while ((*source)->next(frame) == replay::Source::Step::kFrame) {
    use(frame);
    ++frames;
  }
  return frames;
}

std::uint64_t reader(const fs::path& path) {
  return for_each_frame(path, [](const RawFrame& frame) { benchmark::DoNotOptimize(frame.bytes.data()); });
}

std::uint64_t link(const fs::path& path) {
  const RtexSettings settings;
  return for_each_frame(path, [&settings](const RawFrame& frame) {
    const can::Place can = can::find_frame(frame);
    benchmark::DoNotOptimize(can.found);
    if (!can.found) benchmark::DoNotOptimize(rtex::find_record(frame, settings).length);
  });
}

std::uint64_t whole(const fs::path& path, bool looked_at) {
  Pipeline pipeline{Settings{}};
  auto dissection = std::make_unique<Dissection>();
  const std::uint64_t frames = for_each_frame(
      path, [&](const RawFrame& frame) { pipeline.push(frame, looked_at ? dissection.get() : nullptr); });
  pipeline.finish();
  return frames;
}

void print_table() {
  std::printf(
      "\n| capture | libpcap, ns a frame | reader | link | pipeline | with dissection |\n|---|---|---|---|---|---|\n");
  for (const auto& [name, stages] : results()) {
    const auto base = stages.find("libpcap");
    if (base == stages.end()) continue;
    std::printf("| %s | %.1f |", name.c_str(), base->second);
    for (const char* stage : {"reader", "link", "pipeline", "dissection"}) {
      const auto value = stages.find(stage);
      if (value == stages.end()) {
        std::printf(" |");
      } else {
        std::printf(" %.2f x |", value->second / base->second);
      }
    }
    std::printf("\n");
  }
}

void add(const Capture& capture, const char* stage, std::uint64_t (*read)(const fs::path&)) {
  benchmark::RegisterBenchmark((capture.name + "/" + stage).c_str(), [&capture, stage, read](benchmark::State& state) {
    measure(state, capture, stage, read);
  })->Unit(benchmark::kMillisecond);
}

}  // namespace
}  // namespace servotrace::test

int main(int argc, char** argv) {
  using namespace servotrace::test;
  for (const Capture& capture : captures()) {
    add(capture, "libpcap", libpcap_loop);
    add(capture, "reader", reader);
    add(capture, "link", link);
    add(capture, "pipeline", [](const fs::path& path) { return whole(path, false); });
    add(capture, "dissection", [](const fs::path& path) { return whole(path, true); });
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  print_table();
  return 0;
}
