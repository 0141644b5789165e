// SPDX-License-Identifier: MIT
// Any text as a scenario: read, or refused with a reason.
#include <cstdlib>

#include "captures/simulator/scenario.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto scenario = servotrace::simulator::parse_scenario(text, "fuzz.toml");
  if (!scenario && scenario.error().what.empty()) std::abort();
  return 0;
}
