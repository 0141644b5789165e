// SPDX-License-Identifier: GPL-2.0-or-later
#include "dissector/statistics.hpp"

#include <map>
#include <string>

#include "decoder/findings/catalogue.hpp"
#include "decoder/link/rtex_record.hpp"
#include "decoder/rtex/layouts.hpp"
#include "dissector/text.hpp"

namespace servotrace::plugin {
namespace {

int& tap() {
  static int id = -1;
  return id;
}

const Visit& frame_of(const void* data) { return *static_cast<const Visit*>(data); }

// A node of a statistics tree that has children, made on first use.
int branch(stats_tree* tree, const char* name, int parent) { return tick_stat_node(tree, name, parent, TRUE); }
// The same, not counted.
int place(stats_tree* tree, const char* name, int parent) { return increase_stat_node(tree, name, parent, TRUE, 0); }
void leaf(stats_tree* tree, const char* name, int parent) { tick_stat_node(tree, name, parent, FALSE); }
// A leaf with count, average, minimum and maximum.
void measure(stats_tree* tree, const char* name, int parent, double value) {
  avg_stat_node_add_value_float(tree, name, parent, FALSE, static_cast<gfloat>(value));
}

// --- findings -------------------------------------------------------------------------------------------------------

tap_packet_status count_findings(stats_tree* tree, packet_info* pinfo, epan_dissect_t*, const void* data, tap_flags_t) {
  const Visit& frame = frame_of(data);
  bool any = false;
  for (Finding finding : frame.findings) {
    if (!shown_finding(finding)) continue;
    const Rule& row = rule_row(finding.rule);
    const int severity = branch(tree, pool_text(pinfo->pool, name_of(finding.severity)), 0);
    const char* const rule =
        wmem_strdup_printf(pinfo->pool, "%s %s", pool_text(pinfo->pool, row.id), pool_text(pinfo->pool, row.title));
    leaf(tree, node_text(pinfo->pool, finding.node), branch(tree, rule, severity));
    any = true;
  }
  return any ? TAP_PACKET_REDRAW : TAP_PACKET_DONT_REDRAW;
}

// --- RTEX ring ------------------------------------------------------------------------------------------------------

// The times of the last command record of each ring, of each window that is open.
struct RingKey {
  const stats_tree* tree = nullptr;
  std::uint32_t interface_id = 0;
  std::uint8_t ring = 0;
  auto operator<=>(const RingKey&) const = default;
};
struct LastCommand {
  std::int64_t time_ns = 0;
  std::int64_t sequence = -1;
};
std::map<RingKey, LastCommand>& last_commands() {
  static std::map<RingKey, LastCommand> instance;
  return instance;
}

void forget_ring(stats_tree* tree) {
  std::erase_if(last_commands(), [tree](const auto& entry) { return entry.first.tree == tree; });
}

const char* deviation_text(double percent) {
  if (percent < 1) return "below 1 %";
  if (percent < 5) return "1 to 5 %";
  if (percent < 20) return "5 to 20 %";
  if (percent < 50) return "20 to 50 %";
  return "50 % and more";
}

void count_cycle(stats_tree* tree, const packet_info& pinfo, const Visit& frame, Bytes record, int ring) {
  const BusRef& bus = frame.dissection->bus;
  const std::int64_t time_ns = std::int64_t{pinfo.abs_ts.secs} * kSecondNs + pinfo.abs_ts.nsecs;
  const bool has_sequence = read(slot(rtex::kRecord, "sequence_valid"), record) != 0;
  const std::int64_t sequence = has_sequence ? read(slot(rtex::kRecord, "sequence"), record) : -1;
  LastCommand& last = last_commands()[{tree, bus.interface_id, bus.number}];
  // Across lost records there is no cycle to measure.
  const bool follows = last.time_ns != 0 && has_sequence && sequence == last.sequence + 1;
  const auto interval_ns = static_cast<double>(time_ns - last.time_ns);
  last = {time_ns, sequence};
  if (!follows) return;
  measure(tree, "Time between commands (us)", ring, interval_ns / 1e3);
  if (read(slot(rtex::kRecord, "cycle_valid"), record) == 0) return;
  const auto cycle_ns = static_cast<double>(read(slot(rtex::kRecord, "cycle_ns"), record));
  if (cycle_ns <= 0) return;
  const double deviation = (interval_ns > cycle_ns ? interval_ns - cycle_ns : cycle_ns - interval_ns) / cycle_ns * 100;
  leaf(tree, deviation_text(deviation), branch(tree, "Deviation from the communication cycle", ring));
}

tap_packet_status count_ring(stats_tree* tree, packet_info* pinfo, epan_dissect_t*, const void* data, tap_flags_t) {
  const Visit& frame = frame_of(data);
  const Dissection& dissection = *frame.dissection;
  if (dissection.protocol != Protocol::kRtex) return TAP_PACKET_DONT_REDRAW;
  const int ring = branch(tree, wmem_strdup_printf(pinfo->pool, "ring%u", unsigned{dissection.bus.number}), 0);
  leaf(tree, dissection.direction == Direction::kCommand ? "Command records" : "Response records", ring);
  for (const Segment& segment : dissection.segments) {
    if (segment.layout == &rtex::kRecord && dissection.direction == Direction::kCommand)
      count_cycle(tree, *pinfo, frame, dissection.bytes(segment), ring);
    if (segment.layout == &rtex::kCommunicationError)
      leaf(tree, node_text(pinfo->pool, segment.node), branch(tree, "Communication error responses", ring));
  }
  for (Finding finding : frame.findings) {
    const std::string_view id = rule_row(finding.rule).id;
    if (id.substr(0, 4) != "RX20" || !shown_finding(finding)) continue;
    leaf(tree, node_text(pinfo->pool, finding.node), branch(tree, "Update_Counter findings", ring));
  }
  return TAP_PACKET_REDRAW;
}

// --- RTEX handshakes ------------------------------------------------------------------------------------------------

// The names of a node's non-cyclic command and of its Type_Code, as its response echoes them: "Parameter, read".
const char* handshake_text(wmem_allocator_t* pool, const Dissection& dissection, const NodeRef& node) {
  const char* command = nullptr;
  const char* type = nullptr;
  const auto name_of_value = [&](const Segment& segment, std::string_view key) -> const char* {
    const Field* const field = segment.layout->find(key);
    if (field == nullptr) return nullptr;
    const std::int64_t value = read(slot_of(*field), dissection.bytes(segment));
    const ValueName* const name = find_value(field->values, value);
    return name != nullptr ? pool_text(pool, name->name)
                           : wmem_strdup_printf(pool, "%02Xh", static_cast<unsigned>(value & 0xFFF));
  };
  const bool sub = node.channel == Channel::kSub;
  for (const Segment& segment : dissection.segments) {
    if (segment.node.place != node.place || segment.node.mac_id != node.mac_id) continue;
    const char* const found = name_of_value(segment, sub ? "sub_command_code_echo" : "non_cyclic_command_echo");
    if (found != nullptr) command = found;
    if (type == nullptr) type = name_of_value(segment, sub ? "sub_type_code_echo" : "type_code_echo");
  }
  if (command == nullptr) return sub ? "Sub-command" : "Command";
  return wmem_strdup_printf(pool, "%s%s%s%s", sub ? "Sub-command " : "", command, type != nullptr ? ", " : "",
                            type != nullptr ? type : "");
}

tap_packet_status count_handshakes(stats_tree* tree, packet_info* pinfo, epan_dissect_t*, const void* data,
                                   tap_flags_t) {
  const Visit& frame = frame_of(data);
  if (frame.dissection->protocol != Protocol::kRtex) return TAP_PACKET_DONT_REDRAW;
  bool any = false;
  for (const Link& link : frame.dissection->links) {
    const bool accepted = link.kind == LinkKind::kAcceptedIn;
    if (!accepted && link.kind != LinkKind::kRequestIn) continue;
    // A command counts when it is answered.
    const char* const name = handshake_text(pinfo->pool, *frame.dissection, link.node);
    const int command = accepted ? place(tree, name, 0) : branch(tree, name, 0);
    measure(tree, accepted ? "Until accepted (ms)" : "Until completed (ms)", command,
            static_cast<double>(link.after_ns) / 1e6);
    any = true;
  }
  return any ? TAP_PACKET_REDRAW : TAP_PACKET_DONT_REDRAW;
}

// --- DeviceNet nodes ------------------------------------------------------------------------------------------------

tap_packet_status count_nodes(stats_tree* tree, packet_info* pinfo, epan_dissect_t*, const void* data, tap_flags_t) {
  const Visit& frame = frame_of(data);
  const Dissection& dissection = *frame.dissection;
  if (dissection.protocol != Protocol::kDevicenet) return TAP_PACKET_DONT_REDRAW;
  wmem_allocator_t* const pool = pinfo->pool;
  int node = 0;
  for (const Derived& derived : dissection.derived) {
    if (derived.protocol != "dnet" || derived.field->key != "message") continue;
    node = branch(tree, node_text(pool, derived.node), 0);
    leaf(tree, pool_text(pool, derived.text), node);
  }
  for (const Derived& derived : dissection.derived) {
    if (derived.protocol != "dnet" || derived.field->unit != Unit::kNanosecond) continue;
    measure(tree, wmem_strdup_printf(pool, "%s (ms)", pool_text(pool, derived.field->label)), node,
            static_cast<double>(derived.value) / 1e6);
  }
  for (const Link& link : dissection.links) {
    if (link.kind != LinkKind::kRequestIn || link.node.channel == Channel::kPoll) continue;
    measure(tree, "Request answered after (ms)", node, static_cast<double>(link.after_ns) / 1e6);
  }
  for (Finding finding : frame.findings) {
    if (!shown_finding(finding) || finding.severity == Severity::kNote) continue;
    leaf(tree, pool_text(pool, rule_row(finding.rule).id), branch(tree, "Errors and warnings", node));
  }
  return TAP_PACKET_REDRAW;
}

void nothing(stats_tree*) {}

}  // namespace

void register_statistics() {
  tap() = register_tap("servotrace");
  stats_tree_register_plugin("servotrace", "servotrace_findings", "servotrace/Findings", 0, count_findings, nothing,
                             nullptr);
  stats_tree_register_plugin("servotrace", "rtex_ring", "servotrace/RTEX rings", 0, count_ring, forget_ring,
                             forget_ring);
  stats_tree_register_plugin("servotrace", "rtex_handshake", "servotrace/RTEX handshakes", 0, count_handshakes, nothing,
                             nullptr);
  stats_tree_register_plugin("servotrace", "dnet_nodes", "servotrace/DeviceNet nodes", 0, count_nodes, nothing,
                             nullptr);
}

void count_frame(packet_info* pinfo, const Visit& frame) {
  if (tap() < 0 || !have_tap_listener(tap())) return;
  Visit* const kept = wmem_new(pinfo->pool, Visit);
  *kept = frame;
  tap_queue_packet(tap(), pinfo, kept);
}

}  // namespace servotrace::plugin
