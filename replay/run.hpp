// SPDX-License-Identifier: MIT
// One capture through the pipeline, from the first frame to the end of the file: what every subcommand does.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "decoder/pipeline/pipeline.hpp"
#include "replay/bus_names.hpp"
#include "replay/capture/source.hpp"

namespace servotrace::replay {

// Where a frame lies in the (uncompressed) file; length 0 for text formats.
struct FramePlace {
  std::uint64_t frame = 0;
  std::uint64_t offset = 0;  // bytes
  std::uint32_t length = 0;  // bytes
};

struct CaptureResult {
  std::string name;    // as shown to people and in results
  std::string format;  // "pcapng"; empty where the file could not be opened
  std::vector<InterfaceInfo> interfaces;
  std::uint64_t frames = 0;
  std::optional<TimeNs> first_time_ns;  // earliest and latest
  std::optional<TimeNs> last_time_ns;
  std::vector<Finding> findings;  // by frame, rule, node
  std::array<std::uint64_t, kRuleCount> checked = {};
  std::array<std::uint64_t, kRuleCount> total = {};  // findings, those not kept included
  std::vector<FramePlace> places;                    // of frames with findings, by frame
  Summary summary;
  BusNames buses;
  std::optional<Error> error;  // could not be opened, or is broken behind `frames`
  bool stopped = false;        // by RunOptions::stop

  const FramePlace* place(std::uint64_t frame) const;
};

// How much of a frame a visitor wants to see: making a dissection costs more than checking.
enum class Detail : std::uint8_t {
  kNothing,
  kNews,  // a dissection, but for records that say nothing new: those come with Dissection::repeats
  kAll
};

// Sees the frames as they pass.
class FrameVisitor {
 public:
  FrameVisitor() = default;
  FrameVisitor(const FrameVisitor&) = delete;
  FrameVisitor& operator=(const FrameVisitor&) = delete;
  virtual ~FrameVisitor() = default;
  // Asked before each push.
  virtual Detail wanted_of(const RawFrame& frame) {
    static_cast<void>(frame);
    return Detail::kAll;
  }
  // After the push. `dissection`: nullptr where it was not wanted. The new findings are pipeline.fresh(). False:
  // enough, the rest of the capture is not read.
  virtual bool on_frame(const RawFrame& frame, const Dissection* dissection, const Pipeline& pipeline,
                        const Source& source) = 0;
  // Findings that no frame brought: drop counts, the end of the file.
  virtual void on_end(const Pipeline& pipeline) { static_cast<void>(pipeline); }
};

struct RunOptions {
  FrameVisitor* visitor = nullptr;
  const std::atomic<bool>* stop = nullptr;                // set from elsewhere: end as if the capture did
  std::function<void(const Source& source)> on_progress;  // every few thousand frames
};

// Reads `source` to its end. Never fails: what could not be read stands in `error`, what was read before holds.
CaptureResult run(Source& source, std::string name, const Settings& settings, const RunOptions& options = {});

// By frame, rule, node.
bool comes_before(const Finding& left, const Finding& right);

}  // namespace servotrace::replay
