// SPDX-License-Identifier: MIT
// A controller's own log of RTEX memories as a source of records: rows of a table become the blocks of a cycle's
// command and response record. Which column holds what is the map's matter.
#pragma once

#include <memory>
#include <string>

#include "replay/capture/source.hpp"
#include "replay/settings/rtex_log_map.hpp"

namespace servotrace::replay {

class RtexLogSource : public Source {
 public:
  // Records that were left out: rows of an axis were missing in their cycle.
  virtual std::uint64_t incomplete() const = 0;
};

// The log may be compressed. `map` is copied.
Result<std::unique_ptr<RtexLogSource>> open_rtex_log(const std::filesystem::path& path, const RtexLogMap& map);
Result<std::unique_ptr<RtexLogSource>> open_rtex_log_stream(int descriptor, std::string name, const RtexLogMap& map);

}  // namespace servotrace::replay
