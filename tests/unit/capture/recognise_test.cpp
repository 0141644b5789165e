// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "tests/support/bytes.hpp"
#include "tests/unit/capture/support.hpp"

namespace servotrace::test {
namespace {

using namespace std::string_view_literals;

TEST(Recognise, OtherKindsAreRefusedByName) {
  struct Case {
    std::string_view content;
    std::string_view error;  // behind the file's name
  };
  const Case cases[] = {
      {"", ": is empty"},
      {"LOGG\x90\0\0\0"sv,
       ": is a Vector BLF log, which is not read; convert it: can_logconvert - OUT.log (from python-can)"},
      {"snoop\0\0\0\0\0\0\x02"sv,
       ": is a snoop capture, which is not read; convert it: editcap -F pcapng - OUT.pcapng"},
      {"\x7F"
       "ELF\x02\x01\x01\0"sv,
       ": is an ELF program, which is not read"},
      {"PK\x03\x04\x14\0"sv, ": is a zip archive, which is not read; unpack it: unzip -"},
      {"  {\"frames\": []}\n", ": is JSON, which is not read"},
      {"[1, 2]\n", ": is JSON, which is not read"},
      {"<html></html>\n", ": is XML or HTML, which is not read"},
      {"\x30\x26\xB2\x75\x8E\x66\xCF\x11\0\0"sv, ": is an ASF media file, which is not read"},
      {"lorem ipsum dolor\n", ": is text, but no log of a known kind (candump -l, ASC, TRC, CSV with a header line)"},
      {"\x01\x02\x03"sv, ": is no capture of a known kind"},
      {"\0\0\0\0"sv, ": is no capture of a known kind"},
  };
  for (const Case& test : cases) EXPECT_EQ(read_both(bytes_of(test.content)).error, "-" + std::string(test.error));
}

TEST(Recognise, ErfByItsChainOfRecords) {
  Maker maker(ByteOrder::kBig);
  for (int i = 0; i < 3; ++i) maker.u64(0x1234).u8(2).u8(4).u16(20).u16(0).u16(4).u32(0xAABBCCDD);
  EXPECT_NE(read_both(maker.bytes()).error.find("an Endace ERF capture"), std::string::npos);
}

TEST(Recognise, FilesThatCannotBeOpened) {
  const TemporaryFolder folder;
  EXPECT_EQ(read_file(folder.path()).error, folder.path().string() + ": is a directory, not a capture");
  const std::string missing = (folder.path() / "missing.pcapng").string();
  EXPECT_EQ(read_file(missing).error, missing + ": cannot be opened: No such file or directory");
}

}  // namespace
}  // namespace servotrace::test
