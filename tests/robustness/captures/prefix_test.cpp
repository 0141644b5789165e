// SPDX-License-Identifier: MIT
// A recording may end anywhere: every prefix of every shipped capture is read to its last whole record, and cutting it
// adds nothing to what is found but CP101.
#include <gtest/gtest.h>

#include <algorithm>

#include "decoder/findings/catalogue.hpp"
#include "replay/capture/source.hpp"
#include "tests/robustness/captures/corpus.hpp"
#include "tests/support/harness.hpp"

namespace servotrace::test {
namespace {

constexpr std::size_t kEveryByteBelow = 32'768;  // bytes of a capture

struct Border {
  std::size_t end;       // of the block that holds the frame
  std::uint64_t frames;  // up to there
};

// Reads a prefix to its end.
std::uint64_t count_frames(Bytes bytes, bool& truncated, bool& broken) {
  truncated = broken = false;
  auto source = replay::open_bytes(bytes, "prefix");
  if (!source) {
    broken = true;
    return 0;
  }
  std::uint64_t frames = 0;
  RawFrame frame;
  replay::Source::Step step = replay::Source::Step::kEnd;
  while ((step = (*source)->next(frame)) == replay::Source::Step::kFrame) ++frames;
  broken = step == replay::Source::Step::kError;
  truncated = (*source)->truncation().has_value();
  return frames;
}

// Where each block of a little-endian pcapng file ends, and how many frames there are up to there.
std::vector<Border> borders_of(const std::vector<std::uint8_t>& bytes) {
  std::vector<Border> borders;
  std::uint64_t frames = 0;
  const auto word = [&bytes](std::size_t at) {
    return std::uint32_t{bytes[at]} | std::uint32_t{bytes[at + 1]} << 8U | std::uint32_t{bytes[at + 2]} << 16U |
           std::uint32_t{bytes[at + 3]} << 24U;
  };
  for (std::size_t at = 0; at + 12 <= bytes.size(); at += word(at + 4)) {
    if (word(at) == 6 || word(at) == 3) ++frames;
    borders.push_back({at + word(at + 4), frames});
  }
  return borders;
}

TEST(Prefix, EveryCutIsReadToItsLastWholeRecord) {
  for (const Shipped& capture : shipped_captures()) {
    const std::vector<Border> borders = borders_of(capture.bytes);
    ASSERT_FALSE(borders.empty()) << capture.name;
    ASSERT_EQ(borders.back().end, capture.bytes.size()) << capture.name;
    // Reading starts anew for each prefix: of large captures the beginning, the end, and places between.
    std::vector<std::size_t> lengths;
    if (capture.bytes.size() < kEveryByteBelow) {
      for (std::size_t length = 0; length <= capture.bytes.size(); ++length) lengths.push_back(length);
    } else {
      const std::size_t stride = std::max<std::size_t>(1, borders.size() / 200);
      for (std::size_t i = 0; i < borders.size(); i += stride) {
        for (const int around : {-5, -1, 0, 1, 9})
          lengths.push_back(static_cast<std::size_t>(static_cast<int>(borders[i].end) + around));
      }
    }
    for (const std::size_t length : lengths) {
      if (length > capture.bytes.size()) continue;
      bool truncated = false, broken = false;
      const std::uint64_t frames = count_frames(Bytes(capture.bytes).first(length), truncated, broken);
      const auto after = std::upper_bound(borders.begin(), borders.end(), length,
                                          [](std::size_t value, const Border& border) { return value < border.end; });
      const bool in_header = after == borders.begin();
      ASSERT_EQ(broken, in_header) << capture.name << " cut at " << length;
      if (in_header) continue;
      const Border& whole = *std::prev(after);
      ASSERT_EQ(frames, whole.frames) << capture.name << " cut at " << length;
      ASSERT_EQ(truncated, whole.end != length) << capture.name << " cut at " << length;
    }
  }
}

using Key = std::tuple<std::uint64_t, std::string_view, std::int16_t, std::uint8_t, std::uint32_t>;

std::vector<Key> keys(std::span<const Finding> findings) {
  std::vector<Key> result;
  for (const Finding& finding : findings) {
    if (rule_row(finding.rule).id == "CP101") continue;
    result.emplace_back(finding.frame, rule_row(finding.rule).id, finding.node.mac_id,
                        static_cast<std::uint8_t>(finding.node.channel), finding.count);
  }
  std::sort(result.begin(), result.end());
  return result;
}

// At record borders: what is found in a prefix does not depend on how it ends, a clean capture stays clean wherever it
// is cut, and what a prefix finds while it is read is what the whole capture finds there.
TEST(Prefix, CuttingAddsNothingButCp101) {
  for (const Shipped& capture : shipped_captures()) {
    const std::vector<Border> borders = borders_of(capture.bytes);
    const Outcome whole = check_bytes(capture.bytes, {}, false);
    EXPECT_EQ(whole.nonsense, "") << capture.name;
    const auto severe = [](const Finding& finding) {
      return finding.severity != Severity::kNote && rule_row(finding.rule).id != "CP101";
    };
    const bool clean = std::none_of(whole.findings.begin(), whole.findings.end(), severe);
    const std::size_t places = capture.bytes.size() < kEveryByteBelow ? 60 : 8;
    const std::size_t stride = std::max<std::size_t>(1, borders.size() / places);
    for (std::size_t i = 1; i < borders.size(); i += stride) {
      const Outcome ended = check_bytes(Bytes(capture.bytes).first(borders[i].end), {}, false);
      EXPECT_EQ(ended.nonsense, "") << capture.name;
      if (clean) {
        for (const Finding& finding : ended.findings)
          EXPECT_FALSE(severe(finding)) << capture.name << " cut after frame " << ended.last_frame << ": "
                                        << rule_row(finding.rule).id;
      }
      if (borders[i].end + 1 > capture.bytes.size()) continue;
      const Outcome cut = check_bytes(Bytes(capture.bytes).first(borders[i].end + 1), {}, false);
      EXPECT_EQ(cut.nonsense, "") << capture.name;
      EXPECT_TRUE(cut.truncated);
      EXPECT_EQ(keys(cut.findings), keys(ended.findings)) << capture.name << " cut after frame " << ended.last_frame;
      if (cut.frames > 0) {
        EXPECT_EQ(std::count_if(cut.findings.begin(), cut.findings.end(),
                                [&cut](const Finding& finding) {
                                  return rule_row(finding.rule).id == "CP101" && finding.last_frame == cut.last_frame;
                                }),
                  1)
            << capture.name;
      }
    }
  }
}

}  // namespace
}  // namespace servotrace::test
