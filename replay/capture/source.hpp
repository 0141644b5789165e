// SPDX-License-Identifier: MIT
// A capture being read: frames in file order, whatever the file format.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "decoder/core/result.hpp"
#include "decoder/link/raw_frame.hpp"

namespace servotrace::replay {

struct InterfaceInfo {
  LinkType link_type = LinkType::kEthernet;
  std::string name;                      // if_name, the channel of a log; may be empty
  std::uint32_t time_resolution_ns = 1;  // at least 1
};

// The file ends inside a record: `captured` of `expected` bytes are there.
struct Truncation {
  std::uint64_t captured = 0;
  std::uint64_t expected = 0;
};

struct Dropped {
  std::uint32_t interface_id = 0;
  std::uint64_t count = 0;        // since the last report of this interface
  std::uint64_t after_frame = 0;  // known once this frame was read; 0: before the first
};

class Source {
 public:
  Source() = default;
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;
  virtual ~Source() = default;

  enum class Step : std::uint8_t { kFrame, kEnd, kError };
  // The next record. kFrame: `frame` is filled and its bytes live until the next call. kEnd: no whole record is left,
  // see truncation(). kError: the file is broken from here on, see error(); what was read before holds.
  virtual Step next(RawFrame& frame) = 0;

  const Error& error() const { return error_; }
  // After kEnd.
  const std::optional<Truncation>& truncation() const { return truncation_; }
  // All interfaces seen so far; RawFrame::interface_id is an index into them.
  std::span<const InterfaceInfo> interfaces() const { return interfaces_; }
  // Drop reports seen so far, in order; the caller remembers how many it took.
  std::span<const Dropped> dropped() const { return dropped_; }
  // Forgets the reports the caller has taken, so that a capture full of them needs no memory. At most 65,536 are kept.
  void clear_dropped() { dropped_.clear(); }
  // Name of the format for people and results: "pcapng", "pcap", "candump log", "pcapng (gzip)".
  const std::string& format() const { return format_; }
  // Where the last frame's bytes lie in the (uncompressed) file; 0, 0 for text formats.
  std::uint64_t byte_offset() const { return byte_offset_; }
  // Bytes consumed and the size of the file (0: unknown, a stream), for progress.
  virtual std::uint64_t consumed() const { return 0; }
  virtual std::uint64_t total() const { return 0; }

 protected:
  Error error_;
  std::optional<Truncation> truncation_;
  std::vector<InterfaceInfo> interfaces_;
  std::vector<Dropped> dropped_;
  std::string format_;
  std::uint64_t byte_offset_ = 0;
};

// Opens a file by its content (memory-mapped where it can be). An unknown kind is refused by name, with the converter
// that would help.
Result<std::unique_ptr<Source>> open_capture(const std::filesystem::path& path);
// Reads from a descriptor that cannot seek (standard input). `name` stands in messages. Does not close it.
Result<std::unique_ptr<Source>> open_stream(int descriptor, std::string name);
// A capture in memory, which must outlive the source.
Result<std::unique_ptr<Source>> open_bytes(Bytes bytes, std::string name);

}  // namespace servotrace::replay
