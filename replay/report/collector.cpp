// SPDX-License-Identifier: MIT
#include "replay/report/collector.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "decoder/core/slot.hpp"
#include "decoder/devicenet/derived.hpp"
#include "decoder/render/value.hpp"
#include "decoder/rtex/layouts.hpp"
#include "replay/signals.hpp"

namespace servotrace::report {
namespace {

constexpr std::size_t kSeriesBins = 1024;
constexpr std::size_t kCloseUpBins = 2048;
constexpr std::size_t kMaxNodes = 512;
constexpr std::size_t kScaleSamples = 64;  // intervals that choose the histogram's scale
constexpr std::size_t kHistogramBins = 60;

// Messages are kept for a fault from so long before its window on; those of DeviceNet always: a node that fell silent
// said its last word long ago.
constexpr DurationNs kMessagesBefore = 2 * kSecondNs;

constexpr std::string_view kCommandPosition = "command_position";
constexpr std::string_view kActualPosition = "actual_position";
constexpr DurationNs kFreshNs = 5 * kMillisecondNs;  // a command position older than this is no command of now
// No field of a message: what the axis lags behind, or a jump that waits for it.
constexpr Field kDistance = {.key = "command_minus_actual",
                             .label = "Command minus actual",
                             .width = 32,
                             .kind = Kind::kSigned,
                             .role = Role::kSignal,
                             .unit = Unit::kCommandUnit,
                             .section = "SX-DSV02203 7-1-1"};

std::uint64_t key_of(const NodeRef& node) {
  return static_cast<std::uint64_t>(node.bus.kind) << 60U | std::uint64_t{node.bus.interface_id} << 24U |
         std::uint64_t{node.bus.number} << 16U | (static_cast<std::uint64_t>(node.mac_id) & 0xFFU) << 8U;
}

// The bytes of a message of up to eight; of a longer one nothing.
std::uint64_t image_of(Bytes bytes) {
  std::uint64_t image = 0;
  if (bytes.size() == 4) return load_le(bytes, 0, 4);
  if (bytes.size() > sizeof image) return 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) image |= std::uint64_t{bytes[i]} << (8U * i);
  return image;
}

std::string text_of(const Field& field, std::int64_t raw, Bytes under) {
  return field.kind == Kind::kBytes || field.kind == Kind::kText ? bytes_text(field, under) : value_text(field, raw);
}

void count(Histogram& histogram, DurationNs value) {
  ++histogram.samples;
  if (value < histogram.first_ns) {
    ++histogram.below;
    return;
  }
  const auto bin = static_cast<std::size_t>((value - histogram.first_ns) / histogram.bin_ns);
  if (bin >= histogram.counts.size()) {
    ++histogram.above;
  } else {
    ++histogram.counts[bin];
  }
}

bool is_series(const Field& field) {
  return field.kind == Kind::kUnsigned || field.kind == Kind::kSigned || field.kind == Kind::kBool;
}

}  // namespace

Collector::Collector(const Settings& settings, const std::vector<Watch>& watches, std::vector<WantedFrame> evidence)
    : settings_(settings), evidence_(std::move(evidence)) {
  for (const Watch& watch : watches) {
    close_ups_.emplace_back();
    close_ups_.back().watch = watch;
  }
}

std::size_t Collector::node_index(const NodeRef& node) {
  const std::uint64_t key = key_of(node);
  if (key == last_key_ && last_node_) return *last_node_;
  const auto found = node_by_key_.find(key);
  if (found != node_by_key_.end()) {
    last_key_ = key;
    last_node_ = found->second;
    return found->second;
  }
  if (nodes_.size() >= kMaxNodes) return kMaxNodes;
  nodes_.emplace_back();
  nodes_.back().node = node;
  nodes_.back().node.channel = Channel::kNone;
  node_by_key_.emplace(key, nodes_.size() - 1);
  return nodes_.size() - 1;
}

// What is kept of a layout at a node; made at its first message.
Collector::Place& Collector::place_of(Node& node, const RawFrame& frame, const Layout& layout, Bytes bytes) {
  const std::size_t count = node.places.size();
  for (std::size_t i = 0, at = node.next_place; i < count; ++i, ++at) {
    if (at >= count) at = 0;
    if (node.places[at].layout != &layout) continue;
    node.next_place = at + 1;
    return node.places[at];
  }
  Place& place = node.places.emplace_back();
  place.layout = &layout;
  // A response header is one message, before Pr7.23 is known and after.
  const bool has_forms = rtex::is_response_header(layout);
  const Layout& shared = has_forms ? rtex::kResponse : layout;
  for (std::size_t i = 0; i < layout.fields.size(); ++i) {
    const Field& field = layout.fields[i];
    if (field.role == Role::kPlain || !is_series(field)) continue;
    Kept kept{.field = &field, .slot = slot_of(field), .index = 0, .is_state = field.role == Role::kState};
    auto& known = kept.is_state ? node.tracks : node.signals;
    const Field& first = shared.fields[i];
    const auto [entry, is_new] = known.try_emplace(&first, kept.is_state ? tracks_.size() : signals_.size());
    kept.index = entry->second;
    if (is_new && kept.is_state) {
      const std::int64_t value = read(kept.slot, bytes);
      tracks_.push_back({.node = node.node,
                         .layout = &shared,
                         .field = &first,
                         .first_ns = frame.time_ns,
                         .first_value = value,
                         .value = value});
    } else if (is_new) {
      signals_.push_back(
          {node.node, filter_name(layout, field), std::string(field.label), &field, Series(kSeriesBins)});
    }
    place.fields.push_back(kept);
  }
  return place;
}

void Collector::add_segment(Node& node, std::size_t index, const RawFrame& frame, const Segment& segment, Bytes bytes) {
  Place& place = place_of(node, frame, *segment.layout, bytes);
  const std::uint64_t image = image_of(bytes);
  const bool same =
      place.size != 0 && place.size == bytes.size() && place.image == image && place.changes == node.changes;
  for (Kept& kept : place.fields) {
    if (same && kept.is_state) continue;
    if (!same) kept.value = read(kept.slot, bytes);
    const std::int64_t value = kept.value;
    if (!kept.is_state) {
      add_signal(node, index, frame, *segment.layout, kept, value);
      continue;
    }
    StateTrack& track = tracks_[kept.index];
    if (track.value == value) continue;
    ++node.changes;
    track.add({.time_ns = frame.time_ns,
               .frame = frame.number,
               .node = node.node,
               .layout = segment.layout,
               .field = kept.field,
               .before = track.value,
               .after = value,
               .close_up = !open_.empty()});
  }
  place.image = image;
  place.size = bytes.size() <= sizeof image ? bytes.size() : 0;
  place.changes = node.changes;
}

void Collector::add_signal(Node& node, std::size_t index, const RawFrame& frame, const Layout& layout, const Kept& kept,
                           std::int64_t value) {
  signals_[kept.index].series.add(frame.time_ns, value);
  if (open_.empty()) return;
  add_close_up(frame, node, index, layout, *kept.field, value);
  if (kept.field->key == kCommandPosition) {
    node.commanded = value;
    node.commanded_ns = frame.time_ns;
    node.has_commanded = true;
  } else if (kept.field->key == kActualPosition && node.has_commanded &&
             elapsed_ns(node.commanded_ns, frame.time_ns) < kFreshNs) {
    // Positions wrap at 32 bits (SX-DSV02203 7-1-4-2).
    const auto distance =
        static_cast<std::int32_t>(static_cast<std::uint32_t>(node.commanded) - static_cast<std::uint32_t>(value));
    add_close_up(frame, node, index, layout, kDistance, distance);
  }
}

void Collector::add_close_up(const RawFrame& frame, const Node& node, std::size_t index, const Layout& layout,
                             const Field& field, std::int64_t value) {
  for (CloseUp* const entry : open_) {
    CloseUp& close_up = *entry;
    if (close_up.watch.node.mac_id != kNoMacId && key_of(close_up.watch.node) != key_of(node.node)) continue;
    const auto [place, fresh] = close_up.index.try_emplace({index, &field}, close_up.signals.size());
    if (fresh) {
      close_up.signals.push_back(
          {node.node, filter_name(layout, field), std::string(field.label), &field, Series(kCloseUpBins)});
    }
    close_up.signals[place->second].series.add(frame.time_ns, value);
  }
}

void Collector::add_snapshots(const RawFrame& frame, const Dissection& dissection) {
  // Only messages of watched nodes are kept, until their fault.
  for (CloseUp& close_up : close_ups_) {
    if (close_up.taken || close_up.watch.node.mac_id == kNoMacId) continue;
    if (dissection.protocol == Protocol::kRtex && elapsed_ns(frame.time_ns, close_up.watch.begin_ns) > kMessagesBefore)
      continue;
    const std::uint64_t wanted = key_of(close_up.watch.node);
    const std::size_t index = node_index(close_up.watch.node);
    if (index >= kMaxNodes) continue;
    Node& node = nodes_[index];
    Snapshot made;
    Parts kind;
    Direction direction = Direction::kNone;
    for (const Segment& segment : dissection.segments) {
      if (segment.node.mac_id == kNoMacId || key_of(segment.node) != wanted || segment.direction == Direction::kNone)
        continue;
      const Bytes bytes = dissection.bytes(segment);
      direction = segment.direction;
      made.parts.emplace_back(segment.layout, std::vector<std::uint8_t>(bytes.begin(), bytes.end()));
      kind.push_back(segment.layout);
    }
    if (made.parts.empty()) continue;
    made.frame = frame.number;
    const auto slot_index = static_cast<std::size_t>(direction);
    Told& told = node.told[slot_index][kind];
    node.last[slot_index] = &told;
    if (told.latest.frame != frame.number) {
      if (told.latest.frame != 0 && !told.latest.same_bytes(made)) told.before = std::move(told.latest);
      told.latest = std::move(made);
    }
  }
}

void Collector::take_messages(CloseUp& close_up) {
  close_up.taken = true;
  if (close_up.watch.node.mac_id == kNoMacId) return;
  const std::size_t index = node_index(close_up.watch.node);
  if (index >= kMaxNodes) return;
  const Node& node = nodes_[index];
  for (const Direction direction : {Direction::kCommand, Direction::kResponse}) {
    const Told* const told = node.last[static_cast<std::size_t>(direction)];
    if (told == nullptr) continue;
    const Snapshot& after = told->latest;
    const Snapshot& before = told->before;
    MessagePair pair;
    pair.direction = direction;
    pair.after_frame = after.frame;
    pair.before_frame = before.frame;
    for (const auto& [layout, bytes] : after.parts) {
      const std::vector<std::uint8_t>* old = nullptr;
      for (const auto& [other, other_bytes] : before.parts) {
        if (other == layout) old = &other_bytes;
      }
      for_each_field(*layout, bytes, [&, layout = layout](const Field& field, std::int64_t raw, Bytes under) {
        if (field.reserved) return;
        FieldRow row;
        row.filter = filter_name(*layout, field);
        row.label = std::string(field.label);
        row.after = text_of(field, raw, under);
        if (old != nullptr) {
          const Slot place = slot_of(field);
          row.before = text_of(field, place.width == 0 ? 0 : read(place, *old), bytes_of(field, *old));
        }
        row.differs = before.frame != 0 && row.before != row.after;
        pair.rows.push_back(std::move(row));
      });
    }
    close_up.messages.push_back(std::move(pair));
  }
}

// The alarm an asked drive answers with: the main number of RTEX (SX-DSV02203 6-6-2), the code of an NS310 (SIE-C718-7
// 5.3.4).
void Collector::look_for_code(CloseUp& close_up, const RawFrame& frame, const Dissection& dissection) {
  for (const Segment& segment : dissection.segments) {
    if (segment.direction != Direction::kResponse || key_of(segment.node) != key_of(close_up.watch.node)) continue;
    for (const std::string_view key : {"alarm_main", "alarm_code"}) {
      const Field* field = segment.layout->find(key);
      if (field == nullptr || !is_series(*field)) continue;
      const std::int64_t value = read(slot_of(*field), dissection.bytes(segment));
      if (value == 0) continue;
      close_up.code = value;
      close_up.code_frame = frame.number;
      close_up.code_text = value_text(*field, value);
      return;
    }
  }
}

void Collector::scale(Cycle& cycle) {
  // The middle of the picture is the median, its width a fifth of it each way: jitter is what is looked for.
  std::vector<DurationNs> sorted = cycle.first;
  std::sort(sorted.begin(), sorted.end());
  const DurationNs median = std::max<DurationNs>(sorted[sorted.size() / 2], 1);
  DurationNs spread = std::max<DurationNs>(median / 5, static_cast<DurationNs>(kHistogramBins));
  const DurationNs widest = std::max(sorted.back() - median, median - sorted.front());
  while (spread < widest && spread < median) spread *= 2;
  Histogram& histogram = cycle.histogram;
  histogram.first_ns = std::max<DurationNs>(median - spread, 0);
  histogram.bin_ns = std::max<DurationNs>(2 * spread / static_cast<DurationNs>(kHistogramBins), 1);
  histogram.counts.assign(kHistogramBins, 0);
}

Collector::Cycle* Collector::cycle_of(const BusRef& bus, std::string_view title) {
  for (Cycle& cycle : cycles_) {
    if (cycle.bus == bus && cycle.title == title) return &cycle;
  }
  if (cycles_.size() >= 64) return nullptr;
  Cycle& cycle = cycles_.emplace_back();
  cycle.bus = bus;
  cycle.title = title;
  cycle.histogram.bus = bus;
  cycle.histogram.title = std::string(title);
  return &cycle;
}

void Collector::add_interval(Cycle& cycle, DurationNs interval) {
  if (!cycle.histogram.counts.empty()) {
    count(cycle.histogram, interval);
    return;
  }
  cycle.first.push_back(interval);
  if (cycle.first.size() < kScaleSamples) return;
  scale(cycle);
  for (const DurationNs value : cycle.first) count(cycle.histogram, value);
}

void Collector::add_cycle(const RawFrame& frame, const Dissection& dissection) {
  if (dissection.protocol != Protocol::kRtex || dissection.direction != Direction::kCommand || !frame.has_time) return;
  Cycle* const cycle = cycle_of(dissection.bus, "Time between command records");
  if (cycle == nullptr) return;
  const DurationNs interval = elapsed_ns(cycle->last_ns, frame.time_ns);
  const bool usable = cycle->has_last && interval >= 0;
  cycle->last_ns = frame.time_ns;
  cycle->has_last = true;
  if (usable) add_interval(*cycle, interval);
}

// Poll intervals and response times of DeviceNet: the session measured them.
void Collector::add_times(const Dissection& dissection) {
  if (dissection.protocol != Protocol::kDevicenet) return;
  bool is_poll = false;
  for (const Derived& derived : dissection.derived) {
    if (derived.field == &devicenet::kMessageField) is_poll = derived.text.starts_with("Poll");
  }
  for (const Derived& derived : dissection.derived) {
    std::string_view title;
    if (derived.field == &devicenet::kPollIntervalField) title = "Time between poll commands of a node";
    if (derived.field == &devicenet::kResponseTimeField)
      title = is_poll ? "Poll response time" : "Explicit response time";
    if (title.empty() || derived.value < 0) continue;
    if (Cycle* const cycle = cycle_of(dissection.bus, title); cycle != nullptr) add_interval(*cycle, derived.value);
  }
}

// A base frame of n data bytes takes 47 + 8n bits with the space behind it, without stuff bits (ISO 11898-1). The data
// of a SocketCAN record begins at byte 8.
void Collector::add_load(const RawFrame& frame, const Dissection& dissection) {
  if (dissection.protocol != Protocol::kDevicenet || !frame.has_time || frame.bytes.size() < 8) return;
  auto found =
      std::find_if(loads_.begin(), loads_.end(), [&](const Load& load) { return load.load.bus == dissection.bus; });
  if (found == loads_.end()) {
    if (loads_.size() >= 64) return;
    loads_.push_back({{.bus = dissection.bus}, frame.time_ns, 0});
    found = loads_.end() - 1;
  }
  const std::uint64_t bits = 47 + 8 * std::min<std::uint64_t>(frame.bytes.size() - 8, 8);
  found->load.bits += bits;
  const DurationNs into = elapsed_ns(found->window_ns, frame.time_ns);
  if (into < 0 || into >= kLoadWindowNs) {
    found->window_ns = frame.time_ns;
    found->window_bits = 0;
  }
  found->window_bits += bits;
  found->load.peak_bits = std::max(found->load.peak_bits, found->window_bits);
}

void Collector::add(const RawFrame& frame, const Dissection& dissection) {
  evidence_.add(frame, dissection, settings_);
  if (dissection.protocol == Protocol::kNone) return;
  open_.clear();
  for (CloseUp& close_up : close_ups_) {
    if (frame.time_ns >= close_up.watch.begin_ns && frame.time_ns <= close_up.watch.end_ns) open_.push_back(&close_up);
  }
  replay::Answered answered;
  for (const Segment& segment : dissection.segments) {
    if (!answered(dissection, segment) || segment.node.mac_id == kNoMacId || segment.direction == Direction::kNone)
      continue;
    const std::size_t index = node_index(segment.node);
    if (index != kMaxNodes) add_segment(nodes_[index], index, frame, segment, dissection.bytes(segment));
  }
  add_snapshots(frame, dissection);
  for (CloseUp& close_up : close_ups_) {
    if (!close_up.taken && frame.number >= close_up.watch.frame) take_messages(close_up);
    if (close_up.watch.wants_code && close_up.code_frame == 0 && frame.number > close_up.watch.frame &&
        dissection.direction == Direction::kResponse) {
      look_for_code(close_up, frame, dissection);
    }
  }
  add_cycle(frame, dissection);
  add_times(dissection);
  add_load(frame, dissection);
  accesses_.add(frame, dissection);
}

void Collector::finish(Model& model) {
  model.tracks = std::move(tracks_);
  model.signals = std::move(signals_);
  model.evidence = evidence_.take();
  for (std::size_t i = 0; i < close_ups_.size() && i < model.faults.size(); ++i) {
    model.faults[i].signals = std::move(close_ups_[i].signals);
    model.faults[i].messages = std::move(close_ups_[i].messages);
    model.faults[i].code = close_ups_[i].code;
    model.faults[i].code_frame = close_ups_[i].code_frame;
    model.faults[i].code_text = std::move(close_ups_[i].code_text);
  }
  model.accesses = accesses_.take();
  model.more_accesses = accesses_.dropped();
  for (const Load& load : loads_) model.loads.push_back(load.load);
  for (Cycle& cycle : cycles_) {
    if (cycle.histogram.counts.empty()) {
      if (cycle.first.empty()) continue;
      scale(cycle);
      for (const DurationNs value : cycle.first) count(cycle.histogram, value);
    }
    model.histograms.push_back(std::move(cycle.histogram));
  }
}

}  // namespace servotrace::report
