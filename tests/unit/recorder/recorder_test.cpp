// SPDX-License-Identifier: MIT
// What the C header for controllers writes is read like any other capture.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <vector>

#include "captures/recorder/servotrace_rtex_recorder.h"
#include "decoder/findings/catalogue.hpp"
#include "decoder/link/rtex_record.hpp"
#include "decoder/pipeline/pipeline.hpp"
#include "replay/capture/source.hpp"
#include "tests/support/paths.hpp"

namespace servotrace::test {
namespace {

int keep(void* context, const void* bytes, std::size_t size) {
  auto& kept = *static_cast<std::vector<std::uint8_t>*>(context);
  const auto* from = static_cast<const std::uint8_t*>(bytes);
  kept.insert(kept.end(), from, from + size);
  return 0;
}

TEST(Recorder, ExampleIsReadAndClean) {
  const std::filesystem::path program = binary_dir() / "captures" / "servotrace_rtex_recorder_example";
  const std::filesystem::path capture = std::filesystem::path(::testing::TempDir()) / "recorder_example.pcapng";
  ASSERT_EQ(std::system((program.string() + ' ' + capture.string() + " 300").c_str()), 0);
  auto source = replay::open_capture(capture);
  ASSERT_TRUE(source) << source.error().text();
  Pipeline pipeline{Settings{}};
  RawFrame frame;
  std::uint64_t frames = 0;
  while ((*source)->next(frame) == replay::Source::Step::kFrame) {
    ++frames;
    EXPECT_EQ(frame.link_type, LinkType::kWiresharkUpperPdu);
    EXPECT_EQ(frame.time_resolution_ns, 1U);
    pipeline.push(frame);
  }
  pipeline.finish();
  EXPECT_EQ(frames, 600U);
  EXPECT_EQ(pipeline.checked_frames(), 600U);
  for (const Finding& finding : pipeline.findings().all()) ADD_FAILURE() << rule_row(finding.rule).id;
  EXPECT_FALSE((*source)->truncation());
  std::filesystem::remove(capture);
}

TEST(Recorder, RecordsEveryFieldOfTheHeader) {
  std::vector<std::uint8_t> kept;
  servotrace_rtex_config config{};
  config.write = keep;
  config.context = &kept;
  config.ring = 3;
  config.node_count = 2;
  config.wide_nodes = 2;
  config.cycle_ns = 1'000'000;
  config.sampled = 1;
  servotrace_rtex_recorder recorder;
  ASSERT_EQ(servotrace_rtex_open(&recorder, &config), SERVOTRACE_RTEX_OK);
  kept.clear();
  std::vector<std::uint8_t> memory(48);
  for (std::size_t i = 0; i < memory.size(); ++i) memory[i] = static_cast<std::uint8_t>(i + 1);
  ASSERT_EQ(servotrace_rtex_response(&recorder, 0x1122334455667788U, 0xA1B2C3D4U, memory.data()), SERVOTRACE_RTEX_OK);
  const Bytes frame = Bytes(kept).subspan(28, kept.size() - 32);
  const RawFrame raw{.number = 1,
                     .link_type = LinkType::kWiresharkUpperPdu,
                     .bytes = frame,
                     .original_length = static_cast<std::uint32_t>(frame.size())};
  const rtex::RecordPlace place = rtex::find_record(raw, RtexSettings{});
  ASSERT_EQ(place.carrier, rtex::Carrier::kExportedPdu);
  ASSERT_FALSE(place.malformed);
  const Bytes record = frame.subspan(place.offset);
  EXPECT_EQ(place.length, record.size());
  EXPECT_EQ(read(slot(rtex::kRecord, "direction"), record), 1);
  EXPECT_EQ(read(slot(rtex::kRecord, "sequence_valid"), record), 1);
  EXPECT_EQ(read(slot(rtex::kRecord, "cycle_valid"), record), 1);
  EXPECT_EQ(read(slot(rtex::kRecord, "sampled"), record), 1);
  EXPECT_EQ(read(slot(rtex::kRecord, "ring"), record), 3);
  EXPECT_EQ(read(slot(rtex::kRecord, "sequence"), record), 0xA1B2C3D4);
  EXPECT_EQ(read(slot(rtex::kRecord, "cycle_ns"), record), 1'000'000);
  EXPECT_EQ(read(slot(rtex::kRecord, "wide_nodes"), record), 2);
  EXPECT_EQ(read(slot(rtex::kRecord, "node_count"), record), 2);
  EXPECT_TRUE(std::equal(memory.begin(), memory.end(), record.begin() + 24, record.end()));
}

TEST(Recorder, RefusesWhatTheAsicCannotHold) {
  std::vector<std::uint8_t> kept;
  servotrace_rtex_config config{};
  servotrace_rtex_recorder recorder;
  config.node_count = 1;
  EXPECT_EQ(servotrace_rtex_open(&recorder, &config), SERVOTRACE_RTEX_BAD_CONFIG);  // no write function
  config.write = keep;
  config.context = &kept;
  EXPECT_EQ(servotrace_rtex_open(&recorder, &config), SERVOTRACE_RTEX_OK);
  config.node_count = 0;
  EXPECT_EQ(servotrace_rtex_open(&recorder, &config), SERVOTRACE_RTEX_BAD_CONFIG);
  config.node_count = 33;
  EXPECT_EQ(servotrace_rtex_open(&recorder, &config), SERVOTRACE_RTEX_BAD_CONFIG);
  config.node_count = 32;
  config.wide_nodes = 1;
  EXPECT_EQ(servotrace_rtex_open(&recorder, &config), SERVOTRACE_RTEX_BAD_CONFIG);
}

TEST(Recorder, TellsItsLosses) {
  const std::filesystem::path path = std::filesystem::path(::testing::TempDir()) / "recorder_dropped.pcapng";
  std::vector<std::uint8_t> kept;
  servotrace_rtex_config config{};
  config.write = keep;
  config.context = &kept;
  config.node_count = 1;
  servotrace_rtex_recorder recorder;
  ASSERT_EQ(servotrace_rtex_open(&recorder, &config), SERVOTRACE_RTEX_OK);
  const std::vector<std::uint8_t> memory(16, 0);
  ASSERT_EQ(servotrace_rtex_command(&recorder, 1'000, 0, memory.data()), SERVOTRACE_RTEX_OK);
  ASSERT_EQ(servotrace_rtex_dropped(&recorder, 2'000, 7), SERVOTRACE_RTEX_OK);
  std::FILE* file = std::fopen(path.c_str(), "wb");
  ASSERT_NE(file, nullptr);
  EXPECT_EQ(std::fwrite(kept.data(), 1, kept.size(), file), kept.size());
  std::fclose(file);
  auto source = replay::open_capture(path);
  ASSERT_TRUE(source) << source.error().text();
  RawFrame frame;
  while ((*source)->next(frame) == replay::Source::Step::kFrame) {
  }
  ASSERT_EQ((*source)->dropped().size(), 1U);
  EXPECT_EQ((*source)->dropped()[0].count, 7U);
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace servotrace::test
