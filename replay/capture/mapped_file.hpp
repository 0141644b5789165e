// SPDX-License-Identifier: MIT
// A file mapped into memory that survives being cut, or its disk failing, while it is read: the missing pages read as
// zero and lost() tells.
#pragma once

#include <csignal>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "decoder/core/bytes.hpp"

namespace servotrace::replay {

class MappedFile {
 public:
  // Empty where it cannot be mapped: read it instead. Installs a handler of SIGBUS on first use, which passes on what
  // does not concern a mapped file. `length` above 0.
  static std::unique_ptr<MappedFile> map(int descriptor, std::size_t length);
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  ~MappedFile();

  // For a reader that goes forward: asks for the bytes from `from` to `to` at once, and lets go of the memory of those
  // before `passed`. They may still be read: they come from the file again. All are offsets in bytes.
  void advance(std::size_t passed, std::size_t from, std::size_t to);

  Bytes bytes() const { return {static_cast<const std::uint8_t*>(address_), length_}; }
  // Not 0 once a page could not be read. Lives as long as the program.
  const volatile std::sig_atomic_t* lost() const { return lost_; }

 private:
  MappedFile(void* address, std::size_t length, std::size_t slot);
  void* address_;
  std::size_t length_;
  std::size_t slot_;
  std::size_t released_ = 0;  // bytes let go of
  const volatile std::sig_atomic_t* lost_;
};

}  // namespace servotrace::replay
