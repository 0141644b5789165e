// SPDX-License-Identifier: MIT
// The captures in a folder.
#pragma once

#include <filesystem>
#include <vector>

#include "decoder/core/result.hpp"

namespace servotrace::replay {

struct FolderContents {
  std::vector<std::filesystem::path> captures;  // of a kind that is read, by their first bytes; sorted
  std::vector<Error> refused;                   // captures of other kinds, and files that cannot be opened
};

// Looks through `folder` and the folders in it. Hidden files and what is no capture at all are passed over. An error
// where the folder cannot be read.
Result<FolderContents> captures_in(const std::filesystem::path& folder);

}  // namespace servotrace::replay
