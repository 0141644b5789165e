// SPDX-License-Identifier: MIT
// The plugin finds what the command line finds: rule, frame, severity and node of every finding, with one pass and with
// two.
#include <gtest/gtest.h>

#include <memory>

#include "replay/capture/pcapng_writer.hpp"
#include "tests/support/bytes.hpp"
#include "tests/support/peer.hpp"
#include "tests/support/plugin_findings.hpp"
#include "tests/support/recording.hpp"

namespace servotrace::test {
namespace {

namespace fs = std::filesystem;

class Parity : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { shared_ = std::make_unique<Tshark>(); }
  static void TearDownTestSuite() { shared_.reset(); }
  void SetUp() override {
    if (!shared_->available()) GTEST_SKIP() << shared_->why_not();
  }
  static inline std::unique_ptr<Tshark> shared_;
  const Tshark& tshark_ = *shared_;
};

// An RTEX record of one 16-byte block, SX-DSV02203 4-2 and 4-3 in the format of this project's records.
std::vector<std::uint8_t> record(bool response, unsigned sequence, const char* block) {
  std::vector<std::uint8_t> bytes = hex("52544558 01 18 06 00 00000000 20A10700 00000000 01 000000");
  bytes[6] = static_cast<std::uint8_t>(bytes[6] | (response ? 1U : 0U));
  bytes[8] = static_cast<std::uint8_t>(sequence);
  const std::vector<std::uint8_t> tail = hex(block);
  bytes.insert(bytes.end(), tail.begin(), tail.end());
  return bytes;
}

std::vector<std::uint8_t> joined(const char* head, const std::vector<std::uint8_t>& tail) {
  std::vector<std::uint8_t> bytes = hex(head);
  bytes.insert(bytes.end(), tail.begin(), tail.end());
  return bytes;
}

// Records in all carriers, and CAN, on interfaces of one file; wrong ones among them.
fs::path write_mixed(const fs::path& folder) {
  const fs::path path = folder / "mixed.pcapng";
  auto created = replay::PcapngWriter::create(path);
  EXPECT_TRUE(created) << created.error().text();
  replay::PcapngWriter& writer = **created;
  const std::uint32_t pdu = writer.add_interface(LinkType::kWiresharkUpperPdu, "ring");
  const std::uint32_t ethernet = writer.add_interface(LinkType::kEthernet, "eth0");
  const std::uint32_t can = writer.add_interface(LinkType::kCanSocketcan, "can0");
  const std::uint32_t cooked = writer.add_interface(LinkType::kLinuxSll2, "any");
  TimeNs time = 1'700'000'000 * kSecondNs;
  const auto write = [&](std::uint32_t interface, const std::vector<std::uint8_t>& bytes, std::size_t longer = 0) {
    writer.write(interface, time, bytes, static_cast<std::uint32_t>(bytes.size() + longer));
    time += 250 * kMicrosecondNs;
  };
  const char* const command = "21 20 00 00 00000000 00000000 00000000";
  const char* const answer = "A1 20 40 00 00000000 00000000 00000000";
  const char* const tags = "000C 0004 72746578 0000 0000";
  const char* const mac_header = "FFFFFFFFFFFF 020000000001 8100 0001 88B5";
  const char* const udp =
      "FFFFFFFFFFFF 020000000001 0800 4500 0048 0000 0000 40 11 0000 7F000001 7F000001 8998 8998 0034 0000";
  for (unsigned i = 0; i < 4; ++i) {
    write(pdu, joined(tags, record(false, i, command)));
    write(pdu, joined(tags, record(true, i, answer)));
    write(ethernet, joined(mac_header, record(false, i, command)));
    write(ethernet, joined(udp, record(false, i, command)));
  }
  write(pdu, joined(tags, hex("52544558 02 18 06 00 00000000 20A10700 00000000 01 000000")));  // of version 2
  std::vector<std::uint8_t> cut = joined(tags, record(false, 5, command));
  cut.resize(cut.size() - 3);
  write(pdu, cut, 3);
  cut.resize(3);
  write(pdu, cut, 80);
  // Duplicate MAC ID requests of node 5, twice: evidence of DeviceNet.
  write(can, hex("0000042F 07 00 00 00 00 BD02 78563412"));
  write(can, hex("0000042F 07 00 00 00 00 BD02 78563412"));
  write(can, hex("000007F5 00 00 00 00"));                        // an identifier DeviceNet does not have
  write(can, hex("20000004 08 00 00 00 0004000000000000"));       // an error frame
  write(can, hex("0000042F 09 00 00 00 00 BD02 78563412 0000"));  // nine bytes of data
  write(can, hex("0000"), 14);                                    // the header cut
  write(cooked, hex("000C 0000 00000003 0118 01 00 0000000000000000 2F040000 07 00 00 00 00 BD02 78563412"));
  write(cooked, hex("000C 0000 00000003 0118 01 00 0000000000000000 2F040000 07 00 00 00 00 BD02 78563412"));
  write(cooked, hex("000C 0000 00000003 0118 01 00 0000000000000000 F5070000 00 00 00 00"));
  EXPECT_TRUE(writer.finish());
  return path;
}

TEST_F(Parity, EveryCarrierAndWhatIsWrongWithIt) {
  const fs::path capture = write_mixed(tshark_.folder());
  const std::vector<Seen> expected = check_capture(capture);
  EXPECT_FALSE(expected.empty());
  expect_parity(tshark_, capture);
}

TEST_F(Parity, PreferencesActAsTheirSettings) {
  const fs::path capture = write_mixed(tshark_.folder());
  replay::FileSettings settings;
  settings.decoder.devicenet.assumed = true;
  settings.decoder.rtex.ethertype = 0x88B6;
  settings.decoder.rtex.udp_port = 4000;
  expect_parity(tshark_, capture, settings,
                {"dnet.can_is_devicenet:TRUE", "rtex.ethertype:88b6", "rtex.udp_port:4000"});
}

// All of them in one file. The user link type is the only carrier that needs a preference.
TEST_F(Parity, ShippedCaptures) {
  std::vector<Recording> all;
  for (const fs::path& capture : shipped_captures()) all.push_back(read_recording(capture));
  ASSERT_FALSE(all.empty());
  const fs::path file = tshark_.folder() / "shipped.pcapng";
  write_capture(file, all);
  expect_parity(tshark_, file, {}, {"rtex.user_link_type:147"});
}

TEST_F(Parity, Scenarios) {
  const std::vector<Recording> all = simulated_recordings();
  ASSERT_FALSE(all.empty());
  const fs::path file = tshark_.folder() / "scenarios.pcapng";
  write_capture(file, all);
  expect_parity(tshark_, file, {}, {"rtex.user_link_type:147"});
}

// Of an independent slave: with the evidence the traffic gives, and where CAN is said to be DeviceNet.
TEST_F(Parity, PeerCaptures) {
  if (peer_captures().empty()) GTEST_SKIP() << kNoPeerCaptures;
  replay::FileSettings assumed;
  assumed.decoder.devicenet.assumed = true;
  for (const auto& entry : fs::directory_iterator(peer_captures() / "devicenet-peer")) {
    if (entry.path().extension() != ".pcap") continue;
    expect_parity(tshark_, entry.path());
    expect_parity(tshark_, entry.path(), assumed, {"dnet.can_is_devicenet:TRUE"});
  }
}

}  // namespace
}  // namespace servotrace::test
