// SPDX-License-Identifier: MIT
// One session of the peer written by common CAN tools in other formats: the same frames, the same findings. BLF is
// refused, and the converter that the message names helps.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "decoder/link/socketcan.hpp"
#include "replay/capture/source.hpp"
#include "tests/support/check.hpp"
#include "tests/support/peer.hpp"
#include "tests/support/program.hpp"

namespace servotrace::test {
namespace {

namespace fs = std::filesystem;

struct CanFrame {
  TimeNs after_ns = 0;  // from the first frame on
  std::uint32_t identifier = 0;
  bool extended = false;
  bool remote = false;
  std::vector<std::uint8_t> data;
};

struct Log {
  TimeNs first_ns = 0;
  std::vector<CanFrame> frames;
};

Log read_log(const fs::path& path) {
  Log log;
  auto source = replay::open_capture(path);
  if (!source) {
    ADD_FAILURE() << source.error().text();
    return log;
  }
  RawFrame raw;
  replay::Source::Step step = replay::Source::Step::kEnd;
  while ((step = (*source)->next(raw)) == replay::Source::Step::kFrame) {
    const can::Place place = can::find_frame(raw);
    EXPECT_TRUE(place.found && !place.malformed) << path << " " << raw.number;
    if (log.frames.empty()) log.first_ns = raw.time_ns;
    log.frames.push_back({raw.time_ns - log.first_ns,
                          place.frame.identifier,
                          place.frame.extended,
                          place.frame.remote,
                          {place.frame.data.begin(), place.frame.data.end()}});
    EXPECT_EQ(raw.number, log.frames.size()) << path;
  }
  EXPECT_EQ(step, replay::Source::Step::kEnd) << path;
  EXPECT_FALSE((*source)->truncation()) << path;
  return log;
}

class PeerFormats : public testing::Test {
 protected:
  void SetUp() override {
    if (peer_captures().empty()) GTEST_SKIP() << kNoPeerCaptures;
    reference_ = peer_captures() / "devicenet-peer" / "braboj_session.pcap";
    formats_ = peer_captures() / "formats";
  }
  void expect_the_same(const fs::path& file) const {
    const Log expected = read_log(reference_);
    ASSERT_EQ(expected.frames.size(), 127U);
    const Log log = read_log(file);
    ASSERT_EQ(log.frames.size(), expected.frames.size()) << file;
    for (std::size_t i = 0; i < expected.frames.size(); ++i) {
      const CanFrame& want = expected.frames[i];
      const CanFrame& have = log.frames[i];
      // Each format has a start of its own; differences to it are exact to the microsecond all of them print.
      EXPECT_NEAR(static_cast<double>(have.after_ns), static_cast<double>(want.after_ns), 1000.0) << file << " " << i;
      EXPECT_EQ(have.identifier, want.identifier) << file << " " << i;
      EXPECT_EQ(have.extended, want.extended) << file << " " << i;
      EXPECT_EQ(have.remote, want.remote) << file << " " << i;
      EXPECT_EQ(have.data, want.data) << file << " " << i;
    }
    const std::vector<Seen> findings = check_capture(reference_);
    ASSERT_EQ(findings.size(), 2U);
    EXPECT_EQ(check_capture(file), findings) << file;
  }

  fs::path reference_;
  fs::path formats_;
};

TEST_F(PeerFormats, TheSameFramesAndFindings) {
  for (const char* name : {"session.log", "session.asc", "session.canutils.asc", "session.trc", "session.csv"}) {
    expect_the_same(formats_ / name);
  }
}

TEST_F(PeerFormats, ThoseThatKeepTheDateTellTheSameTime) {
  const TimeNs first = read_log(reference_).first_ns;
  EXPECT_EQ(read_log(formats_ / "session.log").first_ns, first);
  EXPECT_EQ(read_log(formats_ / "session.csv").first_ns, first);
}

TEST_F(PeerFormats, BlfIsRefusedWithItsConverter) {
  const Program program;
  const std::string file = (formats_ / "session.blf").string();
  const Outcome outcome = program.run({"check", file});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, testing::HasSubstr(file + ": is a Vector BLF log, which is not read; convert it: " +
                                              "can_logconvert " + file + " OUT.log (from python-can)"));
}

// The command of that message, where python-can is installed.
TEST_F(PeerFormats, TheConverterHelps) {
  const Program program;
  if (program.shell("command -v can_logconvert").status != 0) GTEST_SKIP() << "can_logconvert (python-can) is not here";
  for (const std::string name : {"OUT.log", "OUT.asc", "OUT.csv", "OUT.trc"}) {
    const Outcome outcome = program.shell("can_logconvert '" + (formats_ / "session.blf").string() + "' " + name);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    expect_the_same(program.folder() / name);
  }
}

}  // namespace
}  // namespace servotrace::test
