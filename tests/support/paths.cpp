// SPDX-License-Identifier: MIT
// The one file compiled with this checkout's paths, so that every other object is the same in every checkout.
#include "tests/support/paths.hpp"

namespace servotrace::test {

std::filesystem::path source_dir() { return SERVOTRACE_SOURCE_DIR; }
std::filesystem::path binary_dir() { return SERVOTRACE_BINARY_DIR; }

}  // namespace servotrace::test
