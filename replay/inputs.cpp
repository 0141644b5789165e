// SPDX-License-Identifier: MIT
#include "replay/inputs.hpp"

#include <unistd.h>

#include <algorithm>
#include <iterator>
#include <string_view>

#include "replay/capture/join.hpp"

namespace servotrace::replay {
namespace {

// Endings of files that are captures, and of files that may be: those are looked into.
constexpr std::string_view kCaptureEndings[] = {".pcapng", ".pcap", ".cap", ".ntar"};
constexpr std::string_view kMaybeEndings[] = {".log", ".asc", ".trc", ".csv", ".candump"};
constexpr std::string_view kCompressedEndings[] = {".gz", ".zst"};

bool ends_with_any(std::string_view name, std::span<const std::string_view> endings) {
  return std::any_of(endings.begin(), endings.end(),
                     [name](std::string_view ending) { return name.size() > ending.size() && name.ends_with(ending); });
}

bool is_capture(const std::filesystem::path& path) {
  std::string name = path.filename().string();
  std::transform(name.begin(), name.end(), name.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  for (const std::string_view ending : kCompressedEndings) {
    if (name.ends_with(ending)) name.resize(name.size() - ending.size());
  }
  if (ends_with_any(name, kCaptureEndings)) return true;
  return ends_with_any(name, kMaybeEndings) && open_capture(path);
}

Result<void> add_folder(const std::filesystem::path& folder, std::vector<CaptureInput>& inputs) {
  std::error_code code;
  std::vector<std::filesystem::path> found;
  std::filesystem::recursive_directory_iterator walk(folder, code);
  for (; !code && walk != std::filesystem::recursive_directory_iterator(); walk.increment(code)) {
    std::error_code ignored;
    if (walk->is_regular_file(ignored) && is_capture(walk->path())) found.push_back(walk->path());
  }
  if (code) return Error{folder.string(), code.message()};
  if (found.empty()) return Error{folder.string(), "this folder holds no captures"};
  std::sort(found.begin(), found.end(),
            [](const auto& left, const auto& right) { return left.native() < right.native(); });
  std::transform(found.begin(), found.end(), std::back_inserter(inputs), [](const auto& path) {
    return CaptureInput{path, path.string()};
  });
  return {};
}

}  // namespace

Result<std::vector<CaptureInput>> expand_inputs(const std::vector<std::string>& arguments) {
  std::vector<CaptureInput> inputs;
  bool has_stream = false;
  for (const std::string& argument : arguments) {
    if (argument == "-") {
      if (has_stream) return Error{"-", "standard input can be read once only"};
      has_stream = true;
      inputs.push_back({{}, "-"});
      continue;
    }
    if (argument.empty()) return Error{"", "an empty file name"};
    std::error_code code;
    const std::filesystem::file_status status = std::filesystem::status(argument, code);
    if (!std::filesystem::exists(status)) return Error{argument, "no such file or folder"};
    if (std::filesystem::is_directory(status)) {
      if (Result<void> added = add_folder(argument, inputs); !added) return added.error();
    } else {
      inputs.push_back({argument, argument});
    }
  }
  return inputs;
}

Result<CaptureInput> join_inputs(const std::vector<CaptureInput>& inputs) {
  CaptureInput joined = inputs.front();
  for (const CaptureInput& input : inputs) {
    if (input.is_stream()) return Error{"--join", "a stream cannot be joined with other captures"};
    joined.parts.push_back(input.path);
  }
  if (inputs.size() > 1) joined.name += "+" + std::to_string(inputs.size() - 1);
  return joined;
}

Result<CaptureInput> single_input(const std::string& argument) {
  Result<std::vector<CaptureInput>> inputs = expand_inputs({argument});
  if (!inputs) return inputs.error();
  if (inputs->size() != 1) return Error{argument, "this folder holds several captures: name one of them"};
  return inputs->front();
}

Result<std::unique_ptr<Source>> open_input(const CaptureInput& input) {
  if (!input.parts.empty()) return join_captures(input.parts);
  return input.is_stream() ? open_stream(STDIN_FILENO, input.name) : open_capture(input.path);
}

CaptureResult run_input(const CaptureInput& input, const Settings& settings, const RunOptions& options) {
  Result<std::unique_ptr<Source>> source = open_input(input);
  if (source) return run(**source, input.name, settings, options);
  CaptureResult result;
  result.name = input.name;
  result.error = source.error();
  return result;
}

}  // namespace servotrace::replay
