// SPDX-License-Identifier: MIT
// [[raw]]: frames written out byte by byte, for what no master sends (link types that are not ours, broken records).
#include "captures/simulator/bus.hpp"

namespace servotrace::simulator {

void simulate_raw(const BusJob& job) {
  TableReader reader(job.table, job.problems);
  const auto link_type = static_cast<LinkType>(reader.integer("link_type", 0, 0xFFFF));
  const std::string name = reader.text("interface", "raw" + std::to_string(job.index));
  const std::uint32_t interface_id = job.recording.interface(link_type, name);
  for (const toml::table* entry : reader.tables("frame")) {
    TableReader frame(*entry, job.problems);
    const TimeNs time_ns = job.start_ns + frame.milliseconds("at_ms", 0);
    const std::vector<std::uint8_t> bytes = frame.bytes("bytes");
    const auto size = static_cast<std::int64_t>(bytes.size());
    const auto length = static_cast<std::uint32_t>(frame.integer("original_length", size, size, 0xFFFF));
    const DurationNs early_ns = frame.milliseconds("stamped_early_ms", 0);
    frame.done();
    job.recording.add_stamped(interface_id, time_ns, time_ns - early_ns, bytes, length);
  }
  reader.done();
}

}  // namespace servotrace::simulator
