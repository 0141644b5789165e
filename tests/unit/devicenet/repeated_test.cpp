// SPDX-License-Identifier: MIT
// The short cut for poll messages that repeat those before changes no finding and no count.
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "tests/support/scenarios.hpp"
#include "tests/support/short_cut.hpp"
#include "tests/support/traffic.hpp"

namespace servotrace::test {
namespace {

using Frames = std::vector<simulator::SimulatedFrame>;

constexpr std::size_t kHeader = 8;  // bytes of SocketCAN before the data

// The drives guessed, named, and the bus named as well.
std::vector<Settings> all_settings() {
  Settings named;
  named.devicenet.nodes.push_back({.mac_id = 5, .name = {}, .profile = "yaskawa-ns310"});
  named.devicenet.nodes.push_back({.mac_id = 9, .name = {}, .profile = "nsk-esb"});
  Settings assumed = named;
  assumed.devicenet.assumed = true;
  return {Settings{}, named, assumed};
}

TEST(RepeatedPolls, QuietTrafficSaysTheSame) {
  const simulator::Simulation traffic = make_traffic(devicenet_traffic(300));
  for (const Settings& settings : all_settings()) expect_same(traffic, settings);
}

// What may happen to a frame of quiet polling, at a random place.
using Disturbance = std::function<void(Frames&, std::size_t, std::mt19937&)>;

void flip_bit(Frames& frames, std::size_t at, std::mt19937& random) {
  std::vector<std::uint8_t>& bytes = frames[at].bytes;
  if (bytes.size() <= kHeader) return;
  const std::size_t place = kHeader + random() % (bytes.size() - kHeader);
  bytes[place] = static_cast<std::uint8_t>(bytes[place] ^ (1U << random() % 8));
}
// A bit of one identifier's data that stays for a while.
void hold_bit(Frames& frames, std::size_t at, std::mt19937& random) {
  const std::vector<std::uint8_t> first = frames[at].bytes;
  if (first.size() <= kHeader) return;
  const std::size_t place = kHeader + random() % (first.size() - kHeader);
  const auto bit = static_cast<std::uint8_t>(1U << random() % 8);
  const std::size_t end = std::min(frames.size(), at + 1 + random() % 400);
  for (std::size_t i = at; i < end; ++i) {
    std::vector<std::uint8_t>& bytes = frames[i].bytes;
    // The same fragment of the same connection.
    if (bytes.size() != first.size() || !std::equal(first.begin(), first.begin() + kHeader, bytes.begin())) continue;
    if (place > kHeader && bytes[kHeader] != first[kHeader]) continue;
    bytes[place] = static_cast<std::uint8_t>(bytes[place] ^ bit);
  }
}
void lose(Frames& frames, std::size_t at, std::mt19937& random) {
  const auto count = static_cast<std::ptrdiff_t>(1 + random() % 4);
  const auto first = frames.begin() + static_cast<std::ptrdiff_t>(at);
  frames.erase(first, first + std::min(count, frames.end() - first));
}
void repeat(Frames& frames, std::size_t at, std::mt19937&) {
  const simulator::SimulatedFrame copy = frames[at];
  frames.insert(frames.begin() + static_cast<std::ptrdiff_t>(at), copy);
}
void exchange(Frames& frames, std::size_t at, std::mt19937&) {
  if (at + 1 < frames.size()) std::swap(frames[at].bytes, frames[at + 1].bytes);
}
void pause(Frames& frames, std::size_t at, std::mt19937& random) {
  const auto by_ns = static_cast<DurationNs>(random() % 3'000'000'000U);
  for (std::size_t i = at; i < frames.size(); ++i) frames[i].time_ns += by_ns;
}
void go_back(Frames& frames, std::size_t at, std::mt19937& random) {
  frames[at].time_ns -= static_cast<DurationNs>(random() % 20'000'000U);
}
void cut(Frames& frames, std::size_t at, std::mt19937& random) {
  std::vector<std::uint8_t>& bytes = frames[at].bytes;
  bytes.resize(bytes.size() - 1 - random() % (bytes.size() - 1));
}
void shorten(Frames& frames, std::size_t at, std::mt19937& random) {
  std::vector<std::uint8_t>& bytes = frames[at].bytes;
  bytes[4] = static_cast<std::uint8_t>(random() % 9);
}
void flag(Frames& frames, std::size_t at, std::mt19937& random) {
  std::vector<std::uint8_t>& bytes = frames[at].bytes;
  const std::size_t place = random() % 6;
  bytes[place] = static_cast<std::uint8_t>(bytes[place] ^ (1U << random() % 8));
}

TEST(RepeatedPolls, DisturbedTrafficSaysTheSame) {
  const Disturbance all[] = {flip_bit, hold_bit, lose, repeat, exchange, pause, go_back, cut, shorten, flag};
  const simulator::Simulation whole = make_traffic(devicenet_traffic(200));
  const std::vector<Settings> settings = all_settings();
  for (std::uint32_t seed = 0; seed < 160; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    simulator::Simulation disturbed = whole;
    for (int i = 0; i < 4; ++i) {
      const std::size_t at = 1 + random() % (disturbed.frames.size() - 1);
      all[(seed + static_cast<std::uint32_t>(i) * (1 + random() % 3)) % std::size(all)](disturbed.frames, at, random);
    }
    expect_same(disturbed, settings[seed % settings.size()]);
    if (HasFailure()) return;
  }
}

}  // namespace
}  // namespace servotrace::test
