// SPDX-License-Identifier: MIT
#include "decoder/rtex/rest.hpp"

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

// Preconditions: bytes.size() == 8 * words, words even.
bool same_words(Bytes bytes, const std::array<std::uint64_t, Rest::kMaxWords>& image, std::size_t words) {
  std::uint64_t differs = 0;
  for (std::size_t i = 0; i < words; i += 2)
    differs |= (load_le64(bytes, 8 * i) ^ image[i]) | (load_le64(bytes, 8 * i + 8) ^ image[i + 1]);
  return differs == 0;
}

// Every record is to be taken apart.
bool wants_all(const Context& context) { return context.dissection != nullptr && !context.dissection->only_news; }

void show_repeat(const Context& context) {
  if (context.dissection != nullptr) context.dissection->repeats = true;
}

}  // namespace

// A record of a ring at rest that says nothing to any rule of the ring, either: all there is to do is to count it.
// False, and nothing was done: it is to be taken in order.
bool Engine::glances(const Context& context, const RecordPlace& place) {
  if (!rest_.glancing) return false;
  const Bytes record = context.frame.bytes.subspan(place.offset, place.length);
  if (record.size() != kRecord.size + 8 * rest_.words) return false;
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
      wants_all(context)) {
    return false;
  }
  const std::uint64_t turn = direction.records;
  const auto& image = direction.images[turn % Rest::kMaxPeriod & (rest_.period - 1U)];
  if (!same_words(record.subspan(kRecord.size), image, rest_.words)) return false;
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
  direction.frames[turn % Rest::kFrames] = frame.number;
  ++direction.records;
  show_repeat(context);
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

// A record of a ring at rest that is the one of a period ago. False: it is to be judged block by block, and the nodes
// are up to date.
bool Engine::goes_on_resting(const Context& context, bool response, Bytes blocks) {
  if (!rest_.reached) return false;
  Rest::Direction& direction = response ? rest_.response : rest_.command;
  const bool in_turn = rest_.command.records == rest_.response.records + (response ? 1 : 0);
  if (!in_turn || wants_all(context) || !ring_.record_quiet || !ring_.timing.known ||
      blocks.size() != 8 * rest_.words ||
      !same_words(blocks, direction.images[direction.records % rest_.period], rest_.words)) {
    end_rest();
    return false;
  }
  direction.frames[direction.records % Rest::kFrames] = context.frame.number;
  ++direction.records;
  show_repeat(context);
  return true;
}

// After a record that was judged block by block: two periods of nothing but quiet blocks, and the ring is at rest.
void Engine::collect_rest(const Context& context, const RecordHeader& header, Bytes record) {
  const bool response = header.response;
  const Bytes blocks = record.subspan(header.header_length);
  Rest::Direction& direction = response ? rest_.response : rest_.command;
  const bool in_turn = rest_.command.records == rest_.response.records + (response ? 1 : 0);
  const std::size_t words = blocks.size() / 8;
  if (ring_.awake != 0 || !in_turn || !can_rest() || wants_all(context) || words > Rest::kMaxWords ||
      (rest_.words != words && rest_.command.records + rest_.response.records != 0)) {
    rest_.command.records = rest_.response.records = 0;
    return;
  }
  rest_.words = words;
  rest_.period = ring_.ratio.value == 1 ? 4 : 8;
  auto& image = direction.images[direction.records % rest_.period];
  for (std::size_t i = 0; i < words; ++i) image[i] = load_le64(blocks, 8 * i);
  for (std::size_t i = 0; i < Rest::kHeaderWords; ++i) direction.header[i] = load_le64(record, 8 * i);
  ++direction.records;
  if (!response || direction.records != std::uint64_t{2} * rest_.period) return;
  rest_.reached = true;
  rest_.first_cycle = ring_.cycle + 1;
  rest_.command.records = rest_.response.records = 0;
}

// Brings the nodes up to date: whole periods are only counted, the last of them is gone through.
void Engine::end_rest() {
  if (!rest_.reached) return;
  end_glances();
  rest_.reached = false;
  const std::uint64_t commands = rest_.command.records;
  const std::uint64_t responses = rest_.response.records;
  const std::uint64_t skipped = responses < rest_.period ? 0 : (responses / rest_.period - 1) * rest_.period;
  const std::uint64_t moves = skipped / static_cast<std::uint64_t>(ring_.ratio.value);
  std::size_t at = 0;
  for (unsigned i = 0; i < ring_.node_count; ++i) {
    Node& node = *ring_.nodes[i];
    node.quiet.commands += skipped;
    node.quiet.responses += skipped;
    node.quiet.moves += moves;
    node.quiet.holds += skipped - moves;
    for (std::uint64_t cycle = skipped; cycle < commands; ++cycle) {
      follow_command(node, rest_.command.images[cycle % rest_.period][at], rest_.command.frames[cycle % Rest::kFrames]);
      if (cycle == responses) break;
      follow_response(node, rest_.response.images[cycle % rest_.period][at],
                      rest_.response.frames[cycle % Rest::kFrames],
                      rest_.first_cycle + static_cast<std::int64_t>(cycle));
    }
    at += node.wide ? 4 : 2;
  }
  rest_.command.records = rest_.response.records = 0;
}

}  // namespace servotrace::rtex
