// SPDX-License-Identifier: MIT
// Captures with bytes changed at random: the plugin never crashes, never trips an assertion of Wireshark's, draws every
// frame in full, and still finds what the command line finds. scripts/fuzz-plugin does the same for as long as wanted.
#include <gtest/gtest.h>

#include "tests/support/plugin_findings.hpp"
#include "tests/support/recording.hpp"

namespace servotrace::test {
namespace {

constexpr std::uint32_t kCaptures = 200;
constexpr std::size_t kFrames = 12;   // of each capture
constexpr std::uint32_t kOneIn = 50;  // bytes changed, 2 %

TEST(PluginFuzz, MutatedCaptures) {
  const Tshark tshark;
  if (!tshark.available()) GTEST_SKIP() << tshark.why_not();
  std::vector<Recording> sources;
  for (const auto& capture : shipped_captures()) sources.push_back(read_recording(capture));
  if (sources.empty()) sources = simulated_recordings();
  ASSERT_FALSE(sources.empty());
  std::vector<Recording> all;
  for (std::uint32_t seed = 0; seed < kCaptures; ++seed) {
    const Recording& source = sources[seed % sources.size()];
    // By turns its begin, which shows what it is, and some place in it.
    const std::size_t turn = seed / sources.size();
    const std::size_t first = turn % 2 == 0 ? 0 : turn * source.frames.size() / 5;
    all.push_back(mutated(some_frames(source, first, kFrames), seed, kOneIn));
  }
  const std::filesystem::path file = tshark.folder() / "mutated.pcapng";
  write_capture(file, all);
  expect_parity(tshark, file, {}, {"rtex.user_link_type:147"});
  for (const char* const passes : {"-V", "-2V"}) {
    std::vector<std::string> arguments = {"-r", tshark.copy(file).string(), "-o", "rtex.user_link_type:147", passes};
    // What is cut out of a capture's middle proves no DeviceNet.
    if (passes[1] == '2') arguments.insert(arguments.end(), {"-o", "dnet.can_is_devicenet:TRUE"});
    const Ran ran = tshark.run(arguments);
    EXPECT_EQ(ran.status, 0) << passes << ": " << ran.err;
    EXPECT_EQ(ran.err, "") << passes;
    EXPECT_EQ(ran.out.find("Dissector bug"), std::string::npos) << passes;
  }
}

}  // namespace
}  // namespace servotrace::test
