// SPDX-License-Identifier: MIT
#include "decoder/devicenet/evidence.hpp"

#include "decoder/devicenet/decode.hpp"
#include "decoder/devicenet/fragments.hpp"

namespace servotrace::devicenet {
namespace {

// Between the two Duplicate MAC ID requests of a node: one second, with what timers and a busy bus make of it.
constexpr DurationNs kShortestCheckNs = 750 * kMillisecondNs;
constexpr DurationNs kLongestCheckNs = 1500 * kMillisecondNs;

}  // namespace

std::string_view name_of(EvidenceKind kind) {
  switch (kind) {
    case EvidenceKind::kMacChecks:
      return "two Duplicate MAC ID requests of one device";
    case EvidenceKind::kAllocation:
      return "an allocation and its answer";
    case EvidenceKind::kExplicitPair:
      return "an explicit request and its response";
    case EvidenceKind::kPollPairs:
      return "three poll commands and their responses";
    case EvidenceKind::kNone:
      break;
  }
  return "none";
}

// A message of up to 8 bytes may look like a fragment; none is followed by a frame with the next count by itself.
bool Evidence::Parts::continued_by(Bytes data) {
  const bool was_open = open;
  open = false;
  if (data.size() < kFragment.size) return false;
  const auto type = static_cast<FragmentType>(read(slot(kFragment, "type"), data));
  const auto next = static_cast<std::uint8_t>(read(slot(kFragment, "count"), data));
  const bool middle = type == FragmentType::kMiddle;
  const bool follows = was_open && (middle || type == FragmentType::kLast) && next == ((count + 1U) & 0x3FU);
  open = middle ? follows : type == FragmentType::kFirst && next == 0;
  count = next;
  return follows;
}

void Evidence::gap() {
  for (Node& node : nodes_) {
    node.checked = false;
    node.requested = false;
    node.polled = false;
    node.poll_pairs = 0;
    node.command.open = node.response.open = false;
  }
}

EvidenceKind Evidence::push(const Identifier& id, const can::Frame& frame, TimeNs time_ns) {
  if (frame.error || frame.extended || frame.remote || id.mac_id < 0) return EvidenceKind::kNone;
  Node& node = nodes_[static_cast<std::size_t>(id.mac_id)];
  const Bytes data = frame.data;
  switch (id.kind()) {
    case MessageKind::kMacCheck: {
      if (data.size() != kMacCheck.size || read(slot(kMacCheck, "response"), data) != 0) break;
      const auto vendor = static_cast<std::uint16_t>(read(slot(kMacCheck, "vendor_id"), data));
      const auto serial = static_cast<std::uint32_t>(read(slot(kMacCheck, "serial_number"), data));
      if (vendor == 0) break;  // nobody's number: a frame of zeros, as other protocols send
      // A node asks twice, one second apart; the same frame sooner or later is another protocol's periodic one.
      const bool again = node.checked && node.vendor_id == vendor && node.serial_number == serial;
      const DurationNs apart = elapsed_ns(node.checked_ns, time_ns);
      node.checked_ns = time_ns;
      if (again && apart >= kShortestCheckNs && apart <= kLongestCheckNs) return EvidenceKind::kMacChecks;
      node.checked = true;
      node.vendor_id = vendor;
      node.serial_number = serial;
      break;
    }
    case MessageKind::kUnconnectedRequest:
    case MessageKind::kExplicitRequest: {
      const Request request = parse_request(data, 0);
      const bool fragment = !data.empty() && read(slot(kHeader, "fragmented"), data) != 0;
      node.requested = !fragment && request.malformed == Malformation::kNone && !request.response_bit;
      node.allocation = request.layout == &kAllocate;
      node.header = request.header;
      node.service = request.service;
      break;
    }
    case MessageKind::kExplicitResponse: {
      if (!node.requested) break;
      node.requested = false;
      const Response response = parse_response(data, node.service);
      if (response.malformed != Malformation::kNone || !response.response_bit || response.header != node.header ||
          load_be(data, 0, 1) != response.header) {
        break;
      }
      const bool answers = response.is_error ? data.size() == kError.size : response.service == node.service;
      if (!answers) break;
      return node.allocation ? EvidenceKind::kAllocation : EvidenceKind::kExplicitPair;
    }
    case MessageKind::kPollCommand:
      node.response.open = false;
      if (node.command.continued_by(data)) break;
      if (node.polled) node.poll_pairs = 0;
      node.polled = true;
      break;
    case MessageKind::kPollResponse:
      node.command.open = false;
      if (node.response.continued_by(data)) break;
      if (!node.polled) {
        node.poll_pairs = 0;
        break;
      }
      node.polled = false;
      if (++node.poll_pairs == 3) return EvidenceKind::kPollPairs;
      break;
    default:
      break;
  }
  return EvidenceKind::kNone;
}

}  // namespace servotrace::devicenet
