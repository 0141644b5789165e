// SPDX-License-Identifier: MIT
// Any text as a baseline: read, or refused with a reason; what is read can be asked and written again.
#include <cstdlib>

#include "replay/baseline.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace servotrace::replay;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  auto baseline = Baseline::parse(text, "fuzz.json");
  if (!baseline) {
    if (baseline.error().what.empty()) std::abort();
    return 0;
  }
  const auto again = Baseline::parse(baseline->text(), "again.json");
  if (!again) std::abort();
  for (const std::string& line : baseline->leftovers()) {
    if (line.empty()) std::abort();
  }
  return 0;
}
