// SPDX-License-Identifier: MIT
#include "replay/capture/folder.hpp"

#include <algorithm>
#include <system_error>

#include "replay/capture/compressed.hpp"
#include "replay/capture/recognise.hpp"

namespace servotrace::replay {
namespace {

void look_at(const std::filesystem::path& path, FolderContents& contents) {
  Result<std::unique_ptr<Input>> opened = open_input(path);
  if (!opened) {
    contents.refused.push_back(opened.error());
    return;
  }
  std::unique_ptr<Input> input = std::move(opened.value());
  for (int layers = 0;; ++layers) {
    bool foreign = false;
    const Result<Kind> kind = recognise(*input, path.string(), &foreign);
    if (!kind) {
      if (foreign || input->failure()) contents.refused.push_back(kind.error());
      return;
    }
    const bool gzip = kind.value() == Kind::kGzip;
    if ((!gzip && kind.value() != Kind::kZstd) || layers == kMaxLayers) break;
    input = gzip ? gzip_input(std::move(input)) : zstd_input(std::move(input));
  }
  contents.captures.push_back(path);
}

}  // namespace

Result<FolderContents> captures_in(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  FolderContents contents;
  std::vector<fs::path> files;
  std::error_code error;
  fs::recursive_directory_iterator entry(folder, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    const bool hidden = entry->path().filename().string().front() == '.';
    std::error_code ignored;
    if (entry->is_directory(ignored)) {
      if (hidden) entry.disable_recursion_pending();
    } else if (!hidden && entry->is_regular_file(ignored)) {
      files.push_back(entry->path());
    }
  }
  if (error) return Error{folder.string(), "cannot be looked through: " + error.message()};
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) look_at(file, contents);
  return contents;
}

}  // namespace servotrace::replay
