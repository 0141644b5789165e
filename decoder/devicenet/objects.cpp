// SPDX-License-Identifier: MIT
#include "decoder/devicenet/objects.hpp"

#include "decoder/devicenet/layouts.hpp"
#include "decoder/devicenet/object_layouts.hpp"

namespace servotrace::devicenet {
namespace {

constexpr ServiceName kGet[] = {{0x0E, "Get_Attribute_Single"}};
constexpr ServiceName kGetReset[] = {{0x05, "Reset"}, {0x0E, "Get_Attribute_Single"}};
constexpr ServiceName kGetSet[] = {{0x0E, "Get_Attribute_Single"}, {0x10, "Set_Attribute_Single"}};
constexpr ServiceName kConnectionServices[] = {{0x05, "Reset"},
                                               {0x09, "Delete"},
                                               {0x0D, "Apply_Attributes"},
                                               {0x0E, "Get_Attribute_Single"},
                                               {0x10, "Set_Attribute_Single"}};
constexpr ServiceName kDevicenetServices[] = {{0x0E, "Get_Attribute_Single"},
                                              {0x10, "Set_Attribute_Single"},
                                              {0x4B, "Allocate_Master/Slave_Connection_Set"},
                                              {0x4C, "Release_Master/Slave_Connection_Set"}};

constexpr Field flag(std::string_view key, std::string_view label, std::uint16_t bit) {
  return {.key = key, .label = label, .first_bit = bit, .width = 1, .kind = Kind::kBool, .section = kGeneralSection};
}
constexpr Field reserved_bits(std::string_view key, std::uint16_t bit, std::uint16_t width) {
  return {.key = key,
          .label = "Reserved",
          .first_bit = bit,
          .width = width,
          .base = Base::kHex,
          .section = kGeneralSection};
}

// The value of one attribute of several parts.
template <std::size_t kCount>
constexpr std::array<Layout, kCount> with(std::array<Layout, kCount> layouts, std::size_t index, const Layout& layout) {
  layouts[index] = layout;
  return layouts;
}

// Identity, class 01h.
constexpr Attribute kIdentityAttributes[] = {
    {.number = 1, .key = "vendor_id", .name = "Vendor ID", .type = DataType::kUint, .section = kGeneralSection},
    {.number = 2, .key = "device_type", .name = "Device type", .type = DataType::kUint, .section = kGeneralSection},
    {.number = 3, .key = "product_code", .name = "Product code", .type = DataType::kUint, .section = kGeneralSection},
    {.number = 4,
     .key = "revision",
     .name = "Revision",
     .type = DataType::kWord,
     .section = kGeneralSection,
     .explanation = "low byte major, high byte minor revision"},
    {.number = 5, .key = "status", .name = "Status", .type = DataType::kWord, .section = kGeneralSection},
    {.number = 6,
     .key = "serial_number",
     .name = "Serial number",
     .type = DataType::kDword,
     .section = kGeneralSection},
    {.number = 7,
     .key = "product_name",
     .name = "Product name",
     .type = DataType::kShortString,
     .section = kGeneralSection},
    {.number = 8,
     .key = "state",
     .name = "State",
     .type = DataType::kUsint,
     .values = kDeviceStateNames,
     .section = kGeneralSection},
    {.number = 9,
     .key = "consistency",
     .name = "Configuration consistency value",
     .type = DataType::kUint,
     .section = kGeneralSection},
    {.number = 10,
     .key = "heartbeat_interval",
     .name = "Heartbeat interval",
     .type = DataType::kUsint,
     .access = Access::kGetSet,
     .unit = Unit::kSecond,
     .section = kGeneralSection},
};
constexpr Field kRevisionFields[] = {
    {.key = "major_revision", .label = "Major revision", .first_bit = at(0), .width = 8, .section = kGeneralSection},
    {.key = "minor_revision", .label = "Minor revision", .first_bit = at(1), .width = 8, .section = kGeneralSection},
};
constexpr Layout kRevision{.protocol = "dnet",
                           .key = "identity",
                           .title = "Revision",
                           .size = 2,
                           .fields = kRevisionFields,
                           .section = kGeneralSection};
constexpr Field kStatusFields[] = {
    flag("owned", "Owned by a master", 0),
    reserved_bits("status_reserved_1", 1, 1),
    flag("configured", "Configured", 2),
    reserved_bits("status_reserved_3", 3, 1),
    {.key = "extended_status", .label = "Extended status", .first_bit = 4, .width = 4, .section = kGeneralSection},
    flag("minor_recoverable", "Minor recoverable fault", 8),
    flag("minor_unrecoverable", "Minor unrecoverable fault", 9),
    flag("major_recoverable", "Major recoverable fault", 10),
    flag("major_unrecoverable", "Major unrecoverable fault", 11),
    reserved_bits("status_reserved_12", 12, 4),
};
constexpr Layout kStatus{.protocol = "dnet",
                         .key = "identity",
                         .title = "Status",
                         .size = 2,
                         .fields = kStatusFields,
                         .section = kGeneralSection};
static_assert(well_formed(kRevision) && well_formed(kStatus));
constexpr auto kIdentityFields = attribute_fields(kIdentityAttributes);
constexpr auto kIdentityLayouts =
    with(with(attribute_layouts("dnet", "identity", kIdentityAttributes, kIdentityFields), 3, kRevision), 4, kStatus);
static_assert(kIdentityAttributes[3].number == 4 && kIdentityAttributes[4].number == 5);

// Class attributes: what instance 0 of any class holds.
constexpr Attribute kClassAttributes[] = {
    {.number = 1, .key = "revision", .name = "Class revision", .type = DataType::kUint, .section = kGeneralSection},
    {.number = 2,
     .key = "max_instance",
     .name = "Highest instance",
     .type = DataType::kUint,
     .section = kGeneralSection},
    {.number = 3,
     .key = "instance_count",
     .name = "Number of instances",
     .type = DataType::kUint,
     .section = kGeneralSection},
    {.number = 4,
     .key = "optional_attributes",
     .name = "Optional attributes",
     .type = DataType::kBytes,
     .section = kGeneralSection},
    {.number = 5,
     .key = "optional_services",
     .name = "Optional services",
     .type = DataType::kBytes,
     .section = kGeneralSection},
    {.number = 6,
     .key = "max_class_attribute",
     .name = "Highest class attribute",
     .type = DataType::kUint,
     .section = kGeneralSection},
    {.number = 7,
     .key = "max_instance_attribute",
     .name = "Highest instance attribute",
     .type = DataType::kUint,
     .section = kGeneralSection},
};
constexpr auto kClassFields = attribute_fields(kClassAttributes);
constexpr auto kClassLayouts = attribute_layouts("dnet", "class", kClassAttributes, kClassFields);

// Message router, class 02h.
constexpr Attribute kRouterAttributes[] = {
    {.number = 1, .key = "object_list", .name = "Object list", .type = DataType::kBytes, .section = kGeneralSection},
    {.number = 2,
     .key = "connections_available",
     .name = "Connections available",
     .type = DataType::kUint,
     .section = kGeneralSection},
    {.number = 3,
     .key = "connections_active",
     .name = "Connections active",
     .type = DataType::kUint,
     .section = kGeneralSection},
};
constexpr auto kRouterFields = attribute_fields(kRouterAttributes);
constexpr auto kRouterLayouts = attribute_layouts("dnet", "router", kRouterAttributes, kRouterFields);

// DeviceNet, class 03h.
constexpr ValueName kBaudRates[] = {{0, "125 kbit/s"}, {1, "250 kbit/s"}, {2, "500 kbit/s"}};
constexpr ValueName kBusOffActions[] = {{0, "hold the CAN chip in bus-off"}, {1, "reset it and go on"}};
constexpr Attribute kDevicenetAttributes[] = {
    {.number = 1,
     .key = "mac_id",
     .name = "MAC ID",
     .type = DataType::kUsint,
     .access = Access::kGetSet,
     .section = kGeneralSection},
    {.number = 2,
     .key = "baud_rate",
     .name = "Baud rate",
     .type = DataType::kUsint,
     .access = Access::kGetSet,
     .values = kBaudRates,
     .section = kGeneralSection},
    {.number = 3,
     .key = "bus_off_interrupt",
     .name = "Bus-off interrupt",
     .type = DataType::kUsint,
     .access = Access::kGetSet,
     .values = kBusOffActions,
     .section = kGeneralSection},
    {.number = 4,
     .key = "bus_off_counter",
     .name = "Bus-off counter",
     .type = DataType::kUsint,
     .access = Access::kGetSet,
     .section = kGeneralSection},
    {.number = 5,
     .key = "allocation",
     .name = "Allocation information",
     .type = DataType::kWord,
     .section = kGeneralSection,
     .explanation = "low byte allocation choice, high byte the master's MAC ID, FFh none"},
    {.number = 6,
     .key = "mac_switch_changed",
     .name = "MAC ID switch changed",
     .type = DataType::kUsint,
     .section = kGeneralSection},
    {.number = 7,
     .key = "baud_switch_changed",
     .name = "Baud rate switch changed",
     .type = DataType::kUsint,
     .section = kGeneralSection},
    {.number = 8,
     .key = "mac_switch",
     .name = "MAC ID switch value",
     .type = DataType::kUsint,
     .section = kGeneralSection},
    {.number = 9,
     .key = "baud_switch",
     .name = "Baud rate switch value",
     .type = DataType::kUsint,
     .section = kGeneralSection},
};
constexpr auto kDevicenetFields = attribute_fields(kDevicenetAttributes);
constexpr ValueName kNoMaster[] = {{255, "none"}};
constexpr Field kAllocationFields[] = {
    flag("allocated_explicit", "Explicit", 0),
    flag("allocated_poll", "Poll", 1),
    flag("allocated_bit_strobe", "Bit-strobe", 2),
    flag("allocated_multicast_poll", "Multicast poll", 3),
    flag("allocated_change_of_state", "Change of state", 4),
    flag("allocated_cyclic", "Cyclic", 5),
    flag("allocated_ack_suppression", "Acknowledge suppression", 6),
    reserved_bits("allocated_reserved", 7, 1),
    {.key = "owner",
     .label = "Master's MAC ID",
     .first_bit = at(1),
     .width = 8,
     .values = kNoMaster,
     .section = kGeneralSection},
};
constexpr Layout kAllocation{.protocol = "dnet",
                             .key = "devicenet",
                             .title = "Allocation information",
                             .size = 2,
                             .fields = kAllocationFields,
                             .section = kGeneralSection};
static_assert(well_formed(kAllocation));
constexpr auto kDevicenetLayouts =
    with(attribute_layouts("dnet", "devicenet", kDevicenetAttributes, kDevicenetFields), 4, kAllocation);
static_assert(kDevicenetAttributes[4].number == 5);

// Assembly, class 04h.
constexpr Attribute kAssemblyAttributes[] = {
    {.number = 1,
     .key = "member_count",
     .name = "Number of members",
     .type = DataType::kUint,
     .section = kGeneralSection},
    {.number = 2, .key = "member_list", .name = "Member list", .type = DataType::kBytes, .section = kGeneralSection},
    {.number = 3,
     .key = "assembly_data",
     .name = "Data",
     .type = DataType::kBytes,
     .access = Access::kGetSet,
     .section = kGeneralSection},
};
constexpr auto kAssemblyFields = attribute_fields(kAssemblyAttributes);
constexpr auto kAssemblyLayouts = attribute_layouts("dnet", "assembly", kAssemblyAttributes, kAssemblyFields);

// Connection, class 05h.
constexpr ValueName kConnectionStates[] = {{0, "non-existent"}, {1, "configuring"}, {2, "waiting for connection ID"},
                                           {3, "established"},  {4, "timed out"},   {5, "deferred delete"}};
constexpr ValueName kInstanceTypes[] = {{0, "explicit messaging"}, {1, "I/O"}};
constexpr ValueName kWatchdogActions[] = {
    {0, "transition to timed out"}, {1, "auto delete"}, {2, "auto reset"}, {3, "deferred delete"}};
constexpr Attribute kConnectionAttributes[] = {
    {.number = 1,
     .key = "state",
     .name = "State",
     .type = DataType::kUsint,
     .values = kConnectionStates,
     .section = kLinkSection},
    {.number = 2,
     .key = "instance_type",
     .name = "Instance type",
     .type = DataType::kUsint,
     .values = kInstanceTypes,
     .section = kGeneralSection},
    {.number = 3,
     .key = "transport_trigger",
     .name = "Transport class and trigger",
     .type = DataType::kByte,
     .section = kGeneralSection},
    {.number = 4,
     .key = "produced_id",
     .name = "Produced connection ID",
     .type = DataType::kWord,
     .access = Access::kGetSet,
     .section = kGeneralSection},
    {.number = 5,
     .key = "consumed_id",
     .name = "Consumed connection ID",
     .type = DataType::kWord,
     .access = Access::kGetSet,
     .section = kGeneralSection},
    {.number = 6,
     .key = "initial_characteristics",
     .name = "Initial communication characteristics",
     .type = DataType::kByte,
     .access = Access::kGetSet,
     .section = kGeneralSection},
    {.number = 7,
     .key = "produced_size",
     .name = "Produced connection size",
     .type = DataType::kUint,
     .access = Access::kGetSet,
     .unit = Unit::kByte,
     .section = kLinkSection},
    {.number = 8,
     .key = "consumed_size",
     .name = "Consumed connection size",
     .type = DataType::kUint,
     .access = Access::kGetSet,
     .unit = Unit::kByte,
     .section = kLinkSection},
    {.number = 9,
     .key = "expected_packet_rate",
     .name = "Expected packet rate",
     .type = DataType::kUint,
     .access = Access::kGetSet,
     .unit = Unit::kMillisecond,
     .section = kLinkSection,
     .explanation = "0: never times out"},
    {.number = 12,
     .key = "watchdog_action",
     .name = "Watchdog time-out action",
     .type = DataType::kUsint,
     .access = Access::kGetSet,
     .values = kWatchdogActions,
     .section = kGeneralSection},
    {.number = 13,
     .key = "produced_path_length",
     .name = "Produced connection path length",
     .type = DataType::kUint,
     .unit = Unit::kByte,
     .section = kGeneralSection},
    {.number = 14,
     .key = "produced_path",
     .name = "Produced connection path",
     .type = DataType::kEpath,
     .access = Access::kGetSet,
     .section = kGeneralSection},
    {.number = 15,
     .key = "consumed_path_length",
     .name = "Consumed connection path length",
     .type = DataType::kUint,
     .unit = Unit::kByte,
     .section = kGeneralSection},
    {.number = 16,
     .key = "consumed_path",
     .name = "Consumed connection path",
     .type = DataType::kEpath,
     .access = Access::kGetSet,
     .section = kGeneralSection},
    {.number = 17,
     .key = "production_inhibit_time",
     .name = "Production inhibit time",
     .type = DataType::kUint,
     .access = Access::kGetSet,
     .unit = Unit::kMillisecond,
     .section = kGeneralSection},
    {.number = 18,
     .key = "timeout_multiplier",
     .name = "Connection time-out multiplier",
     .type = DataType::kUsint,
     .access = Access::kGetSet,
     .section = kLinkSection},
};
constexpr auto kConnectionFields = attribute_fields(kConnectionAttributes);
constexpr ValueName kTriggers[] = {{0, "cyclic"}, {1, "change of state"}, {2, "application object"}};
constexpr ValueName kTransportDirections[] = {{0, "client"}, {1, "server"}};
constexpr Field kTransportFields[] = {
    {.key = "transport_class", .label = "Transport class", .first_bit = at(0), .width = 4, .section = kGeneralSection},
    {.key = "production_trigger",
     .label = "Production trigger",
     .first_bit = at(0, 4),
     .width = 3,
     .values = kTriggers,
     .section = kGeneralSection},
    {.key = "transport_direction",
     .label = "Direction",
     .first_bit = at(0, 7),
     .width = 1,
     .values = kTransportDirections,
     .section = kGeneralSection},
};
constexpr Layout kTransport{.protocol = "dnet",
                            .key = "connection",
                            .title = "Transport class and trigger",
                            .size = 1,
                            .fields = kTransportFields,
                            .section = kGeneralSection};
static_assert(well_formed(kTransport));
constexpr auto kConnectionLayouts =
    with(attribute_layouts("dnet", "connection", kConnectionAttributes, kConnectionFields), 2, kTransport);
static_assert(kConnectionAttributes[2].number == 3);

constexpr ObjectClass kClass{.key = "class",
                             .name = "Class",
                             .first_instance = 0,
                             .last_instance = 0,
                             .services = kGet,
                             .attributes = kClassAttributes,
                             .section = kGeneralSection,
                             .layouts = kClassLayouts};

constexpr ObjectClass kStandard[] = {
    {.id = 0x01,
     .key = "identity",
     .name = "Identity",
     .services = kGetReset,
     .attributes = kIdentityAttributes,
     .section = kGeneralSection,
     .layouts = kIdentityLayouts},
    {.id = 0x02,
     .key = "router",
     .name = "Message Router",
     .services = kGet,
     .attributes = kRouterAttributes,
     .section = kGeneralSection,
     .layouts = kRouterLayouts},
    {.id = 0x03,
     .key = "devicenet",
     .name = "DeviceNet",
     .services = kDevicenetServices,
     .attributes = kDevicenetAttributes,
     .section = kGeneralSection,
     .layouts = kDevicenetLayouts},
    {.id = 0x04,
     .key = "assembly",
     .name = "Assembly",
     .last_instance = 0xFFFF,
     .services = kGetSet,
     .attributes = kAssemblyAttributes,
     .section = kGeneralSection,
     .layouts = kAssemblyLayouts},
    {.id = 0x05,
     .key = "connection",
     .name = "Connection",
     .last_instance = 0xFFFF,
     .services = kConnectionServices,
     .attributes = kConnectionAttributes,
     .section = kGeneralSection,
     .layouts = kConnectionLayouts},
    {.id = 0x24,
     .key = "position_supervisor",
     .name = "Position Controller Supervisor",
     .last_instance = 0xFFFF,
     .services = kGetSet,
     .attributes = {},
     .section = "ODVA position controller (SIE-C718-7 B.6)"},
    {.id = 0x25,
     .key = "position_controller",
     .name = "Position Controller",
     .last_instance = 0xFFFF,
     .services = kGetSet,
     .attributes = {},
     .section = "ODVA position controller (SIE-C718-7 B.7)"},
    {.id = 0x26,
     .key = "block_sequencer",
     .name = "Block Sequencer",
     .last_instance = 0xFFFF,
     .services = kGetSet,
     .attributes = {},
     .section = "ODVA position controller (SIE-C718-7 B.8)"},
    {.id = 0x27,
     .key = "command_block",
     .name = "Command Block",
     .last_instance = 0xFFFF,
     .services = kGetSet,
     .attributes = {},
     .section = "ODVA position controller (SIE-C718-7 B.9)"},
};

}  // namespace

bool is_path(const Layout& value) {
  for (std::size_t i = 0; i < kConnectionLayouts.size(); ++i) {
    if (&value == &kConnectionLayouts[i]) return kConnectionAttributes[i].type == DataType::kEpath;
  }
  return false;
}

const ObjectClass& class_attributes() { return kClass; }

std::span<const ObjectClass> standard_objects() { return kStandard; }

}  // namespace servotrace::devicenet
