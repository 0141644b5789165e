// SPDX-License-Identifier: MIT
// What the collector keeps around faults: series at full resolution, messages, and the code read afterwards.
#include "decoder/core/slot.hpp"
#include "decoder/render/value.hpp"
#include "replay/report/collector.hpp"
#include "replay/report/node_key.hpp"

namespace servotrace::report {
namespace {

constexpr std::size_t kCloseUpBins = 2048;

// Messages are kept for a fault from so long before its window on; those of DeviceNet always: a node that fell silent
// said its last word long ago.
constexpr DurationNs kMessagesBefore = 2 * kSecondNs;

std::string text_of(const Field& field, std::int64_t raw, Bytes under) {
  return field.kind == Kind::kBytes || field.kind == Kind::kText ? bytes_text(field, under) : value_text(field, raw);
}

}  // namespace

void Collector::add_close_up(const RawFrame& frame, const Node& node, std::size_t index, const Layout& layout,
                             const Field& field, std::int64_t value) {
  for (CloseUp* const entry : open_) {
    CloseUp& close_up = *entry;
    if (close_up.watch.node.mac_id != kNoMacId && node_key(close_up.watch.node) != node_key(node.node)) continue;
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
    const std::uint64_t wanted = node_key(close_up.watch.node);
    const std::size_t index = node_index(close_up.watch.node);
    if (index >= kMaxNodes) continue;
    Node& node = nodes_[index];
    Snapshot made;
    Parts kind;
    Direction direction = Direction::kNone;
    for (const Segment& segment : dissection.segments) {
      if (segment.node.mac_id == kNoMacId || node_key(segment.node) != wanted || segment.direction == Direction::kNone)
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
    if (segment.direction != Direction::kResponse || node_key(segment.node) != node_key(close_up.watch.node)) continue;
    for (const std::string_view key : {"alarm_main", "alarm_code"}) {
      const Field* field = segment.layout->find(key);
      if (field == nullptr || !is_number(*field)) continue;
      const std::int64_t value = read(slot_of(*field), dissection.bytes(segment));
      if (value == 0) continue;
      close_up.code = value;
      close_up.code_frame = frame.number;
      close_up.code_text = value_text(*field, value);
      return;
    }
  }
}

bool Collector::CloseUp::looks_at(const RawFrame& frame) const {
  if (frame.number == watch.frame || (frame.time_ns >= watch.begin_ns && frame.time_ns <= watch.end_ns)) return true;
  if (taken || watch.node.mac_id == kNoMacId) return false;
  return frame.number > watch.frame || elapsed_ns(frame.time_ns, watch.begin_ns) <= kMessagesBefore;
}

}  // namespace servotrace::report
