// SPDX-License-Identifier: MIT
// Wireshark's own DeviceNet dissector as a second opinion: for every identifier there is, and for the fields it decodes
// (group and message ID, Duplicate MAC ID check, unconnected messages of group 3), ours says the same.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "decoder/pipeline/pipeline.hpp"
#include "replay/capture/pcapng_writer.hpp"
#include "tests/support/bytes.hpp"
#include "tests/support/tshark.hpp"

namespace servotrace::test {
namespace {

struct Sent {
  std::uint32_t identifier;
  std::vector<std::uint8_t> record;
};

std::vector<Sent> frames() {
  std::vector<Sent> all;
  const auto add = [&](std::uint32_t identifier, std::string_view data) {
    const auto bytes = hex(data);
    std::vector<std::uint8_t> record = {0,
                                        0,
                                        static_cast<std::uint8_t>(identifier >> 8U),
                                        static_cast<std::uint8_t>(identifier & 0xFFU),
                                        static_cast<std::uint8_t>(bytes.size()),
                                        0,
                                        0,
                                        0};
    record.insert(record.end(), bytes.begin(), bytes.end());
    all.push_back({identifier, std::move(record)});
  };
  for (std::uint32_t identifier = 0; identifier < 0x7F0; ++identifier) add(identifier, "05 4B 00 33 34 12 07");
  for (const char* check : {"00 2C 00 78 56 34 12", "80 34 12 45 23 00 00", "83 FF FF FF FF FF FF"}) {
    add(0x407, check);
    add(0x5FF, check);
  }
  for (const char* message :
       {"05 4B 00 33", "45 4B 01 13", "02 CB 02 04 07 00", "05 4C 07 00", "02 CC", "02 94 02 FF"}) {
    add(0x745, message);
    add(0x7BF, message);
  }
  return all;
}

// What Wireshark said of a frame: field to number.
using Said = std::map<std::string, std::int64_t>;

std::vector<Said> stock(const Tshark& tshark, const std::filesystem::path& capture) {
  const std::vector<std::string> fields = {"devicenet.can_id",
                                           "devicenet.grp_msg1.id",
                                           "devicenet.grp_msg2.id",
                                           "devicenet.grp_msg3.id",
                                           "devicenet.grp_msg4.id",
                                           "devicenet.src_mac_id",
                                           "devicenet.dest_mac_id",
                                           "devicenet.dup_mac_id.rr",
                                           "devicenet.dup_mac_id.physical_port_number",
                                           "devicenet.dup_mac_id.vendor",
                                           "devicenet.dup_mac_id.serial_number",
                                           "devicenet.service",
                                           "devicenet.rr",
                                           "devicenet.grp_msg3.xid"};
  std::vector<std::string> arguments = {"-r", capture.string(), "-d", "can.subdissector,devicenet", "-T", "fields"};
  for (const std::string& field : fields) {
    arguments.emplace_back("-e");
    arguments.push_back(field);
  }
  const Ran ran = tshark.run(arguments);
  EXPECT_EQ(ran.status, 0) << ran.err;
  std::vector<Said> all;
  for (const auto& row : rows_of(ran.out)) {
    Said& said = all.emplace_back();
    for (std::size_t i = 0; i < row.size() && i < fields.size(); ++i) {
      if (row[i].empty()) continue;
      const std::string first = row[i].substr(0, row[i].find(','));
      said[fields[i]] = first == "True" ? 1 : first == "False" ? 0 : std::strtoll(first.c_str(), nullptr, 0);
    }
  }
  return all;
}

std::int64_t derived(const Dissection& dissection, std::string_view key) {
  for (const Derived& row : dissection.derived) {
    if (row.field->key == key) return row.value;
  }
  return -1;
}

std::int64_t field(const Dissection& dissection, std::string_view layout_key, std::string_view field_key) {
  for (const Segment& segment : dissection.segments) {
    const Field* found = segment.layout->key == layout_key ? segment.layout->find(field_key) : nullptr;
    if (found != nullptr) return read(slot_of(*found), dissection.bytes(segment));
  }
  return -1;
}

TEST(StockDissector, AgreesWhereItDecodes) {
  const Tshark tshark;
  if (!tshark.available()) GTEST_SKIP() << tshark.why_not();
  const std::vector<Sent> sent = frames();
  const std::filesystem::path path = tshark.folder() / "devicenet.pcapng";
  {
    auto writer = replay::PcapngWriter::create(path);
    ASSERT_TRUE(writer) << writer.error().text();
    (*writer)->add_interface(LinkType::kCanSocketcan, "can0");
    TimeNs time = 1'700'000'000 * kSecondNs;
    for (const Sent& frame : sent) {
      (*writer)->write(0, time += kMillisecondNs, frame.record, static_cast<std::uint32_t>(frame.record.size()));
    }
    ASSERT_TRUE((*writer)->finish());
  }
  const std::vector<Said> said = stock(tshark, tshark.copy(path));
  ASSERT_EQ(said.size(), sent.size());

  Settings settings;
  settings.devicenet.assumed = true;
  Pipeline pipeline(settings);
  Dissection ours;
  std::size_t compared = 0;
  for (std::size_t i = 0; i < sent.size(); ++i) {
    pipeline.push({.number = i + 1,
                   .time_ns = static_cast<TimeNs>(i) * kMillisecondNs,
                   .link_type = LinkType::kCanSocketcan,
                   .bytes = sent[i].record,
                   .original_length = static_cast<std::uint32_t>(sent[i].record.size())},
                  &ours);
    SCOPED_TRACE("frame " + std::to_string(i + 1) + ", identifier " + std::to_string(sent[i].identifier));
    const auto same = [&](const char* theirs, std::int64_t value) {
      const auto found = said[i].find(theirs);
      if (found == said[i].end()) return;
      EXPECT_EQ(value, found->second) << theirs;
      ++compared;
    };
    same("devicenet.can_id", derived(ours, "identifier"));
    const std::int64_t group = derived(ours, "group");
    for (std::int64_t g = 1; g <= 4; ++g) {
      const std::string name = "devicenet.grp_msg" + std::to_string(g) + ".id";
      EXPECT_EQ(said[i].count(name), g == group ? 1U : 0U) << name;
      if (g == group) same(name.c_str(), derived(ours, "message_id"));
    }
    // In groups 1 and 3 the identifier holds the sender; in group 2 only the messages that say so.
    if (group == 1 || group == 3) same("devicenet.src_mac_id", derived(ours, "source"));
    same("devicenet.dup_mac_id.rr", field(ours, "mac_check", "response"));
    same("devicenet.dup_mac_id.physical_port_number", field(ours, "mac_check", "physical_port"));
    same("devicenet.dup_mac_id.vendor", field(ours, "mac_check", "vendor_id"));
    same("devicenet.dup_mac_id.serial_number", field(ours, "mac_check", "serial_number"));
    // Messages 0 to 4 of group 3 are explicit only where a connection was opened; the unconnected ports always are.
    if (group == 3 && derived(ours, "message_id") >= 5) {
      same("devicenet.dest_mac_id", derived(ours, "destination"));
      same("devicenet.service", field(ours, "unconnected", "service"));
      same("devicenet.grp_msg3.xid", field(ours, "unconnected", "xid"));
    }
  }
  EXPECT_GT(compared, 2 * 0x7F0U);
}

}  // namespace
}  // namespace servotrace::test
