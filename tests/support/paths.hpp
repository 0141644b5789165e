// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace servotrace::test {

std::filesystem::path source_dir();
std::filesystem::path binary_dir();

}  // namespace servotrace::test
