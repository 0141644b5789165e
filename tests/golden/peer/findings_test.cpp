// SPDX-License-Identifier: MIT
// Traffic of an independent DeviceNet slave: what each capture must show, written down from its description and its
// frames, and nothing else. The slave is none of the two drives, so that its I/O and assembly data are bytes.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "decoder/devicenet/layouts.hpp"
#include "decoder/findings/catalogue.hpp"
#include "decoder/pipeline/pipeline.hpp"
#include "replay/capture/source.hpp"
#include "tests/support/peer.hpp"
#include "tests/support/program.hpp"

namespace servotrace::test {
namespace {

namespace fs = std::filesystem;

struct Expected {
  const char* file;
  std::uint64_t frames;
  std::vector<std::string> findings;  // rule, frame, severity, actor
};

void PrintTo(const Expected& expected, std::ostream* out) { *out << expected.file; }

const Expected kExpected[] = {
    // Two Duplicate MAC ID requests of a lone node, allocation, 400 polls, product names in fragments, release.
    {"normal_poll20ms.pcap", 880, {}},
    {"normal_500k.pcap", 641, {}},
    // The first fragment of a response comes again after a second without its acknowledgement (6, 7), and is given up;
    // then the second one does (11, 12).
    {"frag_ack_missing.pcap", 19, {"DN303@7 error network", "DN303@12 error network"}},
    // An acknowledgement with count 5 instead of 0. One of count 1 that says too much data: the slave's fault.
    {"frag_ack_bad.pcap", 17, {"DN303@7 error network", "DN303@10 error drive"}},
    // Counts 0 and 2. A last fragment with the count of the middle before it. A middle without a first. A first with
    // count 3Fh, which only I/O has. 94 bytes, refused by an acknowledgement: the master's fault. Its fragments of no
    // message are never answered, and no request is in them.
    {"frag_requests.pcap",
     68,
     {"DN301@26 error network", "DN301@32 error network", "DN302@33 error network", "DN301@35 error network",
      "DN303@64 error master"}},
    // Choices none, poll alone, suppression alone (09), then strobe, change of state, cyclic, both, all, reserved (02);
    // explicit twice (0B, usual at a scanner's start); a second master (0C) which then asks on the explicit connection
    // of the first. Release of nothing (09), of strobe (02), of poll and explicit not allocated (0B, no more than a
    // note). Get and an undefined service on the unconnected port (02).
    {"alloc_errors.pcap",
     47,
     {"DN202@4 error master", "DN202@6 error master", "DN202@8 error master", "DN202@10 error master",
      "DN202@12 error master", "DN202@14 error master", "DN202@16 error master", "DN202@18 error master",
      "DN202@20 error master", "DN202@24 note master", "DN202@28 warning master", "DN211@29 warning master",
      "DN401@35 error drive", "DN401@37 error drive", "DN401@39 note drive", "DN401@43 note drive",
      "DN401@45 error drive", "DN401@47 error drive"}},
    // Gets of an object, an instance, an attribute and all attributes that are not there: notes. Sets of what is not
    // settable or out of range, a Reset of type 9, services that are not there: errors. An allocation on the connected
    // port where it is allocated already (0B). A Get without a path, a header alone, nothing at all.
    {"service_errors.pcap",
     41,
     {"DN401@6 note drive", "DN401@8 note drive", "DN401@10 note drive", "DN401@12 note drive", "DN401@14 error drive",
      "DN401@16 error drive", "DN401@18 error drive", "DN401@20 error drive", "DN401@28 error drive",
      "DN401@30 error drive", "DN401@32 error drive", "DN401@34 error drive", "DN202@36 note master",
      "DN304@37 warning network", "DN401@38 note drive", "DN304@39 warning network", "DN401@40 error drive",
      "DN304@41 warning network"}},
    // Two challengers (17, 29), each answered by the slave: one finding a challenger, also when the second one answers
    // itself (41). Then the slave is silent: the poll of frame 42 is found unanswered at the next one.
    {"dupmac_online.pcap", 46, {"DN102@17 error network", "DN102@29 error network", "DN205@43 error drive"}},
    // The first check is answered by a node on line. The allocation at the end has no time left to be answered.
    {"dupmac_startup.pcap", 3, {"DN102@2 error network"}},
    // A poll with three bytes that the slave does not take, found at the next poll. A poll while configuring, UCMM
    // Open,
    // bit-strobe and group 4 messages left unanswered are none.
    {"poll_variants.pcap", 16, {"DN205@15 error drive"}},
    // After its Reset the slave checks its MAC ID once more (20 allocates: no answer for 50 ms). A Set on the explicit
    // connection that is gone, and polls without an allocation.
    {"reset.pcap", 26, {"DN211@21 warning master", "DN201@22 error master"}},
    // Two attributes that the slave does not have.
    {"braboj_session.pcap", 127, {"DN401@31 note drive", "DN401@121 note drive"}},
};

// Frames whose data nobody can name: what is sent with a service of a maker's own class.
const std::map<std::string, std::set<std::uint64_t>> kNameless = {{"service_errors.pcap", {33}}};

class PeerCaptures : public testing::TestWithParam<Expected> {
 protected:
  void SetUp() override {
    if (peer_captures().empty()) GTEST_SKIP() << kNoPeerCaptures;
    path_ = peer_captures() / "devicenet-peer" / GetParam().file;
  }
  void run(const Settings& settings) {
    auto source = replay::open_capture(path_);
    ASSERT_TRUE(source) << source.error().text();
    Pipeline pipeline(settings);
    Dissection dissection;
    RawFrame frame;
    while ((*source)->next(frame) == replay::Source::Step::kFrame) {
      pipeline.push(frame, &dissection);
      if (dissection.protocol == Protocol::kDevicenet) named(frame, dissection);
    }
    pipeline.finish();
    checked_frames_ = pipeline.checked_frames();
    for (const Finding& finding : pipeline.findings().all()) {
      findings_.push_back(fmt::format("{}@{} {} {}", rule_row(finding.rule).id, finding.frame,
                                      name_of(finding.severity), name_of(finding.actor)));
    }
  }

  // Every data byte lies under a segment (the records are padded to 8 of them), and none is left without a name: no
  // "data" of an explicit or unconnected message.
  void named(const RawFrame& frame, const Dissection& dissection) const {
    const std::size_t end = 8U + frame.bytes[4];
    for (std::size_t i = 8; i < end; ++i) {
      const bool under = std::any_of(dissection.segments.begin(), dissection.segments.end(), [&](const Segment& row) {
        return row.buffer == Buffer::kFrame && i >= row.offset && i < row.offset + row.length;
      });
      EXPECT_TRUE(under) << GetParam().file << " frame " << frame.number << " byte " << i;
    }
    const auto nameless = kNameless.find(GetParam().file);
    if (nameless != kNameless.end() && nameless->second.contains(frame.number)) return;
    for (const Segment& segment : dissection.segments) {
      EXPECT_NE(segment.layout, &devicenet::kData) << GetParam().file << " frame " << frame.number;
      EXPECT_NE(segment.layout, &devicenet::kUnconnectedData) << GetParam().file << " frame " << frame.number;
    }
  }

  fs::path path_;
  std::vector<std::string> findings_;
  std::uint64_t checked_frames_ = 0;
};

TEST_P(PeerCaptures, FindingsWhereTheBusIsConfigured) {
  Settings settings;
  settings.devicenet.assumed = true;
  run(settings);
  EXPECT_THAT(findings_, testing::ElementsAreArray(GetParam().findings));
  EXPECT_EQ(checked_frames_, GetParam().frames);
}

// The two Duplicate MAC ID requests at the start are the evidence, from the second one on: the findings are the same.
// A single request, as in dupmac_startup, could be another protocol's frame.
TEST_P(PeerCaptures, FindingsByEvidence) {
  run(Settings{});
  if (std::string_view(GetParam().file) == "dupmac_startup.pcap") {
    EXPECT_EQ(checked_frames_, 0U);
    EXPECT_TRUE(findings_.empty());
    return;
  }
  EXPECT_EQ(checked_frames_, GetParam().frames - 1);
  EXPECT_THAT(findings_, testing::ElementsAreArray(GetParam().findings));
}

// As a user runs it: the exit status says whether there is an error, and decode prints every frame.
TEST_P(PeerCaptures, OnTheCommandLine) {
  const Program program;
  bool has_error = false;
  for (const std::string& finding : GetParam().findings) has_error |= finding.find(" error ") != std::string::npos;
  const Outcome checked = program.run({"check", "--devicenet", path_.string()});
  EXPECT_EQ(checked.status, has_error ? 1 : 0) << checked.err;
  EXPECT_EQ(checked.err, "");
  const Outcome decoded = program.run({"decode", "--devicenet", "--format", "jsonl", path_.string()});
  EXPECT_EQ(decoded.status, 0) << decoded.err;
  EXPECT_EQ(decoded.err, "");
  EXPECT_EQ(std::count(decoded.out.begin(), decoded.out.end(), '\n'), static_cast<std::ptrdiff_t>(GetParam().frames));
}

INSTANTIATE_TEST_SUITE_P(All, PeerCaptures, testing::ValuesIn(kExpected));

// A capture that is added later has to be described here.
TEST(PeerFolder, EveryCaptureIsExpected) {
  if (peer_captures().empty()) GTEST_SKIP() << kNoPeerCaptures;
  std::size_t count = 0;
  for (const auto& entry : fs::directory_iterator(peer_captures() / "devicenet-peer")) {
    if (entry.path().extension() != ".pcap") continue;
    ++count;
    EXPECT_TRUE(std::any_of(std::begin(kExpected), std::end(kExpected), [&](const Expected& row) {
      return entry.path().filename() == row.file;
    })) << entry.path();
  }
  EXPECT_EQ(count, std::size(kExpected));
}

}  // namespace
}  // namespace servotrace::test
