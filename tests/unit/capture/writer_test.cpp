// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "replay/capture/pcapng_writer.hpp"
#include "tests/support/bytes.hpp"
#include "tests/unit/capture/support.hpp"

namespace servotrace::test {
namespace {

using replay::PcapngWriter;

std::size_t entries(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(PcapngWriter, WhatIsWrittenIsRead) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "out.pcapng";
  auto writer = PcapngWriter::create(path);
  ASSERT_TRUE(writer);
  EXPECT_EQ((*writer)->add_interface(LinkType::kCanSocketcan, "can0"), 0U);
  EXPECT_EQ((*writer)->add_interface(LinkType::kWiresharkUpperPdu, ""), 1U);
  (*writer)->write(0, 1'700'000'000'123'456'789, hex("01 02 03"), 8);
  (*writer)->write(1, 0, hex("04 05 06 07"), 4, "ein Kommentar \xC3\xA4");
  EXPECT_FALSE(std::filesystem::exists(path)) << "the file must not appear before it is whole";
  ASSERT_TRUE((*writer)->finish());
  EXPECT_EQ(entries(folder.path()), 1U);
  const ReadCapture capture = read_file(path);
  ASSERT_EQ(capture.error, "");
  ASSERT_EQ(capture.frames.size(), 2U);
  EXPECT_EQ(capture.interfaces[0].name, "can0");
  EXPECT_EQ(capture.interfaces[0].time_resolution_ns, 1U);
  EXPECT_EQ(capture.frames[0].raw.time_ns, 1'700'000'000'123'456'789);
  EXPECT_EQ(capture.frames[0].raw.original_length, 8U);
  EXPECT_EQ(capture.frames[0].bytes, hex("01 02 03"));
  EXPECT_EQ(capture.frames[1].raw.link_type, LinkType::kWiresharkUpperPdu);
  EXPECT_EQ(capture.frames[1].bytes, hex("04 05 06 07"));
}

TEST(PcapngWriter, AnUnfinishedFileLeavesNothing) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.file("out.pcapng", "before");
  {
    auto writer = PcapngWriter::create(path);
    ASSERT_TRUE(writer);
    (*writer)->add_interface(LinkType::kCanSocketcan, "can0");
    EXPECT_EQ(entries(folder.path()), 2U);
  }
  EXPECT_EQ(entries(folder.path()), 1U);
  EXPECT_EQ(std::filesystem::file_size(path), 6U) << "what was there stays";
}

TEST(PcapngWriter, OrdinaryPermissions) {
  const TemporaryFolder folder;
  const mode_t mask = ::umask(022);
  auto writer = PcapngWriter::create(folder.path() / "out.pcapng");
  ASSERT_TRUE(writer && (*writer)->finish());
  ::umask(mask);
  struct ::stat status {};
  ASSERT_EQ(::stat((folder.path() / "out.pcapng").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0644U);
}

TEST(PcapngWriter, ALinkKeepsPointingAtItsFile) {
  const TemporaryFolder folder;
  const std::filesystem::path real = folder.file("real.pcapng", "old");
  std::filesystem::create_symlink(real, folder.path() / "link.pcapng");
  auto writer = PcapngWriter::create(folder.path() / "link.pcapng");
  ASSERT_TRUE(writer && (*writer)->finish());
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path() / "link.pcapng"));
  EXPECT_EQ(read_file(real).error, "");
}

TEST(PcapngWriter, PlacesThatCannotBeWritten) {
  const TemporaryFolder folder;
  const auto missing = PcapngWriter::create(folder.path() / "no" / "such" / "folder.pcapng");
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().text().find("cannot be written: No such file"), std::string::npos);
  const auto directory = PcapngWriter::create(folder.path());
  ASSERT_FALSE(directory);
  EXPECT_NE(directory.error().text().find("it is a directory"), std::string::npos);
}

TEST(PcapngWriter, AFullDiskIsReported) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  auto writer = PcapngWriter::create("/dev/full");
  ASSERT_TRUE(writer);
  (*writer)->add_interface(LinkType::kCanSocketcan, "can0");
  const Buffer packet(1000);
  for (int i = 0; i < 1000; ++i) (*writer)->write(0, 1, packet, 1000);
  const auto finished = (*writer)->finish();
  ASSERT_FALSE(finished);
  EXPECT_EQ(finished.error().text(), "/dev/full: cannot be written: No space left on device");
}

TEST(PcapngWriter, WrongUseIsReportedAtTheEnd) {
  const TemporaryFolder folder;
  auto writer = PcapngWriter::create(folder.path() / "out.pcapng");
  ASSERT_TRUE(writer);
  (*writer)->write(0, 1, hex("01"), 1);
  EXPECT_FALSE((*writer)->finish());
  writer->reset();
  EXPECT_EQ(entries(folder.path()), 0U);
}

}  // namespace
}  // namespace servotrace::test
