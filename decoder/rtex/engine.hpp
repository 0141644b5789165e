// SPDX-License-Identifier: MIT
// The engine of a ring: takes its records in order, keeps the state, and runs the checks whose events occurred.
#pragma once

#include "decoder/link/rtex_record.hpp"
#include "decoder/pipeline/summary.hpp"
#include "decoder/rtex/rest.hpp"
#include "decoder/rtex/scene.hpp"

namespace servotrace::rtex {

struct RecordHeader {
  bool response = false;
  bool sequence_valid = false, cycle_valid = false, sampled = false;
  std::uint32_t sequence = 0, cycle_ns = 0, wide_nodes = 0;
  std::uint8_t node_count = 0;
  std::uint32_t header_length = 0;

  BlockSize size(unsigned place) const {
    return (wide_nodes >> place & 1U) != 0 ? BlockSize::kWide : BlockSize::kNarrow;
  }
};
RecordHeader read_header(Bytes record);

class Engine {
 public:
  Engine(const Settings& settings, const BusRef& bus, Findings& findings) : ring_(settings, bus, findings) {}

  void push(const Context& context, const RecordPlace& place);
  void gap();
  void finish(const Context& context);
  void summarise(BusSummary& summary) const;

 private:
  // records.cpp: the order of records, the cycle, when the ring runs
  enum class Order : std::uint8_t { kNext, kDuplicate };
  void take_header(const Context& context, const RecordHeader& header);
  Order take_sequence(const Context& context, const RecordHeader& header, Bytes record);
  bool same_as_last(const RecordHeader& header, Bytes record) const;
  void next_cycle(const Context& context);
  void restart_comparisons();
  void lose_records(const Context& context, std::int64_t kind, std::int64_t argument);
  void take_command_record(const Context& context, const RecordHeader& header, bool all_nop);
  void judge_interval(const Context& context, DurationNs interval_ns);
  void judge_timeout(const Context& context, bool all_nop);
  void lose_ring(const Context& context);
  void restart_ring(const Context& context);
  void end_command_record(const Context& context);
  void end_response_record(const Context& context);
  void stop_ring(bool by_reset = false);
  Scene ring_scene(const Context& context);

  // blocks.cpp
  bool push_blocks(const Context& context, const RecordPlace& place, const RecordHeader& header, Bytes record,
                   Order order);
  void push_command(const Context& context, Node& node, Bytes block, std::uint32_t block_at, BlockSize size);
  void push_response(const Context& context, Node& node, Bytes block, std::uint32_t block_at, BlockSize size);
  void name_node(Node& node, std::uint8_t mac_id, bool actual);
  void link_previous(const Context& context, bool response);
  void decode(const Context& context, const Node& node, Bytes block, std::uint32_t block_at, BlockSize size,
              bool response);

  // counters.cpp: RX201 to RX206, RX210 to RX212
  void count_command(Scene& scene);
  void judge_start(Scene& scene);
  void judge_step(Scene& scene, std::uint8_t before);
  void judge_misses(Scene& scene);
  void judge_between(Scene& scene);
  static bool judges_between(const Node& node);
  void judge_echo(Scene& scene, bool identical);
  void learn_ratio(const Context& context);
  void decide_ratio(const Context& context);
  void learn_lag(const Context& context);

  // timing.cpp: RX207 to RX209
  void count_timing(const Context& context);
  void step_timing(const Context& context, bool value);
  void learn_timing(const Context& context);

  // handshake.cpp
  void step_command(Scene& scene, ChannelState& channel);
  void begin_hold(Scene& scene, ChannelState& channel);
  void judge_answer(Scene& scene, ChannelState& channel, bool same);
  void step_response(Scene& scene, ChannelState& channel);
  void judge_withheld(Scene& scene, ChannelState& channel);
  void judge_deadlines(const Context& context);

  // engine.cpp
  void report(Scene& scene, RuleId rule, OwnerId owner, Report given);
  void run(Scene& scene, Events events);
  static void run_unsteady(Scene& scene, Events events);
  void judge_command_record(const Context& context);

  // quick.cpp: blocks that say nothing new, of armed nodes. False, and nothing was changed: the block is to be judged
  // in full.
  bool quick_command(const Context& context, Node& node, Bytes block, std::uint32_t block_at);
  bool quick_response(const Context& context, Node& node, Bytes block, std::uint32_t block_at);
  void judge_quick_response(const Context& context, Node& node, std::uint32_t block_at, ChangedParts parts);
  static void follow_counter(Node& node, std::uint8_t now, bool moves, std::uint64_t frame);
  void step_quickly(Scene& scene, ChannelState& channel);
  void answer_quickly(Scene& scene, ChannelState& channel, bool same);
  Scene quick_scene(const Context& context, Node& node, std::uint32_t block_at);
  void note_waits(const Node& node);
  void end_quick(Node& node);

  // quiet.cpp: when a node is quiet
  void wake(Node& node);
  void wake_all();
  void count_quiet(Node& node);
  void count_answers(SteadyAnswers& answers);
  void end_full_command(Node& node, const BlockWords& before, const BlockWords& now);
  void end_full_response(Node& node, const BlockWords& before, const BlockWords& now);
  void note_news(const Node& node, const BlockWords& before, const BlockWords& now);
  bool ring_is_settled() const;

  // rest.cpp: records of a ring that repeat with a period
  void collect_rest(const Context& context, const RecordHeader& header, Bytes record);
  void end_collected_cycle(const Context& context, const RecordHeader& header);
  void forget_collected();
  bool every_node_is_settled() const;
  bool is_where_it_was(TimeNs now_ns) const;
  DurationNs patience_ns() const;
  void begin_rest(const Context& context, const RecordHeader& header);
  bool goes_on_resting(const Context& context, bool response, Bytes blocks);
  bool shows_news(const Context& context) const;
  void end_rest();
  void judge_period(std::uint64_t first, std::uint64_t periods);
  void judge_again(std::uint64_t from, std::uint64_t to, std::uint64_t measured_from);
  void judge_image(bool response, std::uint64_t cycle);
  void add_time(Durations& times, const Moment& start, const Moment& now);

  // glance.cpp: of them, those that say nothing to the rules of the ring, either
  bool glances(const Context& context, const RecordPlace& place);
  void begin_glances(const RecordHeader& header, Bytes record);
  void end_glances();

  Ring ring_;
  Rest rest_;
};

}  // namespace servotrace::rtex
