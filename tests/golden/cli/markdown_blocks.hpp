// SPDX-License-Identifier: MIT
// Fenced blocks of a Markdown page.
#pragma once

#include <fstream>
#include <string>
#include <vector>

namespace servotrace::test {

struct Block {
  std::string heading;   // the text behind ## it stands under
  std::string language;  // "sh", "yaml"
  std::string text;
};

inline std::vector<Block> blocks_of(const std::string& path) {
  std::vector<Block> blocks;
  std::ifstream file(path);
  std::string heading;
  bool inside = false;
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("```", 0) == 0) {
      if (!inside) blocks.push_back({heading, line.substr(3), ""});
      inside = !inside;
    } else if (inside) {
      blocks.back().text += line + "\n";
    } else if (line.rfind("## ", 0) == 0) {
      heading = line.substr(3);
    }
  }
  return blocks;
}

}  // namespace servotrace::test
