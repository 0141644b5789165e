// SPDX-License-Identifier: MIT
// Our readers against libpcap wherever it can read the file, and against tshark where interfaces differ.
#include <gtest/gtest.h>
#include <pcap/pcap.h>

#include <cstdio>

#include "tests/support/bytes.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/peer.hpp"
#include "tests/unit/capture/support.hpp"

namespace servotrace::test {
namespace {

namespace fs = std::filesystem;

struct Other {
  std::vector<ReadFrame> frames;
  std::string error;  // of opening or reading
  int data_link = -1;
};

Other read_with_libpcap(const fs::path& path) {
  Other other;
  char message[PCAP_ERRBUF_SIZE] = {};
  pcap_t* const handle = pcap_open_offline_with_tstamp_precision(path.c_str(), PCAP_TSTAMP_PRECISION_NANO, message);
  if (handle == nullptr) {
    other.error = message;
    return other;
  }
  other.data_link = pcap_datalink(handle);
  pcap_pkthdr* header = nullptr;
  const u_char* bytes = nullptr;
  int status = 0;
  while ((status = pcap_next_ex(handle, &header, &bytes)) == 1) {
    ReadFrame read;
    read.raw.time_ns = TimeNs{header->ts.tv_sec} * kSecondNs + header->ts.tv_usec;
    read.raw.original_length = header->len;
    read.bytes.assign(bytes, bytes + header->caplen);
    other.frames.push_back(std::move(read));
  }
  if (status != PCAP_ERROR_BREAK) other.error = pcap_geterr(handle);
  pcap_close(handle);
  return other;
}

void expect_same(const ReadCapture& ours, const Other& theirs, const std::string& name) {
  ASSERT_EQ(ours.frames.size(), theirs.frames.size()) << name << ": " << theirs.error;
  for (std::size_t i = 0; i < ours.frames.size(); ++i) {
    EXPECT_EQ(ours.frames[i].raw.time_ns, theirs.frames[i].raw.time_ns) << name << " " << i;
    EXPECT_EQ(ours.frames[i].raw.original_length, theirs.frames[i].raw.original_length) << name << " " << i;
    EXPECT_EQ(ours.frames[i].bytes, theirs.frames[i].bytes) << name << " " << i;
  }
}

bool has_tshark() { return std::system("command -v tshark >/dev/null 2>&1") == 0; }

// Frame number, time, captured and original length, as "number seconds captured original".
std::vector<std::string> read_with_tshark(const fs::path& path) {
  const std::string command = "tshark -n -r '" + path.string() +
                              "' -T fields -E separator=/s -e frame.number -e frame.time_epoch -e frame.cap_len"
                              " -e frame.len 2>/dev/null";
  std::vector<std::string> lines;
  FILE* const pipe = ::popen(command.c_str(), "r");
  if (pipe == nullptr) return lines;
  char line[256];
  while (std::fgets(line, sizeof line, pipe) != nullptr) {
    std::string text = line;
    text.resize(text.find('\n'));
    lines.push_back(text);
  }
  ::pclose(pipe);
  return lines;
}

std::string as_tshark(const ReadFrame& read) {
  char text[128];
  std::snprintf(text, sizeof text, "%llu %lld.%09lld %zu %u", static_cast<unsigned long long>(read.raw.number),
                static_cast<long long>(read.raw.time_ns / kSecondNs),
                static_cast<long long>(read.raw.time_ns % kSecondNs), read.bytes.size(), read.raw.original_length);
  return text;
}

std::vector<fs::path> captures() {
  std::vector<fs::path> files;
  for (const fs::path& folder : {source_dir() / "captures", peer_captures()}) {
    if (!fs::exists(folder)) continue;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
      if (entry.path().extension() == ".pcap" || entry.path().extension() == ".pcapng") files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

TEST(SecondOpinion, EveryCaptureAtHand) {
  const bool tshark = has_tshark();
  for (const fs::path& path : captures()) {
    const ReadCapture ours = read_file(path);
    EXPECT_EQ(ours.error, "") << path;
    const Other theirs = read_with_libpcap(path);
    if (theirs.error.empty()) {
      expect_same(ours, theirs, path.string());
      continue;
    }
    // libpcap refuses interfaces that differ.
    EXPECT_GT(ours.interfaces.size(), 1U) << path << ": " << theirs.error;
    if (!tshark) continue;
    const std::vector<std::string> lines = read_with_tshark(path);
    ASSERT_EQ(lines.size(), ours.frames.size()) << path;
    for (std::size_t i = 0; i < lines.size(); ++i) EXPECT_EQ(as_tshark(ours.frames[i]), lines[i]) << path;
  }
}

// All that libpcap understands: both formats, byte orders, resolutions, packet blocks.
std::vector<Buffer> made_captures() {
  const Buffer packet = hex("00 00 05 FF 03 00 00 00 01 02 03");
  std::vector<Buffer> all;
  for (const ByteOrder order : {ByteOrder::kLittle, ByteOrder::kBig}) {
    for (const std::uint32_t magic : {0xA1B2C3D4U, 0xA1B23C4DU}) {
      Maker pcap(order);
      pcap.pcap_header(magic, 227);
      for (std::uint32_t i = 0; i < 5; ++i) pcap.pcap_record(1'700'000'000 + i, 999'999, packet, 11 + i);
      all.push_back(pcap.bytes());
    }
    for (const std::uint8_t resolution : {std::uint8_t{0}, std::uint8_t{3}, std::uint8_t{6}, std::uint8_t{9},
                                          std::uint8_t{12}, std::uint8_t{0x80 | 10}, std::uint8_t{0x80 | 20}}) {
      Maker options(order);
      options.option(9, Bytes(&resolution, 1)).option(14, Maker(order).u64(7).bytes()).u32(0);
      Maker pcapng(order);
      pcapng.section().interface(227, 65535, options.bytes());
      const std::uint64_t unit = (resolution & 0x80U) != 0 ? std::uint64_t{1} << (resolution & 0x7FU) : [&] {
        std::uint64_t ticks = 1;
        for (int i = 0; i < resolution; ++i) ticks *= 10;
        return ticks;
      }();
      pcapng.enhanced(0, 1'700'000'000 * unit + unit / 3, packet, 20);
      pcapng.obsolete(0, 0, 1'700'000'001 * unit, packet, 11);
      pcapng.block(5, Maker(order).u32(0).u64(0).bytes());
      pcapng.enhanced(0, 1'700'000'002 * unit + unit / 7, packet, 11);
      all.push_back(pcapng.bytes());
    }
  }
  return all;
}

TEST(SecondOpinion, MadeCaptures) {
  const TemporaryFolder folder;
  for (const Buffer& bytes : made_captures()) {
    const fs::path path = folder.file("made", bytes);
    const Other theirs = read_with_libpcap(path);
    ASSERT_EQ(theirs.error, "");
    expect_same(read_file(path), theirs, "made");
  }
}

TEST(SecondOpinion, CutCapturesGiveTheSameWholeRecords) {
  const TemporaryFolder folder;
  std::size_t kind = 0;
  for (const Buffer& bytes : made_captures()) {
    if (kind++ % 6 != 0) continue;
    for (std::size_t length = 4; length < bytes.size(); ++length) {
      const fs::path path = folder.file("cut", Bytes(bytes).first(length));
      const Other theirs = read_with_libpcap(path);
      const ReadCapture ours = read_file(path);
      if (theirs.data_link < 0) continue;  // libpcap wants the first interface before it opens a file
      expect_same(ours, theirs, "cut at " + std::to_string(length));
      EXPECT_EQ(ours.truncation.has_value(), !theirs.error.empty()) << length << ": " << theirs.error;
    }
  }
}

TEST(SecondOpinion, TsharkNumbersFramesAsWeDo) {
  if (!has_tshark()) GTEST_SKIP() << "no tshark";
  const Buffer packet = hex("00 00 05 FF 03 00 00 00 01 02 03");
  const TemporaryFolder folder;
  Maker mixed;
  mixed.section().interface(227).interface(252).interface(1, 8);
  mixed.enhanced(0, 1'000'001, packet, 11);
  mixed.block(9, bytes_of("__REALTIME_TIMESTAMP=1700000000000000\n"));  // a journal entry
  mixed.enhanced(1, 1'000'002, packet, 12);
  mixed.block(0xBAD, Maker().u32(12345).raw(hex("01 02 03 04")).bytes());  // custom blocks
  mixed.block(0x40000BAD, Maker().u32(12345).raw(hex("01 02 03 04")).bytes());
  mixed.block(0x12345678, hex("01 02 03 04"));  // unknown
  mixed.block(4, hex("00 00 00 00"));           // names
  mixed.obsolete(0, 0xFFFF, 1'000'003, packet, 11);
  Maker second(ByteOrder::kBig);
  second.section().interface(227).enhanced(0, 1'000'004, packet, 11).enhanced(0, 5, packet, 11);
  Buffer all = mixed.bytes();
  all.insert(all.end(), second.bytes().begin(), second.bytes().end());
  const fs::path path = folder.file("mixed.pcapng", all);
  fs::permissions(folder.path(), fs::perms::all);
  const ReadCapture ours = read_file(path);
  ASSERT_EQ(ours.error, "");
  const std::vector<std::string> lines = read_with_tshark(path);
  ASSERT_EQ(lines.size(), 8U);
  std::size_t found = 0;
  for (const ReadFrame& frame : ours.frames) {
    const auto place = std::find(lines.begin(), lines.end(), as_tshark(frame));
    EXPECT_NE(place, lines.end()) << as_tshark(frame);
    found += place != lines.end() ? 1U : 0U;
  }
  EXPECT_EQ(found, 5U);
}

}  // namespace
}  // namespace servotrace::test
