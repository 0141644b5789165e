// SPDX-License-Identifier: MIT
// What the fuzz targets and the robustness tests do with bytes: any are legal, and what comes out must make sense.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "decoder/core/bytes.hpp"
#include "decoder/findings/finding.hpp"
#include "decoder/pipeline/pipeline.hpp"
#include "replay/capture/source.hpp"

namespace servotrace::test {

// Empty, or what makes no sense: a finding of a frame that was never pushed, an episode that ends before it begins, a
// text that cannot be made.
std::string nonsense(std::span<const Finding> findings, std::uint64_t last_frame);

struct Outcome {
  std::vector<Finding> findings;
  std::uint64_t frames = 0;
  std::uint64_t last_frame = 0;  // its number
  bool truncated = false;
  bool broken = false;   // opening or reading failed
  std::string nonsense;  // see above; also of what the source and the dissection say
};

// Bytes of a capture file through the readers and a pipeline, as the command line does it.
Outcome check_bytes(Bytes bytes, const Settings& settings = {}, bool dissect = true);

// Bytes that describe settings and frames straight for the pipeline: denser than a file format. See the function.
Outcome check_frames(Bytes bytes);

}  // namespace servotrace::test
