// SPDX-License-Identifier: MIT
// Unconnected messages of group 3 (open, close, heartbeat, shutdown) and the dynamic connections they open.
#include <algorithm>

#include "decoder/devicenet/bus.hpp"
#include "decoder/devicenet/derived.hpp"

namespace servotrace::devicenet {
namespace {

constexpr std::uint8_t kOpenService = 0x4B;
constexpr std::uint8_t kCloseService = 0x4C;
constexpr std::uint8_t kHeartbeatService = 0x4D;
constexpr std::uint8_t kShutdownService = 0x4E;
constexpr std::uint8_t kXidMask = 0x40;
constexpr std::size_t kMaxDynamic = 64;  // connections kept; a hostile capture may open any number

// The CAN identifier of a message ID in the group an Open asked for; 0 where there is none. Group 2 identifiers hold
// the server's MAC ID both ways, those of groups 1 and 3 the sender's.
std::uint16_t dynamic_id(std::uint8_t group_select, std::uint8_t message_id, std::uint8_t sender, std::uint8_t server) {
  const unsigned id = message_id;
  switch (group_select) {
    case 0:
      return static_cast<std::uint16_t>(id << 6U | sender);
    case 1:
      return id > 7 ? std::uint16_t{0} : group2_id(server, id);
    case 3:
      return id > 4 ? std::uint16_t{0} : static_cast<std::uint16_t>(0x600U | id << 6U | sender);
    default:
      return 0;
  }
}

}  // namespace

void Bus::push_unconnected(const Arrival& arrival, bool request) {
  const Bytes data = arrival.can.data;
  Node& sender = node(arrival.id.mac_id);
  checked(rule("DN304"));
  if (!fits(kUnconnected, data)) {
    show_plain(arrival, sender, fits(kHeader, data) ? kHeader : kIoData);
    malformed(arrival, sender.unconnected_owner, data.empty() ? Malformation::kEmpty : Malformation::kHeaderOnly);
    return;
  }
  const auto header = static_cast<std::uint8_t>(load_be(data, 0, 1) & 0x7FU);
  const auto service = static_cast<std::uint8_t>(read(slot(kUnconnected, "service"), data));
  const bool answers = read(slot(kUnconnected, "response"), data) != 0;
  const Layout* layout = &kUnconnected;
  if (service == kErrorService && answers) {
    layout = &kUnconnectedError;
  } else if (service == kOpenService) {
    layout = answers ? &kOpenResponse : &kOpenRequest;
  } else if (service == kCloseService && !answers) {
    layout = &kCloseRequest;
  } else if (service == kShutdownService && data.size() == kShutdown.size) {
    layout = &kShutdown;
  } else if (service == kHeartbeatService && data.size() == kHeartbeat.size) {
    layout = &kHeartbeat;
  }
  if (!fits(*layout, data)) layout = &kUnconnected;
  Dissection* const dissection = arrival.context.dissection;
  if (dissection != nullptr) {
    const Segment base{.offset = arrival.can.data_offset, .node = sender.ref, .direction = arrival.id.row->direction};
    show(*dissection, base, *layout, 0, layout->size);
    show(*dissection, base, kUnconnectedData, layout->size, data.size() - layout->size);
    if (const ValueName* name = find_value(kUnconnectedServiceNames, service))
      derive(dissection, kServiceNameField, 0, sender.ref, name->name);
  }
  if (service == kHeartbeatService) return;
  if (service == kShutdownService) {
    checked(rule("DN212"));
    raise(arrival.context, {.rule = rule("DN212"),
                            .owner = sender.unconnected_owner,
                            .arguments = {1},
                            .where = arrival.all(),
                            .variant = 1});
    derive(dissection, kScannerCodeField, 86, sender.ref);
    return;
  }
  if (request && !answers) {
    unconnected_request(arrival, header, service);
  } else if (!request && answers) {
    unconnected_response(arrival, sender, header, service);
  }
}

// From the sender (its MAC ID in the identifier) to the node in the header.
void Bus::unconnected_request(const Arrival& arrival, std::uint8_t header, std::uint8_t service) {
  const Bytes data = arrival.can.data;
  const bool open = service == kOpenService && fits(kOpenRequest, data);
  const bool close = service == kCloseService && fits(kCloseRequest, data);
  if (!open && !close) return;
  PendingOpen& entry = opens_[next_open_];
  next_open_ = static_cast<std::uint8_t>((next_open_ + 1U) % opens_.size());
  entry = PendingOpen{.used = true,
                      .client = static_cast<std::uint8_t>(arrival.id.mac_id),
                      .server = static_cast<std::uint8_t>(header & 0x3FU),
                      .header = static_cast<std::uint8_t>((header & 0x40U) | static_cast<unsigned>(arrival.id.mac_id)),
                      .service = service,
                      .frame = arrival.number(),
                      .time_ns = arrival.now_ns()};
  if (open) {
    entry.group_select = static_cast<std::uint8_t>(read(slot(kOpenRequest, "group_select"), data));
    entry.message_id = static_cast<std::uint8_t>(read(slot(kOpenRequest, "source_message_id"), data));
  } else {
    entry.instance = static_cast<std::uint16_t>(read(slot(kCloseRequest, "connection_instance"), data));
  }
}

// The header holds the client's MAC ID and the request's XID.
void Bus::unconnected_response(const Arrival& arrival, Node& sender, std::uint8_t header, std::uint8_t service) {
  PendingOpen* found = nullptr;
  for (PendingOpen& open : opens_) {
    if (!open.used || open.server != sender.ref.mac_id || open.header != header) continue;
    if (service != kErrorService && open.service != service) continue;
    if (found == nullptr || open.frame > found->frame) found = &open;
  }
  if (found != nullptr) {
    const DurationNs answer = elapsed_ns(found->time_ns, arrival.now_ns());
    derive(arrival.context.dissection, kResponseTimeField, answer, sender.ref);
    if (arrival.context.dissection != nullptr) {
      arrival.context.dissection->links.push_back(
          {.kind = LinkKind::kRequestIn, .frame = found->frame, .after_ns = answer, .node = sender.ref});
    }
  }
  const Bytes data = arrival.can.data;
  if (service == kErrorService) {
    checked(rule("DN401"));
    if (!fits(kUnconnectedError, data)) {
      malformed(arrival, sender.unconnected_owner, Malformation::kNoErrorCodes);
    } else {
      const auto general = read(slot(kUnconnectedError, "general_status"), data);
      raise(arrival.context, {.rule = rule("DN401"),
                              .owner = sender.unconnected_owner,
                              .arguments = {found == nullptr ? kErrorService : found->service, general,
                                            read(slot(kUnconnectedError, "additional_status"), data), 0},
                              .where = arrival.bytes(2, 2),
                              .related = {found == nullptr ? 0 : found->frame, 0},
                              .variant = general});
    }
  } else if (found != nullptr && service == kOpenService && fits(kOpenResponse, data)) {
    opened(arrival, *found);
  } else if (found != nullptr && service == kCloseService) {
    const PendingOpen& close = *found;
    std::erase_if(dynamic_, [&](const DynamicConnection& connection) {
      return connection.server == close.server && connection.instance == close.instance;
    });
  }
  if (found != nullptr) found->used = false;
}

void Bus::opened(const Arrival& arrival, const PendingOpen& open) {
  const Bytes data = arrival.can.data;
  const auto source_id = static_cast<std::uint8_t>(read(slot(kOpenResponse, "source_message_id"), data));
  const auto destination_id = static_cast<std::uint8_t>(read(slot(kOpenResponse, "destination_message_id"), data));
  DynamicConnection connection;
  connection.client = open.client;
  connection.server = open.server;
  connection.instance = static_cast<std::uint16_t>(read(slot(kOpenResponse, "connection_instance"), data));
  // Group 2: both message IDs are the server's to give.
  const std::uint8_t request_message = open.group_select == 1 ? destination_id : open.message_id;
  connection.channel.request_id = dynamic_id(open.group_select, request_message, open.client, open.server);
  connection.channel.response_id = dynamic_id(open.group_select, source_id, open.server, open.server);
  connection.channel.body_format = static_cast<std::uint8_t>(read(slot(kOpenResponse, "body_format"), data));
  if (open.group_select != 1) {  // both identifiers hold their sender's MAC ID, both headers the other end's
    connection.channel.header_mask = kXidMask;
    connection.channel.request = Transfer(true, kXidMask);
    connection.channel.response = Transfer(true, kXidMask);
  }
  std::erase_if(dynamic_, [&](const DynamicConnection& old) {
    return (old.server == connection.server && old.instance == connection.instance) ||
           old.channel.request_id == connection.channel.request_id;
  });
  if (dynamic_.size() >= kMaxDynamic) dynamic_.erase(dynamic_.begin());
  dynamic_.push_back(connection);
}

// The connection that was seen to be opened on this identifier. The explicit ports of the predefined set stay what they
// are: a connection opened on them carries the same.
DynamicConnection* Bus::opened_on(const Identifier& id) {
  if (dynamic_.empty() || id.kind() == MessageKind::kExplicitRequest || id.kind() == MessageKind::kExplicitResponse ||
      id.kind() == MessageKind::kUnconnectedRequest || id.kind() == MessageKind::kMacCheck) {
    return nullptr;
  }
  for (DynamicConnection& connection : dynamic_) {
    if (connection.channel.request_id == id.value || connection.channel.response_id == id.value) return &connection;
  }
  return nullptr;
}

void Bus::push_dynamic(const Arrival& arrival, DynamicConnection& connection) {
  const Identifier& id = arrival.id;
  const bool request = connection.channel.request_id == id.value;
  Node& server = node(static_cast<std::int16_t>(connection.server));
  const std::uint8_t sender = request ? connection.client : connection.server;
  transmitted(arrival, node(static_cast<std::int16_t>(sender)));
  if (Dissection* const dissection = arrival.context.dissection) {
    dissection->direction = request ? Direction::kCommand : Direction::kResponse;
    derive(dissection, kIdentifierField, id.value, server.ref);
    derive(dissection, kMessageField, 0, server.ref,
           request ? "Explicit request (opened connection)" : "Explicit response (opened connection)");
    derive(dissection, kGroupField, id.group, server.ref);
    derive(dissection, kMessageIdField, id.message_id, server.ref);
    derive(dissection, kSourceField, sender, server.ref);
    derive(dissection, kDestinationField, request ? connection.server : connection.client, server.ref);
  }
  push_explicit(arrival, server, connection.channel, request);
}

}  // namespace servotrace::devicenet
