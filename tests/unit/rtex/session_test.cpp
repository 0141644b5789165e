// SPDX-License-Identifier: MIT
// Each rule is raised by a small ring with one fault, and stays silent on the nearest healthy traffic.
#include <gtest/gtest.h>

#include "tests/unit/rtex/bench.hpp"

namespace servotrace::rtex::test {
namespace {

Settings extend_mode() {
  Settings settings;
  settings.rtex.axes.push_back({.mac_id = 0, .parameters = {{0x0717, 0x20}}});
  return settings;
}
Settings a4n_mode() {
  Settings settings;
  settings.rtex.axes.push_back({.mac_id = 0, .parameters = {{0x0717, 0}}});
  return settings;
}

TEST(Ring, HealthyTrafficIsSilent) {
  Bench bench(3);
  bench.set(0, "cyclic_command", 0);
  bench.set(1, "cyclic_command", 0);
  bench.set(2, "cyclic_command", 0);
  bench.cycles(5);
  for (std::size_t i = 0; i < 3; ++i) bench.set(i, "cyclic_command", 2);
  bench.cycles(20);
  for (std::size_t i = 0; i < 3; ++i) bench.set(i, "servo_on", 1);
  for (int n = 0; n < 200; ++n) {
    for (std::size_t i = 0; i < 3; ++i) bench.position(i, n * 10);
    bench.cycle();
  }
  bench.non_cyclic(1, 6, 0x010, 0x0717);
  bench.cycles(6);
  bench.normal(1);
  bench.cycles(6);
  bench.pipeline().finish();
  EXPECT_EQ(bench.rules(), "");
  EXPECT_TRUE(bench.ok());
  const auto summary = bench.pipeline().summary();
  ASSERT_EQ(summary.buses.size(), 1U);
  EXPECT_EQ(summary.buses[0].nodes.size(), 3U);
  ASSERT_GE(summary.buses[0].facts.size(), 3U);
  EXPECT_EQ(summary.buses[0].facts[0].value, "500");
  EXPECT_EQ(summary.buses[0].facts[1].value, "1");
  EXPECT_EQ(summary.buses[0].facts[2].value, "1");
}

TEST(Ring, HealthyRatioTwoIsSilent) {
  Bench bench(2);
  bench.ratio = 2;
  bench.cycles(300);
  EXPECT_EQ(bench.rules(), "");
  EXPECT_EQ(bench.pipeline().summary().buses[0].facts[1].value, "2");
}

TEST(RX101, CommunicationErrorResponse) {
  Bench bench(2);
  bench.cycles(10);
  bench.on_response = [](std::size_t i, MutableBytes block) {
    if (i == 1) {
      block[1] = 0xFF;
      std::fill(block.begin() + 8, block.begin() + 16, std::uint8_t{0});
    }
  };
  bench.cycles(2);
  bench.on_response = nullptr;
  bench.cycles(10);
  ASSERT_EQ(bench.rules(), "RX101");
  const Finding finding = bench.found("RX101").at(0);
  EXPECT_EQ(finding.node.mac_id, 1);
  EXPECT_EQ(finding.count, 2U);
  EXPECT_EQ(finding.frame, 22U);
  EXPECT_EQ(finding.where.offset, 24U + 16 + 1);
}

TEST(RX101, ErrorEchoOfCommand7FIsNone) {
  Bench bench;
  bench.cycles(10);
  bench.on_response = [](std::size_t, MutableBytes block) {
    block[1] = 0xFF;
    std::fill(block.begin() + 8, block.begin() + 16, std::uint8_t{0});
    block[8] = 0x21;
  };
  bench.cycle();
  EXPECT_TRUE(bench.found("RX101").empty());
  EXPECT_EQ(bench.found("RX901").size(), 1U);
}

TEST(RX102, MacIdMismatch) {
  Bench bench(2);
  bench.cycles(5);
  bench.set(1, "mac_id", 7);
  bench.cycles(3);
  bench.set(1, "mac_id", 1);
  bench.cycles(3);
  ASSERT_EQ(bench.rules(), "RX102");
  const Finding finding = bench.found("RX102").at(0);
  EXPECT_EQ(finding.count, 3U);
  EXPECT_EQ(finding.frame, 11U);
  EXPECT_EQ(finding.arguments[0], 7);
  EXPECT_EQ(finding.arguments[1], 1);
}

TEST(RX102, FoundOnTheResponseThatMakesTheDriveKnown) {
  Bench bench;
  bench.set(0, "mac_id", 9);
  bench.cycles(4);
  const auto found = bench.found("RX102");
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].frame, 2U);
  EXPECT_EQ(found[0].node.mac_id, 0);
}

TEST(RX103, CommandCrSet) {
  Bench bench;
  bench.cycles(3);
  bench.set(0, "cr", 1);
  bench.cycle();
  bench.set(0, "cr", 0);
  bench.cycles(3);
  EXPECT_EQ(bench.rules(), "RX103");
}

TEST(RX104, ResponseCrClear) {
  Bench bench;
  bench.on_response = [](std::size_t, MutableBytes block) { block[0] &= 0x7F; };
  bench.cycles(3);  // before the first answer: not yet written by a drive
  EXPECT_EQ(bench.rules(), "");
  bench.on_response = nullptr;
  bench.cycles(3);
  bench.on_response = [](std::size_t, MutableBytes block) { block[0] &= 0x7F; };
  bench.cycles(2);
  EXPECT_EQ(bench.found("RX104").size(), 1U);
}

TEST(RX105, CyclicCodeUndefined) {
  Bench bench;
  bench.cycles(3);
  bench.set(0, "cyclic_command", 5);
  bench.cycles(2);
  bench.set(0, "cyclic_command", 2);
  bench.cycles(2);
  EXPECT_EQ(bench.rules(), "RX105");
}

TEST(RX106, UnusedBitSet) {
  Bench bench;
  bench.cycles(3);
  bench.set(0, "unused_2_5", 1);
  bench.cycle();
  EXPECT_EQ(bench.rules(), "RX106");
}

TEST(RX106, NopBlocksAreFree) {
  Bench bench;
  bench.set(0, "cyclic_command", 0);
  bench.set(0, "unused_2_5", 1);
  bench.cycles(5);
  EXPECT_EQ(bench.rules(), "");
}

TEST(RX107, SubChkClear) {
  Bench bench;
  bench.at(0).wide = true;
  bench.sub(0, 0, 0);
  bench.cycles(3);
  EXPECT_EQ(bench.rules(), "");
  bench.command(0)[16] = 0;
  bench.cycle();
  EXPECT_EQ(bench.rules(), "RX107");
}

TEST(RX108, StaleResponse) {
  Bench bench;
  bench.cycles(60);
  std::array<std::uint8_t, 32> kept = bench.at(0).response;
  bench.on_response = [&](std::size_t, MutableBytes block) { std::copy(kept.begin(), kept.end(), block.begin()); };
  bench.cycles(20);
  bench.on_response = nullptr;
  bench.cycles(5);
  EXPECT_EQ(bench.rules(), "RX108");
}

TEST(RX108, AllZeroBlock) {
  Bench bench(2);
  bench.cycles(10);
  bench.on_response = [](std::size_t i, MutableBytes block) {
    if (i == 0) std::fill(block.begin(), block.end(), std::uint8_t{0});
  };
  bench.cycles(2);
  bench.on_response = nullptr;
  bench.cycles(5);
  EXPECT_EQ(bench.rules(), "RX108");
  EXPECT_EQ(bench.found("RX108", 0).size(), 1U);
}

TEST(RX108, TwoCyclesWithoutResponse) {
  Bench bench;
  bench.cycles(10);
  bench.send_response = false;
  bench.cycles(3);
  bench.send_response = true;
  bench.cycles(10);
  EXPECT_EQ(bench.rules(), "RX108");
}

TEST(CP103, OneMissingResponse) {
  Bench bench;
  bench.cycles(10);
  bench.send_response = false;
  bench.cycle();
  bench.send_response = true;
  bench.cycles(10);
  EXPECT_EQ(bench.rules(), "CP103");
}

TEST(CP103, JumpIsNotBlamedOnTheBus) {
  Bench bench;
  bench.set(0, "servo_on", 1);
  bench.cycles(60);
  bench.drop_cycles(7);
  bench.set(0, "update_counter", 2);
  bench.cycles(60);
  ASSERT_EQ(bench.rules(), "CP103");
  EXPECT_EQ(bench.found("CP103").at(0).arguments[1], 14);
  EXPECT_EQ(bench.found("CP103").at(0).node.bus.kind, BusKind::kNone);
}

TEST(CP103, SequenceGoesBack) {
  Bench bench;
  bench.cycles(60);
  bench.sequence = 3;
  bench.set(0, "cyclic_command", 0);
  bench.set(0, "update_counter", 0);
  bench.cycles(3);
  bench.set(0, "cyclic_command", 2);
  bench.cycles(60);
  EXPECT_EQ(bench.rules(), "CP103");
}

TEST(CP103, SampledRecordsAreSilent) {
  Bench bench;
  bench.sampled = true;
  for (int n = 0; n < 50; ++n) {
    bench.cycle();
    bench.drop_cycles(3);
    bench.set(0, "update_counter", n & 3);
  }
  EXPECT_EQ(bench.rules(), "");
}

TEST(RX111, CycleJitter) {
  Bench bench;
  bench.cycles(10);
  bench.extra_ns = 200'000;
  bench.cycles(3);
  EXPECT_EQ(bench.rules(), "");
  bench.extra_ns = 300'000;
  bench.cycles(3);
  EXPECT_EQ(bench.rules(), "RX111");
}

TEST(RX112, CycleTimeout) {
  Bench bench;
  bench.cycles(10);
  bench.extra_ns = milliseconds(5);
  bench.cycles(3);
  EXPECT_EQ(bench.rules(), "RX112");
}

TEST(RX112, NopIsAllowedAgain) {
  Bench bench;
  bench.set(0, "servo_on", 0);
  bench.cycles(10);
  bench.extra_ns = milliseconds(500);
  bench.set(0, "cyclic_command", 0);
  bench.set(0, "update_counter", 0);
  bench.cycles(4);
  bench.set(0, "cyclic_command", 2);
  bench.cycles(10);
  EXPECT_EQ(bench.rules(), "RX112");
}

TEST(RX113, TooManyAxes) {
  Bench five(5, {}, 83'333);
  five.ratio = 2;
  five.cycles(10);
  EXPECT_EQ(five.rules(), "");
  Bench six(6, {}, 83'333);
  six.ratio = 2;
  six.cycles(10);
  EXPECT_EQ(six.rules(), "RX113");
}

TEST(RX114, MacIdDuplicate) {
  Bench bench(2);
  bench.cycles(3);
  bench.set(1, "mac_id", 0);
  bench.cycles(1);
  EXPECT_EQ(bench.rules(), "RX102 RX114");
}

TEST(RX115, RestartWithServoOn) {
  for (const bool servo_off_first : {false, true}) {
    Bench bench;
    bench.set(0, "servo_on", 1);
    bench.cycles(10);
    bench.extra_ns = milliseconds(20);
    if (servo_off_first) bench.set(0, "servo_on", 0);
    bench.cycles(3);
    bench.set(0, "cyclic_command", 0);
    bench.cycles(3);
    EXPECT_EQ(bench.found("RX115").size(), servo_off_first ? 0U : 1U);
  }
}

TEST(RX201, StuckAtRatioOne) {
  Bench bench;
  bench.cycles(60);
  bench.count = false;
  bench.cycles(3);
  bench.count = true;
  bench.cycles(20);
  ASSERT_EQ(bench.rules(), "RX201");
  EXPECT_EQ(bench.found("RX201").at(0).count, 3U);
  EXPECT_EQ(bench.found("RX201").at(0).basis.kind, BasisKind::kCapture);
}

TEST(RX201, SilentUntilTheRatioIsLearnt) {
  Bench bench;
  bench.cycles(10);
  bench.count = false;
  bench.cycles(2);
  bench.count = true;
  bench.cycles(60);
  EXPECT_EQ(bench.rules(), "");
}

TEST(RX201, ConfiguredRatioNeedsNoLearning) {
  Settings settings;
  settings.rtex.command_update_ratio = 1;
  Bench bench(1, settings);
  bench.cycles(10);
  bench.count = false;
  bench.cycle();
  bench.count = true;
  bench.cycles(5);
  ASSERT_EQ(bench.rules(), "RX201");
  EXPECT_EQ(bench.found("RX201").at(0).basis.kind, BasisKind::kConfigured);
}

TEST(RX201, StuckAtRatioTwo) {
  Bench bench;
  bench.ratio = 2;
  bench.cycles(60);
  bench.count = false;
  bench.cycles(2);
  bench.count = true;
  bench.cycles(20);
  EXPECT_EQ(bench.rules(), "RX201");
}

TEST(RX202, Skip) {
  Bench bench;
  bench.cycles(60);
  bench.set(0, "update_counter", (read(slot(kCommand, "update_counter"), bench.command()) + 1) & 3);
  bench.cycles(20);
  EXPECT_EQ(bench.rules(), "RX202");
}

TEST(RX203, EarlyAtRatioTwo) {
  Bench bench;
  bench.ratio = 2;
  bench.cycles(61);  // the counter moved in the last cycle
  bench.count = false;
  bench.set(0, "update_counter", (read(slot(kCommand, "update_counter"), bench.command()) + 1) & 3);
  bench.cycles(1);
  bench.count = true;
  bench.cycles(21);
  EXPECT_EQ(bench.rules(), "RX203");
}

TEST(RX204, FirstCounterIsNotOne) {
  for (const int first : {1, 3}) {
    Bench bench;
    bench.mac(0, 3);
    bench.set(0, "cyclic_command", 0);
    bench.cycles(5);
    bench.set(0, "cyclic_command", 2);
    bench.set(0, "update_counter", first - 1);
    bench.cycles(40);
    EXPECT_EQ(bench.rules(), first == 1 ? "" : "RX204");
  }
}

TEST(RX204, SilentWithoutNopBefore) {
  Bench bench;
  bench.set(0, "update_counter", 2);
  bench.cycles(40);
  EXPECT_EQ(bench.rules(), "");
}

TEST(RX205, WrongEcho) {
  Bench bench;
  bench.cycles(60);
  bench.on_response = [](std::size_t, MutableBytes block) { block[0] ^= 0x40; };
  bench.cycles(2);
  bench.on_response = nullptr;
  bench.cycles(10);
  ASSERT_EQ(bench.rules(), "RX205");
  EXPECT_EQ(bench.found("RX205").at(0).count, 2U);
}

TEST(RX205, OneStaleResponse) {
  Bench bench;
  bench.cycles(60);
  auto kept = bench.at(0).response;
  bench.on_response = [&](std::size_t, MutableBytes block) { std::copy(kept.begin(), kept.end(), block.begin()); };
  bench.cycle();
  bench.on_response = nullptr;
  bench.cycles(10);
  EXPECT_EQ(bench.rules(), "RX205");
}

TEST(RX210, CycleRatio) {
  Bench bench(1, {}, 1'000'000);
  bench.ratio = 2;
  bench.cycles(60);
  EXPECT_EQ(bench.rules(), "RX210");
}

TEST(RX211, CounterUnused) {
  Bench bench;
  bench.count = false;
  bench.set(0, "cyclic_command", 0);
  bench.cycles(4);
  bench.set(0, "cyclic_command", 2);
  bench.cycles(60);
  ASSERT_EQ(bench.rules(), "RX211");
  EXPECT_EQ(bench.found("RX211").size(), 1U);
}

TEST(RX301, ChainedCommandsInTheA4nMode) {
  Bench bench(1, a4n_mode());
  bench.cycles(10);
  bench.non_cyclic(0, 6, 0x010, 0x0717);
  bench.cycles(5);
  bench.non_cyclic(0, 10, 0x05);
  bench.cycles(5);
  bench.normal();
  bench.cycles(5);
  ASSERT_EQ(bench.rules(), "RX301");
  EXPECT_EQ(bench.found("RX301").at(0).severity, Severity::kError);
  EXPECT_EQ(bench.found("RX301").at(0).node.channel, Channel::kMain);
  EXPECT_EQ(bench.found("RX301").at(0).frame, 31U);
}

TEST(RX301, ExtendModeAllowsIt) {
  Bench bench(1, extend_mode());
  bench.at(0).a4n_ignores = false;
  bench.cycles(10);
  bench.non_cyclic(0, 6, 0x010, 0x0717);
  bench.cycles(5);
  bench.non_cyclic(0, 10, 0x05);
  bench.cycles(5);
  bench.normal();
  bench.cycles(5);
  EXPECT_EQ(bench.rules(), "");
}

TEST(RX301, ExtendModeStartsProfilesFromNormalOnly) {
  Bench bench(1, extend_mode());
  bench.set(0, "cyclic_command", 1);
  bench.set(0, "servo_on", 1);
  bench.cycles(10);
  bench.non_cyclic(0, 10, 0x05);
  bench.cycles(5);
  bench.non_cyclic(0, 7, 0x20);
  bench.cycles(5);
  EXPECT_EQ(bench.rules(), "RX301");
}

TEST(RX301, AssumedModeIsProvedWrongByExecution) {
  Bench bench;
  bench.cycles(10);
  bench.non_cyclic(0, 6, 0x010, 0x0008);
  bench.cycles(5);
  bench.non_cyclic(0, 10, 0x05);  // the bench's drive answers with the new arguments
  bench.cycles(500);
  EXPECT_EQ(bench.rules(), "");
}

TEST(RX301, AssumedModeIsANoteOfLowerSeverity) {
  Bench bench;
  bench.cycles(10);
  bench.non_cyclic(0, 6, 0x010, 0x0008);
  bench.cycles(5);
  auto taken = bench.at(0).response;
  bench.on_response = [&](std::size_t, MutableBytes block) {  // the drive keeps answering the old command
    block[1] = taken[1];
    std::copy(taken.begin() + 8, taken.begin() + 16, block.begin() + 8);
  };
  bench.non_cyclic(0, 10, 0x05);
  bench.cycles(150);
  EXPECT_EQ(bench.found("RX301").size(), 0U) << "the echo limit has not passed";
  bench.cycles(100);
  ASSERT_EQ(bench.found("RX301").size(), 1U);
  const Finding finding = bench.found("RX301").at(0);
  EXPECT_EQ(finding.severity, Severity::kWarning);
  EXPECT_EQ(finding.basis.kind, BasisKind::kAssumed);
  EXPECT_EQ(finding.related[0], 31U);
}

TEST(RX302, LeftBeforeTheEcho) {
  Bench bench;
  bench.cycles(10);
  bench.non_cyclic(0, 6, 0x010, 0x0717);
  bench.cycles(2);
  bench.normal();
  bench.cycles(10);
  ASSERT_EQ(bench.rules(), "RX302");
  EXPECT_EQ(bench.found("RX302").at(0).frame, 25U);
}

TEST(RX302, HeldUntilTheEchoIsSilent) {
  Bench bench;
  bench.cycles(10);
  bench.non_cyclic(0, 6, 0x010, 0x0717);
  bench.cycles(3);
  bench.normal();
  bench.cycles(10);
  EXPECT_EQ(bench.rules(), "");
}

TEST(RX302, ALostResponseSilencesIt) {
  Bench bench;
  bench.cycles(10);
  bench.non_cyclic(0, 6, 0x010, 0x0717);
  bench.cycle();
  bench.send_response = false;
  bench.cycle();
  bench.send_response = true;
  bench.normal();
  bench.cycles(10);
  EXPECT_EQ(bench.rules(), "CP103");
}

TEST(RX303, StartedWhileBusy) {
  Bench bench;
  bench.cycles(10);
  bench.at(0).busy = true;
  bench.non_cyclic(0, 6, 0x081);
  bench.cycles(5);
  bench.normal();
  bench.cycles(3);
  bench.non_cyclic(0, 10, 0x05);
  bench.cycles(1);
  EXPECT_EQ(bench.rules(), "RX303 RX304");
}

TEST(RX303, AfterBusyIsSilent) {
  Bench bench;
  bench.cycles(10);
  bench.at(0).busy = true;
  bench.non_cyclic(0, 6, 0x081);
  bench.cycles(5);
  bench.at(0).busy = false;
  bench.cycles(2);
  bench.normal();
  bench.cycles(3);
  bench.non_cyclic(0, 10, 0x05);
  bench.cycles(5);
  EXPECT_EQ(bench.rules(), "");
}

TEST(RX303, SubChannelHasItsOwnBusy) {
  Bench bench;
  bench.at(0).wide = true;
  bench.sub(0, 0, 0);
  bench.cycles(10);
  bench.at(0).busy = true;
  bench.non_cyclic(0, 6, 0x081);
  bench.cycles(5);
  bench.sub(0, 10, 0x05);
  bench.cycles(5);
  bench.sub(0, 0, 0);
  bench.cycles(5);
  EXPECT_EQ(bench.rules(), "");
}

TEST(RX304, LeftWhileBusy) {
  Bench bench;
  bench.cycles(10);
  bench.at(0).busy = true;
  bench.non_cyclic(0, 6, 0x081);
  bench.cycles(5);
  bench.normal();
  bench.cycles(3);
  EXPECT_EQ(bench.rules(), "RX304");
}

TEST(RX304, SoftwareResetReturnsOnTheEcho) {
  Bench bench;
  bench.cycles(10);
  bench.at(0).busy = true;
  bench.non_cyclic(0, 1, 0x001);
  bench.cycles(5);
  bench.normal();
  bench.cycles(3);
  EXPECT_EQ(bench.rules(), "");
}

TEST(RX305, ArgumentsChangeWhileHeld) {
  Bench bench(1, a4n_mode());
  bench.cycles(10);
  bench.non_cyclic(0, 6, 0x010, 0x0717);
  bench.cycles(5);
  bench.non_cyclic(0, 6, 0x010, 0x0718);
  bench.cycles(5);
  bench.normal();
  bench.cycles(5);
  ASSERT_EQ(bench.rules(), "RX305");
  EXPECT_EQ(bench.found("RX305").at(0).frame, 31U);
}

TEST(RX305, ExtendModeAllowsIt) {
  Bench bench(1, extend_mode());
  bench.at(0).a4n_ignores = false;
  bench.cycles(10);
  bench.non_cyclic(0, 6, 0x010, 0x0717);
  bench.cycles(5);
  bench.non_cyclic(0, 6, 0x010, 0x0718);
  bench.cycles(5);
  bench.normal();
  bench.cycles(5);
  EXPECT_EQ(bench.rules(), "");
}

TEST(RX305, ProvedByTheNewIndexEcho) {
  Bench bench;
  bench.at(0).a4n_ignores = false;
  bench.cycles(10);
  bench.non_cyclic(0, 6, 0x010, 0x0008);
  bench.cycles(5);
  bench.non_cyclic(0, 6, 0x010, 0x0009);
  bench.cycles(400);
  EXPECT_EQ(bench.rules(), "");
}

TEST(RX305, FeedforwardChangesFreely) {
  Bench bench(1, a4n_mode());
  bench.cycles(10);
  bench.non_cyclic(0, 10, 0x05);
  bench.cycles(5);
  bench.command()[12] = 0;
  bench.position(0, 500);
  bench.cycles(5);
  bench.normal();
  bench.cycles(5);
  EXPECT_EQ(bench.rules(), "");
}

TEST(RX306, ReservedCode) {
  Bench bench;
  bench.cycles(10);
  bench.non_cyclic(0, 3, 0);
  bench.cycles(5);
  EXPECT_EQ(bench.rules(), "RX306");
}

TEST(RX306, SubCode) {
  Bench bench;
  bench.at(0).wide = true;
  bench.sub(0, 0, 0);
  bench.cycles(10);
  bench.sub(0, 6, 0x10);
  bench.cycles(5);
  ASSERT_EQ(bench.rules(), "RX306");
  EXPECT_EQ(bench.found("RX306").at(0).node.channel, Channel::kSub);
}

TEST(RX401, ModeChangeFromACommand) {
  Bench bench;
  bench.cycles(10);
  bench.non_cyclic(0, 6, 0x010, 0x0717);
  bench.cycles(5);
  bench.normal();
  bench.set(0, "cyclic_command", 3);
  bench.cycles(10);
  EXPECT_EQ(bench.rules(), "RX401");
}

TEST(RX401, FromTheNormalCommandIsSilent) {
  Bench bench;
  bench.cycles(10);
  bench.set(0, "cyclic_command", 3);
  bench.cycles(10);
  bench.set(0, "cyclic_command", 1);
  bench.cycles(10);
  EXPECT_EQ(bench.rules(), "");
}

TEST(RX402, ModeChangeWhileBusy) {
  Bench bench;
  bench.cycles(10);
  bench.at(0).busy = true;
  bench.non_cyclic(0, 6, 0x081);
  bench.cycles(5);
  bench.set(0, "cyclic_command", 3);
  bench.cycles(1);
  EXPECT_EQ(bench.rules(), "RX402");
}

TEST(RX403, ModeChangeTooSoon) {
  for (const unsigned cycles : {3U, 4U}) {  // 2 ms are 4 cycles
    Bench bench;
    bench.cycles(10);
    bench.set(0, "cyclic_command", 3);
    bench.cycles(cycles);
    bench.set(0, "cyclic_command", 4);
    bench.cycles(10);
    EXPECT_EQ(bench.rules(), cycles == 3 ? "RX403" : "");
  }
}

TEST(RX410, NopAfterStart) {
  Bench bench;
  bench.set(0, "cyclic_command", 0);
  bench.cycles(5);
  EXPECT_EQ(bench.rules(), "");
  bench.set(0, "update_counter", 0);
  bench.set(0, "cyclic_command", 2);
  bench.cycles(5);
  bench.set(0, "cyclic_command", 0);
  bench.cycles(2);
  bench.set(0, "cyclic_command", 2);
  bench.cycles(5);
  ASSERT_EQ(bench.rules(), "RX410");
  EXPECT_EQ(bench.found("RX410").at(0).count, 2U);
}

TEST(RX410, AllowedAfterASoftwareReset) {
  Bench bench;
  bench.cycles(10);
  bench.non_cyclic(0, 1, 0x001);
  bench.cycles(5);
  bench.normal();
  bench.cycles(1);
  bench.set(0, "cyclic_command", 0);
  bench.set(0, "update_counter", 0);
  bench.cycles(10);
  bench.set(0, "cyclic_command", 2);
  bench.cycles(10);
  EXPECT_EQ(bench.rules(), "");
}

TEST(RX901, OneEpisodeAndItsCause) {
  Bench bench;
  bench.cycles(10);
  bench.non_cyclic(0, 3, 0);
  bench.cycles(3);
  bench.at(0).error_code = 0x0022;
  bench.cycles(5);
  bench.at(0).error_code = 0;
  bench.normal();
  bench.cycles(5);
  ASSERT_EQ(bench.rules(), "RX306 RX901");
  const Finding finding = bench.found("RX901").at(0);
  EXPECT_EQ(finding.arguments[0], 0x22);
  EXPECT_EQ(finding.count, 5U);
  EXPECT_EQ(rule_row(finding.cause.rule).id, "RX306");
  EXPECT_EQ(finding.cause.frame, 21U);
}

TEST(RX902, AlarmRises) {
  Bench bench;
  bench.cycles(10);
  bench.at(0).alarm = true;
  bench.cycles(5);
  ASSERT_EQ(bench.rules(), "RX902");
  ASSERT_EQ(bench.found("RX902").size(), 1U);
  EXPECT_EQ(bench.found("RX902").at(0).arguments[2], 0);
}

TEST(RX902, SetBeforeTheCapture) {
  Bench bench;
  bench.at(0).alarm = true;
  bench.cycles(5);
  ASSERT_EQ(bench.found("RX902").size(), 1U);
  EXPECT_EQ(bench.found("RX902").at(0).arguments[2], 1);
}

TEST(RX902, AGapDoesNotHideIt) {
  Bench bench;
  bench.cycles(10);
  bench.drop_cycles(5);
  bench.at(0).alarm = true;
  bench.cycles(5);
  EXPECT_EQ(bench.rules(), "CP103 RX902");
}

TEST(Ring, StartsAnywhereInTheTraffic) {
  // The capture begins inside a command that is left while Busy: nothing is known of its start.
  Bench bench;
  bench.non_cyclic(0, 6, 0x010, 0x0717);
  bench.cycles(1);
  bench.normal();
  bench.cycles(10);
  EXPECT_EQ(bench.rules(), "");
}

}  // namespace
}  // namespace servotrace::rtex::test
