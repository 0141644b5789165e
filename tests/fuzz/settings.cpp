// SPDX-License-Identifier: MIT
// Any text as servotrace.toml: read, or refused with a place and a reason.
#include <cstdlib>

#include "replay/settings/settings.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto settings = servotrace::replay::parse_settings(text, "fuzz.toml");
  if (!settings && (settings.error().what.empty() || settings.error().where.empty())) std::abort();
  return 0;
}
