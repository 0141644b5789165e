// SPDX-License-Identifier: MIT
// What the plugin keeps of a frame comes back as it was put, in any order and as often as asked.
#include "dissector/store.hpp"

#include <gtest/gtest.h>

#include "decoder/link/rtex_record.hpp"
#include "tests/support/bytes.hpp"

namespace servotrace::plugin {
namespace {

constexpr NodeRef kAxis{.bus = {.kind = BusKind::kRing, .number = 1, .interface_id = 3},
                        .protocol = Protocol::kRtex,
                        .mac_id = 7,
                        .place = 2,
                        .channel = Channel::kSub};

std::vector<std::uint8_t> frame_bytes() { return std::vector<std::uint8_t>(40, 0x55); }

Dissection dissection_of(const std::vector<std::uint8_t>& bytes, std::uint64_t previous) {
  Dissection result;
  result.frame = bytes;
  result.protocol = Protocol::kRtex;
  result.bus = kAxis.bus;
  result.direction = Direction::kResponse;
  EXPECT_TRUE(result.add({.layout = &rtex::kRecord,
                          .offset = 16,
                          .length = 24,
                          .node = kAxis,
                          .direction = Direction::kResponse,
                          .guessed = true}));
  result.links.push_back({LinkKind::kRequestIn, previous, 1'500'000, kAxis});
  result.links.push_back({LinkKind::kPreviousOfNode, previous, -5, kAxis});
  return result;
}

TEST(FrameStore, GivesBackWhatWasPut) {
  FrameStore store;
  const std::vector<std::uint8_t> bytes = frame_bytes();
  const std::vector<std::uint8_t> whole = {1, 2, 3};
  Dissection put = dissection_of(bytes, 4);
  put.reassembled = whole;
  store.put(9, put, {.first = 3, .count = 2});
  store.put(12, dissection_of(bytes, 9), {});

  Dissection shown;
  FrameStore::Found found;
  ASSERT_NE(store.get(9, bytes, shown, found), FrameStore::kNoShape);
  EXPECT_EQ(found.first, 3U);
  EXPECT_EQ(found.count, 2U);
  EXPECT_EQ(shown.protocol, Protocol::kRtex);
  EXPECT_EQ(shown.bus, kAxis.bus);
  EXPECT_EQ(shown.direction, Direction::kResponse);
  ASSERT_EQ(shown.segments.size(), 1U);
  EXPECT_EQ(shown.segments[0].layout, &rtex::kRecord);
  EXPECT_EQ(shown.segments[0].offset, 16U);
  EXPECT_EQ(shown.segments[0].length, 24U);
  EXPECT_EQ(shown.segments[0].node, kAxis);
  EXPECT_EQ(shown.segments[0].direction, Direction::kResponse);
  EXPECT_TRUE(shown.segments[0].guessed);
  ASSERT_EQ(shown.links.size(), 2U);
  EXPECT_EQ(shown.links[0].kind, LinkKind::kRequestIn);
  EXPECT_EQ(shown.links[0].frame, 4U);
  EXPECT_EQ(shown.links[0].after_ns, 1'500'000);
  EXPECT_EQ(shown.links[0].node, kAxis);
  EXPECT_EQ(shown.links[1].after_ns, -5);
  EXPECT_EQ(std::vector<std::uint8_t>(shown.reassembled.begin(), shown.reassembled.end()), whole);
}

TEST(FrameStore, NothingOfFramesThatWereNotPut) {
  FrameStore store;
  const std::vector<std::uint8_t> bytes = frame_bytes();
  Dissection shown = dissection_of(bytes, 1);
  FrameStore::Found found{1, 1};
  EXPECT_EQ(store.get(5, bytes, shown, found), FrameStore::kNoShape);
  EXPECT_TRUE(shown.segments.empty());
  EXPECT_EQ(found.count, 0U);
  store.put(6, Dissection{}, {});
  EXPECT_EQ(store.get(6, bytes, shown, found), FrameStore::kNoShape);
}

// A read filter drops a frame and the next one takes its number.
TEST(FrameStore, TheLaterOfTwoFramesOfOneNumberCounts) {
  FrameStore store;
  const std::vector<std::uint8_t> bytes = frame_bytes();
  store.put(2, dissection_of(bytes, 1), {.first = 0, .count = 1});
  store.put(2, Dissection{}, {});
  Dissection shown;
  FrameStore::Found found;
  EXPECT_EQ(store.get(2, bytes, shown, found), FrameStore::kNoShape);
}

// Fewer bytes than before (they should be the same, but they come from outside): the segment is left out.
TEST(FrameStore, LooksAtTheBoundsAgain) {
  FrameStore store;
  const std::vector<std::uint8_t> bytes = frame_bytes();
  store.put(1, dissection_of(bytes, 0), {});
  Dissection shown;
  FrameStore::Found found;
  ASSERT_NE(store.get(1, Bytes(bytes).first(30), shown, found), FrameStore::kNoShape);
  EXPECT_TRUE(shown.segments.empty());
}

TEST(FrameStore, TellsARequestOfItsAnswers) {
  FrameStore store;
  const std::vector<std::uint8_t> bytes = frame_bytes();
  store.put(3, dissection_of(bytes, 0), {});
  store.put(5, dissection_of(bytes, 3), {});
  store.put(6, dissection_of(bytes, 3), {});
  std::vector<FrameStore::Answer> answers;
  store.answers(3, answers);
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_EQ(answers[0].frame, 5U);
  EXPECT_EQ(answers[1].frame, 6U);
  EXPECT_EQ(answers[0].kind, LinkKind::kRequestIn);
  EXPECT_EQ(answers[0].node, kAxis);
  store.answers(5, answers);
  EXPECT_TRUE(answers.empty());
}

TEST(FrameStore, TellsAFrameOfTheNextOne) {
  FrameStore store;
  const std::vector<std::uint8_t> bytes = frame_bytes();
  store.put(3, dissection_of(bytes, 0), {});
  store.put(100'000, dissection_of(bytes, 3), {});
  EXPECT_EQ(store.next_of(3), 100'000U);
  EXPECT_EQ(store.next_of(0), 0U);
  EXPECT_EQ(store.next_of(100'000), 0U);
  EXPECT_EQ(store.next_of(100'001), 0U);
}

// Frames that differ in their values only have one shape; of another node or layout they have another.
TEST(FrameStore, FramesThatLookAlikeHaveOneShape) {
  FrameStore store;
  const std::vector<std::uint8_t> bytes = frame_bytes();
  const std::uint32_t first = store.put(1, dissection_of(bytes, 0), {});
  EXPECT_EQ(store.put(2, dissection_of(bytes, 1), {}), first);
  Dissection other = dissection_of(bytes, 1);
  other.segments[0].node.mac_id = 8;
  const std::uint32_t second = store.put(3, other, {});
  EXPECT_NE(second, first);
  Dissection shown;
  FrameStore::Found found;
  EXPECT_EQ(store.get(2, bytes, shown, found), first);
  EXPECT_EQ(store.get(3, bytes, shown, found), second);
  EXPECT_EQ(shown.segments[0].node.mac_id, 8);
}

// Many rows: the dictionaries grow.
TEST(FrameStore, GivesBackWhatWasPutOfManyNodes) {
  FrameStore store;
  const std::vector<std::uint8_t> bytes = frame_bytes();
  const auto of_node = [&bytes](std::uint32_t number) {
    Dissection result = dissection_of(bytes, number - 1);
    result.segments[0].node.mac_id = static_cast<std::int16_t>(number % 1000);
    result.links[1].node.mac_id = static_cast<std::int16_t>(number % 1000);
    return result;
  };
  for (std::uint32_t i = 1; i <= 5000; ++i) store.put(i, of_node(i), {});
  Dissection shown;
  FrameStore::Found found;
  for (std::uint32_t i = 1; i <= 5000; ++i) {
    ASSERT_NE(store.get(i, bytes, shown, found), FrameStore::kNoShape);
    EXPECT_EQ(shown.segments[0].node.mac_id, static_cast<std::int16_t>(i % 1000));
    EXPECT_EQ(shown.links[1].node.mac_id, static_cast<std::int16_t>(i % 1000));
  }
}

// Cyclic traffic: a frame that looks like an earlier one costs a few bytes.
TEST(FrameStore, SameShapesAreKeptOnce) {
  FrameStore store;
  const std::vector<std::uint8_t> bytes = frame_bytes();
  for (std::uint32_t i = 1; i <= 1000; ++i) store.put(i, dissection_of(bytes, 0), {});
  const std::size_t before = store.bytes_used();
  for (std::uint32_t i = 1001; i <= 20000; ++i) store.put(i, dissection_of(bytes, 0), {});
  EXPECT_LT(store.bytes_used() - before, std::size_t{19000} * 64);
}

}  // namespace
}  // namespace servotrace::plugin
