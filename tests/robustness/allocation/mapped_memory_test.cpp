// SPDX-License-Identifier: MIT
// A long capture takes no more memory than a short one: the pages of a mapped file that were read are let go of.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "replay/capture/source.hpp"

namespace servotrace::test {
namespace {

constexpr std::uint32_t kPacket = 8U << 20U;  // bytes
constexpr int kPackets = 24;

// Resident memory of this process, in KiB, as /proc names it ("RssFile").
std::uint64_t resident_kib(const std::string& kind) {
  std::ifstream status("/proc/self/status");
  std::string word;
  std::uint64_t kib = 0;
  while (status >> word) {
    if (word == kind + ":" && status >> kib) return kib;
  }
  return 0;
}

void put32(std::ofstream& out, std::uint32_t value) {
  const char bytes[] = {static_cast<char>(value), static_cast<char>(value >> 8U), static_cast<char>(value >> 16U),
                        static_cast<char>(value >> 24U)};
  out.write(bytes, sizeof bytes);
}

// A pcapng of packets that are all zeros: holes of the file system.
void write_holes(const std::filesystem::path& path) {
  std::ofstream out(path, std::ios::binary);
  for (const std::uint32_t word : {0x0A0D0D0AU, 28U, 0x1A2B3C4DU, 1U, 0xFFFFFFFFU, 0xFFFFFFFFU, 28U}) put32(out, word);
  for (const std::uint32_t word : {1U, 20U, 227U, 0U, 20U}) put32(out, word);
  for (int i = 0; i < kPackets; ++i) {
    for (const std::uint32_t word : {6U, kPacket + 32, 0U, 0U, 0U, kPacket, kPacket}) put32(out, word);
    out.seekp(kPacket, std::ios::cur);
    put32(out, kPacket + 32);
  }
}

TEST(MappedMemory, WhatWasReadIsLetGoOf) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("servotrace-memory-test-" + std::to_string(::getpid()) + ".pcapng");
  write_holes(path);
  {
    auto source = replay::open_capture(path);
    ASSERT_TRUE(source) << source.error().text();
    const std::uint64_t before = resident_kib("RssFile");
    ASSERT_GT(before, 0U);
    RawFrame frame;
    int packets = 0;
    std::uint64_t most = 0;
    std::uint64_t sum = 0;
    while ((*source)->next(frame) == replay::Source::Step::kFrame) {
      ++packets;
      for (const std::uint8_t byte : frame.bytes) sum += byte;  // still there
      most = std::max(most, resident_kib("RssFile"));
    }
    EXPECT_EQ(packets, kPackets);
    EXPECT_EQ(sum, 0U);
    EXPECT_GT(most, before + kPacket / 1024 / 2) << "a packet is looked at where it lies";
    EXPECT_LT(most, before + 64 * 1024) << "of " << kPackets * (kPacket / 1024) << " KiB";
  }
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace servotrace::test
