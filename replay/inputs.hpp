// SPDX-License-Identifier: MIT
// What the CAPTURE arguments mean: files, folders, standard input.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "decoder/core/result.hpp"
#include "replay/capture/source.hpp"
#include "replay/run.hpp"

namespace servotrace::replay {

struct CaptureInput {
  std::filesystem::path path;                     // empty: standard input
  std::string name;                               // for people and results
  std::vector<std::filesystem::path> parts = {};  // files of one recording; `path` is the first of them

  bool is_stream() const { return path.empty(); }
};

// Every capture the arguments name, in the order given; those of a folder (and the folders in it) sorted by path. A
// missing file, a folder without captures, or standard input named twice is an error.
Result<std::vector<CaptureInput>> expand_inputs(const std::vector<std::string>& arguments);

// All of them as one recording, merged by time (--join). A stream cannot be part of one.
Result<CaptureInput> join_inputs(const std::vector<CaptureInput>& inputs);

// The one capture an argument names; a folder of several is an error.
Result<CaptureInput> single_input(const std::string& argument);

Result<std::unique_ptr<Source>> open_input(const CaptureInput& input);

// run() over an input; what cannot be opened is in the result's error.
CaptureResult run_input(const CaptureInput& input, const Settings& settings, const RunOptions& options = {});

}  // namespace servotrace::replay
