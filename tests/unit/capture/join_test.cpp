// SPDX-License-Identifier: MIT
#include "replay/capture/join.hpp"

#include <gtest/gtest.h>

#include "replay/capture/folder.hpp"
#include "tests/support/bytes.hpp"
#include "tests/unit/capture/support.hpp"

namespace servotrace::test {
namespace {

// A pcapng of one interface with a frame at each time (in microseconds), whose byte is `mark`.
Buffer one_interface(std::string_view name, std::initializer_list<std::uint64_t> times, std::uint8_t mark,
                     std::uint16_t link_type = 227) {
  Maker maker;
  maker.section().interface(link_type, 0, Maker().option(2, bytes_of(name)).u32(0).bytes());
  for (const std::uint64_t time : times) maker.enhanced(0, time, Bytes(&mark, 1), 1);
  return maker.bytes();
}

ReadCapture join(const std::vector<std::filesystem::path>& paths) {
  auto source = replay::join_captures(paths);
  if (!source) return {.error = source.error().text()};
  return read_all(**source);
}

std::string marks(const ReadCapture& capture) {
  std::string text;
  for (const ReadFrame& frame : capture.frames) text += static_cast<char>(frame.bytes.at(0));
  return text;
}

TEST(Join, ARingBufferOfFilesIsOneInterface) {
  const TemporaryFolder folder;
  const auto a = folder.file("a", one_interface("can0", {1, 2}, 'a'));
  const auto b = folder.file("b", one_interface("can0", {3, 4}, 'b'));
  const auto c = folder.file("c", one_interface("can0", {5}, 'c'));
  const ReadCapture capture = join({c, a, b});
  ASSERT_EQ(capture.error, "");
  EXPECT_EQ(marks(capture), "aabbc");
  EXPECT_EQ(capture.interfaces.size(), 1U);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(capture.frames[i].raw.number, i + 1);
  // Each border is a place where nothing may be compared across.
  ASSERT_EQ(capture.dropped.size(), 2U);
  EXPECT_EQ(capture.dropped[0].count, 0U);
  EXPECT_EQ(capture.dropped[0].after_frame, 2U);
  EXPECT_EQ(capture.dropped[1].after_frame, 4U);
  EXPECT_EQ(capture.format, "3 joined captures");
}

TEST(Join, OverlappingFilesAreInterfacesOfTheirOwn) {
  const TemporaryFolder folder;
  const auto a = folder.file("a", one_interface("can0", {1, 3, 5}, 'a'));
  const auto b = folder.file("b", one_interface("can0", {2, 3, 6}, 'b'));
  const auto c = folder.file("c", one_interface("ring", {0, 9}, 'c', 252));
  const ReadCapture capture = join({a, b, c});
  ASSERT_EQ(capture.error, "");
  EXPECT_EQ(marks(capture), "cabababc");
  EXPECT_EQ(capture.interfaces.size(), 3U);
  EXPECT_TRUE(capture.dropped.empty());
  EXPECT_EQ(capture.frames[0].raw.link_type, LinkType::kWiresharkUpperPdu);
  EXPECT_NE(capture.frames[1].raw.interface_id, capture.frames[2].raw.interface_id);
}

TEST(Join, DropsAndTruncationAreKept) {
  const TemporaryFolder folder;
  Maker drops;
  drops.section().interface(227).enhanced(0, 5, hex("61"), 1);
  drops.enhanced(0, 6, hex("61"), 1, Maker().option(4, Maker().u64(7).bytes()).u32(0).bytes());
  const auto a = folder.file("a", drops.bytes());
  const Buffer whole = one_interface("x", {1, 2, 3}, 'b');
  const auto b = folder.file("b", Bytes(whole).first(whole.size() - 3));
  const ReadCapture capture = join({a, b});
  ASSERT_EQ(capture.error, "");
  EXPECT_EQ(marks(capture), "bbaa");
  ASSERT_EQ(capture.dropped.size(), 1U);
  EXPECT_EQ(capture.dropped[0].count, 7U);
  EXPECT_EQ(capture.dropped[0].after_frame, 3U);
  EXPECT_EQ(capture.dropped[0].interface_id, 1U);
  EXPECT_TRUE(capture.truncation);
}

TEST(Join, ABrokenFileIsAnError) {
  const TemporaryFolder folder;
  const auto a = folder.file("a", one_interface("can0", {1, 2}, 'a'));
  const auto b = folder.file("b", "no capture");
  EXPECT_NE(join({a, b}).error.find("/b: is text"), std::string::npos);
  EXPECT_NE(join({a, folder.path() / "missing"}).error.find("cannot be opened"), std::string::npos);
}

TEST(Folder, FindsCapturesByTheirContent) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "deeper" / ".hidden");
  folder.file("z.pcapng", one_interface("can0", {1}, 'a'));
  folder.file("deeper/log.txt", "(1.5) can0 5FF#00\n");
  folder.file("deeper/.hidden/x.pcapng", one_interface("can0", {1}, 'a'));
  folder.file(".unfinished.pcapng", one_interface("can0", {1}, 'a'));
  folder.file("README.md", "# Captures\n");
  folder.file("empty", "");
  folder.file("old.blf", "LOGG\x90");
  const auto contents = replay::captures_in(folder.path());
  ASSERT_TRUE(contents);
  ASSERT_EQ(contents->captures.size(), 2U);
  EXPECT_EQ(contents->captures[0], folder.path() / "deeper" / "log.txt");
  EXPECT_EQ(contents->captures[1], folder.path() / "z.pcapng");
  ASSERT_EQ(contents->refused.size(), 1U);
  EXPECT_NE(contents->refused[0].text().find("Vector BLF"), std::string::npos);
  EXPECT_FALSE(replay::captures_in(folder.path() / "missing"));
}

}  // namespace
}  // namespace servotrace::test
