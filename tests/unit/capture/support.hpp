// SPDX-License-Identifier: MIT
// Capture files made in memory, byte by byte in either byte order, and read through every way in.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "decoder/core/bytes.hpp"
#include "replay/capture/source.hpp"

namespace servotrace::test {

using Buffer = std::vector<std::uint8_t>;

// A folder of its own for each test, removed at its end.
class TemporaryFolder {
 public:
  TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path file(const std::string& name, Bytes bytes) const;
  std::filesystem::path file(const std::string& name, std::string_view text) const;

 private:
  std::filesystem::path path_;
};

Bytes bytes_of(std::string_view text);

// Numbers and blocks in one byte order.
class Maker {
 public:
  explicit Maker(ByteOrder order = ByteOrder::kLittle) : order_(order) {}

  Maker& u8(std::uint64_t value) { return put(value, 1); }
  Maker& u16(std::uint64_t value) { return put(value, 2); }
  Maker& u32(std::uint64_t value) { return put(value, 4); }
  Maker& u64(std::uint64_t value) { return put(value, 8); }
  Maker& raw(Bytes bytes);
  Maker& padded(Bytes bytes);  // to a multiple of 4
  Maker& option(std::uint16_t code, Bytes value);

  // pcap.
  Maker& pcap_header(std::uint32_t magic, std::uint32_t link_type);
  Maker& pcap_record(std::uint32_t second, std::uint32_t fraction, Bytes bytes, std::uint32_t original);
  // pcapng. `options` are bytes in this byte order.
  Maker& block(std::uint32_t type, Bytes body);
  Maker& section();
  Maker& interface(std::uint16_t link_type, std::uint32_t snap_length = 0, Bytes options = {});
  Maker& enhanced(std::uint32_t interface, std::uint64_t ticks, Bytes bytes, std::uint32_t original,
                  Bytes options = {});
  Maker& simple(Bytes bytes, std::uint32_t original);
  Maker& obsolete(std::uint16_t interface, std::uint16_t drops, std::uint64_t ticks, Bytes bytes,
                  std::uint32_t original);

  const Buffer& bytes() const { return bytes_; }
  Maker fresh() const { return Maker(order_); }

 private:
  Maker& put(std::uint64_t value, unsigned byte_count);
  ByteOrder order_;
  Buffer bytes_;
};

// A frame with bytes of its own.
struct ReadFrame {
  RawFrame raw;
  Buffer bytes;
  std::uint64_t byte_offset = 0;
};

struct ReadCapture {
  std::vector<ReadFrame> frames;
  std::vector<replay::InterfaceInfo> interfaces;
  std::vector<replay::Dropped> dropped;
  std::optional<replay::Truncation> truncation;
  std::string error;  // of opening or reading; empty: none
  std::string format;
};

ReadCapture read_all(replay::Source& source);
ReadCapture read_file(const std::filesystem::path& path);
// Through a pipe that hands over `piece` bytes at a time.
ReadCapture read_stream(Bytes bytes, std::size_t piece = 7);
// Reads the bytes as a mapped file and as a stream, expects the same of both, and returns it.
ReadCapture read_both(Bytes bytes);

}  // namespace servotrace::test
