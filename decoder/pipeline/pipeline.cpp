// SPDX-License-Identifier: MIT
#include "decoder/pipeline/pipeline.hpp"

#include <cassert>
#include <map>
#include <vector>

#include "decoder/core/slot.hpp"
#include "decoder/devicenet/bus.hpp"
#include "decoder/link/rtex_record.hpp"
#include "decoder/link/socketcan.hpp"
#include "decoder/pipeline/context.hpp"
#include "decoder/rtex/session.hpp"

namespace servotrace {
namespace {

// A hostile capture may name any number of interfaces and rings: what is beyond is counted as not tracked.
constexpr std::size_t kMaxInterfaces = 1024;
constexpr std::size_t kMaxBuses = 256;

struct Interface {
  OwnerId owner{};  // findings of the capture, one owner an interface
  bool has_time = false;
  TimeNs last_time_ns = 0;
  bool assume_devicenet = false;
  std::vector<std::uint32_t> can_indices;  // interface indices of link type 276, in order of appearance
};

struct Ring {
  BusRef bus;
  std::uint64_t frames = 0;
  std::unique_ptr<rtex::RingSession> session;
};

struct CanBus {
  BusRef bus;
  std::uint64_t frames = 0;
  std::unique_ptr<devicenet::Bus> session;
};

}  // namespace

struct Pipeline::Impl {
  explicit Impl(const Settings& given) : settings(given), findings(given.max_findings) {}

  Settings settings;
  Findings findings;
  std::vector<Interface> interfaces;
  std::vector<Ring> rings;
  std::vector<CanBus> buses;
  std::uint64_t frames = 0;
  std::uint64_t checked = 0;
  std::uint64_t untracked = 0;
  RawFrame last;  // its number, time and interface
  // Where the last frame of link type 227 belonged: most frames are followed by one of the same bus. In buses and
  // interfaces, so forgotten where these grow; and where CP101 or CP102 is found, which no plain frame ends. nullptr:
  // none.
  CanBus* plain_bus = nullptr;
  Interface* plain_interface = nullptr;
  std::uint32_t plain_interface_id = 0;

  Interface* interface(std::uint32_t id) {
    if (id >= kMaxInterfaces) return nullptr;
    while (interfaces.size() <= id) {
      const auto next = static_cast<std::uint32_t>(interfaces.size());
      plain_bus = nullptr;
      interfaces.push_back(Interface{.owner = findings.owner(NodeRef{.bus = BusRef{.interface_id = next}})});
    }
    return &interfaces[id];
  }

  Ring* ring(std::uint32_t interface_id, std::uint8_t number) {
    const BusRef bus{.kind = BusKind::kRing, .number = number, .interface_id = interface_id};
    for (Ring& entry : rings) {
      if (entry.bus == bus) return &entry;
    }
    if (rings.size() + buses.size() >= kMaxBuses) return nullptr;
    rings.push_back(Ring{bus, 0, std::make_unique<rtex::RingSession>(settings, bus, findings)});
    return &rings.back();
  }

  CanBus* can_bus(Interface& interface, std::uint32_t interface_id, std::uint32_t can_index) {
    std::size_t number = 0;
    while (number < interface.can_indices.size() && interface.can_indices[number] != can_index) ++number;
    if (number == interface.can_indices.size()) {
      if (number >= 16 || rings.size() + buses.size() >= kMaxBuses) return nullptr;
      interface.can_indices.push_back(can_index);
    }
    const BusRef bus{.kind = BusKind::kCan, .number = static_cast<std::uint8_t>(number), .interface_id = interface_id};
    for (CanBus& entry : buses) {
      if (entry.bus == bus) return &entry;
    }
    plain_bus = nullptr;
    buses.push_back(CanBus{bus, 0, std::make_unique<devicenet::Bus>(settings, bus, findings)});
    if (interface.assume_devicenet) buses.back().session->assume();
    return &buses.back();
  }

  // Everything known of this interface must not be compared with what follows.
  void gap(std::uint32_t interface_id) {
    for (Ring& entry : rings) {
      if (entry.bus.interface_id == interface_id) entry.session->gap();
    }
    for (CanBus& entry : buses) {
      if (entry.bus.interface_id == interface_id) entry.session->gap();
    }
  }

  void push_time(const RawFrame& frame, Interface& interface) {
    static constexpr RuleId kTimeBackwards = rule("CP102");
    if (!frame.has_time) return;
    if (interface.has_time && frame.time_ns < interface.last_time_ns) {
      plain_bus = nullptr;
      findings.raise(frame, {.rule = kTimeBackwards,
                             .owner = interface.owner,
                             .arguments = {elapsed_ns(frame.time_ns, interface.last_time_ns)}});
    } else {
      findings.calm(interface.owner, kTimeBackwards);
    }
    findings.checked(kTimeBackwards);
    interface.has_time = true;
    interface.last_time_ns = frame.time_ns;
  }

  void malformed(const RawFrame& frame, Interface& interface, capture::Malformed why, std::uint32_t offset) {
    findings.raise(frame, {.rule = rule("CP104"),
                           .owner = interface.owner,
                           .arguments = {static_cast<std::int64_t>(why)},
                           .where = {offset, static_cast<std::uint32_t>(frame.bytes.size()) - offset},
                           .variant = static_cast<std::int64_t>(why)});
  }

  void push_rtex(const RawFrame& frame, Interface& interface, const rtex::RecordPlace& place, bool truncated,
                 Dissection* dissection) {
    if (dissection != nullptr) {
      dissection->protocol = Protocol::kRtex;
      dissection->bus = BusRef{.kind = BusKind::kRing, .number = 0, .interface_id = frame.interface_id};
    }
    if (place.malformed) {
      gap(frame.interface_id);
      if (!truncated) malformed(frame, interface, place.why, place.offset);
      if (dissection != nullptr) {
        dissection->add({.layout = &rtex::kRecord,
                         .offset = place.offset,
                         .length = rtex::kRecord.size,
                         .node = {.bus = dissection->bus}});
      }
      ++checked;
      return;
    }
    const Bytes record = frame.bytes.subspan(place.offset);
    Ring* entry = ring(frame.interface_id, static_cast<std::uint8_t>(read(slot(rtex::kRecord, "ring"), record)));
    if (entry == nullptr) {
      ++untracked;
      return;
    }
    ++checked;
    ++entry->frames;
    const Context context{frame, settings, findings, dissection};
    if (dissection != nullptr) {
      dissection->bus = entry->bus;
      dissection->direction =
          read(slot(rtex::kRecord, "direction"), record) == 0 ? Direction::kCommand : Direction::kResponse;
      dissection->add({.layout = &rtex::kRecord,
                       .offset = place.offset,
                       .length = rtex::kRecord.size,
                       .node = {.bus = entry->bus, .protocol = Protocol::kRtex},
                       .direction = dissection->direction});
    }
    entry->session->push(context, place);
  }

  void push_can(const RawFrame& frame, Interface& interface, const can::Place& place, bool truncated,
                Dissection* dissection) {
    CanBus* entry = can_bus(interface, frame.interface_id, place.frame.interface_index);
    if (entry == nullptr) {
      ++untracked;
      return;
    }
    ++entry->frames;
    if (dissection != nullptr) dissection->bus = entry->bus;
    if (place.malformed) {
      entry->session->gap();
      // CAN FD and XL are ordinary on a bus that is not DeviceNet.
      const bool other = place.why == capture::Malformed::kCanFd || place.why == capture::Malformed::kCanXl;
      if (!truncated && (!other || entry->session->is_devicenet()))
        malformed(frame, interface, place.why, place.header_offset);
      if (entry->session->is_devicenet()) ++checked;
      return;
    }
    const bool in_order =
        !findings.is_open(interface.owner, rule("CP101")) && !findings.is_open(interface.owner, rule("CP102"));
    plain_bus = frame.link_type == LinkType::kCanSocketcan && in_order && !settings.judge_every_block ? entry : nullptr;
    plain_interface = &interface;
    plain_interface_id = frame.interface_id;
    entry->session->push({frame, settings, findings, dissection}, place.frame);
    if (entry->session->is_devicenet()) {
      ++checked;
      if (dissection != nullptr) dissection->protocol = Protocol::kDevicenet;
    } else if (dissection != nullptr) {
      dissection->clear();
      dissection->frame = frame.bytes;
    }
  }

  // A whole data frame, not looked at, of the bus of the one before: there is nothing to find in its record but a time
  // that goes back. False, and nothing was done, for any other.
  [[gnu::always_inline]] bool push_plain_can(const RawFrame& frame) {
    constexpr std::size_t kHeader = 8;
    constexpr std::uint32_t kLastIdentifier = 0x7FF;  // above: flags, or 29 bits
    if (plain_bus == nullptr || frame.interface_id != plain_interface_id || frame.link_type != LinkType::kCanSocketcan)
      return false;
    const std::size_t size = frame.bytes.size();
    if (size < kHeader || frame.original_length > size || !frame.has_time) return false;
    const std::uint32_t identifier = load_be(frame.bytes, 0, 4);
    const std::size_t length = frame.bytes[4];
    const std::uint8_t flags = frame.bytes[5];
    if (identifier > kLastIdentifier || length > 8 || size < kHeader + length || flags != 0 ||
        !plain_interface->has_time || frame.time_ns < plain_interface->last_time_ns) {
      return false;
    }
    findings.checked(rule("CP101"));
    findings.checked(rule("CP102"));
    plain_interface->last_time_ns = frame.time_ns;
    ++plain_bus->frames;
    devicenet::Bus& bus = *plain_bus->session;
    bus.push_plain({frame, settings, findings, nullptr}, {.identifier = identifier,
                                                          .data = frame.bytes.subspan(kHeader, length),
                                                          .data_offset = static_cast<std::uint32_t>(kHeader)});
    if (bus.is_devicenet()) ++checked;
    return true;
  }

  // True for link types that may carry our protocols, even where a frame of them carries something else.
  bool is_known(LinkType type) const {
    switch (type) {
      case LinkType::kNull:
      case LinkType::kEthernet:
      case LinkType::kRawIp:
      case LinkType::kLoop:
      case LinkType::kLinuxSll:
      case LinkType::kCanSocketcan:
      case LinkType::kIpv4:
      case LinkType::kIpv6:
      case LinkType::kWiresharkUpperPdu:
      case LinkType::kLinuxSll2:
        return true;
      default:
        return static_cast<std::uint16_t>(type) == settings.rtex.user_link_type;
    }
  }
};

Pipeline::Pipeline(const Settings& settings) : impl_(std::make_unique<Impl>(settings)) {}
Pipeline::~Pipeline() = default;
Pipeline::Pipeline(Pipeline&&) noexcept = default;
Pipeline& Pipeline::operator=(Pipeline&&) noexcept = default;

void Pipeline::push(const RawFrame& frame, Dissection* dissection) {
  Impl& self = *impl_;
  self.findings.mark();
  ++self.frames;
  self.last.number = frame.number;
  self.last.time_ns = frame.time_ns;
  self.last.interface_id = frame.interface_id;
  if (dissection == nullptr && self.push_plain_can(frame)) return;
  if (dissection != nullptr) {
    dissection->clear();
    dissection->frame = frame.bytes;
  }
  Interface* interface = self.interface(frame.interface_id);
  if (interface == nullptr) {
    ++self.untracked;
    return;
  }
  self.push_time(frame, *interface);
  const bool truncated = frame.original_length > frame.bytes.size();
  if (truncated) {
    self.plain_bus = nullptr;
    self.findings.raise(frame, {.rule = rule("CP101"),
                                .owner = interface->owner,
                                .arguments = {static_cast<std::int64_t>(frame.bytes.size()), frame.original_length}});
  } else {
    self.findings.calm(interface->owner, rule("CP101"));
  }
  self.findings.checked(rule("CP101"));
  if (can::may_hold_can(frame.link_type)) {
    const can::Place can_place = can::find_frame(frame);
    if (can_place.found) {
      self.push_can(frame, *interface, can_place, truncated, dissection);
      return;
    }
  }
  const rtex::RecordPlace record = rtex::find_record(frame, self.settings.rtex);
  if (record.carrier != rtex::Carrier::kNone) {
    self.push_rtex(frame, *interface, record, truncated, dissection);
    return;
  }
  if (truncated) self.gap(frame.interface_id);  // it may have been one of ours
  if (!self.is_known(frame.link_type)) {
    self.findings.raise(frame, {.rule = rule("CP105"),
                                .owner = interface->owner,
                                .arguments = {static_cast<std::int64_t>(frame.link_type)},
                                .variant = static_cast<std::int64_t>(frame.link_type)});
  }
}

void Pipeline::assume_devicenet(std::uint32_t interface_id) {
  Interface* interface = impl_->interface(interface_id);
  if (interface == nullptr) return;
  interface->assume_devicenet = true;
  for (CanBus& entry : impl_->buses) {
    if (entry.bus.interface_id == interface_id) entry.session->assume();
  }
}

void Pipeline::add_dropped(std::uint32_t interface_id, std::uint64_t count) {
  Interface* interface = impl_->interface(interface_id);
  if (interface == nullptr) return;
  impl_->findings.mark();
  impl_->gap(interface_id);
  if (count == 0) return;
  impl_->findings.raise(impl_->last, {.rule = rule("CP103"),
                                      .owner = interface->owner,
                                      .arguments = {capture::kLostDropped, static_cast<std::int64_t>(count)}});
}

void Pipeline::truncated_end(std::uint64_t captured, std::uint64_t expected) {
  impl_->findings.mark();
  Interface* interface = impl_->interface(impl_->last.interface_id);
  if (interface == nullptr) return;
  impl_->findings.calm(interface->owner, rule("CP101"));
  impl_->findings.raise(impl_->last,
                        {.rule = rule("CP101"),
                         .owner = interface->owner,
                         .arguments = {static_cast<std::int64_t>(captured), static_cast<std::int64_t>(expected)}});
}

void Pipeline::finish() {
  Impl& self = *impl_;
  self.findings.mark();
  const Context context{self.last, self.settings, self.findings, nullptr};
  for (Ring& entry : self.rings) entry.session->finish(context);
  for (CanBus& entry : self.buses) entry.session->finish(context);
}

std::span<const Finding> Pipeline::fresh() const { return impl_->findings.fresh(); }
const Findings& Pipeline::findings() const { return impl_->findings; }
std::uint64_t Pipeline::checked_frames() const { return impl_->checked; }

Summary Pipeline::summary() const {
  Summary summary;
  summary.frames = impl_->frames;
  summary.checked_frames = impl_->checked;
  summary.untracked_frames = impl_->untracked;
  for (const Ring& entry : impl_->rings) {
    BusSummary& bus = summary.buses.emplace_back();
    bus.bus = entry.bus;
    bus.protocol = Protocol::kRtex;
    bus.frames = entry.frames;
    entry.session->summarise(bus);
  }
  for (const CanBus& entry : impl_->buses) {
    BusSummary& bus = summary.buses.emplace_back();
    bus.bus = entry.bus;
    bus.protocol = entry.session->is_devicenet() ? Protocol::kDevicenet : Protocol::kNone;
    bus.frames = entry.frames;
    entry.session->summarise(bus);
  }
  return summary;
}

}  // namespace servotrace
