// SPDX-License-Identifier: MIT
// Bytes of a capture, forward only: a memory-mapped file, a descriptor that cannot seek, or a decompressed stream.
#pragma once

#include <cassert>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "decoder/core/bytes.hpp"
#include "decoder/core/result.hpp"

namespace servotrace::replay {

class Input {
 public:
  Input() = default;
  Input(const Input&) = delete;
  Input& operator=(const Input&) = delete;
  virtual ~Input() = default;

  // The next `count` bytes, or fewer where the input ends before (failure() tells whether it ended or broke). Valid
  // until the next peek(). A stream waits for `count` bytes and no more.
  Bytes peek(std::size_t count) {
    if (static_cast<std::size_t>(end_ - cursor_) < count) [[unlikely]]
      refill(count);
    const auto there = static_cast<std::size_t>(end_ - cursor_);
    return {cursor_, there < count ? there : count};
  }
  // All bytes at hand without reading on; empty where peek() must be asked.
  Bytes at_hand() const { return {cursor_, static_cast<std::size_t>(end_ - cursor_)}; }
  // Precondition: the last peek() returned at least `count` bytes.
  void skip(std::size_t count) {
    assert(count <= static_cast<std::size_t>(end_ - cursor_));
    cursor_ += count;
  }
  // Bytes skipped so far.
  std::uint64_t position() const { return base_ + static_cast<std::uint64_t>(cursor_ - begin_); }
  // Of the whole input; 0 where it is unknown.
  std::uint64_t size() const { return size_; }
  // Set once reading broke: the bytes before it hold.
  const std::optional<std::string>& failure() const { return failure_; }
  // A memory-mapped file was cut or could not be read while it was in use: what was peeked at last may be zeros. Touch
  // the bytes, then ask.
  bool lost() const { return *lost_ != 0; }
  // Of what lies on disk, for progress: differs from position() and size() where the input is compressed.
  virtual std::uint64_t consumed() const { return position(); }
  virtual std::uint64_t total() const { return size_; }

 protected:
  // Makes `count` bytes available from cursor_, or as many as there are.
  virtual void refill(std::size_t count) = 0;

  const std::uint8_t* begin_ = nullptr;
  const std::uint8_t* cursor_ = nullptr;
  const std::uint8_t* end_ = nullptr;
  std::uint64_t base_ = 0;  // position of begin_
  std::uint64_t size_ = 0;
  std::optional<std::string> failure_;
  static constexpr std::sig_atomic_t kNothingLost = 0;
  const volatile std::sig_atomic_t* lost_ = &kNothingLost;
};

// What to say where lost() is true.
inline constexpr const char* kLost = "cannot be read on: the file was cut while it was read, or its disk fails";

// An input that is read piece by piece into a buffer.
class BufferedInput : public Input {
 protected:
  // Reads some bytes, at least one, into `into`. 0: the end, the run was interrupted, or failure_ is set.
  virtual std::size_t fill(MutableBytes into) = 0;

 private:
  void refill(std::size_t count) final;
  std::vector<std::uint8_t> buffer_;
  bool ended_ = false;
};

// Maps a regular file; any other is read through its descriptor. Errors carry `path` as their place.
Result<std::unique_ptr<Input>> open_input(const std::filesystem::path& path);
// Bytes in memory, which must outlive it.
std::unique_ptr<Input> memory_input(Bytes bytes);
// Reads a descriptor, which is not closed.
std::unique_ptr<Input> descriptor_input(int descriptor);

}  // namespace servotrace::replay
