// SPDX-License-Identifier: MIT
// Wireshark's own DeviceNet dissector as a second opinion: for every identifier there is, and for the fields it decodes
// (group and message ID, Duplicate MAC ID check, unconnected messages of group 3), ours says the same.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "decoder/pipeline/pipeline.hpp"
#include "replay/capture/pcapng_writer.hpp"
#include "replay/capture/source.hpp"
#include "tests/support/bytes.hpp"
#include "tests/support/peer.hpp"
#include "tests/support/recording.hpp"
#include "tests/support/tshark.hpp"

namespace servotrace::test {
namespace {

namespace fs = std::filesystem;

// Every identifier there is, and messages of the kinds the stock dissector decodes.
std::vector<std::vector<std::uint8_t>> typed_records() {
  std::vector<std::vector<std::uint8_t>> all;
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
    all.push_back(std::move(record));
  };
  for (std::uint32_t identifier = 0; identifier < 0x7F0; ++identifier) add(identifier, "05 4B 00 33 34 12 07");
  for (const char* check : {"00 2C 00 78 56 34 12", "80 34 12 45 23 00 00", "83 FF FF FF FF FF FF"}) {
    add(0x407, check);
    add(0x5FF, check);
  }
  for (const char* message : {"05 4B 00 33", "45 4B 01 13", "02 CB 02 04 07 00", "05 4C 07 00", "02 CC", "02 94 02 FF",
                              "05 4D 01 00 03 00 34 12", "05 4E 03 00 01 00 02 00"}) {
    add(0x745, message);
    add(0x7BF, message);
  }
  for (const std::uint32_t identifier : {0x7EEU, 0x7EFU}) add(identifier, "3F 4B 34 12 78 56 34 12");
  for (const std::uint32_t identifier : {0x7ECU, 0x7EDU}) add(identifier, "7F CC");
  return all;
}

// What Wireshark said of a frame: field to number.
using Said = std::map<std::string, std::int64_t>;

constexpr const char* kFields[] = {"frame.number",
                                   "devicenet.can_id",
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
                                   "devicenet.grp_msg3.frag",
                                   "devicenet.grp_msg3.xid",
                                   "devicenet.open_message.src_message_id",
                                   "devicenet.open_message.dest_message_id",
                                   "devicenet.open_message.req_body_format",
                                   "devicenet.open_message.actual_body_format",
                                   "devicenet.open_message.group_select",
                                   "devicenet.comm_fault.match",
                                   "devicenet.comm_fault.value",
                                   "devicenet.offline_ownership.client_mac_id",
                                   "devicenet.offline_ownership.allocate",
                                   "devicenet.vendor",
                                   "devicenet.serial_number"};

std::map<std::uint64_t, Said> stock(const Tshark& tshark, const fs::path& capture) {
  std::vector<std::string> arguments = {"-r", capture.string(), "-d", "can.subdissector,devicenet", "-T", "fields"};
  for (const char* field : kFields) {
    arguments.emplace_back("-e");
    arguments.emplace_back(field);
  }
  const Ran ran = tshark.run(arguments);
  EXPECT_EQ(ran.status, 0) << ran.err;
  std::map<std::uint64_t, Said> all;
  for (const auto& row : rows_of(ran.out)) {
    Said said;
    for (std::size_t i = 1; i < row.size() && i < std::size(kFields); ++i) {
      if (row[i].empty()) continue;
      const std::string first = row[i].substr(0, row[i].find(','));
      said[kFields[i]] = first == "True" ? 1 : first == "False" ? 0 : std::strtoll(first.c_str(), nullptr, 0);
    }
    all.emplace(std::stoull(row[0]), std::move(said));
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

// Whose MAC ID the stock dissector calls the source: right in groups 1 and 3; in group 2 only for what the holder of
// the MAC ID sends (bit-strobe command, explicit response, its own MAC check).
bool source_is_right(std::int64_t group, std::int64_t message_id) {
  return group == 1 || group == 3 || (group == 2 && (message_id == 0 || message_id == 3 || message_id == 7));
}

// One frame: the number of values compared.
std::size_t compare(const Said& said, const Dissection& ours) {
  std::size_t compared = 0;
  const auto same = [&](const char* theirs, std::int64_t value) {
    const auto found = said.find(theirs);
    if (found == said.end()) return;
    EXPECT_EQ(value, found->second) << theirs;
    ++compared;
  };
  same("devicenet.can_id", derived(ours, "identifier"));
  const std::int64_t group = derived(ours, "group");
  const std::int64_t message_id = derived(ours, "message_id");
  for (std::int64_t g = 1; g <= 4; ++g) {
    const std::string name = "devicenet.grp_msg" + std::to_string(g) + ".id";
    EXPECT_EQ(said.count(name), g == group ? 1U : 0U) << name;
    if (g == group) same(name.c_str(), message_id);
  }
  if (source_is_right(group, message_id)) same("devicenet.src_mac_id", derived(ours, "source"));
  same("devicenet.dup_mac_id.rr", field(ours, "mac_check", "response"));
  same("devicenet.dup_mac_id.physical_port_number", field(ours, "mac_check", "physical_port"));
  same("devicenet.dup_mac_id.vendor", field(ours, "mac_check", "vendor_id"));
  same("devicenet.dup_mac_id.serial_number", field(ours, "mac_check", "serial_number"));
  // Messages 0 to 4 of group 3 are explicit only where a connection was opened; the unconnected ports always are.
  if (group == 3 && message_id >= 5) {
    same("devicenet.dest_mac_id", derived(ours, "destination"));
    same("devicenet.service", field(ours, "unconnected", "service"));
    same("devicenet.rr", field(ours, "unconnected", "response"));
    same("devicenet.grp_msg3.frag", field(ours, "unconnected", "fragmented"));
    same("devicenet.grp_msg3.xid", field(ours, "unconnected", "xid"));
    same("devicenet.open_message.src_message_id", field(ours, "unconnected", "source_message_id"));
    same("devicenet.open_message.dest_message_id", field(ours, "unconnected", "destination_message_id"));
    same("devicenet.open_message.req_body_format", field(ours, "unconnected", "body_format"));
    same("devicenet.open_message.actual_body_format", field(ours, "unconnected", "body_format"));
    same("devicenet.open_message.group_select", field(ours, "unconnected", "group_select"));
  }
  same("devicenet.comm_fault.match", field(ours, "faulted", "match"));
  same("devicenet.comm_fault.value", field(ours, "faulted", "value"));
  same("devicenet.offline_ownership.client_mac_id", field(ours, "ownership", "client"));
  same("devicenet.offline_ownership.allocate", field(ours, "ownership", "service"));
  same("devicenet.vendor", field(ours, "ownership", "vendor_id"));
  same("devicenet.serial_number", field(ours, "ownership", "serial_number"));
  return compared;
}

// Every frame of a capture: the number of values compared.
std::size_t compare(const Tshark& tshark, const fs::path& capture) {
  const std::map<std::uint64_t, Said> said = stock(tshark, tshark.copy(capture));
  Settings settings;
  settings.devicenet.assumed = true;
  Pipeline pipeline(settings);
  Dissection ours;
  RawFrame frame;
  auto source = replay::open_capture(capture);
  EXPECT_TRUE(source) << source.error().text();
  std::size_t compared = 0;
  std::size_t frames = 0;
  while (source && (*source)->next(frame) == replay::Source::Step::kFrame) {
    ++frames;
    pipeline.push(frame, &ours);
    const auto theirs = said.find(frame.number);
    if (theirs == said.end() || theirs->second.count("devicenet.can_id") == 0) continue;
    SCOPED_TRACE(capture.filename().string() + " frame " + std::to_string(frame.number));
    compared += compare(theirs->second, ours);
  }
  EXPECT_EQ(frames, said.size()) << capture;
  return compared;
}

class StockDissector : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { shared_ = std::make_unique<Tshark>(); }
  static void TearDownTestSuite() { shared_.reset(); }
  void SetUp() override {
    if (!shared_->available()) GTEST_SKIP() << shared_->why_not();
  }
  static inline std::unique_ptr<Tshark> shared_;
  const Tshark& tshark_ = *shared_;
};

TEST_F(StockDissector, AgreesOnEveryIdentifierAndMessage) {
  const fs::path path = tshark_.folder() / "typed.pcapng";
  auto writer = replay::PcapngWriter::create(path);
  ASSERT_TRUE(writer) << writer.error().text();
  (*writer)->add_interface(LinkType::kCanSocketcan, "can0");
  TimeNs time = 1'700'000'000 * kSecondNs;
  for (const auto& record : typed_records())
    (*writer)->write(0, time += kMillisecondNs, record, static_cast<std::uint32_t>(record.size()));
  ASSERT_TRUE((*writer)->finish());
  EXPECT_GT(compare(tshark_, path), 2 * 0x7F0U);
}

// The CAN buses among them, in one file.
TEST_F(StockDissector, AgreesOnTheShippedCaptures) {
  std::vector<Recording> all;
  for (const fs::path& capture : shipped_captures()) all.push_back(read_recording(capture));
  const fs::path file = tshark_.folder() / "shipped.pcapng";
  write_capture(file, all);
  EXPECT_GT(compare(tshark_, file), 1000U);
}

TEST_F(StockDissector, AgreesOnThePeerCaptures) {
  if (peer_captures().empty()) GTEST_SKIP() << kNoPeerCaptures;
  for (const auto& entry : fs::directory_iterator(peer_captures() / "devicenet-peer")) {
    if (entry.path().extension() != ".pcap") continue;
    EXPECT_GT(compare(tshark_, entry.path()), 3U) << entry.path();
  }
}

}  // namespace
}  // namespace servotrace::test
