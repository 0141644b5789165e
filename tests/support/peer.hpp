// SPDX-License-Identifier: MIT
// Captures of an independent DeviceNet slave, which have no licence for this repository: named by the environment
// variable SERVOTRACE_PEER_CAPTURES (the folder that holds devicenet-peer and formats), and tests skipped without it.
#pragma once

#include <cstdlib>
#include <filesystem>

namespace servotrace::test {

inline constexpr const char* kNoPeerCaptures =
    "SERVOTRACE_PEER_CAPTURES does not name the folder of the peer captures (devicenet-peer, formats)";

// Empty where there are none.
inline std::filesystem::path peer_captures() {
  const char* const named = std::getenv("SERVOTRACE_PEER_CAPTURES");
  if (named == nullptr || !std::filesystem::exists(std::filesystem::path(named) / "devicenet-peer")) return {};
  return named;
}

}  // namespace servotrace::test
