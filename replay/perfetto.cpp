// SPDX-License-Identifier: MIT
#include "replay/perfetto.hpp"

#include <bit>

namespace servotrace::replay {
namespace {

// Protocol buffers wire format.
void put_varint(std::string& out, std::uint64_t value) {
  while (value >= 0x80) {
    out += static_cast<char>(value | 0x80U);
    value >>= 7U;
  }
  out += static_cast<char>(value);
}
void put_number(std::string& out, unsigned field, std::uint64_t value) {
  put_varint(out, std::uint64_t{field} << 3U);
  put_varint(out, value);
}
void put_bytes(std::string& out, unsigned field, std::string_view bytes) {
  put_varint(out, std::uint64_t{field} << 3U | 2U);
  put_varint(out, bytes.size());
  out += bytes;
}
void put_double(std::string& out, unsigned field, double value) {
  put_varint(out, std::uint64_t{field} << 3U | 1U);
  auto bits = std::bit_cast<std::uint64_t>(value);
  for (int i = 0; i < 8; ++i) {
    out += static_cast<char>(bits & 0xFFU);
    bits >>= 8U;
  }
}

// Field numbers of perfetto/trace: Trace, TracePacket, TrackDescriptor, CounterDescriptor, TrackEvent.
constexpr unsigned kTracePacket = 1;
constexpr unsigned kPacketTimestamp = 8;
constexpr unsigned kPacketSequence = 10;
constexpr unsigned kPacketTrackEvent = 11;
constexpr unsigned kPacketTrackDescriptor = 60;
constexpr unsigned kDescriptorUuid = 1;
constexpr unsigned kDescriptorName = 2;
constexpr unsigned kDescriptorParent = 5;
constexpr unsigned kDescriptorCounter = 8;
constexpr unsigned kCounterUnitName = 6;
constexpr unsigned kEventType = 9;
constexpr unsigned kEventTrack = 11;
constexpr unsigned kEventName = 23;
constexpr unsigned kEventDouble = 44;
constexpr unsigned kSliceBegin = 1;
constexpr unsigned kSliceEnd = 2;
constexpr unsigned kCounter = 4;

std::string descriptor(std::uint64_t uuid, std::uint64_t parent, std::string_view name) {
  std::string content;
  put_number(content, kDescriptorUuid, uuid);
  put_bytes(content, kDescriptorName, name);
  if (parent != 0) put_number(content, kDescriptorParent, parent);
  return content;
}

}  // namespace

void PerfettoWriter::packet(const std::string& content) { put_bytes(out_, kTracePacket, content); }

void PerfettoWriter::track(std::uint64_t uuid, std::uint64_t parent, std::string_view name) {
  std::string content;
  put_bytes(content, kPacketTrackDescriptor, descriptor(uuid, parent, name));
  packet(content);
}

void PerfettoWriter::counter_track(std::uint64_t uuid, std::uint64_t parent, std::string_view name,
                                   std::string_view unit) {
  std::string counter_descriptor;
  if (!unit.empty()) put_bytes(counter_descriptor, kCounterUnitName, unit);
  std::string described = descriptor(uuid, parent, name);
  put_bytes(described, kDescriptorCounter, counter_descriptor);
  std::string content;
  put_bytes(content, kPacketTrackDescriptor, described);
  packet(content);
}

void PerfettoWriter::event(std::uint64_t uuid, TimeNs time_ns, unsigned type, std::string_view more) {
  body_.clear();
  put_number(body_, kEventType, type);
  put_number(body_, kEventTrack, uuid);
  body_ += more;
  content_.clear();
  put_number(content_, kPacketTimestamp, static_cast<std::uint64_t>(time_ns));
  put_number(content_, kPacketSequence, 1);
  put_bytes(content_, kPacketTrackEvent, body_);
  packet(content_);
}

void PerfettoWriter::begin_slice(std::uint64_t uuid, TimeNs time_ns, std::string_view name) {
  more_.clear();
  put_bytes(more_, kEventName, name);
  event(uuid, time_ns, kSliceBegin, more_);
}

void PerfettoWriter::end_slice(std::uint64_t uuid, TimeNs time_ns) { event(uuid, time_ns, kSliceEnd, {}); }

void PerfettoWriter::counter(std::uint64_t uuid, TimeNs time_ns, double value) {
  more_.clear();
  put_double(more_, kEventDouble, value);
  event(uuid, time_ns, kCounter, more_);
}

}  // namespace servotrace::replay
