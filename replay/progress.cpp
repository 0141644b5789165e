// SPDX-License-Identifier: MIT
#include "replay/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace servotrace::replay {
namespace {

constexpr std::chrono::milliseconds kBetween{100};
constexpr std::size_t kWidth = 30;  // letters of the bar

std::string bytes_text(double bytes) {
  if (bytes < 1e6) return fmt::format("{:.0f} kB", bytes / 1e3);
  if (bytes < 1e9) return fmt::format("{:.1f} MB", bytes / 1e6);
  return fmt::format("{:.2f} GB", bytes / 1e9);
}

}  // namespace

Progress::Progress(When when, std::uint64_t total_bytes)
    : on_(when == When::kAlways || (when == When::kAuto && is_terminal(2))),
      total_(total_bytes),
      start_(std::chrono::steady_clock::now()),
      last_(start_) {}

Progress::~Progress() { clear(); }

void Progress::add(std::uint64_t bytes) {
  if (!on_) return;
  const std::lock_guard lock(mutex_);
  done_ += bytes;
  const auto now = std::chrono::steady_clock::now();
  if (now - last_ < kBetween) return;
  last_ = now;
  draw();
}

void Progress::clear() {
  if (!on_) return;
  const std::lock_guard lock(mutex_);
  if (drawn_) fmt::print(stderr, "\r\x1B[K");
  drawn_ = false;
}

void Progress::draw() {
  const double passed = std::chrono::duration<double>(last_ - start_).count();
  const double rate = passed > 0 ? static_cast<double>(done_) / passed : 0;
  if (total_ == 0) {
    fmt::print(stderr, "\r{}  {}/s\x1B[K", bytes_text(static_cast<double>(done_)), bytes_text(rate));
  } else {
    const double part = std::min(1.0, static_cast<double>(done_) / static_cast<double>(total_));
    const auto filled = static_cast<std::size_t>(part * kWidth);
    const auto left = rate > 0 ? static_cast<std::uint64_t>(static_cast<double>(total_) * (1 - part) / rate) : 0;
    fmt::print(stderr, "\r[{:=<{}}{:{}}] {:3.0f} %  {}/s  {}:{:02} left\x1B[K", "", filled, "", kWidth - filled,
               part * 100, bytes_text(rate), left / 60, left % 60);
  }
  std::fflush(stderr);
  drawn_ = true;
}

}  // namespace servotrace::replay
