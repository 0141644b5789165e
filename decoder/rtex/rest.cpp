// SPDX-License-Identifier: MIT
#include "decoder/rtex/rest.hpp"

#include <algorithm>
#include <utility>

#include "decoder/rtex/block_bits.hpp"
#include "decoder/rtex/engine.hpp"

namespace servotrace::rtex {
namespace {

ChannelState without_time(ChannelState channel) {
  channel.hold.start = channel.hold.echo = channel.process.since = channel.withheld.at = {};
  return channel;
}

CounterState without_time(CounterState counter) {
  counter.start = counter.echo_at = {};
  counter.last_move_frame = 0;
  counter.active_records = counter.window_records = counter.window_moves = 0;  // enough of them
  return counter;
}

NodeImage image_of(const Node& node) {
  return {.channels = {without_time(node.channels[0]), without_time(node.channels[1])},
          .counter = without_time(node.counter),
          .inhibit = node.inhibit,
          .off = node.off,
          .following = node.following,
          .emergency = node.emergency,
          .same_responses = node.same_responses,
          .counter_moved_since_response = node.counter_moved_since_response,
          .identical_response = node.identical_response};
}

// But for the Update_Counters every record of the period is the one before.
bool stands_still(const Rest& rest, const Rest::Direction& direction) {
  const auto block = [&](unsigned phase, std::size_t at, std::size_t size) {
    return words_of(Bytes(direction.images[(rest.first_image + phase) % Rest::kMaxPeriod]).subspan(at, size));
  };
  for (unsigned phase = 1; phase < rest.period; ++phase) {
    std::size_t at = 0;
    for (unsigned node = 0; node < rest.node_count; ++node) {
      const std::size_t size = (rest.wide_nodes >> node & 1U) != 0 ? kWideBlockSize : kBlockSize;
      const BlockWords changed = bits::changes(block(phase, at, size), block(phase - 1, at, size));
      if (bits::any(changed, bits::kEveryBit)) return false;
      at += size;
    }
  }
  return true;
}

}  // namespace

// After a record that was judged block by block.
void Engine::collect_rest(const Context& context, const RecordHeader& header, Bytes record) {
  const bool response = header.response;
  const Bytes blocks = record.subspan(header.header_length);
  Rest::Direction& direction = response ? rest_.response : rest_.command;
  const bool in_turn = rest_.command.records == rest_.response.records + (response ? 1 : 0);
  const bool shows_all = context.dissection != nullptr && !context.dissection->only_news;
  if (ring_.of_record.telling != 0 || ring_.of_record.restless || !in_turn || shows_all ||
      ring_.settings.judge_every_block || blocks.size() > Rest::kMaxBytes ||
      (rest_.command.records != 0 && blocks.size() != rest_.bytes)) {
    forget_collected();
    return;
  }
  rest_.bytes = blocks.size();
  const std::uint64_t cycle = direction.records++;
  const bool same =
      cycle >= rest_.period && Rest::is_image(direction.images[(cycle - rest_.period) % Rest::kMaxPeriod], blocks);
  rest_.cycle_same = same && (!response || rest_.cycle_same);
  std::copy(blocks.begin(), blocks.end(), direction.images[cycle % Rest::kMaxPeriod].begin());
  for (std::size_t i = 0; i < Rest::kHeaderWords; ++i) direction.header[i] = load_le64(record, 8 * i);
  if (response) end_collected_cycle(context, header);
}

void Engine::forget_collected() {
  rest_.command.records = rest_.response.records = 0;
  rest_.same = 0;
  rest_.marked = false;
}

bool Engine::every_node_is_settled() const {
  return std::all_of(ring_.all().begin(), ring_.all().end(), [](const auto& node) { return is_settled(*node); });
}

void Engine::end_collected_cycle(const Context& context, const RecordHeader& header) {
  const std::uint64_t cycles = rest_.response.records;
  if (rest_.cycle_same) {
    ++rest_.same;
  } else {
    rest_.same = 0;
    rest_.marked = false;
    if (cycles > rest_.period)
      rest_.period = rest_.period == Rest::kMaxPeriod ? Rest::kPeriodStep : rest_.period + Rest::kPeriodStep;
  }
  if (rest_.marked && cycles == rest_.mark + rest_.period) {
    rest_.marked = false;
    if (is_where_it_was(context.frame.time_ns)) begin_rest(context, header);
    if (rest_.reached) return;
  }
  if (rest_.marked || rest_.same == 0 || !every_node_is_settled()) return;
  rest_.marked = true;
  rest_.mark = cycles;
  rest_.mark_ns = context.frame.time_ns;
  rest_.measured.clear();
  const auto nodes = ring_.all();
  std::transform(nodes.begin(), nodes.end(), rest_.nodes.begin(), [](const auto& node) { return image_of(*node); });
}

// Any wait as long as that may be judged.
DurationNs Engine::patience_ns() const {
  const Limits& limits = ring_.settings.limits;
  return milliseconds(std::min(limits.echo_ms, limits.busy_ms));
}

// A period of cycles was that before it, and has left the nodes as they were.
bool Engine::is_where_it_was(TimeNs now_ns) const {
  const auto nodes = ring_.all();
  return rest_.same >= rest_.period && rest_.measured.dropped() == 0 &&
         elapsed_ns(rest_.mark_ns, now_ns) <= patience_ns() &&
         std::equal(nodes.begin(), nodes.end(), rest_.nodes.begin(),
                    [](const auto& node, const NodeImage& image) { return image_of(*node) == image; });
}

void Engine::begin_rest(const Context& context, const RecordHeader& header) {
  rest_.first_cycle = ring_.cycle + 1;
  rest_.first_image = static_cast<unsigned>((rest_.response.records - rest_.period) % Rest::kMaxPeriod);
  rest_.phase = 0;
  rest_.next_measured = 0;
  rest_.last_ns = context.frame.time_ns;
  rest_.longest_ns = patience_ns() / (2 * rest_.period + 2);
  rest_.node_count = header.node_count;
  rest_.wide_nodes = header.wide_nodes;
  rest_.still = stands_still(rest_, rest_.command) && stands_still(rest_, rest_.response);
  rest_.reached = rest_.still || context.dissection == nullptr;
  if (rest_.reached) rest_.command.records = rest_.response.records = 0;
}

// A record of a ring at rest that is the one of a period ago. False: it is to be judged block by block, and the nodes
// are up to date.
bool Engine::goes_on_resting(const Context& context, bool response, Bytes blocks) {
  if (!rest_.reached) return false;
  Rest::Direction& direction = response ? rest_.response : rest_.command;
  const bool in_turn = rest_.command.records == rest_.response.records + (response ? 1 : 0);
  if (!in_turn || shows_news(context) || !ring_.record_quiet || !ring_.timing.known ||
      !rest_.repeats(direction, context.frame, blocks)) {
    end_rest();
    return false;
  }
  rest_.take(direction, context.frame);
  if (context.dissection != nullptr) context.dissection->repeats = true;
  return true;
}

// Every record is to be taken apart, or this one, for it is not but for the counters the one before.
bool Engine::shows_news(const Context& context) const {
  return context.dissection != nullptr && !(context.dissection->only_news && rest_.still);
}

// A response of a ring at rest came: how long the drives took that answer here.
void Rest::measure(TimeNs now_ns) {
  for (; next_measured < measured.size(); ++next_measured) {
    Measured& here = measured[next_measured];
    if (here.phase != phase) return;
    const std::uint64_t sent = command.records - 1 - here.cycles;
    here.times.add(elapsed_ns(command.stamps[sent % kStamps].time_ns, now_ns));
  }
}

// Brings the nodes up to date: the last whole period and what came behind it is judged block by block.
void Engine::end_rest() {
  if (!rest_.reached) return;
  end_glances();
  rest_.reached = false;
  rest_.judging_again = true;
  const Ring::OfRecord of_record = ring_.of_record;
  const std::int64_t cycle = ring_.cycle;
  const bool has_command = std::exchange(ring_.cycle_has_command, true);
  const std::uint64_t commands = rest_.command.records;
  const std::uint64_t periods = rest_.response.records / rest_.period;
  if (periods <= 1) {
    judge_again(0, commands, 0);
  } else {
    const std::uint64_t last = (periods - 1) * rest_.period;
    judge_period(last, periods);
    judge_again(last + rest_.period, commands, last);
  }
  ring_.cycle_has_command = has_command;
  ring_.cycle = cycle;
  ring_.of_record = of_record;
  rest_.judging_again = false;
  forget_collected();
}

// The period that begins with the cycle `first`, for as many: what it counts counts for those before it, too.
void Engine::judge_period(std::uint64_t first, std::uint64_t periods) {
  const auto count_all = [this] {
    for (const auto& node : ring_.all()) count_quiet(*node);
  };
  Findings& findings = ring_.findings;
  std::array<std::uint64_t, kRuleCount> before;
  count_all();
  for (std::size_t i = 0; i < kRuleCount; ++i) before[i] = findings.times_checked(static_cast<RuleId>(i));
  judge_again(first, first + rest_.period, first);
  count_all();
  for (std::size_t i = 0; i < kRuleCount; ++i) {
    const auto rule = static_cast<RuleId>(i);
    findings.checked(rule, (findings.times_checked(rule) - before[i]) * (periods - 1));
  }
}

// Cycles at rest; what was measured is found where they are less than a period behind `measured_from`.
void Engine::judge_again(std::uint64_t from, std::uint64_t to, std::uint64_t measured_from) {
  for (std::uint64_t cycle = from; cycle < to; ++cycle) {
    rest_.again_phase = static_cast<unsigned>(cycle - measured_from);
    ring_.cycle = rest_.first_cycle + static_cast<std::int64_t>(cycle);
    judge_image(false, cycle);
    if (cycle < rest_.response.records) judge_image(true, cycle);
  }
}

void Engine::judge_image(bool response, std::uint64_t cycle) {
  const Rest::Direction& direction = response ? rest_.response : rest_.command;
  const auto& image = direction.images[(rest_.first_image + cycle % rest_.period) % Rest::kMaxPeriod];
  const Rest::Stamp& stamp = direction.stamps[cycle % Rest::kStamps];
  const RawFrame frame{.number = stamp.frame,
                       .time_ns = stamp.time_ns,
                       .bytes = Bytes(image).first(rest_.bytes),
                       .has_time = ring_.timed};
  const Context context{frame, ring_.settings, ring_.findings};
  RecordHeader blocks_only;
  blocks_only.response = response;
  blocks_only.node_count = rest_.node_count;
  blocks_only.wide_nodes = rest_.wide_nodes;
  push_blocks(context, {}, blocks_only, frame.bytes, Order::kNext);
}

// How long a drive took. Of what is judged again it was measured when the records came.
void Engine::add_time(Durations& times, const Moment& start, const Moment& now) {
  const auto cycles = static_cast<unsigned>(now.cycle - start.cycle);
  const auto measured_at = [&](unsigned phase) {
    return std::find_if(rest_.measured.begin(), rest_.measured.end(), [&](const Rest::Measured& measured) {
      return measured.phase == phase && measured.cycles == cycles;
    });
  };
  if (rest_.judging_again) {
    const auto* const found = measured_at(rest_.again_phase);
    if (found != rest_.measured.end()) times.merge(found->times);
    return;
  }
  times.add(elapsed_ns(start.time_ns, now.time_ns));
  if (!rest_.marked) return;
  const auto phase = static_cast<unsigned>(rest_.response.records - rest_.mark);
  if (measured_at(phase) == rest_.measured.end()) rest_.measured.push_back({phase, cycles, {}});
}

}  // namespace servotrace::rtex
