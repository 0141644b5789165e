// SPDX-License-Identifier: GPL-2.0-or-later
#include "dissector/tree.hpp"

#include <algorithm>
#include <type_traits>

#include "decoder/core/slot.hpp"
#include "decoder/devicenet/derived.hpp"
#include "decoder/findings/catalogue.hpp"
#include "dissector/columns.hpp"
#include "dissector/fields.hpp"
#include "dissector/text.hpp"

namespace servotrace::plugin {
namespace {

// Places where findings and values of a node are hung up: the tree of each node, and the item of each segment.
struct NodePlace {
  NodeRef node;
  proto_tree* tree = nullptr;
  proto_item* item = nullptr;
};

struct Canvas {
  packet_info* pinfo = nullptr;
  const Visit* frame = nullptr;
  tvbuff_t* reassembled = nullptr;
  proto_tree* tree = nullptr;  // nullptr: nobody looks
  bool whole = false;          // everything is drawn; else what a filter or a statistic names
  proto_tree* main = nullptr;  // of the frame's own protocol
  proto_item* main_item = nullptr;
  SmallVector<NodePlace, 80> nodes;
  proto_item* segment_items[decltype(Dissection::segments)::capacity()] = {};
};

bool wants(const Canvas& canvas, int id) {
  return canvas.whole || (id >= 0 && proto_field_is_referenced(canvas.tree, id) != 0);
}

bool same_node(const NodeRef& a, const NodeRef& b) {
  return a.bus == b.bus && a.protocol == b.protocol && a.mac_id == b.mac_id && a.place == b.place;
}

const NodePlace* place_of(const Canvas& canvas, const NodeRef& node) {
  for (const NodePlace& place : canvas.nodes) {
    if (same_node(place.node, node)) return &place;
  }
  return nullptr;
}

proto_tree* tree_of(const Canvas& canvas, const NodeRef& node) {
  const NodePlace* const place = place_of(canvas, node);
  return place != nullptr ? place->tree : canvas.main;
}

tvbuff_t* tvb_of(const Canvas& canvas, const Segment& segment) {
  return segment.buffer == Buffer::kFrame ? canvas.frame->tvb : canvas.reassembled;
}

// Where a value lies.
struct Place {
  tvbuff_t* tvb = nullptr;
  int offset = 0;
  int length = 0;
};

// Hidden: the row itself shows the value. For graphs and filters.
void draw_axis_signal(const Canvas& canvas, proto_tree* tree, const Signal* of, std::int16_t mac_id, const Field& field,
                      std::int64_t value, const Place& at) {
  const AxisSignal signal = axis_signal(of, mac_id);
  if (signal.field < 0 || !wants(canvas, signal.field)) return;
  const double scaled = static_cast<double>(value) * field.scale.numerator / field.scale.denominator;
  proto_item_set_hidden(signal.scaled ? proto_tree_add_double(tree, signal.field, at.tvb, at.offset, at.length, scaled)
                                      : proto_tree_add_int64(tree, signal.field, at.tvb, at.offset, at.length, value));
}

unsigned encoding_of(const Field& field) {
  if (field.kind == Kind::kText) return unsigned{ENC_ASCII} | unsigned{ENC_NA};
  if (field.kind == Kind::kBytes) return ENC_NA;
  return field.order == ByteOrder::kBig ? unsigned{ENC_BIG_ENDIAN} : unsigned{ENC_LITTLE_ENDIAN};
}

// Returns the item, nullptr where nothing was drawn.
proto_item* draw_field(const Canvas& canvas, proto_tree* tree, const Segment& segment, Bytes bytes,
                       const LayoutFields& ids, std::size_t row) {
  const Field& field = segment.layout->fields[row];
  const std::size_t size = field.width == 0 ? bytes.size() - field.first_byte() : field.byte_count();
  if (size == 0) return nullptr;
  const bool is_number = field.kind != Kind::kBytes && field.kind != Kind::kText;
  const std::int64_t value = is_number ? read(slot_of(field), bytes) : 0;
  if (field.reserved && value == 0) return nullptr;
  const Place at{tvb_of(canvas, segment), static_cast<int>(segment.offset + field.first_byte()),
                 static_cast<int>(size)};
  proto_item* item = nullptr;
  if (wants(canvas, ids.fields[row]))
    item = proto_tree_add_item(tree, ids.fields[row], at.tvb, at.offset, at.length, encoding_of(field));
  if (!is_number) return item;
  draw_axis_signal(canvas, tree, ids.signals[row], segment.node.mac_id, field, value, at);
  if (!is_visible(tree)) return item;
  const char* const unit = unit_text(canvas.pinfo->pool, field, value);
  if (*unit != '\0') proto_item_append_text(item, "%s", unit);
  const ValueName* const name = find_value(field.values, value);
  if (name != nullptr && !name->explanation.empty())
    proto_item_append_text(item, ": %s", pool_text(canvas.pinfo->pool, name->explanation));
  return item;
}

void draw_segment(Canvas& canvas, proto_tree* parent, std::size_t index) {
  const Dissection& dissection = *canvas.frame->dissection;
  const Segment& segment = dissection.segments[index];
  const LayoutFields ids = fields_of(segment.layout);
  const Bytes bytes = dissection.bytes(segment);
  tvbuff_t* const tvb = tvb_of(canvas, segment);
  if (ids.fields == nullptr || tvb == nullptr) return;
  if (segment.layout->fields.size() == 1 && !segment.guessed) {  // its only row says it all
    canvas.segment_items[index] = draw_field(canvas, parent, segment, bytes, ids, 0);
    return;
  }
  proto_tree* tree = parent;
  if (canvas.whole) {
    tree = proto_tree_add_subtree_format(parent, tvb, static_cast<int>(segment.offset),
                                         static_cast<int>(segment.length), ids.subtree, &canvas.segment_items[index],
                                         "%s%s", pool_text(canvas.pinfo->pool, segment.layout->title),
                                         segment.guessed ? " (guessed)" : "");
  }
  for (std::size_t i = 0; i < segment.layout->fields.size(); ++i) draw_field(canvas, tree, segment, bytes, ids, i);
}

// How far the run of segments from `index` on goes that `same` holds together, and the frame bytes under it.
template <class Same>
std::size_t run_end(const Dissection& dissection, std::size_t index, ByteRange& range, Same same) {
  std::uint32_t begin = UINT32_MAX;
  std::uint32_t end = 0;
  std::size_t next = index;
  for (; next < dissection.segments.size() && same(dissection.segments[next]); ++next) {
    const Segment& segment = dissection.segments[next];
    if (segment.buffer != Buffer::kFrame) continue;
    begin = segment.offset < begin ? segment.offset : begin;
    end = segment.offset + segment.length > end ? segment.offset + segment.length : end;
  }
  range = begin < end ? ByteRange{begin, end - begin} : ByteRange{};
  return next;
}

// The segments of one node of a ring under one subtree; those of a whole record, and all of DeviceNet (whose frames
// are of one node anyway), straight below the protocol.
std::size_t draw_node(Canvas& canvas, proto_tree* parent, std::size_t index, std::size_t end) {
  const Dissection& dissection = *canvas.frame->dissection;
  const Segment& first = dissection.segments[index];
  const bool whole_record = first.node.mac_id == kNoMacId && first.layout->key == "record";
  if (first.node.protocol != Protocol::kRtex || whole_record || !canvas.whole) {
    draw_segment(canvas, parent, index);
    return index + 1;
  }
  ByteRange range;
  std::size_t next = run_end(dissection, index, range,
                             [&first](const Segment& segment) { return same_node(segment.node, first.node); });
  next = next < end ? next : end;
  proto_item* item = nullptr;
  proto_tree* const tree = proto_tree_add_subtree_format(parent, canvas.frame->tvb, static_cast<int>(range.offset),
                                                         static_cast<int>(range.length), subtrees().node, &item, "%s",
                                                         node_text(canvas.pinfo->pool, first.node));
  canvas.nodes.push_back({first.node, tree, item});
  for (std::size_t i = index; i < next; ++i) draw_segment(canvas, tree, i);
  return next;
}

void draw_protocols(Canvas& canvas) {
  const Dissection& dissection = *canvas.frame->dissection;
  std::size_t index = 0;
  while (index < dissection.segments.size()) {
    const std::string_view protocol = dissection.segments[index].layout->protocol;
    ByteRange range;
    const std::size_t end = run_end(
        dissection, index, range, [protocol](const Segment& segment) { return segment.layout->protocol == protocol; });
    const int id = protocol_id(protocol);
    proto_item* const item = proto_tree_add_item(canvas.tree, id, canvas.frame->tvb, static_cast<int>(range.offset),
                                                 static_cast<int>(range.length), ENC_NA);
    proto_tree* const tree = proto_item_add_subtree(item, subtrees().protocol);
    if (canvas.main == nullptr) {
      canvas.main = tree;
      canvas.main_item = item;
    }
    // Where nobody asks for the protocol, nobody asks for one of its fields either.
    const bool wanted = wants(canvas, id);
    while (wanted && index < end) index = draw_node(canvas, tree, index, end);
    index = end;
  }
  if (canvas.main != nullptr || dissection.protocol == Protocol::kNone) return;
  const int id = protocol_id(dissection.protocol == Protocol::kRtex ? "rtex" : "dnet");
  canvas.main_item = proto_tree_add_item(canvas.tree, id, canvas.frame->tvb, 0, -1, ENC_NA);
  canvas.main = proto_item_add_subtree(canvas.main_item, subtrees().protocol);
}

void draw_derived(const Canvas& canvas, const Derived& derived) {
  const DerivedIds ids = ids_of(derived);
  const int id = ids.field;
  proto_tree* const tree = tree_of(canvas, derived.node);
  if (id < 0 || tree == nullptr) return;
  tvbuff_t* const tvb = canvas.frame->tvb;
  proto_item* item = nullptr;
  draw_axis_signal(canvas, tree, ids.signal, derived.node.mac_id, *derived.field, derived.value, {tvb, 0, 0});
  if (!wants(canvas, id)) return;
  const bool wide = derived.field->width == 0 || derived.field->byte_count() > 4;
  switch (derived.field->kind) {
    case Kind::kText:
      item = proto_tree_add_string(tree, id, tvb, 0, 0, pool_text(canvas.pinfo->pool, derived.text));
      break;
    case Kind::kBool:
      item = proto_tree_add_boolean(tree, id, tvb, 0, 0, derived.value != 0 ? 1 : 0);
      break;
    case Kind::kBytes:
      return;
    case Kind::kSigned:
    case Kind::kUnsigned:
      if (derived.field->kind == Kind::kSigned) {
        item = wide ? proto_tree_add_int64(tree, id, tvb, 0, 0, derived.value)
                    : proto_tree_add_int(tree, id, tvb, 0, 0, static_cast<int>(derived.value));
      } else {
        item = wide ? proto_tree_add_uint64(tree, id, tvb, 0, 0, static_cast<std::uint64_t>(derived.value))
                    : proto_tree_add_uint(tree, id, tvb, 0, 0, static_cast<std::uint32_t>(derived.value));
      }
      if (is_visible(tree)) {
        const char* const unit = unit_text(canvas.pinfo->pool, *derived.field, derived.value);
        if (*unit != '\0') proto_item_append_text(item, "%s", unit);
      }
      break;
  }
  proto_item_set_generated(item);
  if (derived.field == &devicenet::kResponseTimeField) proto_item_set_hidden(item);  // the link says it in seconds
}

void draw_frame_link(const Canvas& canvas, proto_tree* tree, int id, std::uint64_t number) {
  if (number == 0 || !wants(canvas, id)) return;
  proto_item_set_generated(proto_tree_add_uint(tree, id, canvas.frame->tvb, 0, 0, static_cast<std::uint32_t>(number)));
}

void draw_time(const Canvas& canvas, proto_tree* tree, int id, DurationNs after_ns) {
  if (!wants(canvas, id)) return;
  const nstime_t time = {static_cast<time_t>(after_ns / kSecondNs), static_cast<int>(after_ns % kSecondNs)};
  proto_item_set_generated(proto_tree_add_time(tree, id, canvas.frame->tvb, 0, 0, &time));
}

void draw_links(const Canvas& canvas) {
  const Dissection& dissection = *canvas.frame->dissection;
  const LinkFields& fields = link_fields(dissection.protocol);
  for (const Link& link : dissection.links) {
    proto_tree* const tree = tree_of(canvas, link.node);
    switch (link.kind) {
      case LinkKind::kRequestIn:
        draw_frame_link(canvas, tree, fields.request_in, link.frame);
        draw_time(canvas, tree, fields.response_time, link.after_ns);
        break;
      case LinkKind::kAcceptedIn:
        draw_frame_link(canvas, tree, fields.accepted_command, link.frame);
        break;
      case LinkKind::kPreviousOfNode:
        draw_frame_link(canvas, tree, fields.previous_in, link.frame);
        break;
      case LinkKind::kFirstFragment:
        draw_frame_link(canvas, tree, fields.first_fragment, link.frame);
        break;
      case LinkKind::kReassembledFrom:
        draw_frame_link(canvas, tree, fields.fragment, link.frame);
        break;
    }
  }
  // Known once the frames behind it were read, and sought only where somebody looks.
  if (canvas.pinfo->fd->visited && wants(canvas, fields.next_in)) {
    const NextOfNode next = next_of_node(canvas.frame->number);
    draw_frame_link(canvas, tree_of(canvas, next.node), fields.next_in, next.frame);
  }
  for (const FrameStore::Answer& answer : answers_of(canvas.frame->number)) {
    proto_tree* const tree = tree_of(canvas, answer.node);
    switch (answer.kind) {
      case LinkKind::kRequestIn:
        draw_frame_link(canvas, tree, fields.response_in, answer.frame);
        break;
      case LinkKind::kAcceptedIn:
        draw_frame_link(canvas, tree, fields.accepted_in, answer.frame);
        break;
      case LinkKind::kReassembledFrom:
      case LinkKind::kFirstFragment:
        draw_frame_link(canvas, tree, fields.reassembled_in, answer.frame);
        break;
      case LinkKind::kPreviousOfNode:
        break;
    }
  }
}

// The innermost item the finding is about: the smallest segment of its node that holds its bytes, else the node, else
// the protocol.
proto_item* item_of(const Canvas& canvas, const Finding& finding) {
  const Dissection& dissection = *canvas.frame->dissection;
  proto_item* best = nullptr;
  std::uint32_t best_length = UINT32_MAX;
  for (std::size_t i = 0; finding.where.length != 0 && i < dissection.segments.size(); ++i) {
    const Segment& segment = dissection.segments[i];
    if (segment.buffer != Buffer::kFrame || canvas.segment_items[i] == nullptr) continue;
    if (finding.where.offset < segment.offset ||
        finding.where.offset + finding.where.length > segment.offset + segment.length || segment.length >= best_length)
      continue;
    best = canvas.segment_items[i];
    best_length = segment.length;
  }
  if (best != nullptr) return best;
  const NodePlace* const place = place_of(canvas, finding.node);
  return place != nullptr ? place->item : canvas.main_item;
}

const char* basis_text(BasisKind kind) {
  switch (kind) {
    case BasisKind::kConfigured:
      return "configured";
    case BasisKind::kCapture:
      return "capture";
    case BasisKind::kAssumed:
      return "assumed";
    case BasisKind::kNone:
      break;
  }
  return nullptr;
}

void draw_finding(Canvas& canvas, proto_tree* parent, const Finding& finding) {
  wmem_allocator_t* const pool = canvas.pinfo->pool;
  const Rule& row = rule_row(finding.rule);
  const char* const text = message_text(pool, finding);
  const char* const node = node_text(pool, finding.node);
  const char* const id = pool_text(pool, row.id);
  proto_item* target = item_of(canvas, finding);
  if (parent != nullptr) {
    const FindingFields& f = finding_fields();
    tvbuff_t* const tvb = canvas.frame->tvb;
    const std::uint32_t size = tvb_captured_length(tvb);
    const bool inside = finding.where.offset <= size && finding.where.length <= size - finding.where.offset;
    const int offset = inside ? static_cast<int>(finding.where.offset) : 0;
    const int length = inside ? static_cast<int>(finding.where.length) : 0;
    proto_item* item = nullptr;
    proto_tree* const tree =
        proto_tree_add_subtree_format(parent, tvb, offset, length, subtrees().finding, &item, "%s[%s] %s: %s",
                                      pool_text(pool, name_of(finding.severity)), id, node, text);
    if (target == nullptr) target = item;
    const auto add = [&](int field, const char* value) {
      if (value != nullptr) proto_item_set_generated(proto_tree_add_string(tree, field, tvb, offset, length, value));
    };
    add(f.rule, id);
    add(f.slug, pool_text(pool, row.slug));
    add(f.severity, pool_text(pool, name_of(finding.severity)));
    add(f.actor, pool_text(pool, name_of(finding.actor)));
    add(f.title, pool_text(pool, row.title));
    add(f.message, text);
    add(f.node, node);
    if (finding.node.mac_id != kNoMacId)
      proto_item_set_generated(
          proto_tree_add_uint(tree, f.mac_id, tvb, offset, length, static_cast<std::uint32_t>(finding.node.mac_id)));
    for (const std::uint64_t related : finding.related) draw_frame_link(canvas, tree, f.related, related);
    if (finding.cause.frame != 0) {
      add(f.cause, pool_text(pool, rule_row(finding.cause.rule).id));
      draw_frame_link(canvas, tree, f.cause_frame, finding.cause.frame);
    }
    add(f.basis, basis_text(finding.basis.kind));
    if (finding.basis.kind == BasisKind::kCapture) draw_frame_link(canvas, tree, f.basis_frame, finding.basis.frame);
    if (finding.count > 1) {
      proto_item_set_generated(proto_tree_add_uint(tree, f.count, tvb, offset, length, finding.count));
      draw_frame_link(canvas, tree, f.last_frame, finding.last_frame);
    }
    add(f.section, pool_text(pool, row.section));
    add(f.why, pool_text(pool, row.why));
    add(f.fix, pool_text(pool, row.fix));
  }
  expert_add_info_format(canvas.pinfo, target, expert_of(finding.rule, finding.severity), "%s %s: %s", id, node, text);
}

void draw_findings(Canvas& canvas) {
  std::uint32_t shown = 0;
  for (Finding finding : canvas.frame->findings) shown += shown_finding(finding) ? 1U : 0U;
  if (shown == 0) return;
  proto_tree* tree = nullptr;
  if (canvas.tree != nullptr) {
    proto_item* const item =
        proto_tree_add_protocol_format(canvas.tree, servotrace_protocol_id(), canvas.frame->tvb, 0, 0,
                                       "servotrace, %u finding%s", shown, shown == 1 ? "" : "s");
    tree = proto_item_add_subtree(item, subtrees().findings);
  }
  for (Finding finding : canvas.frame->findings) {
    if (shown_finding(finding)) draw_finding(canvas, tree, finding);
  }
}

static_assert(std::is_trivially_destructible_v<Canvas>);

// One for all frames: its lists are long, and cleared sooner than made.
Canvas& cleared_canvas(packet_info* pinfo, proto_tree* tree, const Visit& frame) {
  static Canvas canvas;
  canvas.pinfo = pinfo;
  canvas.frame = &frame;
  canvas.reassembled = nullptr;
  canvas.tree = tree;
  // Findings hang on what they are about, so a frame that has one is drawn whole.
  canvas.whole = is_visible(tree) || (tree != nullptr && !frame.findings.empty());
  canvas.main = nullptr;
  canvas.main_item = nullptr;
  canvas.nodes.clear();
  std::fill_n(canvas.segment_items, frame.dissection->segments.size(), nullptr);
  return canvas;
}

}  // namespace

void draw(packet_info* pinfo, proto_tree* tree, const Visit& frame) {
  draw_columns(pinfo, frame);
  if (tree == nullptr && frame.findings.empty()) return;
  const Dissection& dissection = *frame.dissection;
  Canvas& canvas = cleared_canvas(pinfo, tree, frame);
  if (tree != nullptr) {
    const Bytes reassembled = dissection.reassembled;
    if (!reassembled.empty()) {
      // A copy that lives as long as what is drawn here: a window of this packet outlasts a reload, the store does not.
      const auto size = static_cast<std::uint32_t>(reassembled.size());
      const auto* const copy = static_cast<const std::uint8_t*>(wmem_memdup(pinfo->pool, reassembled.data(), size));
      canvas.reassembled = tvb_new_child_real_data(frame.tvb, copy, size, static_cast<int>(size));
      add_new_data_source(pinfo, canvas.reassembled, "Reassembled message");
    }
    draw_protocols(canvas);
    for (const Derived& derived : dissection.derived) draw_derived(canvas, derived);
    if (dissection.protocol != Protocol::kNone) draw_links(canvas);
  }
  draw_findings(canvas);
}

}  // namespace servotrace::plugin
