// SPDX-License-Identifier: MIT
#include "captures/simulator/rtex_record_writer.hpp"

#include <algorithm>

namespace servotrace::simulator::ring {
namespace {

using servotrace::rtex::Carrier;
using servotrace::rtex::kRecord;

constexpr std::size_t kShortestEthernet = 60;  // bytes, without the checksum
constexpr std::uint16_t kUdpPort = 35224;
constexpr std::uint16_t kEthertype = 0x88B5;

void append_be(std::vector<std::uint8_t>& out, std::uint32_t value, unsigned byte_count) {
  for (unsigned i = byte_count; i-- > 0;) out.push_back(static_cast<std::uint8_t>(value >> (8U * i)));
}

// A controller (02:..:01) that mirrors to everybody.
void append_ethernet(std::vector<std::uint8_t>& out, std::uint16_t ethertype) {
  out.insert(out.end(), 6, 0xFF);
  const std::uint8_t source[] = {0x02, 0x00, 0x00, 0x00, 0x00, 0x01};
  out.insert(out.end(), std::begin(source), std::end(source));
  append_be(out, ethertype, 2);
}

std::uint16_t internet_checksum(Bytes header) {
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i + 1 < header.size(); i += 2) sum += load_be(header, i, 2);
  while (sum > 0xFFFF) sum = (sum & 0xFFFF) + (sum >> 16U);
  return static_cast<std::uint16_t>(~sum);
}

// IPv4 from 192.0.2.1 to the broadcast address, UDP without a checksum.
void append_udp(std::vector<std::uint8_t>& out, std::size_t payload) {
  std::vector<std::uint8_t> header;
  append_be(header, 0x4500, 2);
  append_be(header, static_cast<std::uint32_t>(28 + payload), 2);
  append_be(header, 0, 4);
  append_be(header, 0x4011, 2);
  append_be(header, 0, 2);
  append_be(header, 0xC0000201, 4);
  append_be(header, 0xC00002FF, 4);
  const std::uint16_t checksum = internet_checksum(header);
  header[10] = static_cast<std::uint8_t>(checksum >> 8U);
  header[11] = static_cast<std::uint8_t>(checksum);
  out.insert(out.end(), header.begin(), header.end());
  append_be(out, kUdpPort, 2);
  append_be(out, kUdpPort, 2);
  append_be(out, static_cast<std::uint32_t>(8 + payload), 2);
  append_be(out, 0, 2);
}

}  // namespace

std::vector<std::uint8_t> make_record(const RecordHeader& header, Bytes blocks) {
  std::vector<std::uint8_t> record(kRecord.size, 0);
  const auto set = [&](Slot place, std::int64_t value) {
    [[maybe_unused]] const bool written = write(place, record, value);
    assert(written);
  };
  set(slot(kRecord, "version"), 1);
  std::copy_n("RTEX", 4, record.begin());
  set(slot(kRecord, "header_length"), kRecord.size);
  set(slot(kRecord, "direction"), header.response ? 1 : 0);
  set(slot(kRecord, "sequence_valid"), header.sequence_valid ? 1 : 0);
  set(slot(kRecord, "cycle_valid"), header.cycle_valid ? 1 : 0);
  set(slot(kRecord, "sampled"), header.sampled ? 1 : 0);
  set(slot(kRecord, "ring"), header.ring);
  set(slot(kRecord, "sequence"), header.sequence);
  set(slot(kRecord, "cycle_ns"), header.cycle_ns);
  set(slot(kRecord, "wide_nodes"), header.wide_nodes);
  set(slot(kRecord, "node_count"), header.node_count);
  record.insert(record.end(), blocks.begin(), blocks.end());
  return record;
}

std::vector<std::uint8_t> wrap_record(Carrier carrier, Bytes record) {
  std::vector<std::uint8_t> frame;
  switch (carrier) {
    case Carrier::kExportedPdu:
      append_be(frame, 12, 2);  // dissector name
      append_be(frame, 4, 2);
      frame.insert(frame.end(), {'r', 't', 'e', 'x'});
      append_be(frame, 0, 4);  // end of the tags
      break;
    case Carrier::kEthernet:
      append_ethernet(frame, kEthertype);
      break;
    case Carrier::kUdp:
      append_ethernet(frame, 0x0800);
      append_udp(frame, record.size());
      break;
    case Carrier::kUserLink:
    case Carrier::kNone:
      break;
  }
  frame.insert(frame.end(), record.begin(), record.end());
  const bool on_wire = carrier == Carrier::kEthernet || carrier == Carrier::kUdp;
  if (on_wire && frame.size() < kShortestEthernet) frame.resize(kShortestEthernet, 0);
  return frame;
}

LinkType link_type_of(Carrier carrier) {
  switch (carrier) {
    case Carrier::kEthernet:
    case Carrier::kUdp:
      return LinkType::kEthernet;
    case Carrier::kUserLink:
      return LinkType::kUser0;
    default:
      return LinkType::kWiresharkUpperPdu;
  }
}

}  // namespace servotrace::simulator::ring
