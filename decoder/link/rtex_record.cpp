// SPDX-License-Identifier: MIT
#include "decoder/link/rtex_record.hpp"

#include <array>
#include <bit>

namespace servotrace::rtex {
namespace {

using capture::Malformed;

struct Payload {
  Carrier carrier = Carrier::kNone;
  std::size_t offset = 0;
};

// Tags of an exported PDU, big-endian: 12 names the dissector, 0 ends the list.
Payload exported_pdu(Bytes bytes) {
  constexpr std::uint32_t kTagEnd = 0;
  constexpr std::uint32_t kTagDissectorName = 12;
  constexpr std::string_view kName = "rtex";
  // The tags as nearly every record has them: the name and the end, no more.
  constexpr std::array<std::uint8_t, 12> kUsual = {0, kTagDissectorName, 0, 4, 'r', 't', 'e', 'x', 0, kTagEnd, 0, 0};
  constexpr std::uint64_t kUsualFirst = load_le64(kUsual, 0);
  if (bytes.size() >= kUsual.size() && load_le64(bytes, 0) == kUsualFirst && load_le(bytes, 8, 4) == kTagEnd)
    return {Carrier::kExportedPdu, kUsual.size()};
  bool is_rtex = false;
  std::size_t at_tag = 0;
  while (at_tag + 4 <= bytes.size()) {
    const std::uint32_t tag = load_be(bytes, at_tag, 2);
    const std::size_t length = load_be(bytes, at_tag + 2, 2);
    if (tag == kTagEnd) return is_rtex ? Payload{Carrier::kExportedPdu, at_tag + 4} : Payload{};
    if (length > bytes.size() - at_tag - 4) return {};
    if (tag == kTagDissectorName) {
      std::size_t name_length = length;  // padded with zeros
      while (name_length > 0 && bytes[at_tag + 4 + name_length - 1] == 0) --name_length;
      is_rtex = name_length == kName.size();
      for (std::size_t i = 0; is_rtex && i < kName.size(); ++i)
        is_rtex = bytes[at_tag + 4 + i] == static_cast<std::uint8_t>(kName[i]);
    }
    at_tag += 4 + length;
  }
  return {};
}

// A UDP datagram to or from our port, at `offset`.
Payload udp(Bytes bytes, std::size_t offset, const RtexSettings& settings) {
  constexpr std::size_t kHeader = 8;
  if (offset + kHeader > bytes.size()) return {};
  if (load_be(bytes, offset, 2) != settings.udp_port && load_be(bytes, offset + 2, 2) != settings.udp_port) return {};
  return {Carrier::kUdp, offset + kHeader};
}

constexpr std::uint32_t kProtocolUdp = 17;

Payload ipv4(Bytes bytes, std::size_t offset, const RtexSettings& settings) {
  if (offset + 20 > bytes.size() || load_be(bytes, offset, 1) >> 4U != 4) return {};
  const std::size_t header = (load_be(bytes, offset, 1) & 0xFU) * 4U;
  if (header < 20 || load_be(bytes, offset + 9, 1) != kProtocolUdp) return {};
  if ((load_be(bytes, offset + 6, 2) & 0x3FFFU) != 0) return {};  // a fragment: no whole datagram
  return udp(bytes, offset + header, settings);
}

Payload ipv6(Bytes bytes, std::size_t offset, const RtexSettings& settings) {
  if (offset + 40 > bytes.size() || load_be(bytes, offset, 1) >> 4U != 6) return {};
  std::uint32_t next = load_be(bytes, offset + 6, 1);
  std::size_t place = offset + 40;
  for (int i = 0; i < 8 && (next == 0 || next == 43 || next == 60); ++i) {  // hop-by-hop, routing, destination options
    if (place + 8 > bytes.size()) return {};
    next = load_be(bytes, place, 1);
    place += (load_be(bytes, place + 1, 1) + 1U) * 8U;
  }
  return next == kProtocolUdp ? udp(bytes, place, settings) : Payload{};
}

Payload by_ethertype(Bytes bytes, std::uint32_t ethertype, std::size_t offset, const RtexSettings& settings) {
  for (int i = 0; i < 4 && (ethertype == 0x8100 || ethertype == 0x88A8 || ethertype == 0x9100); ++i) {  // VLAN tags
    if (offset + 4 > bytes.size()) return {};
    ethertype = load_be(bytes, offset + 2, 2);
    offset += 4;
  }
  if (ethertype == settings.ethertype) return {Carrier::kEthernet, offset};
  if (ethertype == 0x0800) return ipv4(bytes, offset, settings);
  if (ethertype == 0x86DD) return ipv6(bytes, offset, settings);
  return {};
}

Payload find_payload(const RawFrame& frame, const RtexSettings& settings) {
  const Bytes bytes = frame.bytes;
  switch (frame.link_type) {
    case LinkType::kWiresharkUpperPdu:
      return exported_pdu(bytes);
    case LinkType::kEthernet:
      return bytes.size() < 14 ? Payload{} : by_ethertype(bytes, load_be(bytes, 12, 2), 14, settings);
    case LinkType::kLinuxSll:
      return bytes.size() < 16 ? Payload{} : by_ethertype(bytes, load_be(bytes, 14, 2), 16, settings);
    case LinkType::kLinuxSll2:
      return bytes.size() < 20 ? Payload{} : by_ethertype(bytes, load_be(bytes, 0, 2), 20, settings);
    case LinkType::kRawIp: {
      const Payload payload = ipv4(bytes, 0, settings);
      return payload.carrier != Carrier::kNone ? payload : ipv6(bytes, 0, settings);
    }
    case LinkType::kIpv4:
      return ipv4(bytes, 0, settings);
    case LinkType::kIpv6:
      return ipv6(bytes, 0, settings);
    case LinkType::kNull:
    case LinkType::kLoop: {  // a family word in the byte order of the machine, then IP: the IP version tells
      const Payload payload = ipv4(bytes, 4, settings);
      return payload.carrier != Carrier::kNone ? payload : ipv6(bytes, 4, settings);
    }
    default:
      break;
  }
  if (static_cast<std::uint16_t>(frame.link_type) == settings.user_link_type) return {Carrier::kUserLink, 0};
  return {};
}

}  // namespace

std::uint32_t record_length(Bytes record) {
  const auto nodes = static_cast<std::uint32_t>(read(slot(kRecord, "node_count"), record));
  const auto wide = static_cast<std::uint32_t>(read(slot(kRecord, "wide_nodes"), record));
  if (nodes == 0 || nodes > kMaxBlocks) return 0;
  const std::uint32_t mask = nodes == 32 ? 0xFFFFFFFFU : (1U << nodes) - 1U;
  const std::uint32_t blocks = nodes + (wide == 0 ? 0U : static_cast<std::uint32_t>(std::popcount(wide & mask)));
  if (blocks > kMaxBlocks) return 0;
  return static_cast<std::uint32_t>(read(slot(kRecord, "header_length"), record)) +
         blocks * static_cast<std::uint32_t>(kBlockSize);
}

RecordPlace find_record(const RawFrame& frame, const RtexSettings& settings) {
  const Payload payload = find_payload(frame, settings);
  if (payload.carrier == Carrier::kNone || payload.offset > frame.bytes.size()) return {};
  const Bytes record = frame.bytes.subspan(payload.offset);
  RecordPlace place{.carrier = payload.carrier,
                    .offset = static_cast<std::uint32_t>(payload.offset),
                    .length = static_cast<std::uint32_t>(record.size()),
                    .available = static_cast<std::uint32_t>(record.size())};
  const bool shared = payload.carrier == Carrier::kEthernet || payload.carrier == Carrier::kUdp;
  const auto malformed = [&place](Malformed why) {
    place.malformed = true;
    place.why = why;
    return place;
  };
  const bool has_magic = record.size() >= 4 && load_le(record, 0, 4) == kMagic;
  if (!has_magic) {
    if (shared) return {};  // other traffic
    return malformed(record.size() < 4 ? Malformed::kTooShort : Malformed::kCarrier);
  }
  if (!fits(kRecord, record)) return malformed(Malformed::kTooShort);
  if (read(slot(kRecord, "version"), record) != 1) return malformed(Malformed::kVersion);
  if (read(slot(kRecord, "header_length"), record) < kRecord.size) return malformed(Malformed::kHeaderLength);
  const std::uint32_t length = record_length(record);
  if (length == 0) return malformed(Malformed::kNodeCount);
  if (length > record.size()) return malformed(Malformed::kTooShort);
  if (length < record.size() && !shared) return malformed(Malformed::kTooLong);
  place.length = length;
  return place;
}

}  // namespace servotrace::rtex
