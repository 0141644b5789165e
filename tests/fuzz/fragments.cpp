// SPDX-License-Identifier: MIT
// Reassembly of DeviceNet: a transfer by itself, and explicit and I/O fragments of an allocated node through the
// pipeline. Each step: a byte of kind, one of count and type, one of length, the bytes.
#include <cstdlib>
#include <vector>

#include "decoder/devicenet/fragments.hpp"
#include "tests/support/harness.hpp"

namespace {

using namespace servotrace;
using devicenet::FragmentType;
using devicenet::Transfer;

void check(const Transfer& transfer) {
  if (transfer.message().size() > Transfer::kCapacity) std::abort();
  if (transfer.first_frame() > transfer.last_frame()) std::abort();
}

void push_can(Pipeline& pipeline, RawFrame& frame, std::uint32_t identifier, Bytes data) {
  std::vector<std::uint8_t> record = {0,
                                      0,
                                      static_cast<std::uint8_t>(identifier >> 8U & 7U),
                                      static_cast<std::uint8_t>(identifier & 0xFFU),
                                      static_cast<std::uint8_t>(data.size()),
                                      0,
                                      0,
                                      0};
  record.insert(record.end(), data.begin(), data.end());
  ++frame.number;
  frame.bytes = record;
  frame.original_length = static_cast<std::uint32_t>(record.size());
  pipeline.push(frame);
  frame.bytes = {};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Settings settings;
  settings.devicenet.assumed = true;
  Pipeline pipeline(settings);
  RawFrame frame{.link_type = LinkType::kCanSocketcan};
  constexpr std::uint32_t kUnconnectedPort5 = 0x42E;  // group 2, MAC ID 5, message 6
  constexpr std::uint32_t kRequest5 = 0x42C;          // message 4
  constexpr std::uint32_t kResponse5 = 0x42B;         // message 3
  constexpr std::uint32_t kPoll5 = 0x42D;             // message 5
  constexpr std::uint8_t kAllocate[] = {0x01, 0x4B, 0x03, 0x01, 0x03, 0x01};
  constexpr std::uint8_t kAllocated[] = {0x01, 0xCB, 0x00};
  push_can(pipeline, frame, kUnconnectedPort5, kAllocate);
  push_can(pipeline, frame, kResponse5, kAllocated);

  Transfer acknowledged(true);
  Transfer plain(false);
  Bytes rest(data, size);
  while (rest.size() >= 3) {
    const std::uint8_t kind = rest[0];
    const std::uint8_t fragment = rest[1];
    const std::size_t length = std::min<std::size_t>(rest[2] & 7U, rest.size() - 3);
    const Bytes payload = rest.subspan(3, length);
    frame.time_ns += (rest[2] >> 3U) * 40 * kMillisecondNs;
    rest = rest.subspan(3 + length);

    const auto type = static_cast<FragmentType>(fragment >> 6U);
    const auto count = static_cast<std::uint8_t>(fragment & 0x3FU);
    Transfer& transfer = (kind & 1U) != 0 ? acknowledged : plain;
    if ((kind & 2U) != 0) transfer.expire(frame.time_ns, kSecondNs, kSecondNs / 10);
    if ((kind & 0x80U) != 0) transfer.forget();
    if (type == FragmentType::kAcknowledge) {
      transfer.acknowledge(count, static_cast<std::uint8_t>(length), 0x80);
    } else if (transfer.push(type, count, 0x80, payload, frame.number, frame.time_ns, (kind & 4U) != 0).complete &&
               transfer.message().empty() && length != 0) {
      std::abort();
    }
    if (transfer.active()) check(transfer);

    // The same as a frame: explicit fragments carry the header's fragment bit and their own byte, I/O ones the latter.
    std::vector<std::uint8_t> bytes;
    constexpr std::uint32_t kPlaces[] = {kRequest5,         kResponse5, kPoll5,    0x3C5,
                                         kUnconnectedPort5, 0x3C5,      kRequest5, kResponse5};
    const std::uint32_t identifier = kPlaces[kind >> 3U & 7U];
    if (identifier != kPoll5 && identifier != 0x3C5) bytes.push_back((kind & 0x40U) != 0 ? 0x81 : 0xC1);
    bytes.push_back(fragment);
    bytes.insert(bytes.end(), payload.begin(), payload.end());
    if (bytes.size() > 8) bytes.resize(8);
    push_can(pipeline, frame, identifier, bytes);
  }
  pipeline.finish();
  if (!test::nonsense(pipeline.findings().all(), frame.number).empty()) std::abort();
  return 0;
}
