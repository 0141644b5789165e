// SPDX-License-Identifier: MIT
// Any bytes are legal input: random ones, and shipped captures with bytes changed, taken out, doubled and moved.
#include <gtest/gtest.h>

#include <random>

#include "tests/robustness/captures/corpus.hpp"
#include "tests/support/harness.hpp"

namespace servotrace::test {
namespace {

using Random = std::mt19937_64;  // the same everywhere, unlike the distributions of <random>

std::size_t below(Random& random, std::size_t limit) {
  return limit == 0 ? 0 : static_cast<std::size_t>(random() % limit);
}

TEST(AnyBytes, RandomFiles) {
  const std::vector<std::vector<std::uint8_t>> starts = {
      {},
      {0xD4, 0xC3, 0xB2, 0xA1, 2, 0, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4, 0, 227, 0, 0, 0},
      {0xA1, 0xB2, 0x3C, 0x4D, 0, 2, 0, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4, 0, 0, 0, 0, 0, 252},
      {0x0A, 0x0D, 0x0D, 0x0A, 28,   0,    0,    0,    0x4D, 0x3C, 0x2B, 0x1A, 1, 0,
       0,    0,    0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 28,   0,    0, 0},
      {'(', '1', '.', '5', ')', ' ', 'c', ' ', '5', 'F', 'F', '#'},
      {'d', 'a', 't', 'e', ' '},
      {';', '$', 'F', 'I', 'L', 'E', 'V', 'E', 'R', 'S', 'I', 'O', 'N', '=', '2', '.', '1', '\n'},
      {'t', 'i', 'm', 'e', ',', 'i', 'd', ',', 'd', 'a', 't', 'a', '\n'},
      {0x1F, 0x8B, 8, 0, 0, 0, 0, 0, 0, 3},
      {0x28, 0xB5, 0x2F, 0xFD},
  };
  Random random(20231114);
  for (int i = 0; i < 4000; ++i) {
    std::vector<std::uint8_t> bytes = starts[below(random, starts.size())];
    const std::size_t size = below(random, 600);
    const bool text = random() % 4 == 0;
    constexpr std::string_view kLetters = "0123456789ABCDEFabcdefRrxTX #().,;:= \n\n\t-";
    for (std::size_t k = 0; k < size; ++k)
      bytes.push_back(text ? static_cast<std::uint8_t>(kLetters[below(random, kLetters.size())])
                           : static_cast<std::uint8_t>(random() & (random() % 3 == 0 ? 0x0FU : 0xFFU)));
    ASSERT_EQ(check_bytes(bytes).nonsense, "") << "round " << i;
  }
}

TEST(AnyBytes, RandomFrames) {
  Random random(7);
  for (int i = 0; i < 1500; ++i) {
    std::vector<std::uint8_t> bytes(below(random, 2000));
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    ASSERT_EQ(check_frames(bytes).nonsense, "") << "round " << i;
  }
}

TEST(AnyBytes, ChangedCaptures) {
  Random random(4711);
  const std::vector<Shipped> captures = shipped_captures();
  if (captures.empty()) GTEST_SKIP() << "no captures";
  constexpr std::size_t kPart = 24'000;  // bytes of each that are changed
  for (int i = 0; i < 400; ++i) {
    const Shipped& capture = captures[below(random, captures.size())];
    std::vector<std::uint8_t> bytes(capture.bytes.begin(), capture.bytes.begin() + static_cast<std::ptrdiff_t>(std::min(
                                                                                       kPart, capture.bytes.size())));
    const std::size_t changes = 1 + below(random, 40);
    for (std::size_t k = 0; k < changes && !bytes.empty(); ++k) {
      const std::size_t at = below(random, bytes.size());
      const std::size_t length = std::min(1 + below(random, 64), bytes.size() - at);
      const auto from = bytes.begin() + static_cast<std::ptrdiff_t>(at);
      const auto to = from + static_cast<std::ptrdiff_t>(length);
      // Mostly changes that leave the file's own structure whole, so that they reach the sessions.
      switch (below(random, 12)) {
        case 0:
          bytes.erase(from, to);
          break;
        case 1: {
          const std::vector<std::uint8_t> part(from, to);
          bytes.insert(from, part.begin(), part.end());
          break;
        }
        case 2:
          std::fill(from, to, static_cast<std::uint8_t>(random()));
          break;
        default:
          *from = static_cast<std::uint8_t>(*from ^ (1U << (random() % 8)));
          break;
      }
    }
    ASSERT_EQ(check_bytes(bytes, i % 2 == 0 ? Settings{} : assuming_devicenet()).nonsense, "")
        << capture.name << ", round " << i;
  }
}

// Whole frames left out, doubled or swapped: the losses and repetitions of real recorders.
TEST(AnyBytes, FramesLostDoubledAndSwapped) {
  Random random(99);
  for (const Shipped& capture : shipped_captures()) {
    auto source = replay::open_bytes(capture.bytes, capture.name);
    ASSERT_TRUE(source);
    struct Kept {
      RawFrame raw;
      std::vector<std::uint8_t> bytes;
    };
    std::vector<Kept> frames;
    RawFrame frame;
    while (frames.size() < 600 && (*source)->next(frame) == replay::Source::Step::kFrame)
      frames.push_back({frame, std::vector<std::uint8_t>(frame.bytes.begin(), frame.bytes.end())});
    Pipeline pipeline(assuming_devicenet());
    std::uint64_t number = 0;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const std::uint64_t chance = random() % 20;
      if (chance == 0) continue;
      if (chance == 1 && i + 1 < frames.size()) std::swap(frames[i], frames[i + 1]);
      for (int times = chance == 2 ? 2 : 1; times > 0; --times) {
        RawFrame raw = frames[i].raw;
        raw.bytes = frames[i].bytes;
        raw.number = ++number;
        pipeline.push(raw);
      }
    }
    pipeline.finish();
    EXPECT_EQ(nonsense(pipeline.findings().all(), number), "") << capture.name;
  }
}

}  // namespace
}  // namespace servotrace::test
