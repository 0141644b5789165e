// SPDX-License-Identifier: MIT
#include "replay/report/collector.hpp"

#include <algorithm>

#include "decoder/core/slot.hpp"
#include "decoder/render/value.hpp"
#include "decoder/rtex/layouts.hpp"
#include "replay/report/node_key.hpp"
#include "replay/signals.hpp"

namespace servotrace::report {
namespace {

constexpr std::size_t kSeriesBins = 1024;

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

// The bytes of a message of up to eight; of a longer one nothing.
std::uint64_t image_of(Bytes bytes) {
  std::uint64_t image = 0;
  if (bytes.size() == 4) return load_le(bytes, 0, 4);
  if (bytes.size() == 8) return load_le64(bytes, 0);
  if (bytes.size() > sizeof image) return 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) image |= std::uint64_t{bytes[i]} << (8U * i);
  return image;
}

// Of such an image.
std::uint64_t byte_mask(std::size_t byte) { return byte < 8 ? std::uint64_t{0xFF} << 8U * byte : 0; }

}  // namespace

Collector::Collector(const Settings& settings, const std::vector<Watch>& watches, std::vector<WantedFrame> evidence)
    : settings_(settings), evidence_(std::move(evidence)) {
  for (const Watch& watch : watches) {
    close_ups_.emplace_back();
    close_ups_.back().watch = watch;
  }
}

std::size_t Collector::node_index(const NodeRef& node) {
  const std::uint64_t key = node_key(node);
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
    if (field.role == Role::kPlain || !is_number(field)) continue;
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
    (kept.is_state ? place.states : place.signals).push_back(kept);
    if (!kept.is_state) continue;
    for (unsigned byte = 0; byte < kept.slot.byte_count; ++byte)
      place.state_bytes |= byte_mask(kept.slot.first_byte + byte);
  }
  return place;
}

void Collector::add_segment(Node& node, std::size_t index, const RawFrame& frame, const Segment& segment, Bytes bytes) {
  Place& place = place_of(node, frame, *segment.layout, bytes);
  if (!place.states.empty()) add_states(node, frame, place, bytes);
  for (const Kept& kept : place.signals) add_signal(node, index, frame, *segment.layout, kept, read(kept.slot, bytes));
}

void Collector::add_states(Node& node, const RawFrame& frame, Place& place, Bytes bytes) {
  const std::uint64_t image = image_of(bytes) & place.state_bytes;
  if (place.size == bytes.size() && place.image == image && place.changes == node.changes) return;
  for (const Kept& kept : place.states) {
    const std::int64_t value = read(kept.slot, bytes);
    StateTrack& track = tracks_[kept.index];
    if (track.value == value) continue;
    ++node.changes;
    repeats_.note_change(kept.index);
    track.add({.time_ns = frame.time_ns,
               .frame = frame.number,
               .node = node.node,
               .layout = place.layout,
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
  repeats_.note_sample(kept.index, value);
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

// A code is looked for behind the fault's frame, which is taken apart, and then so is what comes before a record can
// repeat another.
bool Collector::wants_all(const RawFrame& frame) const {
  if (repeats_.are_entangled() || accesses_.are_entangled() || evidence_.is_due(frame.number)) return true;
  return std::any_of(close_ups_.begin(), close_ups_.end(),
                     [&](const CloseUp& close_up) { return close_up.looks_at(frame); });
}

void Collector::add(const RawFrame& frame, const Dissection& dissection) {
  if (dissection.repeats) {
    repeats_.add(frame.time_ns, dissection);
    times_.add(frame, dissection);
    return;
  }
  repeats_.begin(dissection);
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
  times_.add(frame, dissection);
  accesses_.add(frame, dissection);
}

void Collector::finish(Model& model) {
  repeats_.finish();
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
  times_.finish(model);
}

}  // namespace servotrace::report
