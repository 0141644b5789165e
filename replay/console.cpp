// SPDX-License-Identifier: MIT
#include "replay/console.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace servotrace::replay {
namespace {

constexpr std::size_t kBufferSize = std::size_t{64} * 1024;

}  // namespace

void complain(std::string_view message) {
  std::string line(message);
  // One line, whatever a file name or a library's message holds.
  for (char& c : line) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  fmt::print(stderr, "servotrace: {}\n", line);
}

void complain(const Error& error) { complain(error.text()); }

Error not_written(Error error, std::string_view path) {
  error.what += fmt::format("; {} is not written", path);
  return error;
}

StandardOut::~StandardOut() { StandardOut::flush(); }

void StandardOut::write(std::string_view text) {
  if (closed_ || error_ != 0) return;
  buffer_ += text;
  if (buffer_.size() >= kBufferSize) flush();
}

void StandardOut::flush() {
  std::string_view rest = buffer_;
  while (!rest.empty() && !closed_ && error_ == 0) {
    const ssize_t written = ::write(STDOUT_FILENO, rest.data(), rest.size());
    if (written >= 0) {
      rest.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno == EPIPE) {
      closed_ = true;
    } else if (errno != EINTR) {
      error_ = errno;
    }
  }
  buffer_.clear();
}

Result<void> StandardOut::finish() {
  flush();
  if (error_ != 0) return Error{"standard output", std::strerror(error_)};
  return {};
}

std::optional<When> when_of(std::string_view word) {
  if (word == "auto") return When::kAuto;
  if (word == "always") return When::kAlways;
  if (word == "never") return When::kNever;
  return {};
}

bool is_terminal(int descriptor) { return ::isatty(descriptor) == 1; }

bool use_colour(When when, int descriptor) {
  if (when != When::kAuto) return when == When::kAlways;
  const char* const no_colour = std::getenv("NO_COLOR");
  if (no_colour != nullptr && *no_colour != '\0') return false;
  const char* const terminal = std::getenv("TERM");
  if (terminal != nullptr && std::strcmp(terminal, "dumb") == 0) return false;
  return is_terminal(descriptor);
}

}  // namespace servotrace::replay
