// SPDX-License-Identifier: MIT
// servotrace.toml: reads it, checks it, finds it. Whatever is wrong with it is one error with file, line and column.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "decoder/core/result.hpp"
#include "decoder/pipeline/settings.hpp"
#include "replay/settings/rtex_log_map.hpp"
#include "replay/settings/rule_filter.hpp"

namespace servotrace::replay {

inline constexpr std::string_view kSettingsName = "servotrace.toml";

struct FileSettings {
  Settings decoder;
  RuleSettings rules;
  std::optional<RtexLogMap> log;  // how a controller's own log is read (`convert`)
  std::string origin;             // the file's path; empty: built-in defaults, no file
};

// `origin` names the text in messages. On failure the error's place is "origin:line:column".
Result<FileSettings> parse_settings(std::string_view text, std::string origin);
Result<FileSettings> read_settings(const std::filesystem::path& path);

// servotrace.toml in `folder` or the nearest folder above it.
std::optional<std::filesystem::path> find_settings_above(const std::filesystem::path& folder);
// Upward from the capture's folder, then from the working directory. An empty path (a stream) has no folder.
std::optional<std::filesystem::path> find_settings(const std::filesystem::path& capture);

}  // namespace servotrace::replay
