// SPDX-License-Identifier: MIT
// Records of a ring that say nothing new (Dissection::repeats) are not taken apart. Of each kind of record, the
// commands of a ring and its responses, the samples of the last one that was are kept; those of the records that repeat
// it are added to their series together when the stretch ends.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "decoder/pipeline/dissection.hpp"
#include "replay/report/series.hpp"

namespace servotrace::report {

class Repeats {
 public:
  explicit Repeats(std::vector<Signal>& signals) : signals_(signals) {}

  // A frame that was taken apart; what is noted until the next call is of it.
  void begin(const Dissection& dissection);
  void note_sample(std::size_t signal, std::int64_t value);
  void note_change(std::size_t track) { touch(tracks_, track); }
  // A record that repeats the one of its kind that was taken apart last.
  void add(TimeNs time_ns, const Dissection& dissection);
  // Adds what was not added yet: before the series are looked at.
  void finish();
  // Two parts of a record, or records of two kinds, share a series or a state: what another record of that kind does
  // depends on those in between, and each has to be taken apart.
  bool are_entangled() const { return entangled_; }

 private:
  struct Sample {
    std::size_t signal = 0;
    std::int64_t value = 0;
  };
  struct Kind {
    BusRef bus;
    Direction direction = Direction::kNone;
    std::vector<Sample> samples;
    std::vector<TimeNs> times;  // of the repetitions that are not added yet, ascending
  };
  // Who touched a series or a track last.
  struct Toucher {
    const Kind* kind = nullptr;
    std::uint64_t frame = 0;
  };

  Kind& kind_of(const BusRef& bus, Direction direction);
  void touch(std::vector<Toucher>& list, std::size_t index);
  void settle(Kind& kind);

  std::vector<Signal>& signals_;
  std::deque<Kind> kinds_;
  Kind* present_ = nullptr;   // of the frame begun; nullptr: no record of a ring
  std::uint64_t frames_ = 0;  // begun
  std::vector<Toucher> series_, tracks_;
  bool entangled_ = false;
};

}  // namespace servotrace::report
