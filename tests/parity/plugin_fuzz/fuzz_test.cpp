// SPDX-License-Identifier: MIT
// Captures with bytes changed at random: the plugin never crashes, never trips an assertion of Wireshark's, draws every
// frame in full, and still finds what the command line finds. scripts/fuzz-plugin does the same for as long as wanted.
#include <gtest/gtest.h>

#include "tests/support/plugin_findings.hpp"
#include "tests/support/recording.hpp"

namespace servotrace::test {
namespace {

constexpr std::uint32_t kSeeds = 20;
constexpr std::size_t kFrames = 40;   // of each capture
constexpr std::uint32_t kOneIn = 50;  // bytes changed, 2 %
constexpr std::size_t kCapturesASeed = 3;

TEST(PluginFuzz, MutatedCaptures) {
  const Tshark tshark;
  if (!tshark.available()) GTEST_SKIP() << tshark.why_not();
  std::vector<Recording> sources;
  for (const auto& capture : shipped_captures()) sources.push_back(first_frames(read_recording(capture), kFrames));
  if (sources.empty()) sources = simulated_recordings();
  ASSERT_FALSE(sources.empty());
  std::vector<Recording> all;
  std::size_t next = 0;
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    for (std::size_t i = 0; i < kCapturesASeed; ++i)
      all.push_back(mutated(sources[next++ % sources.size()], seed, kOneIn));
  }
  const std::filesystem::path file = tshark.folder() / "mutated.pcapng";
  write_capture(file, all);
  expect_parity(tshark, file, {}, {"rtex.user_link_type:147"});
  for (const char* const passes : {"-V", "-2V"}) {
    const Ran ran = tshark.run({"-r", tshark.copy(file).string(), "-o", "rtex.user_link_type:147", passes});
    EXPECT_EQ(ran.status, 0) << passes << ": " << ran.err;
    EXPECT_EQ(ran.err, "") << passes;
    EXPECT_EQ(ran.out.find("Dissector bug"), std::string::npos) << passes;
  }
}

}  // namespace
}  // namespace servotrace::test
