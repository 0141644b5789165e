// SPDX-License-Identifier: MIT
#include "tests/unit/capture/support.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <thread>

namespace servotrace::test {

TemporaryFolder::TemporaryFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "servotrace-test-XXXXXX").string();
  const char* const made = ::mkdtemp(pattern.data());
  EXPECT_NE(made, nullptr);
  if (made != nullptr) path_ = made;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path TemporaryFolder::file(const std::string& name, Bytes bytes) const {
  const std::filesystem::path place = path_ / name;
  std::ofstream out(place, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  return place;
}

std::filesystem::path TemporaryFolder::file(const std::string& name, std::string_view text) const {
  return file(name, bytes_of(text));
}

Bytes bytes_of(std::string_view text) { return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}; }

Maker& Maker::put(std::uint64_t value, unsigned byte_count) {
  for (unsigned i = 0; i < byte_count; ++i) {
    const unsigned place = order_ == ByteOrder::kLittle ? i : byte_count - 1 - i;
    bytes_.push_back(static_cast<std::uint8_t>(value >> (8U * place)));
  }
  return *this;
}

Maker& Maker::raw(Bytes bytes) {
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  return *this;
}

Maker& Maker::padded(Bytes bytes) {
  raw(bytes);
  for (std::size_t i = bytes.size(); i % 4 != 0; ++i) bytes_.push_back(0);
  return *this;
}

Maker& Maker::option(std::uint16_t code, Bytes value) { return u16(code).u16(value.size()).padded(value); }

Maker& Maker::pcap_header(std::uint32_t magic, std::uint32_t link_type) {
  return u32(magic).u16(2).u16(4).u32(0).u32(0).u32(65535).u32(link_type);
}

Maker& Maker::pcap_record(std::uint32_t second, std::uint32_t fraction, Bytes bytes, std::uint32_t original) {
  return u32(second).u32(fraction).u32(bytes.size()).u32(original).raw(bytes);
}

Maker& Maker::block(std::uint32_t type, Bytes body) {
  const std::size_t total = 12 + (body.size() + 3) / 4 * 4;
  return u32(type).u32(total).padded(body).u32(total);
}

Maker& Maker::section() {
  return block(0x0A0D0D0A, fresh().u32(0x1A2B3C4D).u16(1).u16(0).u64(0xFFFFFFFFFFFFFFFF).bytes());
}

Maker& Maker::interface(std::uint16_t link_type, std::uint32_t snap_length, Bytes options) {
  return block(1, fresh().u16(link_type).u16(0).u32(snap_length).raw(options).bytes());
}

Maker& Maker::enhanced(std::uint32_t interface, std::uint64_t ticks, Bytes bytes, std::uint32_t original,
                       Bytes options) {
  return block(6, fresh()
                      .u32(interface)
                      .u32(ticks >> 32U)
                      .u32(ticks & 0xFFFFFFFF)
                      .u32(bytes.size())
                      .u32(original)
                      .padded(bytes)
                      .raw(options)
                      .bytes());
}

Maker& Maker::simple(Bytes bytes, std::uint32_t original) {
  return block(3, fresh().u32(original).padded(bytes).bytes());
}

Maker& Maker::obsolete(std::uint16_t interface, std::uint16_t drops, std::uint64_t ticks, Bytes bytes,
                       std::uint32_t original) {
  return block(2, fresh()
                      .u16(interface)
                      .u16(drops)
                      .u32(ticks >> 32U)
                      .u32(ticks & 0xFFFFFFFF)
                      .u32(bytes.size())
                      .u32(original)
                      .padded(bytes)
                      .bytes());
}

ReadCapture read_all(replay::Source& source) {
  ReadCapture capture;
  RawFrame frame;
  for (;;) {
    const replay::Source::Step step = source.next(frame);
    if (step == replay::Source::Step::kFrame) {
      capture.frames.push_back({frame, Buffer(frame.bytes.begin(), frame.bytes.end()), source.byte_offset()});
      continue;
    }
    if (step == replay::Source::Step::kError) capture.error = source.error().text();
    break;
  }
  for (ReadFrame& read : capture.frames) read.raw.bytes = read.bytes;
  capture.interfaces.assign(source.interfaces().begin(), source.interfaces().end());
  capture.dropped.assign(source.dropped().begin(), source.dropped().end());
  capture.truncation = source.truncation();
  capture.format = source.format();
  return capture;
}

ReadCapture read_file(const std::filesystem::path& path) {
  auto source = replay::open_capture(path);
  if (!source) return {.error = source.error().text()};
  return read_all(**source);
}

ReadCapture read_stream(Bytes bytes, std::size_t piece) {
  int ends[2] = {-1, -1};
  if (::pipe(ends) != 0) return {.error = "no pipe"};
  std::thread feeder([bytes, piece, out = ends[1]] {
    Bytes rest = bytes;
    while (!rest.empty()) {
      const ssize_t done = ::write(out, rest.data(), std::min(piece, rest.size()));
      if (done <= 0) break;
      rest = rest.subspan(static_cast<std::size_t>(done));
    }
    ::close(out);
  });
  ReadCapture capture;
  {
    auto source = replay::open_stream(ends[0], "-");
    if (source) {
      capture = read_all(**source);
    } else {
      capture.error = source.error().text();
    }
  }
  // What was not read must not stop the feeder.
  std::uint8_t rest[4096];
  while (::read(ends[0], rest, sizeof rest) > 0) {
  }
  feeder.join();
  ::close(ends[0]);
  return capture;
}

ReadCapture read_both(Bytes bytes) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.file("capture", bytes);
  ReadCapture file = read_file(path);
  const ReadCapture stream = read_stream(bytes);
  EXPECT_EQ(file.frames.size(), stream.frames.size());
  for (std::size_t i = 0; i < std::min(file.frames.size(), stream.frames.size()); ++i) {
    const ReadFrame& a = file.frames[i];
    const ReadFrame& b = stream.frames[i];
    EXPECT_EQ(a.bytes, b.bytes) << i;
    EXPECT_EQ(a.byte_offset, b.byte_offset) << i;
    EXPECT_EQ(a.raw.number, b.raw.number);
    EXPECT_EQ(a.raw.time_ns, b.raw.time_ns);
    EXPECT_EQ(a.raw.interface_id, b.raw.interface_id);
    EXPECT_EQ(a.raw.link_type, b.raw.link_type);
    EXPECT_EQ(a.raw.original_length, b.raw.original_length);
  }
  EXPECT_EQ(file.interfaces.size(), stream.interfaces.size());
  EXPECT_EQ(file.dropped.size(), stream.dropped.size());
  EXPECT_EQ(file.truncation.has_value(), stream.truncation.has_value());
  EXPECT_EQ(file.format, stream.format);
  // The same message, but for the name.
  const std::string name = path.string();
  for (std::size_t at = file.error.find(name); at != std::string::npos; at = file.error.find(name))
    file.error.replace(at, name.size(), "-");
  EXPECT_EQ(file.error, stream.error);
  return file;
}

}  // namespace servotrace::test
