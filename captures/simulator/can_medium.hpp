// SPDX-License-Identifier: MIT
// A CAN bus in simulated time: stations ask to send, the lowest identifier wins, a frame takes the bits it has, and a
// recorder notes when each frame ended.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "captures/simulator/can_frame.hpp"
#include "decoder/core/time.hpp"

namespace servotrace::simulator {

class Station {
 public:
  Station() = default;
  Station(const Station&) = delete;
  Station& operator=(const Station&) = delete;
  virtual ~Station() = default;
  // A frame of another station ended now.
  virtual void receive(const CanFrame& frame) = 0;
};

// What becomes of a frame on its way.
enum class Fate : std::uint8_t {
  kSent,
  kLost,       // never reaches the wire
  kUnheard,    // sent and recorded, but no station takes it
  kUnrecorded  // sent, but the recorder misses it
};

struct RecordedFrame {
  TimeNs time_ns = 0;
  CanFrame frame;
};

class CanBus {
 public:
  CanBus(std::uint32_t bit_rate, TimeNs start_ns) : bit_rate_(bit_rate), now_ns_(start_ns), free_ns_(start_ns) {}

  TimeNs now_ns() const { return now_ns_; }
  void attach(Station* station) { stations_.push_back(station); }
  void detach(const Station* station);

  // `sender` (may be null: a frame from outside) wants to send once `delay_ns` has passed.
  void send(const Station* sender, const CanFrame& frame, DurationNs delay_ns = 0);
  void at(TimeNs time_ns, std::function<void()> action);
  void after(DurationNs delay_ns, std::function<void()> action) { at(now_ns_ + delay_ns, std::move(action)); }

  // Runs until `until_ns`, or until `done` holds; true where it holds.
  bool run(TimeNs until_ns, const std::function<bool()>& done);
  void run(TimeNs until_ns) {
    run(until_ns, [] { return false; });
  }

  // Asked once for every frame just before it starts; may change it.
  std::function<Fate(CanFrame&)> tamper;
  bool recording = true;
  const std::vector<RecordedFrame>& recorded() const { return recorded_; }

 private:
  struct Waiting {
    TimeNs ready_ns = 0;
    const Station* sender = nullptr;
    CanFrame frame;
  };
  bool step(TimeNs until_ns);
  void transmit(std::size_t index, TimeNs start_ns);
  std::size_t winner(TimeNs at_ns) const;

  std::uint32_t bit_rate_;
  TimeNs now_ns_;
  TimeNs free_ns_;
  std::vector<Station*> stations_;
  std::vector<Waiting> waiting_;                         // in the order they asked
  std::multimap<TimeNs, std::function<void()>> timers_;  // equal times keep their order
  std::vector<RecordedFrame> recorded_;
};

}  // namespace servotrace::simulator
