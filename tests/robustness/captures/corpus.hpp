// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "decoder/pipeline/settings.hpp"
#include "tests/support/paths.hpp"

namespace servotrace::test {

struct Shipped {
  std::string name;
  std::vector<std::uint8_t> bytes;
};

// captures/*.pcapng, by name.
inline std::vector<Shipped> shipped_captures() {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(source_dir() / "captures")) {
    if (entry.path().extension() == ".pcapng") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  std::vector<Shipped> all;
  for (const std::filesystem::path& path : paths) {
    std::ifstream in(path, std::ios::binary);
    all.push_back({path.stem().string(),
                   std::vector<std::uint8_t>(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>())});
  }
  return all;
}

// As a user would check them.
inline Settings assuming_devicenet() {
  Settings settings;
  settings.devicenet.assumed = true;
  return settings;
}

}  // namespace servotrace::test
