// SPDX-License-Identifier: MIT
// The changes of a state in bounded memory.
#include <algorithm>

#include "replay/report/model.hpp"

namespace servotrace::report {
namespace {

// Joins what lies closer together than the spacing, as far as it is not to be kept.
void thin(StateTrack& track) {
  std::vector<Event>& changes = track.changes;
  const DurationNs span = std::max<DurationNs>(elapsed_ns(changes.front().time_ns, changes.back().time_ns), 1);
  track.spacing_ns = std::max<DurationNs>(track.spacing_ns * 2, 2 * (span / static_cast<DurationNs>(kMaxChanges)) + 1);
  std::size_t kept = 0;
  for (std::size_t i = 1; i < changes.size(); ++i) {
    Event& target = changes[kept];
    const Event& event = changes[i];
    if (!target.close_up && !event.close_up && elapsed_ns(target.time_ns, event.time_ns) < track.spacing_ns) {
      target.after = event.after;
      target.joined += event.joined + 1;
    } else {
      changes[++kept] = event;
    }
  }
  changes.resize(kept + 1);
}

}  // namespace

void StateTrack::add(const Event& event) {
  value = event.after;
  ++total;
  if (!changes.empty() && spacing_ns != 0) {
    Event& latest = changes.back();
    if (!latest.close_up && !event.close_up && elapsed_ns(latest.time_ns, event.time_ns) < spacing_ns) {
      latest.after = event.after;
      ++latest.joined;
      return;
    }
  }
  if (changes.size() >= kMaxChanges) thin(*this);
  if (changes.size() >= kMaxChanges) {  // close-ups alone fill it: the last one takes the rest
    changes.back().after = event.after;
    ++changes.back().joined;
    return;
  }
  changes.push_back(event);
}

}  // namespace servotrace::report
