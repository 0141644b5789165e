// SPDX-License-Identifier: MIT
// Explicit messages: fragments joined, requests and responses matched by node and XID.
#include <algorithm>

#include "decoder/devicenet/bus.hpp"
#include "decoder/devicenet/derived.hpp"

namespace servotrace::devicenet {
namespace {

constexpr std::int64_t kRequestTransfer = 2;  // argument 0 of DN301-DN303
constexpr std::int64_t kResponseTransfer = 3;
constexpr std::uint8_t kMacMask = 0x3F;
constexpr std::int64_t kDefaultExplicitRateMs = 2500;

std::int16_t mac_of(std::uint8_t header) { return static_cast<std::int16_t>(header & kMacMask); }
unsigned xid_of(std::uint8_t header) { return header >> 6U & 1U; }

bool is_get(std::uint8_t service) {
  return service == kGetAttribute || service == kGetAttributesAll || service == kGetAttributeList;
}

std::int64_t scanner_code(std::uint8_t service) { return service == kAllocateService ? 78 : 84; }

}  // namespace

OwnerId Bus::owner_of(const Arrival& arrival, const Node& node) const {
  return arrival.id.row->channel == Channel::kUnconnected ? node.unconnected_owner : node.explicit_owner;
}

void Bus::malformed(const Arrival& arrival, OwnerId owner, Malformation why) {
  raise(arrival.context, {.rule = rule("DN304"),
                          .owner = owner,
                          .arguments = {static_cast<std::int64_t>(why)},
                          .where = arrival.all(),
                          .variant = static_cast<std::int64_t>(why)});
}

void Bus::push_explicit(const Arrival& arrival, Node& node, ExplicitChannel& channel, bool request) {
  const Bytes data = arrival.can.data;
  checked(rule("DN304"));
  if (data.empty()) {
    malformed(arrival, owner_of(arrival, node), Malformation::kEmpty);
    return;
  }
  const auto header = static_cast<std::uint8_t>(load_be(data, 0, 1) & 0x7FU);
  if (arrival.id.group == 2) node.master_seen = mac_of(header);
  if (read(slot(kHeader, "fragmented"), data) != 0) {
    push_explicit_fragment(arrival, node, channel, request);
    return;
  }
  // A plain message of this end ends a fragmented one that it left unfinished.
  Transfer& transfer = request ? channel.request : channel.response;
  if (transfer.active() && mac_of(static_cast<std::uint8_t>(load_be(transfer.message(), 0, 1))) == mac_of(header)) {
    report_fragment(arrival.context, node.explicit_owner, transfer.abandon(),
                    request ? kRequestTransfer : kResponseTransfer, FragmentType::kFirst, 0, arrival.all(),
                    request ? Actor::kMaster : Actor::kDrive);
  }
  const Whole whole{.bytes = data,
                    .buffer = Buffer::kFrame,
                    .offset = arrival.can.data_offset,
                    .first_frame = arrival.number(),
                    .first_time_ns = arrival.now_ns(),
                    .fragmented = false};
  if (request) {
    request_begins(arrival, node, channel, header);
    handle_request(arrival, node, channel, whole);
  } else {
    handle_response(arrival, node, channel, whole, nullptr);
  }
}

void Bus::push_explicit_fragment(const Arrival& arrival, Node& node, ExplicitChannel& channel, bool request) {
  const Bytes data = arrival.can.data;
  const auto header = static_cast<std::uint8_t>(load_be(data, 0, 1) & 0x7FU);
  Dissection* const dissection = arrival.context.dissection;
  const Segment base{.offset = arrival.can.data_offset, .node = node.ref, .direction = arrival.id.row->direction};
  if (dissection != nullptr) show(*dissection, base, kHeader, 0, kHeader.size);
  if (data.size() < 2) {
    malformed(arrival, owner_of(arrival, node), Malformation::kNoCount);
    return;
  }
  const Bytes behind = data.subspan(1);
  const auto type = static_cast<FragmentType>(read(slot(kFragment, "type"), behind));
  const auto count = static_cast<std::uint8_t>(read(slot(kFragment, "count"), behind));
  const bool ack = type == FragmentType::kAcknowledge;
  // An acknowledgement belongs to the transfer of the other direction.
  const bool of_request = request != ack;
  Transfer& transfer = of_request ? channel.request : channel.response;
  const std::int64_t kind = of_request ? kRequestTransfer : kResponseTransfer;
  const Actor sender = of_request ? Actor::kMaster : Actor::kDrive;
  if (ack) {
    if (dissection != nullptr) {
      if (fits(kFragmentAck, behind)) {
        show(*dissection, base, kFragmentAck, 1, kFragmentAck.size);
        show(*dissection, base, kFragmentData, 3, data.size() - 3);
      } else {
        show(*dissection, base, kFragment, 1, kFragment.size);
      }
    }
    if (!fits(kFragmentAck, behind)) {
      malformed(arrival, owner_of(arrival, node), Malformation::kNoAckStatus);
      return;
    }
    const auto status = static_cast<std::uint8_t>(read(slot(kFragmentAck, "ack_status"), behind));
    const FragmentResult result = transfer.acknowledge(count, status, header);
    checked(rule("DN303"));
    report_fragment(arrival.context, node.explicit_owner, result, kind, type, count, arrival.bytes(1, 2), sender);
    if (result.fault == FragmentFault::kNone) findings_.calm(node.explicit_owner, rule("DN303"));
    note_transfer(transfer);
    return;
  }
  if (dissection != nullptr) {
    show(*dissection, base, kFragment, 1, kFragment.size);
    show(*dissection, base, kFragmentData, 2, data.size() - 2);
  }
  const Bytes payload = data.subspan(2);
  const FragmentResult result =
      transfer.push(type, count, header, payload, arrival.number(), arrival.now_ns(), mid_stream(arrival.now_ns()));
  checked(rule("DN301"));
  checked(rule("DN302"));
  report_fragment(arrival.context, node.explicit_owner, result, kind, type, count, arrival.bytes(1, 1), sender);
  if (result.again) derive(dissection, kRetransmissionField, 1, node.ref);
  note_transfer(transfer);
  if (result.begins) {
    if (request) {
      request_begins(arrival, node, channel, header);
    } else if (!payload.empty()) {  // a first fragment counts as the response
      const auto service = static_cast<std::uint8_t>(load_be(payload, 0, 1) & 0x7FU);
      if (PendingRequest* pending = match(channel, header, service, service == kErrorService)) {
        answered(arrival, node, *pending, true);
        pending->state = PendingRequest::State::kAnswering;
      } else {
        unrequested(arrival, node, header, service);
      }
    }
  }
  if (!result.complete) return;
  findings_.calm(node.explicit_owner, rule("DN301"));
  findings_.calm(node.explicit_owner, rule("DN302"));
  show_fragments(arrival, transfer, node.ref);
  if (dissection != nullptr) dissection->reassembled = transfer.message();
  const Whole whole{.bytes = transfer.message(),
                    .buffer = Buffer::kReassembled,
                    .offset = 0,
                    .first_frame = transfer.first_frame(),
                    .first_time_ns = transfer.first_time_ns(),
                    .fragmented = true};
  if (request) {
    handle_request(arrival, node, channel, whole);
    return;
  }
  PendingRequest* answering = nullptr;
  for (PendingRequest& pending : channel.pending) {
    const bool same = ((pending.request.header ^ header) & channel.header_mask) == 0;
    if (pending.state == PendingRequest::State::kAnswering && same) answering = &pending;
  }
  handle_response(arrival, node, channel, whole, answering);
}

// A new request begins: what the same master asked before on this identifier and is not answered yet.
void Bus::request_begins(const Arrival& arrival, Node& node, ExplicitChannel& channel, std::uint8_t header) {
  checked(rule("DN209"));
  bool overlaps = false;
  for (PendingRequest& pending : channel.pending) {
    if (pending.state == PendingRequest::State::kFree || pending.port != arrival.id.value) continue;
    if (pending.request.header == header) {
      if (pending.state == PendingRequest::State::kOpen) {
        unanswered(arrival.context, node, pending, arrival.now_ns());
        if (pending.state == PendingRequest::State::kLate) ++node.late_allowance;
      } else if (pending.state == PendingRequest::State::kLate) {
        ++node.late_allowance;
      }
      pending.state = PendingRequest::State::kFree;
    } else if (pending.state == PendingRequest::State::kOpen && !pending.silent && !pending.malformed &&
               mac_of(pending.request.header) == mac_of(header)) {
      overlaps = true;
      raise(arrival.context, {.rule = rule("DN209"),
                              .owner = node.explicit_owner,
                              .arguments = {xid_of(header), elapsed_ns(pending.time_ns, arrival.now_ns()),
                                            xid_of(pending.request.header)},
                              .where = arrival.bytes(0, 1),
                              .related = {pending.frame, 0}});
    }
  }
  if (!overlaps) findings_.calm(node.explicit_owner, rule("DN209"));
  // The response under way to the same request number never ends.
  Transfer& response = channel.response;
  if (!response.message().empty() && ((load_be(response.message(), 0, 1) ^ header) & channel.header_mask) == 0) {
    report_fragment(arrival.context, node.explicit_owner, response.abandon(), kResponseTransfer, FragmentType::kFirst,
                    0, arrival.all(), Actor::kDrive);
  }
}

PendingRequest& Bus::free_slot(ExplicitChannel& channel) {
  PendingRequest* oldest = channel.pending.data();
  for (PendingRequest& pending : channel.pending) {
    if (pending.state == PendingRequest::State::kFree) return pending;
    if (pending.time_ns < oldest->time_ns) oldest = &pending;
  }
  return *oldest;
}

void Bus::check_connection(const Arrival& arrival, Node& node, const Request& request, PendingRequest& pending) {
  if (arrival.id.kind() != MessageKind::kExplicitRequest) return;
  checked(rule("DN211"));
  const bool other_master = node.master != kNoMacId && mac_of(request.header) != node.master;
  const bool none = node.explicit_connection == Known::kNo;
  if (!other_master && !none) {
    findings_.calm(node.explicit_owner, rule("DN211"));
    // Unused for four times its rate, and no I/O connection keeps it: the node may have dropped it.
    const std::int64_t rate_ms = node.explicit_rate_ms ? node.explicit_rate_ms->value : kDefaultExplicitRateMs;
    const DurationNs limit = milliseconds(rate_ms * settings_.limits.epr_factor);
    if (limit != 0 && node.channel.used && node.poll.state != PollState::kEstablished &&
        elapsed_ns(node.channel.used_time_ns, arrival.now_ns()) > limit) {
      pending.silent = true;
    }
    return;
  }
  pending.silent = true;
  if (request.service == kAllocateService && request.class_id == 3) return;  // real masters allocate here too
  raise(arrival.context, {.rule = rule("DN211"),
                          .owner = node.explicit_owner,
                          .arguments = {none ? 0 : 1, mac_of(request.header)},
                          .where = arrival.bytes(0, 1),
                          .related = {none ? node.check_frame : 0, 0},
                          .variant = none ? 0 : 1});
}

void Bus::handle_request(const Arrival& arrival, Node& node, ExplicitChannel& channel, const Whole& whole) {
  const bool unconnected = arrival.id.kind() == MessageKind::kUnconnectedRequest;
  const Request request = parse_request(whole.bytes, unconnected ? std::uint8_t{0} : channel.body_format);
  const Bytes data = whole.bytes.subspan(std::min<std::size_t>(request.data_offset, whole.bytes.size()));
  if (arrival.context.dissection != nullptr) {
    show_request(*arrival.context.dissection,
                 {.offset = whole.offset, .buffer = whole.buffer, .node = node.ref, .direction = Direction::kCommand},
                 whole.bytes, request, request_values(node, request, data.size()), shown_by_session(node, request));
    show_names(arrival, node, request);
  }
  PendingRequest& pending = free_slot(channel);
  pending.state = PendingRequest::State::kOpen;
  pending.malformed = request.malformed != Malformation::kNone;
  pending.silent = pending.malformed;
  pending.port = arrival.id.value;
  pending.request = request;
  pending.frame = arrival.number();
  pending.time_ns = arrival.now_ns();
  pending.data_size = static_cast<std::uint16_t>(std::min(data.size(), pending.data.size()));
  std::copy_n(data.begin(), pending.data_size, pending.data.begin());
  if (pending.malformed) {
    malformed(arrival, owner_of(arrival, node), request.malformed);
    return;
  }
  findings_.calm(owner_of(arrival, node), rule("DN304"));
  // The allocation's choice and master lie in front of data_offset: keep them as its data.
  if (request.layout == &kAllocate || request.layout == &kRelease) {
    const Bytes choice = whole.bytes.subspan(kRequest88.size, request.layout->size - kRequest88.size);
    pending.data_size = static_cast<std::uint16_t>(choice.size());
    std::copy_n(choice.begin(), pending.data_size, pending.data.begin());
  }
  check_connection(arrival, node, request, pending);
  check_motion(arrival, node, request, pending.request_data());
  check_attribute(arrival, node, request, data);
  checked(rule("DN207"));
  note_deadline(after_ns(arrival.now_ns(), milliseconds(settings_.limits.explicit_response_ms)));
  if (!node.session || !devicenet_) return;
  served_ = node.session.get();
  const Message message{.bytes = data,
                        .buffer = whole.buffer,
                        .offset = whole.offset + request.data_offset,
                        .first_frame = whole.first_frame,
                        .in_frame = arrival.all()};
  node.session->on_explicit(arrival.context, {.service = request.service,
                                              .class_id = request.class_id,
                                              .instance = request.instance,
                                              .attribute = request.attribute,
                                              .request_data = data,
                                              .request_frame = arrival.number(),
                                              .request_time_ns = arrival.now_ns(),
                                              .response = {},
                                              .request = message});
}

// The request a response of this header and service answers; of two alike, the older.
PendingRequest* Bus::match(ExplicitChannel& channel, std::uint8_t header, std::uint8_t service, bool is_error) {
  PendingRequest* found = nullptr;
  for (PendingRequest& pending : channel.pending) {
    const bool waits = pending.state == PendingRequest::State::kOpen || pending.state == PendingRequest::State::kLate;
    if (!waits || ((pending.request.header ^ header) & channel.header_mask) != 0) continue;
    if (!is_error && (pending.malformed || pending.request.service != service)) continue;
    if (found == nullptr || pending.time_ns < found->time_ns) found = &pending;
  }
  return found;
}

// The response of `pending` began on this frame.
void Bus::answered(const Arrival& arrival, Node& node, PendingRequest& pending, bool link) {
  const DurationNs answer = elapsed_ns(pending.time_ns, arrival.now_ns());
  node.explicit_answer.add(answer);
  node.exchanged = true;
  checked(rule("DN208"));
  findings_.calm(node.explicit_owner, rule("DN208"));
  if (!link || arrival.context.dissection == nullptr) return;
  derive(arrival.context.dissection, kResponseTimeField, answer, node.ref);
  arrival.context.dissection->links.push_back(
      {.kind = LinkKind::kRequestIn, .frame = pending.frame, .after_ns = answer, .node = node.ref});
}

void Bus::unrequested(const Arrival& arrival, Node& node, std::uint8_t header, std::uint8_t service) {
  if (elapsed_ns(begin_ns_, arrival.now_ns()) < kSecondNs) return;
  if (gap_seen_ && !node.exchanged) return;
  checked(rule("DN208"));
  if (node.late_allowance > 0) {
    --node.late_allowance;
    return;
  }
  raise(arrival.context, {.rule = rule("DN208"),
                          .owner = node.explicit_owner,
                          .arguments = {service, mac_of(header)},
                          .where = arrival.all()});
}

void Bus::handle_response(const Arrival& arrival, Node& node, ExplicitChannel& channel, const Whole& whole,
                          PendingRequest* answering) {
  Response response = parse_response(whole.bytes, std::nullopt);
  PendingRequest* pending = answering;
  if (pending == nullptr && response.malformed == Malformation::kNone && response.response_bit && !whole.fragmented) {
    pending = match(channel, response.header, response.service, response.is_error);
    if (pending != nullptr) {
      answered(arrival, node, *pending, true);
    } else {
      unrequested(arrival, node, response.header, response.service);
    }
  }
  if (pending != nullptr) response = parse_response(whole.bytes, pending->request.service);
  const Bytes data = whole.bytes.subspan(std::min<std::size_t>(response.data_offset, whole.bytes.size()));
  const Values values = pending == nullptr ? Values{} : response_values(node, pending->request, data.size());
  if (arrival.context.dissection != nullptr) {
    show_response(*arrival.context.dissection,
                  {.offset = whole.offset, .buffer = whole.buffer, .node = node.ref, .direction = Direction::kResponse},
                  whole.bytes, response, values, pending != nullptr && shown_by_session(node, pending->request));
    if (pending != nullptr) show_names(arrival, node, pending->request);
  }
  const OwnerId owner =
      pending != nullptr && pending->port == channel.unconnected_id ? node.unconnected_owner : node.explicit_owner;
  if (response.malformed != Malformation::kNone) {
    malformed(arrival, owner, response.malformed);
    return;
  }
  if (!response.response_bit) return;
  findings_.calm(owner, rule("DN304"));
  if (response.is_error) {
    error_response(arrival, node, owner, pending, response);
  } else {
    findings_.calm(owner, rule("DN401"));
  }
  if (pending == nullptr) return;
  channel.used = true;
  channel.used_time_ns = arrival.now_ns();
  const PendingRequest answered_request = *pending;
  pending->state = PendingRequest::State::kFree;
  if (!response.is_error) succeeded(arrival, node, channel, answered_request, response, whole.bytes);
  if (!node.session || !devicenet_ || answered_request.malformed) return;
  served_ = node.session.get();
  const Request& request = answered_request.request;
  node.session->on_explicit(arrival.context, {.service = request.service,
                                              .class_id = request.class_id,
                                              .instance = request.instance,
                                              .attribute = request.attribute,
                                              .request_data = answered_request.request_data(),
                                              .request_frame = answered_request.frame,
                                              .request_time_ns = answered_request.time_ns,
                                              .is_response = true,
                                              .is_error = response.is_error,
                                              .general_status = response.general_status,
                                              .additional_status = response.additional_status,
                                              .response = {.bytes = data,
                                                           .buffer = whole.buffer,
                                                           .offset = whole.offset + response.data_offset,
                                                           .first_frame = whole.first_frame,
                                                           .in_frame = arrival.all()},
                                              .request = {}});
}

// The finding of the same node that was raised on the request's frame, if there is one.
Cause Bus::cause_of(const Node& node, std::uint64_t frame) const {
  const auto all = findings_.all();
  for (std::size_t back = 0; back < all.size() && back < 256; ++back) {
    const Finding& finding = all[all.size() - 1 - back];
    if (finding.last_frame < frame) break;
    if (finding.last_frame != frame && finding.frame != frame) continue;
    if (finding.node.bus == node.ref.bus && finding.node.mac_id == node.ref.mac_id)
      return {.rule = finding.rule, .frame = frame};
  }
  return {};
}

void Bus::error_response(const Arrival& arrival, Node& node, OwnerId owner, const PendingRequest* pending,
                         const Response& response) {
  const std::uint8_t general = response.general_status;
  const bool allocation = pending != nullptr && pending->request.layout == &kAllocate;
  if (allocation || (pending != nullptr && pending->request.layout == &kRelease)) {
    const auto code = static_cast<std::int64_t>(general << 8U | response.additional_status);
    if (const ValueName* meaning = find_value(kAllocationErrorNames, code))
      derive(arrival.context.dissection, kAllocationErrorField, code, node.ref, meaning->name);
  }
  checked(rule("DN401"));
  if (allocation) {
    checked(rule("DN202"));
    const auto choice = static_cast<std::int64_t>(load_le(pending->request_data(), 0, 1));
    const bool poll = (choice & 0x02) != 0;
    if (poll && (general == 0x02 || general == 0x09)) step(node, PollEvent::kRefusal);
    raise(arrival.context, {.rule = rule("DN202"),
                            .owner = owner,
                            .arguments = {choice, general, response.additional_status},
                            .where = arrival.bytes(2, 2),
                            .related = {pending->frame, 0},
                            .variant = choice << 16U | std::int64_t{general} << 8U | response.additional_status,
                            .as_note = general == 0x0B,
                            .as_warning = general == 0x0C});
    derive(arrival.context.dissection, kScannerCodeField, 83, node.ref);
    return;
  }
  Report report{.rule = rule("DN401"),
                .owner = owner,
                .arguments = {kErrorService, general, response.additional_status, 0},
                .where = arrival.bytes(2, 2)};
  if (pending != nullptr) {
    const Request& request = pending->request;
    const bool unknown = general == 0x08 || general == 0x14 || general == 0x16;
    report.arguments[0] = request.service;
    report.arguments[3] = request.class_id;
    report.related = {pending->frame, 0};
    report.cause = cause_of(node, pending->frame);
    report.variant = std::int64_t{request.service} << 48U | std::int64_t{request.class_id} << 32U |
                     std::int64_t{request.instance} << 16U | (request.attribute & 0xFF) << 8U | general;
    report.as_note = (is_get(request.service) && unknown) || (request.service == kReleaseService && general == 0x0B);
  }
  raise(arrival.context, report);
}

// `pending` will not be answered in time. Becomes late, or free where nobody waits for it.
void Bus::unanswered(const Context& context, Node& node, PendingRequest& pending, TimeNs now_ns) {
  pending.state = PendingRequest::State::kLate;
  if (pending.silent) return;
  const bool unconnected = pending.port == node.channel.unconnected_id;
  raise(context, {.rule = rule("DN207"),
                  .owner = unconnected ? node.unconnected_owner : node.explicit_owner,
                  .arguments = {pending.request.service, elapsed_ns(pending.time_ns, now_ns),
                                scanner_code(pending.request.service)},
                  .related = {pending.frame, 0},
                  .as_note = unconnected && !node.heard});
}

void Bus::check_requests(const Context& context, Node& node, ExplicitChannel& channel) {
  const DurationNs limit = milliseconds(settings_.limits.explicit_response_ms);
  for (PendingRequest& pending : channel.pending) {
    if (pending.state != PendingRequest::State::kOpen) continue;
    if (elapsed_ns(pending.time_ns, context.frame.time_ns) < limit) {
      note_deadline(after_ns(pending.time_ns, limit));
    } else {
      unanswered(context, node, pending, context.frame.time_ns);
    }
  }
}

}  // namespace servotrace::devicenet
