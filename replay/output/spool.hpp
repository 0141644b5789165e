// SPDX-License-Identifier: MIT
// Text that has to wait for what stands in front of it: in memory while it is short, then in a temporary file.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

#include "replay/console.hpp"

namespace servotrace::replay {

class Spool {
 public:
  // most_in_memory: bytes.
  explicit Spool(std::size_t most_in_memory = std::size_t{4} << 20U) : most_in_memory_(most_in_memory) {}

  void write(std::string_view text);
  // Throws std::system_error where the temporary file cannot be read.
  void copy_to(Out& out) const;

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  void unload();

  std::size_t most_in_memory_;
  std::string memory_;                      // behind what lies in the file
  std::unique_ptr<std::FILE, Close> file_;  // has no name, and is gone with the program
  std::uint64_t in_file_ = 0;               // bytes
  bool is_full_ = false;                    // the disk takes no more: memory has to
};

}  // namespace servotrace::replay
