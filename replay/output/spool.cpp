// SPDX-License-Identifier: MIT
#include "replay/output/spool.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

namespace servotrace::replay {

void Spool::write(std::string_view text) {
  memory_ += text;
  if (memory_.size() > most_in_memory_ && !is_full_) unload();
}

void Spool::unload() {
  if (!file_) file_.reset(std::tmpfile());
  std::size_t done = 0;
  while (file_ && done < memory_.size()) {
    const ssize_t count = ::pwrite(::fileno(file_.get()), memory_.data() + done, memory_.size() - done,
                                   static_cast<::off_t>(in_file_ + done));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    done += static_cast<std::size_t>(count);
  }
  is_full_ = done < memory_.size();
  in_file_ += done;
  memory_.erase(0, done);
}

void Spool::copy_to(Out& out) const {
  std::string part(std::size_t{256} * 1024, '\0');
  for (std::uint64_t at = 0; at < in_file_;) {
    const std::size_t wanted = std::min<std::uint64_t>(part.size(), in_file_ - at);
    const ssize_t count = ::pread(::fileno(file_.get()), part.data(), wanted, static_cast<::off_t>(at));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw std::system_error(errno, std::generic_category(), "a temporary file cannot be read");
    out.write(std::string_view(part).substr(0, static_cast<std::size_t>(count)));
    at += static_cast<std::uint64_t>(count);
  }
  out.write(memory_);
}

}  // namespace servotrace::replay
