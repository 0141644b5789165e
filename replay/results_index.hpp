// SPDX-License-Identifier: MIT
// The captures of many result files, in the order of a merge: the files are read once to see what is in them, then
// capture by capture, so that memory does not grow with what they hold.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "decoder/core/result.hpp"
#include "replay/results.hpp"

namespace servotrace::replay {

class ResultsIndex {
 public:
  ResultsIndex();
  ~ResultsIndex();
  ResultsIndex(const ResultsIndex&) = delete;
  ResultsIndex& operator=(const ResultsIndex&) = delete;

  // Looks through the whole file. What is no regular file (a pipe) is kept in memory.
  Result<void> add(const std::string& path);
  // By name, then time, then content: independent of the order of the files.
  void sort();
  std::size_t size() const { return entries_.size(); }
  Result<CaptureRecord> read(std::size_t index);
  // Worst of what the files end with.
  int status() const { return status_; }

 private:
  struct Entry {
    std::string name;
    std::optional<TimeNs> first_time_ns;
    std::uint64_t hash = 0;  // of its lines
    std::size_t file = 0;
    std::uint64_t offset = 0;  // bytes
    std::uint64_t length = 0;  // bytes
    std::uint64_t line = 0;    // lines before it
  };
  struct File {
    std::string path;
    std::string text;  // of what cannot be read twice
    bool is_kept = false;
  };
  std::unique_ptr<std::istream> open(const File& file) const;

  std::vector<Entry> entries_;
  std::vector<File> files_;
  std::size_t open_file_ = 0;
  std::unique_ptr<std::istream> open_stream_;  // of open_file_: captures of one file often follow one another
  int status_ = 0;
};

}  // namespace servotrace::replay
