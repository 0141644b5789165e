// SPDX-License-Identifier: MIT
// One session written by common CAN tools in five formats, beside the repository: all must tell the same frames.
#include <gtest/gtest.h>

#include <cstdlib>

#include "decoder/link/socketcan.hpp"
#include "tests/support/paths.hpp"
#include "tests/unit/capture/support.hpp"

namespace servotrace::test {
namespace {

std::filesystem::path peer_captures() {
  const char* const named = std::getenv("SERVOTRACE_PEER_CAPTURES");
  if (named != nullptr) return named;
  return source_dir() / ".." / "shared" / "captures";
}

TEST(PeerFormats, TheSameFramesInEveryFormat) {
  const std::filesystem::path folder = peer_captures();
  const std::filesystem::path reference = folder / "devicenet-peer" / "braboj_session.pcap";
  if (!std::filesystem::exists(reference)) GTEST_SKIP() << "the peer captures are not here";
  const ReadCapture expected = read_file(reference);
  ASSERT_EQ(expected.error, "");
  ASSERT_EQ(expected.frames.size(), 127U);
  for (const char* const name : {"session.log", "session.asc", "session.canutils.asc", "session.trc", "session.csv"}) {
    const ReadCapture capture = read_file(folder / "formats" / name);
    ASSERT_EQ(capture.error, "") << name;
    EXPECT_FALSE(capture.truncation) << name;
    ASSERT_EQ(capture.frames.size(), expected.frames.size()) << name;
    for (std::size_t i = 0; i < expected.frames.size(); ++i) {
      const RawFrame& want = expected.frames[i].raw;
      const RawFrame& have = capture.frames[i].raw;
      EXPECT_EQ(have.number, want.number);
      // Each format has a start of its own; differences to it are exact to the microsecond all of them print.
      EXPECT_NEAR(static_cast<double>(have.time_ns - capture.frames[0].raw.time_ns),
                  static_cast<double>(want.time_ns - expected.frames[0].raw.time_ns), 1000.0)
          << name << " " << i;
      const can::Place a = can::find_frame(have);
      const can::Place b = can::find_frame(want);
      ASSERT_TRUE(a.found && !a.malformed && b.found && !b.malformed);
      EXPECT_EQ(a.frame.identifier, b.frame.identifier);
      EXPECT_EQ(a.frame.extended, b.frame.extended);
      EXPECT_EQ(a.frame.remote, b.frame.remote);
      EXPECT_EQ(Buffer(a.frame.data.begin(), a.frame.data.end()), Buffer(b.frame.data.begin(), b.frame.data.end()));
    }
  }
  // Those that keep the date tell the same time.
  EXPECT_EQ(read_file(folder / "formats" / "session.log").frames[0].raw.time_ns, expected.frames[0].raw.time_ns);
  EXPECT_EQ(read_file(folder / "formats" / "session.csv").frames[0].raw.time_ns, expected.frames[0].raw.time_ns);
}

TEST(PeerFormats, BlfIsRefusedWithItsConverter) {
  const std::filesystem::path path = peer_captures() / "formats" / "session.blf";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "the peer captures are not here";
  EXPECT_NE(
      read_file(path).error.find("is a Vector BLF log, which is not read; convert it: can_logconvert " + path.string()),
      std::string::npos);
}

}  // namespace
}  // namespace servotrace::test
