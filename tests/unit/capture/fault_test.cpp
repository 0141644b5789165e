// SPDX-License-Identifier: MIT
// Disks and pipes that fail while a capture is read.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/support/bytes.hpp"
#include "tests/unit/capture/support.hpp"

namespace servotrace::test {
namespace {

constexpr int kFrames = 4000;

Buffer pcapng_of_many_pages() {
  Maker maker;
  maker.section().interface(227);
  for (int i = 0; i < kFrames; ++i) maker.enhanced(0, 1, hex("01 02 03 04"), 4);
  return maker.bytes();
}

Buffer pcap_of_many_pages() {
  Maker maker;
  maker.pcap_header(0xA1B2C3D4, 227);
  for (int i = 0; i < kFrames; ++i) maker.pcap_record(1, 2, hex("01 02 03 04"), 4);
  return maker.bytes();
}

Buffer log_of_many_pages() {
  std::string text;
  for (int i = 0; i < kFrames; ++i) text += "(1.500000) can0 5FF#0034\n";
  return Buffer(text.begin(), text.end());
}

TEST(Fault, AMappedFileThatIsCutWhileItIsRead) {
  for (const Buffer& bytes : {pcapng_of_many_pages(), pcap_of_many_pages(), log_of_many_pages()}) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.file("capture", bytes);
    auto source = replay::open_capture(path);
    ASSERT_TRUE(source);
    RawFrame frame;
    for (int i = 0; i < 10; ++i) ASSERT_EQ((*source)->next(frame), replay::Source::Step::kFrame);
    std::filesystem::resize_file(path, 3 * 4096);
    int frames = 10;
    replay::Source::Step step = replay::Source::Step::kEnd;
    while ((step = (*source)->next(frame)) == replay::Source::Step::kFrame) ++frames;
    EXPECT_EQ(step, replay::Source::Step::kError);
    EXPECT_NE((*source)->error().text().find("cannot be read on"), std::string::npos) << (*source)->error().text();
    EXPECT_GT(frames, 100);
    EXPECT_LT(frames, kFrames);
    EXPECT_EQ((*source)->next(frame), replay::Source::Step::kError) << "and it stays so";
  }
}

// A connection that is reset under its reader.
TEST(Fault, AStreamThatFails) {
  int ends[2] = {-1, -1};
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);
  Maker maker;
  maker.section().interface(227).enhanced(0, 1, hex("01 02 03 04"), 4);
  ASSERT_EQ(::write(ends[1], maker.bytes().data(), maker.bytes().size()), static_cast<ssize_t>(maker.bytes().size()));
  // Bytes of the other direction that nobody read make the close a reset.
  ASSERT_EQ(::write(ends[0], "x", 1), 1);
  auto source = replay::open_stream(ends[0], "-");
  ASSERT_TRUE(source);
  ::close(ends[1]);
  RawFrame frame;
  ASSERT_EQ((*source)->next(frame), replay::Source::Step::kFrame);
  EXPECT_EQ((*source)->next(frame), replay::Source::Step::kError);
  EXPECT_EQ((*source)->error().text(), "-: byte 84: cannot be read on: Connection reset by peer");
  ::close(ends[0]);
}

TEST(Fault, ADescriptorThatCannotBeRead) {
  const auto source = replay::open_stream(-1, "-");
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().text(), "-: cannot be read on: Bad file descriptor");
}

}  // namespace
}  // namespace servotrace::test
