// SPDX-License-Identifier: MIT
// A progress bar on standard error: how far, how fast, how long still. Nothing where it is off.
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

#include "replay/console.hpp"

namespace servotrace::replay {

class Progress {
 public:
  // `total_bytes` 0: not known (a stream), then only the rate is shown.
  Progress(When when, std::uint64_t total_bytes);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // More bytes were read. From any thread.
  void add(std::uint64_t bytes);
  // Takes the bar away, so that a line can be written; it comes back with the next add().
  void clear();

 private:
  void draw();

  bool on_;
  std::uint64_t total_;
  std::mutex mutex_;
  std::uint64_t done_ = 0;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace servotrace::replay
