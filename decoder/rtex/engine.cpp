// SPDX-License-Identifier: MIT
// Which checks run on which events, and the way of a record through the engine.
#include "decoder/rtex/engine.hpp"

#include <bit>

#include "decoder/pipeline/rules.hpp"
#include "decoder/rtex/derived.hpp"

namespace servotrace::rtex {
namespace {

// A row of kRules that has a check, with what running it takes: the rows themselves are long.
struct Entry {
  Check check = nullptr;
  Events earlier = kNoEvent;  // events of the row that come before this one
  RuleId rule{};
  std::uint8_t row = 0;
  Scope scope = Scope::kNode;
  bool needs_every_cycle = false;
  bool steady = false;  // its passing is noted for the short cut
};

// Of whom something happened.
enum class Level : std::uint8_t { kRing, kNode, kChannel };
constexpr std::size_t kLevels = 3;

// The entries by event and level, in the order of the catalogue: built by the compiler.
struct Dispatch {
  std::array<Entry, kRules.size()* 8> entries = {};
  std::array<std::uint16_t, kEventCount* kLevels + 1> first = {};
  Events events = kNoEvent;  // that have entries
};
constexpr bool runs_at(Scope scope, Level level, unsigned event) {
  if (scope == Scope::kRing) return true;
  if (scope == Scope::kChannel) return level == Level::kChannel;
  // A node's rules see a command block once, not once a channel.
  return level == Level::kNode || (level == Level::kChannel && (1U << event) != kActiveCommand);
}
constexpr RuleId kFirstRule = rule("RX101");
constexpr bool has_event(Events events, unsigned event) { return (events >> event & 1U) != 0; }
consteval Dispatch make_dispatch(bool steady_too) {
  Dispatch table{};
  std::size_t next = 0;
  for (unsigned event = 0; event < kEventCount; ++event) {
    for (std::size_t level = 0; level < kLevels; ++level) {
      table.first[event * kLevels + level] = static_cast<std::uint16_t>(next);
      for (std::size_t row = 0; row < kRules.size(); ++row) {
        const RtexRule& rule = kRules[row];
        if (!has_event(rule.events, event) || !runs_at(rule.scope, static_cast<Level>(level), event)) continue;
        const bool steady = !has_event(unsteady_events(rule.row.id, rule.events), event);
        if (!steady_too && steady) continue;
        table.entries[next++] = {rule.check,
                                 rule.events & ((1U << event) - 1U),
                                 static_cast<RuleId>(static_cast<std::size_t>(kFirstRule) + row),
                                 static_cast<std::uint8_t>(row),
                                 rule.scope,
                                 rule.row.needs_every_cycle,
                                 steady};
        table.events |= 1U << event;
      }
    }
  }
  table.first[kEventCount * kLevels] = static_cast<std::uint16_t>(next);
  return table;
}
constexpr Dispatch kDispatch = make_dispatch(true);
constexpr Dispatch kUnsteady = make_dispatch(false);  // what a quiet block is judged by
static_assert(kRules.size() < 256);

// What may change in a quiet block is judged at its node.
static_assert([] {
  for (unsigned event = 0; event < kEventCount; ++event) {
    const std::size_t list = event * kLevels + static_cast<std::size_t>(Level::kChannel);
    const bool of_block = has_event(kActiveCommand | kAnswer, event);
    if (of_block && kUnsteady.first[list] != kUnsteady.first[list + 1]) return false;
  }
  return (kUnsteady.events & (kCommandBlock | kResponseBlock)) == 0;
}());

// Who may have episodes, by scope.
using Owners = std::array<OwnerId, 3>;

// One check, with all that is known of its row when the program is compiled. `done`: the events judged before.
template <const Dispatch& table, std::size_t place>
[[gnu::always_inline]] inline void run_entry(Scene& scene, const Owners& owners, Events done) {
  constexpr Entry kEntry = table.entries[place];
  if constexpr (kEntry.earlier != kNoEvent) {
    if ((kEntry.earlier & done) != 0) return;  // it ran for an earlier event of this block
  }
  if constexpr (kEntry.needs_every_cycle) {
    if (scene.ring.sampled) return;
  }
  const OwnerId owner = owners[static_cast<std::size_t>(kEntry.scope)];
  scene.rule = kEntry.rule;
  scene.owner = owner;
  const Outcome outcome = kEntry.check(scene);
  if (outcome == Outcome::kSilent) return;
  Findings& findings = scene.ring.findings;
  findings.checked(kEntry.rule);
  if (outcome != Outcome::kPassed) return;
  findings.calm(owner, kEntry.rule);
  if constexpr (kEntry.steady) {
    if (scene.passed != nullptr) scene.passed->push_back(kEntry.row);
  }
}

// The entries of an event and level, one behind the other.
template <const Dispatch& table, std::size_t list>
void run_list(Scene& scene, const Owners& owners, Events done) {
  constexpr std::size_t kFirst = table.first[list];
  [&]<std::size_t... offset>(std::index_sequence<offset...>) {
    (run_entry<table, kFirst + offset>(scene, owners, done), ...);
  }
  (std::make_index_sequence<table.first[list + 1] - kFirst>{});
}

template <const Dispatch& table>
constexpr auto kLists = []<std::size_t... list>(std::index_sequence<list...>) {
  return std::array{&run_list<table, list>...};
}
(std::make_index_sequence<kEventCount * kLevels>{});

// The entries of `table` at these events.
template <const Dispatch& table>
void run_rows(Scene& scene, Events events) {
  const OwnerId ring = scene.ring.owner;
  const Level level = scene.node == nullptr ? Level::kRing : scene.channel == nullptr ? Level::kNode : Level::kChannel;
  const Owners owners = {ring, scene.node == nullptr ? ring : scene.node->owner,
                         scene.channel == nullptr ? ring : scene.channel->owner};
  Events done = 0;
  for (Events rest = events & table.events; rest != 0; rest &= rest - 1U) {
    const auto event = static_cast<unsigned>(std::countr_zero(rest));
    kLists<table>[event * kLevels + static_cast<std::size_t>(level)](scene, owners, done);
    done |= 1U << event;
  }
}

}  // namespace

RecordHeader read_header(Bytes record) {
  RecordHeader header;
  header.response = read(slot(kRecord, "direction"), record) != 0;
  header.sequence_valid = read(slot(kRecord, "sequence_valid"), record) != 0;
  header.cycle_valid = read(slot(kRecord, "cycle_valid"), record) != 0;
  header.sampled = read(slot(kRecord, "sampled"), record) != 0;
  header.sequence = static_cast<std::uint32_t>(read(slot(kRecord, "sequence"), record));
  header.cycle_ns = static_cast<std::uint32_t>(read(slot(kRecord, "cycle_ns"), record));
  header.wide_nodes = static_cast<std::uint32_t>(read(slot(kRecord, "wide_nodes"), record));
  header.node_count = static_cast<std::uint8_t>(read(slot(kRecord, "node_count"), record));
  header.header_length = static_cast<std::uint32_t>(read(slot(kRecord, "header_length"), record));
  return header;
}

void Engine::run(Scene& scene, Events events) { run_rows<kDispatch>(scene, events); }

// The checks of a quiet block whose outcome may change all the same.
void Engine::run_unsteady(Scene& scene, Events events) { run_rows<kUnsteady>(scene, events); }

// The rules of a command record. Where no block of it tells them anything, the steady ones find what they found before.
void Engine::judge_command_record(const Context& context) {
  Scene scene = ring_scene(context);
  ring_.record_raised = false;
  if (ring_.of_record.telling == 0 && ring_.record_quiet) {
    for (const std::uint8_t row : ring_.record_passed) ring_.findings.checked(id_of(row));
    run_rows<kUnsteady>(scene, kCommandRecord);
    return;
  }
  ring_.record_passed.clear();
  scene.passed = &ring_.record_passed;
  run_rows<kDispatch>(scene, kCommandRecord);
  ring_.record_quiet = ring_.of_record.telling == 0 && !ring_.record_raised;
}

// For what the engine itself finds: the same as a check that raised.
void Engine::report(Scene& scene, RuleId rule, OwnerId owner, Report given) {
  if (rule_row(rule).needs_every_cycle && ring_.sampled) return;
  scene.rule = rule;
  scene.owner = owner;
  scene.raise(given);
}

Scene Engine::ring_scene(const Context& context) {
  return Scene{.ring = ring_, .context = context, .now = {context.frame.number, context.frame.time_ns, ring_.cycle}};
}

void Engine::push(const Context& context, const RecordPlace& place) {
  if (glances(context, place)) return;
  end_glances();
  const Bytes record = context.frame.bytes.subspan(place.offset, place.length);
  const RecordHeader header = read_header(record);
  ring_.shared_carrier = place.carrier == Carrier::kEthernet || place.carrier == Carrier::kUdp;
  ring_.time_resolution_ns = context.frame.time_resolution_ns;
  if (header.sampled != ring_.sampled || context.frame.has_time != ring_.timed) wake_all();
  ring_.sampled = header.sampled;
  ring_.timed = context.frame.has_time;
  take_header(context, header);
  const Order order = take_sequence(context, header, record);
  bool all_nop = !header.response;
  if (order == Order::kNext && !header.response) {
    std::uint32_t at = header.header_length;
    for (unsigned i = 0; i < header.node_count; ++i) {
      if (read(slot(kCommand, "cyclic_command"), record.subspan(at)) != 0) {
        all_nop = false;
        break;
      }
      at += static_cast<std::uint32_t>(header.size(i));
    }
    take_command_record(context, header, all_nop);
  }
  const Bytes blocks = record.subspan(header.header_length);
  ring_.of_record = {};
  bool answered = order == Order::kNext && goes_on_resting(context, header.response, blocks);
  if (!answered) {
    answered = push_blocks(context, place, header, record, order);
    if (order == Order::kNext) collect_rest(context, header, record);
  }
  if (order == Order::kDuplicate) return;
  if (context.dissection != nullptr) link_previous(context, header.response);
  if (header.response) {
    ring_.last_response_time_ns = context.frame.time_ns;
    ring_.last_response_frame = context.frame.number;
    if (!ring_.running && answered && ring_.cycle_has_command && !ring_.awaiting_start)
      ring_.running = ring_.had_run = true;
    if (ring_.of_record.telling != 0) ring_.record_quiet = false;
    end_response_record(context);
  } else {
    ring_.last_command = {context.frame.number, context.frame.time_ns, ring_.cycle};
    end_command_record(context);
  }
  judge_deadlines(context);
  if (rest_.reached) begin_glances(header, record);
}

// True where a node has answered.
bool Engine::push_blocks(const Context& context, const RecordPlace& place, const RecordHeader& header, Bytes record,
                         Order order) {
  std::uint32_t at = header.header_length;
  bool answered = false;
  for (unsigned i = 0; i < header.node_count; ++i) {
    const BlockSize size = header.size(i);
    const Bytes block = record.subspan(at, static_cast<std::size_t>(size));
    const std::uint32_t block_at = place.offset + at;
    Node& node = ring_.node(i);
    node.wide = size == BlockSize::kWide;
    if (order == Order::kNext) {
      if (header.response) {
        if (!node.quiet.armed || !quick_response(context, node, block, block_at))
          push_response(context, node, block, block_at, size);
        answered = answered || node.answered;
      } else if (!node.quiet.armed || !quick_command(context, node, block, block_at)) {
        push_command(context, node, block, block_at, size);
      }
    }
    if (context.dissection != nullptr) decode(context, node, block, block_at, size, header.response);
    at += static_cast<std::uint32_t>(size);
  }
  return answered;
}

// Every axis has its block in each record: the record before is the frame before of all of them.
void Engine::link_previous(const Context& context, bool response) {
  const std::uint64_t frame = response ? ring_.last_response_frame : ring_.last_command.frame;
  if (frame == 0) return;
  const TimeNs time_ns = response ? ring_.last_response_time_ns : ring_.last_command.time_ns;
  context.dissection->links.push_back({.kind = LinkKind::kPreviousOfNode,
                                       .frame = frame,
                                       .after_ns = elapsed_ns(time_ns, context.frame.time_ns),
                                       .node = NodeRef{.bus = ring_.bus, .protocol = Protocol::kRtex}});
}

void Engine::decode(const Context& context, const Node& node, Bytes block, std::uint32_t block_at, BlockSize size,
                    bool response) {
  NodeRef ref = node.ref;
  // A response without C/R is no drive's answer yet (4-3-2): its MAC-ID says nothing, the command of the place does.
  const bool named = !response || read(slot(kResponse, "cr"), block) != 0 || ref.mac_id == kNoMacId;
  if (!node.mac_known && named) ref.mac_id = static_cast<std::int16_t>(read(slot(kCommand, "mac_id"), block));
  const BlockLayouts layouts =
      response ? layouts_of_response(block, size, node.format) : layouts_of_command(block, size, node.format);
  decode_block(layouts, block_at, ref, response ? Direction::kResponse : Direction::kCommand, *context.dissection);
  // Positions wrap at 32 bits (7-1-4-2).
  const bool has_position = response && layouts.count > 1 && layouts.words[1]->find("actual_position") != nullptr;
  if (has_position && read(slot(kResponse, "cr"), block) != 0 && node.have_command &&
      node.command.cyclic == static_cast<std::uint8_t>(Cyclic::kCp)) {
    const auto distance =
        static_cast<std::uint32_t>(node.command.data1) - static_cast<std::uint32_t>(load_le(block, kData1At, 4));
    context.dissection->derived.push_back(
        {.field = &kDeviationField, .protocol = "rtex", .value = static_cast<std::int32_t>(distance), .node = ref});
  }
}

// RX609: only the end of the capture shows that nothing followed.
void Engine::finish(const Context& context) {
  wake_all();
  for (const auto& node : ring_.nodes) {
    if (node == nullptr) continue;
    Scene scene = ring_scene(context);
    scene.node = node.get();
    for (const Knowledge::Waiting& entry : node->known.waiting()) {
      if (entry.lost || (entry.attribute != Attribute::kC && entry.attribute != Attribute::kR)) continue;
      ring_.findings.checked(rule("RX609"));
      report(scene, rule("RX609"), node->owner, {.arguments = {entry.index}, .related = {entry.frame, 0}});
    }
  }
}

}  // namespace servotrace::rtex
