// SPDX-License-Identifier: MIT
#include "decoder/rtex/ring.hpp"

namespace servotrace::rtex {

Ring::Ring(const Settings& given, const BusRef& bus_ref, Findings& list)
    : settings(given),
      bus(bus_ref),
      findings(list),
      owner(list.owner(NodeRef{.bus = bus_ref, .protocol = Protocol::kRtex, .place = kWholeRing})),
      capture_owner(list.owner(NodeRef{.bus = BusRef{.interface_id = bus_ref.interface_id}})) {
  if (given.rtex.communication_cycle_ns) cycle_ns = {*given.rtex.communication_cycle_ns, {BasisKind::kConfigured, 0}};
  if (given.rtex.command_update_ratio) {
    ratio = {*given.rtex.command_update_ratio, {BasisKind::kConfigured, 0}};
    ratio_decided = true;
  }
  if (given.rtex.full_sync) full_sync = {*given.rtex.full_sync ? 1 : 0, {BasisKind::kConfigured, 0}};
}

Node& Ring::make_node(unsigned place) {
  std::unique_ptr<Node>& entry = nodes[place];
  entry = std::make_unique<Node>();
  entry->place = static_cast<std::uint8_t>(place);
  entry->ref = NodeRef{.bus = bus, .protocol = Protocol::kRtex, .place = entry->place};
  entry->owner = findings.owner(entry->ref);
  entry->eeprom_writes = Hourly(settings.limits.eeprom_writes_per_hour);
  entry->channels[0].id = Channel::kMain;
  entry->channels[1].id = Channel::kSub;
  for (ChannelState& channel : entry->channels) {
    NodeRef ref = entry->ref;
    ref.channel = channel.id;
    channel.owner = findings.owner(ref);
  }
  return *entry;
}

}  // namespace servotrace::rtex
