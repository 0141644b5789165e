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
  void step_response(Scene& scene, ChannelState& channel);
  void judge_withheld(Scene& scene, ChannelState& channel);
  void judge_deadlines(const Context& context);

  // engine.cpp
  void report(Scene& scene, RuleId rule, OwnerId owner, Report given);
  void run(Scene& scene, Events events);
  void judge_unsteady(const Context& context, Node& node, std::uint32_t block_at, Events events);
  void judge_command_record(const Context& context);

  // quiet.cpp: blocks that say nothing new. The quick ones, of armed nodes, return false, and have changed nothing,
  // where the block is to be judged in full.
  bool quick_command(const Context& context, Node& node, Bytes block, std::uint32_t block_at);
  bool quick_response(const Context& context, Node& node, Bytes block, std::uint32_t block_at);
  static void follow_command(Node& node, std::uint64_t first_word, std::uint64_t frame);
  static void follow_response(Node& node, std::uint64_t first_word, std::uint64_t frame, std::int64_t cycle);
  void wake(Node& node);
  void wake_all();
  static void end_full_command(Node& node, bool same);
  void end_full_response(Node& node, bool same);
  bool ring_is_settled() const;
  static bool same_but_counter(Bytes block, const std::array<std::uint64_t, 4>& raw, BlockSize size);

  // rest.cpp: records of a ring of which every block is quiet
  bool glances(const Context& context, const RecordPlace& place);
  void begin_glances(const RecordHeader& header, Bytes record);
  void end_glances();
  bool goes_on_resting(const Context& context, bool response, Bytes blocks);
  void collect_rest(const Context& context, const RecordHeader& header, Bytes record);
  void end_rest();
  static bool can_rest();

  Ring ring_;
  Rest rest_;
};

}  // namespace servotrace::rtex
