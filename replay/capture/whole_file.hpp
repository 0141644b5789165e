// SPDX-License-Identifier: MIT
// A file that is written whole or not at all: a temporary file beside it, renamed at the end.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>

#include "decoder/core/bytes.hpp"
#include "decoder/core/result.hpp"

namespace servotrace::replay {

class WholeFile {
 public:
  // A path that exists and is no regular file (a device, a pipe) is written directly.
  static Result<std::unique_ptr<WholeFile>> create(const std::filesystem::path& path);
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;
  // Removes the temporary file where finish() was not called or failed.
  ~WholeFile();

  // Buffered. An error is kept for finish(); what follows it is dropped.
  void write(Bytes bytes);
  void write(std::string_view text);
  bool failed() const;
  // Flushes, closes and renames; reports the first error since create().
  Result<void> finish();

 private:
  struct Impl;
  explicit WholeFile(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace servotrace::replay
