// SPDX-License-Identifier: MIT
#include "replay/capture/input.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "replay/capture/interrupt.hpp"
#include "replay/capture/limits.hpp"
#include "replay/capture/mapped_file.hpp"

namespace servotrace::replay {
namespace {

std::string reason(int error) { return std::generic_category().message(error); }

// Shows the file window by window, so that a long one takes no more memory than a short one.
class MappedInput final : public Input {
 public:
  explicit MappedInput(std::unique_ptr<MappedFile> file) : file_(std::move(file)) {
    const Bytes bytes = file_->bytes();
    begin_ = cursor_ = end_ = bytes.data();
    size_ = bytes.size();
    lost_ = file_->lost();
  }

 private:
  static constexpr std::size_t kWindow = std::size_t{4} << 20U;  // bytes

  void refill(std::size_t count) override {
    const auto passed = static_cast<std::size_t>(cursor_ - begin_);
    const auto shown = static_cast<std::size_t>(end_ - begin_);
    const auto size = static_cast<std::size_t>(size_);
    const std::size_t wanted = std::min(size, std::max(shown + kWindow, passed + std::min(count, size - passed)));
    if (wanted == shown) return;
    file_->advance(passed, shown, wanted);
    end_ = begin_ + wanted;
  }

  std::unique_ptr<MappedFile> file_;
};

class MemoryInput final : public Input {
 public:
  explicit MemoryInput(Bytes bytes) {
    begin_ = cursor_ = bytes.data();
    end_ = begin_ + bytes.size();
    size_ = bytes.size();
  }

 private:
  void refill(std::size_t) override {}
};

class DescriptorInput final : public BufferedInput {
 public:
  DescriptorInput(int descriptor, bool owned) : descriptor_(descriptor), owned_(owned) {}
  ~DescriptorInput() override {
    if (owned_) ::close(descriptor_);
  }

 private:
  std::size_t fill(MutableBytes into) override {
    while (wait_for_bytes()) {
      const ssize_t got = ::read(descriptor_, into.data(), into.size());
      if (got >= 0) return static_cast<std::size_t>(got);
      if (errno == EINTR) continue;
      failure_ = "cannot be read on: " + reason(errno);
      return 0;
    }
    return 0;
  }

  // False once the run was interrupted. The signal may come to any thread and just before the wait, so the flag is
  // looked at again and again.
  bool wait_for_bytes() const {
    if (descriptor_ < 0) return true;  // poll() would pass it over; read() tells
    constexpr int kLookEveryMs = 100;
    ::pollfd waiting{.fd = descriptor_, .events = POLLIN, .revents = 0};
    while (!interrupted()) {
      const int ready = ::poll(&waiting, 1, kLookEveryMs);
      if (ready > 0 || (ready < 0 && errno != EINTR)) return true;  // bytes, the end, or what read() will tell
    }
    return false;
  }

  int descriptor_;
  bool owned_;
};

}  // namespace

void BufferedInput::refill(std::size_t count) {
  auto there = static_cast<std::size_t>(end_ - cursor_);
  if (ended_) return;
  const std::size_t wanted = std::max(count, kChunk);
  base_ += static_cast<std::uint64_t>(cursor_ - begin_);
  if (buffer_.size() < wanted) {
    std::vector<std::uint8_t> larger(wanted);
    if (there > 0) std::memcpy(larger.data(), cursor_, there);
    buffer_ = std::move(larger);
  } else if (there > 0) {
    std::memmove(buffer_.data(), cursor_, there);
  }
  while (there < count && !ended_) {
    const std::size_t got = fill(MutableBytes(buffer_).subspan(there));
    ended_ = got == 0;
    there += got;
  }
  begin_ = cursor_ = buffer_.data();
  end_ = begin_ + there;
}

Result<std::unique_ptr<Input>> open_input(const std::filesystem::path& path) {
  const std::string name = path.string();
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return Error{name, "cannot be opened: " + reason(errno)};
  auto closing = std::make_unique<DescriptorInput>(descriptor, true);
  struct ::stat status {};
  if (::fstat(descriptor, &status) != 0) return Error{name, "cannot be opened: " + reason(errno)};
  if (S_ISDIR(status.st_mode)) return Error{name, "is a directory, not a capture"};
  if (S_ISREG(status.st_mode) && status.st_size > 0) {
    const auto length = static_cast<std::size_t>(status.st_size);
    if (auto mapped = MappedFile::map(descriptor, length))
      return std::unique_ptr<Input>(std::make_unique<MappedInput>(std::move(mapped)));
  }
  return std::unique_ptr<Input>(std::move(closing));
}

std::unique_ptr<Input> memory_input(Bytes bytes) { return std::make_unique<MemoryInput>(bytes); }

std::unique_ptr<Input> descriptor_input(int descriptor) { return std::make_unique<DescriptorInput>(descriptor, false); }

}  // namespace servotrace::replay
