// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdlib>

#include "decoder/pipeline/rules.hpp"
#include "decoder/rtex/engine.hpp"

namespace servotrace::rtex {
namespace {

constexpr Slot kSequence = slot(kRecord, "sequence");
constexpr Slot kNodeBits = slot(kRecord, "wide_nodes");
static_assert(kRecord.size == 24 && kSequence.first_byte == 8 && kSequence.width == 32 && kNodeBits.first_byte == 16);
constexpr std::uint64_t kBesidesSequence = ~std::uint64_t{0xFFFFFFFFU};  // of the header's second word

}  // namespace

// A record of a ring at rest that says nothing to any rule of the ring, either: all there is to do is to count it.
// False, and nothing was done: it is to be taken in order.
bool Engine::glances(const Context& context, const RecordPlace& place) {
  if (!rest_.glancing) return false;
  const Bytes record = context.frame.bytes.subspan(place.offset, place.length);
  if (record.size() != kRecord.size + rest_.bytes) return false;
  const std::uint64_t first = load_le64(record, 0);
  const bool response = first != rest_.command.header[0];
  Rest::Direction& direction = response ? rest_.response : rest_.command;
  const std::uint64_t second = load_le64(record, kSequence.first_byte);
  if (first != direction.header[0] || ((second ^ direction.header[1]) & kBesidesSequence) != 0 ||
      load_le64(record, kNodeBits.first_byte) != direction.header[2] ||
      static_cast<std::uint32_t>(second) != ring_.sequence + (response ? 0U : 1U) ||
      rest_.command.records != rest_.response.records + (response ? 1U : 0U)) {
    return false;
  }
  const RawFrame& frame = context.frame;
  const bool shared = place.carrier == Carrier::kEthernet || place.carrier == Carrier::kUdp;
  if (!frame.has_time || frame.time_resolution_ns != ring_.time_resolution_ns || shared != ring_.shared_carrier ||
      (context.dissection != nullptr && shows_news(context))) {
    return false;
  }
  if (!rest_.repeats(direction, frame, record.subspan(kRecord.size))) return false;
  if (response) {
    ring_.cycle_has_response = true;
    ring_.last_response_frame = frame.number;
    ring_.last_response_time_ns = frame.time_ns;
    ++rest_.glanced_responses;
  } else {
    const DurationNs interval = elapsed_ns(ring_.last_command.time_ns, frame.time_ns);
    if (interval < rest_.least_ns || interval > rest_.most_ns) return false;
    TimingCount& timing = ring_.timing;
    if (ring_.cycle + 1 - timing.toggled >= rest_.timing_period) {
      if (timing.is_used || timing.any_set) return false;
      timing.in_phase = false;
      timing.toggled = ring_.cycle + 1;  // nobody counts
    }
    ring_.sequence = static_cast<std::uint32_t>(second);
    ++ring_.cycle;
    ring_.cycle_has_response = false;
    ring_.cycle_times.add(interval);
    ring_.cycle_deviations.add(std::abs(interval - ring_.cycle_ns.value));
    ring_.last_command = {frame.number, frame.time_ns, ring_.cycle};
    ++rest_.glanced_commands;
  }
  rest_.take(direction, frame);
  if (context.dissection != nullptr) context.dissection->repeats = true;
  return true;
}

// A record is to be taken in order: what the ring's rules would have counted until now.
void Engine::end_glances() {
  rest_.glancing = false;
  if (rest_.glanced_commands + rest_.glanced_responses == 0) return;
  Findings& findings = ring_.findings;
  findings.checked(rule("CP103"), rest_.glanced_commands + rest_.glanced_responses);
  findings.checked(rule("RX111"), rest_.glanced_commands);
  findings.checked(rule("RX112"), rest_.glanced_commands);
  for (const std::uint8_t row : ring_.record_passed) findings.checked(id_of(row), rest_.glanced_commands);
  if (rest_.glanced_commands != 0) {
    ring_.timing.verdict = TimingCount::Verdict::kNone;
    ring_.timing.passed = ring_.cycle - ring_.timing.toggled;
  }
  rest_.glanced_commands = rest_.glanced_responses = 0;
}

// After a record that was taken in order: whether those behind it may be glanced at.
void Engine::begin_glances(const RecordHeader& header, Bytes record) {
  Rest::Direction& direction = header.response ? rest_.response : rest_.command;
  for (std::size_t i = 0; i < Rest::kHeaderWords; ++i) direction.header[i] = load_le64(record, 8 * i);
  const Limits& limits = ring_.settings.limits;
  const DurationNs cycle = ring_.cycle_ns.value;
  rest_.timing_period = cycles_in(ring_, milliseconds(2));
  rest_.least_ns = cycle - limits.jitter_percent * cycle / 100;
  rest_.most_ns = std::min(cycle + limits.jitter_percent * cycle / 100, limits.timeout_cycles * cycle);
  rest_.glancing =
      rest_.reached && ring_is_settled() && header.sequence_valid && header.header_length == kRecord.size &&
      ring_.timed && ring_.time_resolution_ns <= cycle / 4 && rest_.least_ns >= 0 && ring_.last_command_follows &&
      !ring_.last_all_nop && !ring_.timeout_pending && !ring_.ever_lost && !ring_.gap_reported && !ring_.reset_sent &&
      ring_.missing_responses == 0 && ring_.record_quiet && ring_.timing.known && rest_.timing_period > 0 &&
      ring_.cycle_has_command && !ring_.findings.is_open(ring_.owner, rule("RX111")) &&
      !ring_.findings.is_open(ring_.owner, rule("RX112")) && !ring_.findings.is_open(ring_.owner, rule("RX108"));
}

}  // namespace servotrace::rtex
