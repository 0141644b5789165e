// SPDX-License-Identifier: MIT
// Writes pcapng: one section, any interfaces, nanosecond time. The file appears under its name only when finish()
// succeeds.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "decoder/core/result.hpp"
#include "decoder/link/raw_frame.hpp"

namespace servotrace::replay {

class PcapngWriter {
 public:
  // Writes to a temporary file beside `path`.
  static Result<std::unique_ptr<PcapngWriter>> create(const std::filesystem::path& path);
  PcapngWriter(const PcapngWriter&) = delete;
  PcapngWriter& operator=(const PcapngWriter&) = delete;
  // Removes the temporary file where finish() was not called.
  ~PcapngWriter();

  // Returns the interface's id, from 0. `resolution_ns`: how fine its times are, written down where it is a power of
  // ten of a second below one; else nanoseconds. Times are rounded down to it.
  std::uint32_t add_interface(LinkType link_type, std::string_view name, std::uint32_t resolution_ns = 1);
  // `comment` (UTF-8) becomes an opt_comment where not empty.
  void write(std::uint32_t interface_id, TimeNs time_ns, Bytes bytes, std::uint32_t original_length,
             std::string_view comment = {});
  // Flushes, closes and renames; any earlier write error (disk full) is reported here.
  Result<void> finish();

 private:
  struct Impl;
  explicit PcapngWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace servotrace::replay
