// SPDX-License-Identifier: MIT
// A column map and, behind a line of its own, "---", the log it describes: the map read, or refused with a reason; the
// log's records make sense to the reader and the pipeline.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <string_view>

#include "replay/capture/rtex_log.hpp"
#include "tests/support/harness.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace servotrace;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  constexpr std::string_view kBorder = "\n---\n";
  const std::size_t border = text.find(kBorder);
  const auto map = replay::parse_log_map(text.substr(0, border), "fuzz.toml");
  if (!map) {
    if (map.error().what.empty()) std::abort();
    return 0;
  }
  if (border == std::string_view::npos) return 0;
  const std::string_view log = text.substr(border + kBorder.size());
  const int file = memfd_create("log", MFD_CLOEXEC);
  if (file < 0) return 0;
  if (::write(file, log.data(), log.size()) != static_cast<ssize_t>(log.size()) || ::lseek(file, 0, SEEK_SET) != 0)
    std::abort();
  auto opened = replay::open_rtex_log_stream(file, "fuzz.log", *map);
  if (opened) {
    Pipeline pipeline{Settings{}};
    RawFrame frame;
    std::uint64_t last = 0;
    while ((*opened)->next(frame) == replay::Source::Step::kFrame) {
      if (frame.number <= last) std::abort();
      last = frame.number;
      pipeline.push(frame);
    }
    pipeline.finish();
    if (!test::nonsense(pipeline.findings().all(), last).empty()) std::abort();
  } else if (opened.error().what.empty()) {
    std::abort();
  }
  ::close(file);
  return 0;
}
