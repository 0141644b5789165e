// SPDX-License-Identifier: MIT
#include "replay/capture/recognise.hpp"

#include <algorithm>
#include <optional>
#include <string_view>

#include "replay/capture/csv.hpp"
#include "replay/capture/interrupt.hpp"
#include "replay/capture/text_source.hpp"

namespace servotrace::replay {
namespace {

using namespace std::string_view_literals;

struct Signature {
  std::size_t offset;
  std::string_view bytes;
  Kind kind;
};

constexpr Signature kRead[] = {
    {0, "\xD4\xC3\xB2\xA1"sv, Kind::kPcap},   {0, "\xA1\xB2\xC3\xD4"sv, Kind::kPcap},
    {0, "\x4D\x3C\xB2\xA1"sv, Kind::kPcap},   {0, "\xA1\xB2\x3C\x4D"sv, Kind::kPcap},
    {0, "\x34\xCD\xB2\xA1"sv, Kind::kPcap},   {0, "\xA1\xB2\xCD\x34"sv, Kind::kPcap},
    {0, "\x0A\x0D\x0D\x0A"sv, Kind::kPcapng}, {0, "\x1F\x8B"sv, Kind::kGzip},
    {0, "\x28\xB5\x2F\xFD"sv, Kind::kZstd},
};

// Kinds that are not read. `help` begins after a semicolon; empty: nothing would make a capture of it.
struct Refused {
  std::size_t offset;
  std::string_view bytes;
  std::string_view what;
  std::string_view help;
  bool is_capture = false;
};

constexpr std::string_view kEditcap = "convert it: editcap -F pcapng FILE OUT.pcapng";

constexpr Refused kRefused[] = {
    {0, "LOGG"sv, "a Vector BLF log", "convert it: can_logconvert FILE OUT.log (from python-can)", true},
    {0, "MDF     "sv, "a measurement file (ASAM MDF)", "convert it: can_logconvert FILE OUT.log (from python-can)",
     true},
    {0, "UnFinMF "sv, "an unfinished measurement file (ASAM MDF)", "finalise it with the tool that recorded it", true},
    {0, "snoop\0\0\0"sv, "a snoop capture", kEditcap, true},
    {0, "btsnoop\0"sv, "a Bluetooth snoop capture", {}},
    {0, "GMBU"sv, "a Microsoft Network Monitor capture", kEditcap, true},
    {0, "RTSS"sv, "a Microsoft Network Monitor capture", kEditcap, true},
    {0, "TRSNIFF data    \x1A"sv, "a Sniffer capture", kEditcap, true},
    {0, "XCP\0"sv, "a NetXRay capture", kEditcap, true},
    {0, "\x00\x00\x02\x00\x12\x05\x00\x10"sv, "a K12 capture", kEditcap, true},
    {0, "iptrace "sv, "an AIX iptrace capture", kEditcap, true},
    {0, "\xA1\xB2\xC3\xCD"sv, "a pcap file of an unknown variant", kEditcap, true},
    {0,
     "\xFD"
     "7zXZ\0"sv,
     "xz compressed", "unpack it: xz -dc FILE | servotrace check -"},
    {0, "BZh"sv, "bzip2 compressed", "unpack it: bzip2 -dc FILE | servotrace check -"},
    {0, "\x04\x22\x4D\x18"sv, "lz4 compressed", "unpack it: lz4 -dc FILE | servotrace check -"},
    {0, "PK\x03\x04"sv, "a zip archive", "unpack it: unzip FILE"},
    {0, "PK\x05\x06"sv, "an empty zip archive", {}},
    {0, "7z\xBC\xAF\x27\x1C"sv, "a 7-Zip archive", "unpack it: 7z x FILE"},
    {0, "Rar!\x1A\x07"sv, "a RAR archive", "unpack it: unrar x FILE"},
    {257, "ustar"sv, "a tar archive", "unpack it: tar -xf FILE"},
    {0,
     "\x7F"
     "ELF"sv,
     "an ELF program",
     {}},
    {0, "MZ"sv, "a Windows program", {}},
    {0, "%PDF-"sv, "a PDF document", {}},
    {0, "\x89PNG\r\n\x1A\n"sv, "a PNG picture", {}},
    {0, "\xFF\xD8\xFF"sv, "a JPEG picture", {}},
    {0, "GIF8"sv, "a GIF picture", {}},
    {0, "SQLite format 3\0"sv, "an SQLite database", {}},
    {0, "\x89HDF\r\n\x1A\n"sv, "an HDF5 file", {}},
    {0, "PAR1"sv, "a Parquet table", {}},
    {0, "\x30\x26\xB2\x75\x8E\x66\xCF\x11"sv, "an ASF media file", {}},
    {0, "RIFF"sv, "a RIFF media file", {}},
    {0, "\xFF\xFE"sv, "UTF-16 text", "convert it: iconv -f UTF-16 -t UTF-8 FILE"},
    {0, "\xFE\xFF"sv, "UTF-16 text", "convert it: iconv -f UTF-16 -t UTF-8 FILE"},
};

bool has(Input& input, std::size_t offset, std::string_view bytes) {
  const Bytes there = input.peek(offset + bytes.size());
  if (there.size() < offset + bytes.size()) return false;
  return std::equal(bytes.begin(), bytes.end(), there.begin() + static_cast<std::ptrdiff_t>(offset),
                    [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
}

Error refuse(const std::string& name, std::string_view what, std::string_view help) {
  std::string text = "is " + std::string(what) + ", which is not read";
  if (!help.empty()) {
    std::string command(help);
    const std::size_t place = command.find("FILE");
    if (place != std::string::npos) command.replace(place, 4, name);
    text += "; " + command;
  }
  return Error{name, std::move(text)};
}

// ERF has no magic: a chain of records (8-byte time, type, flags, length) that fits says it.
bool is_erf(Input& input) {
  constexpr std::size_t kHeader = 16;
  constexpr int kChain = 3;  // records that must follow each other
  std::size_t at = 0;
  for (int i = 0; i < kChain; ++i) {
    const Bytes there = input.peek(at + kHeader);
    if (there.size() == at && i > 0) return true;
    if (there.size() < at + kHeader) return false;
    const Bytes record = there.subspan(at);
    const unsigned type = record[8] & 0x7FU;
    const std::size_t length = std::size_t{record[10]} << 8U | record[11];
    if (type == 0 || type > 48 || length < kHeader) return false;
    at += length;
  }
  return true;
}

// The first line that is not empty, without the blanks around it; a stream is not waited for beyond its end.
std::string_view first_line(Input& input) {
  constexpr std::size_t kLongest = 4096;  // bytes looked at
  for (std::size_t wanted = 1; wanted <= kLongest; ++wanted) {
    const Bytes there = input.peek(wanted);
    const std::size_t reach = std::min(input.at_hand().size(), kLongest);
    std::string_view text(reinterpret_cast<const char*>(there.data()), reach);
    if (text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);
    const std::size_t begin = text.find_first_not_of(" \t\r\n");
    if (begin != std::string_view::npos) {
      const std::size_t end = text.find_first_of("\r\n", begin);
      if (end != std::string_view::npos || there.size() < wanted || reach == kLongest)
        return text.substr(begin, end == std::string_view::npos ? end : end - begin);
    }
    if (there.size() < wanted) return {};
    wanted = std::max(wanted, reach);
  }
  return {};
}

std::optional<Kind> text_kind(Input& input) {
  const std::string_view line = first_line(input);
  if (line.empty()) return std::nullopt;
  const std::string word = lower(Words(line).next());
  if (line.front() == '(' && line.find(')') != std::string_view::npos && line.find('#') != std::string_view::npos)
    return Kind::kCandump;
  if (word == "date" || word == "base" || (word == "begin" && lower(line).find("triggerblock") == 6)) return Kind::kAsc;
  if (line.front() == ';') return Kind::kTrc;
  if (parse_csv_header(line)) return Kind::kCsv;
  return std::nullopt;
}

// The first byte that is no blank, over a UTF-8 mark.
char first_letter(Bytes bytes) {
  std::size_t i = bytes.size() >= 3 && bytes[0] == 0xEF && bytes[1] == 0xBB && bytes[2] == 0xBF ? 3 : 0;
  while (i < bytes.size() && (bytes[i] == ' ' || bytes[i] == '\t' || bytes[i] == '\r' || bytes[i] == '\n')) ++i;
  return i < bytes.size() ? static_cast<char>(bytes[i]) : '\0';
}

}  // namespace

Result<Kind> recognise(Input& input, const std::string& name, bool* foreign_capture) {
  constexpr std::size_t kSample = 512;  // bytes that tell text from other content
  const Bytes first = input.peek(4);
  if (input.failure()) return Error{name, *input.failure()};
  if (first.empty()) return Error{name, interrupted() ? "was interrupted before anything came" : "is empty"};
  for (const Signature& signature : kRead) {
    if (has(input, signature.offset, signature.bytes)) return signature.kind;
  }
  for (const Refused& kind : kRefused) {
    if (!has(input, kind.offset, kind.bytes)) continue;
    if (foreign_capture != nullptr) *foreign_capture = kind.is_capture;
    return refuse(name, kind.what, kind.help);
  }
  if (const auto kind = text_kind(input)) return *kind;
  const Bytes sample = input.peek(kSample);
  if (input.failure()) return Error{name, *input.failure()};
  const bool binary = std::any_of(sample.begin(), sample.end(), [](std::uint8_t byte) {
    return byte < 0x20 && byte != '\t' && byte != '\n' && byte != '\r' && byte != '\f';
  });
  if (binary) {
    if (is_erf(input)) {
      if (foreign_capture != nullptr) *foreign_capture = true;
      return refuse(name, "an Endace ERF capture", kEditcap);
    }
    return Error{name, "is no capture of a known kind"};
  }
  switch (first_letter(sample)) {
    case '{':
    case '[':
      return refuse(name, "JSON", {});
    case '<':
      return refuse(name, "XML or HTML", {});
    default:
      return Error{name, "is text, but no log of a known kind (candump -l, ASC, TRC, CSV with a header line)"};
  }
}

}  // namespace servotrace::replay
