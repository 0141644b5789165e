// SPDX-License-Identifier: MIT
#include "tests/unit/devicenet/bench.hpp"

#include <fmt/format.h>

#include "decoder/devicenet/can_id.hpp"

namespace servotrace::devicenet::test {

std::vector<std::uint8_t> can_record(std::uint32_t identifier, const std::vector<std::uint8_t>& data) {
  std::vector<std::uint8_t> record;
  for (unsigned shift = 32; shift > 0; shift -= 8)
    record.push_back(static_cast<std::uint8_t>(identifier >> (shift - 8)));
  record.push_back(static_cast<std::uint8_t>(data.size()));
  record.insert(record.end(), 3, 0);
  record.insert(record.end(), data.begin(), data.end());
  return record;
}

Bench& Bench::frame(std::uint32_t identifier, std::string_view hex_data, double after_ms) {
  bytes_ = can_record(identifier, servotrace::test::hex(hex_data));
  now_ns_ += static_cast<TimeNs>(after_ms * 1e6);
  const RawFrame raw{.number = ++number_,
                     .time_ns = now_ns_,
                     .link_type = LinkType::kCanSocketcan,
                     .bytes = bytes_,
                     .original_length = static_cast<std::uint32_t>(bytes_.size())};
  pipeline_.push(raw, &dissection_);
  return *this;
}

Bench& Bench::start(unsigned mac_id) {
  frame(0x7C0, "");
  frame(group2_id(mac_id, 7), "00 2C 00 01 02 03 04", 2000);
  return frame(group2_id(mac_id, 7), "00 2C 00 01 02 03 04", 1000);
}

Bench& Bench::allocate(unsigned mac_id, unsigned choice) {
  frame(group2_id(mac_id, 6), fmt::format("01 4B 03 01 {:02X} 01", choice));
  return frame(group2_id(mac_id, 3), "01 CB 00");
}

Bench& Bench::poll(unsigned mac_id, std::string_view command, std::string_view response, double after_ms) {
  frame(group2_id(mac_id, 5), command, after_ms);
  return frame(poll_response_id(mac_id), response);
}

Bench& Bench::gap(std::uint64_t count) {
  pipeline_.add_dropped(0, count);
  return *this;
}

Bench& Bench::finish() {
  pipeline_.finish();
  return *this;
}

std::vector<std::string> words(std::span<const Finding> findings) {
  std::vector<std::string> list;
  for (const Finding& finding : findings) {
    const Rule& row = rule_row(finding.rule);
    if (row.id.substr(0, 2) != "DN") continue;
    std::string text = fmt::format("{}@{}", row.id, finding.frame);
    if (finding.severity != row.severity) text += fmt::format(" {}", name_of(finding.severity));
    list.push_back(std::move(text));
  }
  return list;
}

std::vector<std::string> Bench::findings() const { return words(pipeline_.findings().all()); }

std::int64_t derived_value(const Dissection& dissection, std::string_view key) {
  for (const Derived& row : dissection.derived) {
    if (row.field->key == key) return row.value;
  }
  return -1;
}

std::string derived_text(const Dissection& dissection, std::string_view key) {
  for (const Derived& row : dissection.derived) {
    if (row.field->key == key) return std::string(row.text);
  }
  return {};
}

std::int64_t field_value(const Dissection& dissection, std::string_view layout_key, std::string_view field_key) {
  for (const Segment& segment : dissection.segments) {
    if (segment.layout->key != layout_key) continue;
    if (const Field* field = segment.layout->find(field_key)) return read(slot_of(*field), dissection.bytes(segment));
  }
  return -1;
}

}  // namespace servotrace::devicenet::test
