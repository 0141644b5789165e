// SPDX-License-Identifier: MIT
// I/O data of a node outside the poll connection: change of state, cyclic, multicast poll. Neither drive has these
// connections: they are decoded, joined and checked for the sequence of their fragments, no more.
#include "decoder/devicenet/bus.hpp"
#include "decoder/devicenet/derived.hpp"

namespace servotrace::devicenet {
namespace {

constexpr std::size_t kFrameData = 8;

}  // namespace

void Bus::push_io(const Arrival& arrival, Node& node, IoStream& stream, std::int64_t transfer) {
  const Bytes data = arrival.can.data;
  Dissection* const dissection = arrival.context.dissection;
  if (data.empty()) {
    derive(dissection, kIdleField, 1, node.ref);
    return;
  }
  const auto type = static_cast<FragmentType>(read(slot(kFragment, "type"), data));
  const auto count = static_cast<std::uint8_t>(read(slot(kFragment, "count"), data));
  const bool fragmented = stream.size && stream.size->value > static_cast<std::int64_t>(kFrameData);
  if (!fragmented) {
    const bool follows = stream.transfer.continues(type, count);
    const bool begins = type == FragmentType::kFirst && count == 0 && data.size() == kFrameData;
    const bool only = type == FragmentType::kFirst && count == kOnlyFragment;
    if (!stream.size && (follows || begins || only)) derive(dissection, kAmbiguousField, 1, node.ref);
    if (!stream.size && (follows || begins)) {
      stream.transfer.push(type, count, 0, data.subspan(1), arrival.number(), arrival.now_ns(), true);
    } else {
      stream.transfer.forget();
    }
    show_plain(arrival, node, kIoData);
    return;
  }
  const Segment base{.offset = arrival.can.data_offset, .node = node.ref, .direction = arrival.id.row->direction};
  if (dissection != nullptr) {
    show(*dissection, base, kFragment, 0, kFragment.size);
    show(*dissection, base, kFragmentData, kFragment.size, data.size() - kFragment.size);
  }
  FragmentResult result = stream.transfer.push(type, count, 0, data.subspan(1), arrival.number(), arrival.now_ns(),
                                               mid_stream(arrival.now_ns()));
  checked(rule("DN301"));
  checked(rule("DN302"));
  if (type == FragmentType::kAcknowledge) {  // I/O fragments have none
    result.fault = FragmentFault::kType;
    result.detail = 0;
  }
  report_fragment(arrival.context, node.owner, result, transfer, type, count, arrival.bytes(0, 1), Actor::kDrive);
  note_transfer(stream.transfer);
  if (!result.complete) return;
  findings_.calm(node.owner, rule("DN301"));
  findings_.calm(node.owner, rule("DN302"));
  show_fragments(arrival, stream.transfer, node.ref);
  if (dissection == nullptr) return;
  dissection->reassembled = stream.transfer.message();
  show(*dissection, {.buffer = Buffer::kReassembled, .node = node.ref, .direction = arrival.id.row->direction}, kIoData,
       0, stream.transfer.message().size());
}

}  // namespace servotrace::devicenet
