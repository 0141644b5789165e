// SPDX-License-Identifier: MIT
#include "tests/support/disturbed.hpp"

#include <algorithm>
#include <functional>
#include <random>

#include "decoder/link/rtex_record.hpp"

namespace servotrace::test {
namespace {

using Frames = std::vector<simulator::SimulatedFrame>;

// What may happen to a record of a quiet ring, at a random place.
using Disturbance = std::function<void(Frames&, std::size_t, std::mt19937&)>;

constexpr std::size_t kTags = 12;  // bytes of the exported PDU's tags before the record
constexpr std::size_t kBlocks = kTags + rtex::kRecord.size;

void flip_bit(Frames& frames, std::size_t at, std::mt19937& random) {
  std::vector<std::uint8_t>& bytes = frames[at].bytes;
  const std::size_t place = kBlocks + random() % (bytes.size() - kBlocks);
  bytes[place] = static_cast<std::uint8_t>(bytes[place] ^ (1U << random() % 8));
}
// A status or command bit that stays for a while.
void hold_bit(Frames& frames, std::size_t at, std::mt19937& random) {
  const std::size_t place = kBlocks + random() % (frames[at].bytes.size() - kBlocks);
  const auto bit = static_cast<std::uint8_t>(1U << random() % 8);
  const std::size_t end = std::min(frames.size(), at + 2 * (1 + random() % 60));
  for (std::size_t i = at; i < end; i += 2) {
    if (place < frames[i].bytes.size())
      frames[i].bytes[place] = static_cast<std::uint8_t>(frames[i].bytes[place] ^ bit);
  }
}
void lose(Frames& frames, std::size_t at, std::mt19937& random) {
  const auto count = static_cast<std::ptrdiff_t>(1 + random() % 3);
  const auto first = frames.begin() + static_cast<std::ptrdiff_t>(at);
  frames.erase(first, first + std::min(count, frames.end() - first));
}
void repeat(Frames& frames, std::size_t at, std::mt19937&) {
  const simulator::SimulatedFrame copy = frames[at];
  frames.insert(frames.begin() + static_cast<std::ptrdiff_t>(at), copy);
}
// The response of the cycle before stays in the memory.
void go_stale(Frames& frames, std::size_t at, std::mt19937& random) {
  const std::size_t count = 1 + random() % 12;
  for (std::size_t i = at; i < std::min(frames.size(), at + 2 * count); i += 2) {
    if (i < 2 || frames[i].bytes.size() != frames[i - 2].bytes.size()) return;
    std::copy(frames[i - 2].bytes.begin() + kBlocks, frames[i - 2].bytes.end(), frames[i].bytes.begin() + kBlocks);
  }
}
void pause(Frames& frames, std::size_t at, std::mt19937& random) {
  const auto by_ns = static_cast<DurationNs>(random() % 4'000'000);
  for (std::size_t i = at; i < frames.size(); ++i) frames[i].time_ns += by_ns;
}
// The times of records waver from here on.
void jitter(Frames& frames, std::size_t at, std::mt19937& random) {
  for (std::size_t i = at; i < frames.size(); ++i) frames[i].time_ns += static_cast<DurationNs>(random() % 15'000);
}
void cut(Frames& frames, std::size_t at, std::mt19937& random) {
  frames[at].bytes.resize(frames[at].bytes.size() - 1 - random() % 16);
}
void blank(Frames& frames, std::size_t at, std::mt19937&) {
  std::fill(frames[at].bytes.begin() + kBlocks, frames[at].bytes.end(), std::uint8_t{0});
}

}  // namespace

simulator::Simulation disturbed(const simulator::Simulation& whole, std::uint32_t seed) {
  const Disturbance all[] = {flip_bit, hold_bit, lose, repeat, go_stale, pause, jitter, cut, blank};
  std::mt19937 random(seed);
  simulator::Simulation result = whole;
  for (int i = 0; i < 4; ++i) {
    const std::size_t at = result.frames.size() / 2 + random() % (result.frames.size() / 2);
    all[(seed + static_cast<std::uint32_t>(i) * (1 + random() % 3)) % std::size(all)](result.frames, at, random);
  }
  return result;
}

}  // namespace servotrace::test
