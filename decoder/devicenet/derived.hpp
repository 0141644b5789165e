// SPDX-License-Identifier: MIT
// The fields of a DeviceNet frame that lie in its CAN identifier, or that only the frames before it show.
#pragma once

#include "decoder/core/layout.hpp"
#include "decoder/devicenet/can_id.hpp"

namespace servotrace::devicenet {

inline constexpr Field kIdentifierField{
    .key = "identifier", .label = "CAN identifier", .width = 11, .base = Base::kHex, .section = kLinkSection};
inline constexpr Field kGroupField{.key = "group", .label = "Message group", .width = 3, .section = kLinkSection};
inline constexpr Field kMessageIdField{.key = "message_id", .label = "Message ID", .width = 6, .section = kLinkSection};
inline constexpr Field kMessageField{
    .key = "message", .label = "Message", .kind = Kind::kText, .section = kLinkSection};
inline constexpr Field kSourceField{.key = "source",
                                    .label = "Source MAC ID",
                                    .width = 6,
                                    .section = kLinkSection,
                                    .explanation = "the node that sent the frame"};
inline constexpr Field kDestinationField{.key = "destination",
                                         .label = "Destination MAC ID",
                                         .width = 6,
                                         .section = kLinkSection,
                                         .explanation = "the node the frame is for"};
inline constexpr Field kMulticastGroupField{
    .key = "multicast_group", .label = "Multicast group", .width = 6, .section = kLinkSection};
inline constexpr Field kCheckedField{.key = "checked_mac",
                                     .label = "MAC ID checked",
                                     .width = 6,
                                     .section = kLinkSection,
                                     .explanation = "the MAC ID a Duplicate MAC ID check asks about"};
inline constexpr Field kIdleField{.key = "idle",
                                  .label = "Idle",
                                  .width = 1,
                                  .kind = Kind::kBool,
                                  .section = kLinkSection,
                                  .explanation = "a zero-length message: its sender is idle"};
inline constexpr Field kAmbiguousField{
    .key = "fragment_or_data",
    .label = "Fragment or data",
    .width = 1,
    .kind = Kind::kBool,
    .section = kLinkSection,
    .explanation = "the connection size is not known: the first byte is data, or the header of a fragment"};
inline constexpr Field kRetransmissionField{.key = "retransmission",
                                            .label = "Retransmission",
                                            .width = 1,
                                            .kind = Kind::kBool,
                                            .section = kLinkSection,
                                            .explanation = "the last fragment once more"};
// General and additional code of the answer to an allocation or a release.
inline constexpr ValueName kAllocationErrorNames[] = {{0x0202, "choice not supported"},
                                                      {0x0902, "bad choice"},
                                                      {0x0B02, "already allocated, or not allocated on release"},
                                                      {0x0C01, "owned by another master"}};
inline constexpr Field kAllocationErrorField{.key = "allocation_error",
                                             .label = "Refused because",
                                             .kind = Kind::kText,
                                             .section = kLinkSection,
                                             .explanation = "general and additional code together"};
inline constexpr Field kServiceNameField{
    .key = "service_name", .label = "Service", .kind = Kind::kText, .section = kLinkSection};
inline constexpr Field kObjectNameField{
    .key = "object_name", .label = "Object", .kind = Kind::kText, .section = kLinkSection};
inline constexpr Field kAttributeNameField{
    .key = "attribute_name", .label = "Attribute", .kind = Kind::kText, .section = kLinkSection};
inline constexpr Field kResponseTimeField{.key = "response_time_ns",
                                          .label = "Response time",
                                          .width = 64,
                                          .kind = Kind::kSigned,
                                          .role = Role::kSignal,
                                          .unit = Unit::kNanosecond,
                                          .section = kLinkSection,
                                          .explanation = "from the request, or the poll command, to this answer"};
inline constexpr Field kPollIntervalField{.key = "poll_interval_ns",
                                          .label = "Poll interval",
                                          .width = 64,
                                          .kind = Kind::kSigned,
                                          .role = Role::kSignal,
                                          .unit = Unit::kNanosecond,
                                          .section = kLinkSection,
                                          .explanation = "from the poll command before to this one, same node"};
inline constexpr ValueName kPollStateNames[] = {{0, "unknown"},     {1, "not allocated"}, {2, "refused"},
                                                {3, "configuring"}, {4, "established"},   {5, "timed out"}};
inline constexpr Field kPollStateField{.key = "poll_state",
                                       .label = "Poll connection",
                                       .width = 8,
                                       .role = Role::kState,
                                       .values = kPollStateNames,
                                       .section = kLinkSection};
inline constexpr Field kErrorClassField{.key = "error_class",
                                        .label = "Error class",
                                        .width = 29,
                                        .base = Base::kHex,
                                        .section = kLinkSection,
                                        .explanation = "the class bits of a CAN error frame (SocketCAN)"};
constexpr Field error_bit(std::string_view key, std::string_view label) {
  return {.key = key, .label = label, .width = 1, .kind = Kind::kBool, .section = kLinkSection};
}
// By bit number of the error class.
inline constexpr Field kErrorBits[] = {error_bit("error_transmit_timeout", "Transmit time-out"),
                                       error_bit("error_lost_arbitration", "Lost arbitration"),
                                       error_bit("error_controller", "Controller problem"),
                                       error_bit("error_protocol", "Protocol violation"),
                                       error_bit("error_transceiver", "Transceiver fault"),
                                       error_bit("error_no_ack", "No acknowledgement on transmission"),
                                       error_bit("error_bus_off", "Bus-off"),
                                       error_bit("error_bus", "Bus error"),
                                       error_bit("error_restarted", "Controller restarted"),
                                       error_bit("error_counters", "Error counters")};
inline constexpr Field kScannerCodeField{
    .key = "scanner_code",
    .label = "Scanner code",
    .width = 8,
    .section = kLinkSection,
    .explanation = "the status code common scanners show for this node in this case"};

}  // namespace servotrace::devicenet
