// SPDX-License-Identifier: GPL-2.0-or-later
#include "dissector/entries.hpp"

#include "dissector/columns.hpp"
#include "dissector/fields.hpp"
#include "dissector/preferences.hpp"
#include "dissector/session.hpp"
#include "dissector/statistics.hpp"
#include "dissector/tree.hpp"
#include "dissector/ws.hpp"

namespace servotrace::plugin {
namespace {

struct Handles {
  dissector_handle_t rtex = nullptr;
  dissector_handle_t dnet = nullptr;
  dissector_handle_t after = nullptr;
  Carriers carriers;  // as registered
};
Handles& handles() {
  static Handles instance;
  return instance;
}

constexpr int kLinkTypeUser0 = 147;

bool is_drawn(packet_info* pinfo) {
  return p_get_proto_data(pinfo->pool, pinfo, servotrace_protocol_id(), 0) != nullptr;
}

void draw_once(packet_info* pinfo, proto_tree* tree, const Visit& frame) {
  if (is_drawn(pinfo)) return;
  p_add_proto_data(pinfo->pool, pinfo, servotrace_protocol_id(), 0, GUINT_TO_POINTER(1));
  draw(pinfo, tree, frame);
  count_frame(pinfo, frame);
}

int dissect_rtex(tvbuff_t* tvb, packet_info* pinfo, proto_tree* tree, void*) {
  const Visit frame = visit(pinfo);
  if (frame.dissection->protocol != Protocol::kRtex) return 0;  // other traffic of this port or EtherType
  draw_once(pinfo, tree, frame);
  return static_cast<int>(tvb_captured_length(tvb));
}

// Chosen under Decode As. Never 0, not even for an empty message: Wireshark would go on with the heuristics.
int dissect_dnet(tvbuff_t* tvb, packet_info* pinfo, proto_tree* tree, void*) {
  const Visit frame = visit(pinfo);
  draw_once(pinfo, tree, frame);
  const auto length = static_cast<int>(tvb_captured_length(tvb));
  return length == 0 ? 1 : length;
}

// Of any CAN frame: ours once the traffic has shown that the bus is DeviceNet, or the user has said so.
WsBool dissect_can(tvbuff_t*, packet_info* pinfo, proto_tree* tree, void*) {
  const Visit frame = visit(pinfo);
  if (frame.dissection->protocol != Protocol::kDevicenet) return false;
  draw_once(pinfo, tree, frame);
  return true;
}

// Sees every frame: CAN error frames, cut headers and what another dissector took.
int dissect_after(tvbuff_t*, packet_info* pinfo, proto_tree* tree, void*) {
  if (is_drawn(pinfo)) return 0;
  const Visit frame = visit(pinfo);
  if (frame.dissection->protocol != Protocol::kNone || !frame.findings.empty()) draw_once(pinfo, tree, frame);
  return 0;
}

void forget_file() {
  reset_session();
  reset_columns();
}

void change_table(const char* table, std::uint32_t before, std::uint32_t now) {
  if (before != 0) dissector_delete_uint(table, before, handles().rtex);
  if (now != 0) dissector_add_uint(table, now, handles().rtex);
}

std::uint32_t user_encapsulation(std::uint16_t link_type) {
  return link_type == 0 ? 0 : static_cast<std::uint32_t>(WTAP_ENCAP_USER0 + (link_type - kLinkTypeUser0));
}

}  // namespace

void register_entries() {
  Handles& all = handles();
  all.rtex = register_dissector("rtex", dissect_rtex, protocol_id("rtex"));
  all.dnet = register_dissector("dnet", dissect_dnet, protocol_id("dnet"));
  all.after = register_dissector("servotrace", dissect_after, servotrace_protocol_id());
  register_postdissector(all.after);
  register_init_routine(forget_file);
  register_cleanup_routine(forget_file);
}

void apply_carriers() {
  Handles& all = handles();
  const Carriers now = current_carriers();
  if (all.rtex == nullptr) return;
  if (now.ethertype != all.carriers.ethertype) change_table("ethertype", all.carriers.ethertype, now.ethertype);
  if (now.udp_port != all.carriers.udp_port) change_table("udp.port", all.carriers.udp_port, now.udp_port);
  if (now.user_link_type != all.carriers.user_link_type)
    change_table("wtap_encap", user_encapsulation(all.carriers.user_link_type), user_encapsulation(now.user_link_type));
  all.carriers = now;
}

void hand_off_entries() {
  heur_dissector_add("can", dissect_can, "DeviceNet drives over CAN", "dnet_can", protocol_id("dnet"),
                     HEURISTIC_ENABLE);
  dissector_add_for_decode_as("can.subdissector", handles().dnet);
  apply_carriers();
}

bool can_is_decoded_as_devicenet() {
  const dissector_table_t table = find_dissector_table("can.subdissector");
  return table != nullptr && dissector_get_payload_handle(table) == handles().dnet;
}

}  // namespace servotrace::plugin
