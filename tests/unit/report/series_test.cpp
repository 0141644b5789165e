// SPDX-License-Identifier: MIT
// Downsampling keeps every spike and the whole capture; the SVG writer keeps markup whole; the symptom table names
// rules that exist.
#include <gtest/gtest.h>

#include <algorithm>

#include "decoder/findings/catalogue.hpp"
#include "replay/report/model.hpp"
#include "replay/report/series.hpp"
#include "replay/report/svg.hpp"
#include "replay/report/symptoms.hpp"

namespace servotrace::report {
namespace {

TEST(Series, KeepsEverySampleWhereThereIsRoom) {
  Series series(8);
  for (int i = 0; i < 8; ++i) series.add(i * 100, i);
  ASSERT_EQ(series.bins().size(), 8U);
  EXPECT_EQ(series.bins()[7].last, 7);
  EXPECT_EQ(series.samples(), 8U);
}

TEST(Series, ASpikeNeverDisappears) {
  for (const int spike_at : {0, 1, 499, 777, 9999}) {
    Series series(64);
    for (int i = 0; i < 10'000; ++i) series.add(i * 1'000, i == spike_at ? -5000 : 10);
    EXPECT_LE(series.bins().size(), 64U);
    EXPECT_EQ(series.samples(), 10'000U);
    const auto lowest =
        std::min_element(series.bins().begin(), series.bins().end(),
                         [](const auto& left, const auto& right) { return left.minimum < right.minimum; });
    EXPECT_EQ(lowest->minimum, -5000) << spike_at;
    EXPECT_LE(lowest->time_ns, spike_at * 1'000) << spike_at;
    EXPECT_FALSE(series.is_constant());
  }
}

TEST(Series, TimesThatGoBackwardsOrStandStillStayBounded) {
  Series series(4);
  for (int i = 0; i < 1000; ++i) series.add(i % 3, i);
  EXPECT_LE(series.bins().size(), 4U);
  EXPECT_EQ(series.samples(), 1000U);
}

TEST(Svg, TextCannotBecomeMarkup) {
  EXPECT_EQ(escape_html("<b>\"a\" & 'c'</b>"), "&lt;b&gt;&quot;a&quot; &amp; &#39;c&#39;&lt;/b&gt;");
  EXPECT_EQ(escape_html("\x01\xFFok\xC3\xA4"), "?ok\xC3\xA4");
  Svg svg(10, 10, "a<b");
  svg.text(1, 1, "<script>", "x");
  EXPECT_EQ(svg.str().find("<script>"), std::string::npos);
}

TEST(Svg, TicksAreRoundAndFew) {
  EXPECT_EQ(ticks(0, 1, 5), (std::vector<double>{0, 0.2, 0.4, 0.6000000000000001, 0.8, 1}));
  EXPECT_TRUE(ticks(1, 1, 5).empty());
  EXPECT_LE(ticks(-3e9, 7e9, 9).size(), 11U);
}

TEST(StateTrack, CoversTheWholeCaptureInBoundedMemory) {
  StateTrack track;
  constexpr std::uint64_t kChanges = 20'000;
  for (std::uint64_t i = 1; i <= kChanges; ++i) {
    const auto time_ns = static_cast<TimeNs>(i) * kMillisecondNs;
    const auto value = static_cast<std::int64_t>(i % 2);
    const bool close_up = i > 15'000 && i <= 15'100;
    track.add({.time_ns = time_ns, .frame = i, .before = 1 - value, .after = value, .close_up = close_up});
  }
  EXPECT_LE(track.changes.size(), kMaxChanges);
  EXPECT_EQ(track.total, kChanges);
  EXPECT_EQ(track.value, 0);
  EXPECT_EQ(track.changes.front().frame, 1U);
  EXPECT_EQ(track.changes.back().after, 0);
  EXPECT_GT(track.changes.back().frame, kChanges - 100);
  std::uint64_t total = 0;
  std::uint64_t kept = 0;
  std::int64_t state = 0;
  for (const Event& event : track.changes) {
    EXPECT_EQ(event.before, state);  // one follows the other
    state = event.after;
    total += 1 + event.joined;
    kept += event.frame > 15'000 && event.frame <= 15'100 ? 1 : 0;
    EXPECT_TRUE(!event.close_up || event.joined == 0) << event.frame;
  }
  EXPECT_EQ(total, kChanges);
  EXPECT_EQ(kept, 100U);
}

TEST(Symptoms, NameRulesThatExist) {
  for (const Symptom& symptom : kSymptoms) {
    EXPECT_NE(find_rule(symptom.rule), kRuleCount) << symptom.rule;
    if (!symptom.cause.empty()) {
      EXPECT_NE(find_rule(symptom.cause), kRuleCount) << symptom.cause;
    }
    EXPECT_FALSE(symptom.text.empty());
    EXPECT_FALSE(symptom.section.empty());
  }
  // One explanation of a report by a cause stands once: a second row would never be reached.
  for (std::size_t i = 0; i < kSymptoms.size(); ++i) {
    for (std::size_t j = i + 1; j < kSymptoms.size(); ++j) {
      EXPECT_FALSE(!kSymptoms[i].cause.empty() && kSymptoms[i].rule == kSymptoms[j].rule &&
                   kSymptoms[i].argument == kSymptoms[j].argument && kSymptoms[i].cause == kSymptoms[j].cause)
          << kSymptoms[i].rule << ' ' << kSymptoms[i].argument << ' ' << kSymptoms[i].cause;
    }
  }
  for (const FaultRule& row : kFaultRules) EXPECT_NE(find_rule(row.rule), kRuleCount) << row.rule;
}

}  // namespace
}  // namespace servotrace::report
