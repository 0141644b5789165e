// SPDX-License-Identifier: MIT
// Traffic of an independent DeviceNet slave. The captures are not part of this repository: the test is skipped where
// they are absent. What each must show was written down from its description before the decoder first saw it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "decoder/devicenet/layouts.hpp"
#include "replay/capture/source.hpp"
#include "tests/support/paths.hpp"
#include "tests/unit/devicenet/bench.hpp"

namespace servotrace::devicenet {
namespace {

std::filesystem::path peer_folder() {
  const char* given = std::getenv("SERVOTRACE_PEER_CAPTURES");
  const std::filesystem::path root = given != nullptr
                                         ? std::filesystem::path(given)
                                         : servotrace::test::source_dir().parent_path() / "shared/captures";
  return std::filesystem::exists(root / "devicenet-peer") ? root / "devicenet-peer" : root;
}

struct Expected {
  const char* file;
  std::vector<std::string> findings;
  std::uint64_t frames;
};

void PrintTo(const Expected& expected, std::ostream* out) { *out << expected.file; }

class PeerCaptures : public testing::TestWithParam<Expected> {
 protected:
  void run(const Settings& settings) {
    const std::filesystem::path path = peer_folder() / GetParam().file;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path;
    auto source = replay::open_capture(path);
    ASSERT_TRUE(source) << source.error().text();
    Pipeline pipeline(settings);
    Dissection dissection;
    RawFrame frame;
    while ((*source)->next(frame) == replay::Source::Step::kFrame) {
      pipeline.push(frame, &dissection);
      if (dissection.protocol == Protocol::kDevicenet) covered(frame, dissection);
    }
    pipeline.finish();
    frames_ = pipeline.checked_frames();
    words_ = test::words(pipeline.findings().all());
  }

  // Every data byte lies under a segment (the records are padded to 8 of them).
  void covered(const RawFrame& frame, const Dissection& dissection) {
    const std::size_t end = 8U + frame.bytes[4];
    for (std::size_t i = 8; i < end; ++i) {
      bool under = false;
      for (const Segment& segment : dissection.segments) {
        under =
            under || (segment.buffer == Buffer::kFrame && i >= segment.offset && i < segment.offset + segment.length);
      }
      EXPECT_TRUE(under) << GetParam().file << " frame " << frame.number << " byte " << i;
    }
  }

  std::vector<std::string> words_;
  std::uint64_t frames_ = 0;
};

TEST_P(PeerCaptures, FindingsWhereTheBusIsConfigured) {
  run(test::Bench::assumed());
  if (IsSkipped()) return;
  EXPECT_THAT(words_, testing::ElementsAreArray(GetParam().findings));
  EXPECT_EQ(frames_, GetParam().frames);
}

// The two Duplicate MAC ID requests at the start are the evidence: the findings are the same.
TEST_P(PeerCaptures, FindingsByEvidence) {
  run(Settings{});
  if (IsSkipped()) return;
  if (std::string_view(GetParam().file) == "dupmac_startup.pcap") {
    EXPECT_EQ(frames_, 0U);
    EXPECT_TRUE(words_.empty());
    return;
  }
  EXPECT_EQ(frames_, GetParam().frames - 1);
  EXPECT_THAT(words_, testing::ElementsAreArray(GetParam().findings));
}

const Expected kExpected[] = {
    {"normal_poll20ms.pcap", {}, 880},
    {"normal_500k.pcap", {}, 641},
    // No acknowledgement at all: the first fragment comes again; then the second fragment does.
    {"frag_ack_missing.pcap", {"DN303@7", "DN303@12"}, 19},
    // An acknowledgement of another count; one that says too much data.
    {"frag_ack_bad.pcap", {"DN303@7", "DN303@10"}, 17},
    // A count gap; a last fragment with the count before; a middle without a first; a first with count 3Fh; a body of
    // 94 bytes refused with acknowledge status 1.
    {"frag_requests.pcap", {"DN301@26", "DN301@32", "DN302@33", "DN301@35", "DN303@64"}, 68},
    // Nine choices refused, one allocated twice, a second master, an explicit request of that master, and releases and
    // services refused.
    {"alloc_errors.pcap",
     {"DN202@4", "DN202@6", "DN202@8", "DN202@10", "DN202@12", "DN202@14", "DN202@16", "DN202@18", "DN202@20",
      "DN202@24 note", "DN202@28 warning", "DN211@29", "DN401@35", "DN401@37", "DN401@39 note", "DN401@43 note",
      "DN401@45", "DN401@47"},
     47},
    // Refused services; an allocation on the connected port that is there already; three truncated requests.
    {"service_errors.pcap",
     {"DN401@6 note", "DN401@8 note", "DN401@10 note", "DN401@12 note", "DN401@14", "DN401@16", "DN401@18", "DN401@20",
      "DN401@28", "DN401@30", "DN401@32", "DN401@34", "DN202@36 note", "DN304@37", "DN401@38 note", "DN304@39",
      "DN401@40", "DN304@41"},
     41},
    // Two challengers; then the slave has fallen silent and its polls stay unanswered.
    {"dupmac_online.pcap", {"DN102@17", "DN102@29", "DN205@43"}, 46},
    {"dupmac_startup.pcap", {"DN102@2"}, 3},
    // A poll with data the slave does not take. UCMM, bit-strobe and group 4 left unanswered are no findings.
    {"poll_variants.pcap", {"DN205@15"}, 16},
    // After its restart the slave is asked and polled without an allocation.
    {"reset.pcap", {"DN211@21", "DN201@22"}, 26},
    // Two attributes the slave does not have.
    {"braboj_session.pcap", {"DN401@31 note", "DN401@121 note"}, 127},
};
INSTANTIATE_TEST_SUITE_P(All, PeerCaptures, testing::ValuesIn(kExpected));

}  // namespace
}  // namespace servotrace::devicenet
