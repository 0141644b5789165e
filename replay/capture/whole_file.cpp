// SPDX-License-Identifier: MIT
#include "replay/capture/whole_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

namespace servotrace::replay {
namespace {

constexpr std::size_t kBufferSize = 256 * 1024;
constexpr int kTries = 100;  // names of temporary files

std::string reason(int error) { return std::generic_category().message(error); }

}  // namespace

struct WholeFile::Impl {
  std::filesystem::path path;
  std::filesystem::path temporary;  // empty: written directly
  int descriptor = -1;
  std::vector<std::uint8_t> buffer;
  std::optional<Error> error;

  void fail(std::string_view what, int code) {
    if (!error) error = Error{path.string(), std::string(what) + ": " + reason(code)};
  }

  void put(const std::uint8_t* bytes, std::size_t size) {
    while (size > 0 && !error) {
      const ssize_t done = ::write(descriptor, bytes, size);
      if (done < 0) {
        if (errno != EINTR) fail("cannot be written", errno);
        continue;
      }
      bytes += done;
      size -= static_cast<std::size_t>(done);
    }
  }

  void flush() {
    put(buffer.data(), buffer.size());
    buffer.clear();
  }
};

WholeFile::WholeFile(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

WholeFile::~WholeFile() {
  if (impl_->descriptor >= 0) ::close(impl_->descriptor);
  if (!impl_->temporary.empty()) ::unlink(impl_->temporary.c_str());
}

Result<std::unique_ptr<WholeFile>> WholeFile::create(const std::filesystem::path& path) {
  auto impl = std::make_unique<Impl>();
  impl->path = path;
  impl->buffer.reserve(kBufferSize);
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  if (std::filesystem::is_directory(status)) return Error{path.string(), "cannot be written: it is a directory"};
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    impl->descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (impl->descriptor < 0) return Error{path.string(), "cannot be written: " + reason(errno)};
    return std::unique_ptr<WholeFile>(new WholeFile(std::move(impl)));
  }
  // A link keeps pointing at its file: the file behind it is replaced.
  std::filesystem::path target = path;
  if (std::filesystem::exists(status)) {
    const std::filesystem::path real = std::filesystem::canonical(path, ignored);
    if (!ignored) target = real;
  }
  for (int i = 0; i < kTries; ++i) {
    std::filesystem::path name = target.parent_path();
    name /= "." + target.filename().string() + "." + std::to_string(::getpid()) + "-" + std::to_string(i) + ".tmp";
    impl->descriptor = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (impl->descriptor >= 0) {
      impl->temporary = std::move(name);
      impl->path = std::move(target);
      return std::unique_ptr<WholeFile>(new WholeFile(std::move(impl)));
    }
    if (errno != EEXIST) break;
  }
  return Error{path.string(), "cannot be written: " + reason(errno)};
}

void WholeFile::write(Bytes bytes) {
  Impl& self = *impl_;
  if (self.error) return;
  if (self.buffer.size() + bytes.size() > kBufferSize) self.flush();
  if (bytes.size() >= kBufferSize) {
    self.put(bytes.data(), bytes.size());
  } else {
    self.buffer.insert(self.buffer.end(), bytes.begin(), bytes.end());
  }
}

void WholeFile::write(std::string_view text) {
  write(Bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

bool WholeFile::failed() const { return impl_->error.has_value(); }

Result<void> WholeFile::finish() {
  Impl& self = *impl_;
  self.flush();
  // Some file systems report a full disk only on closing.
  if (self.descriptor >= 0 && ::close(self.descriptor) != 0) self.fail("cannot be written", errno);
  self.descriptor = -1;
  if (self.error) return *self.error;
  if (self.temporary.empty()) return {};
  if (::rename(self.temporary.c_str(), self.path.c_str()) != 0) {
    self.fail("cannot be written", errno);
    return *self.error;
  }
  self.temporary.clear();
  return {};
}

}  // namespace servotrace::replay
