// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace servotrace::test {

inline std::filesystem::path source_dir() { return SERVOTRACE_SOURCE_DIR; }
inline std::filesystem::path binary_dir() { return SERVOTRACE_BINARY_DIR; }

}  // namespace servotrace::test
