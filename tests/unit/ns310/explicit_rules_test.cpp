// SPDX-License-Identifier: MIT
// The YS rules that explicit messages decide: parameters and command blocks. Each raised, and nearly raised.
#include <gtest/gtest.h>

#include "decoder/profiles/yaskawa_ns310/blocks.hpp"
#include "decoder/profiles/yaskawa_ns310/profile.hpp"
#include "decoder/profiles/yaskawa_ns310/rules.hpp"
#include "tests/support/bytes.hpp"
#include "tests/support/drive_bench.hpp"

namespace servotrace::ns310 {
namespace {

using test::hex;

constexpr const char* kOn = "C0 00 01 21 00 00 00 00";
constexpr const char* kMoving = "C1 00 21 21 00 00 00 00";
constexpr const char* kIdle = "C0 00 20 21 00 00 00 00";
constexpr const char* kGo = "C1 00 21 21 00 F4 01 00";
constexpr const char* kBlocksRun = "C2 01 01 21 00 00 00 00";

class Ns310Explicit : public ::testing::Test {
 protected:
  void poll(const char* command, const char* response, int times = 1) {
    bench_.poll(hex(command), hex(response), times);
  }
  void ready() { poll(kIdle, kOn, 2); }
  void start_block_1() {
    poll("C2 01 20 21 00 00 00 00", kBlocksRun);
    poll(kIdle, kOn);
  }
  // Set_Attribute_All of a block.
  void set_block(std::uint16_t number, const char* data) {
    bench_.request(0x02, 0x27, number, -1, hex(data));
    bench_.answer();
  }
  void set(std::uint16_t class_id, std::int32_t attribute, const char* data) {
    bench_.set(class_id, 1, attribute, hex(data));
  }
  test::DriveBench bench_{kProfile};
};

TEST_F(Ns310Explicit, YS202HomeBeforeHoming) {
  bench_.start();
  ready();
  set_block(1, "10 00 00 00 00 00 40 1F 00 00");
  start_block_1();
  EXPECT_EQ(bench_.rules(), "YS202");
}
TEST_F(Ns310Explicit, YS202NotAfterAHomingNorWithoutTheStart) {
  bench_.start();
  ready();
  poll("C1 00 32 21 00 00 00 00", kMoving);
  poll(kIdle, kOn);
  set_block(1, "10 00 00 00 00 00 40 1F 00 00");
  start_block_1();
  EXPECT_EQ(bench_.rules(), "");
  test::DriveBench late{kProfile};
  late.poll(hex(kIdle), hex(kOn), 2);
  late.request(0x02, 0x27, 1, -1, hex("10 00 00 00 00 00 40 1F 00 00"));
  late.answer();
  late.poll(hex("C2 01 20 21 00 00 00 00"), hex(kBlocksRun));
  EXPECT_EQ(late.rules(), "");
}

TEST_F(Ns310Explicit, YS302BlockEditRunning) {
  poll(kIdle, kBlocksRun, 2);
  set_block(2, "06 00 08 00 00 00");
  EXPECT_EQ(bench_.rules(), "YS302");
}
TEST_F(Ns310Explicit, YS302ReadingIsAllowedAndSoIsEditingAtRest) {
  poll(kIdle, kBlocksRun, 2);
  bench_.get(0x27, 2, 1, hex("06"));
  poll(kIdle, kOn);
  set_block(2, "06 00 08 00 00 00");
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(Ns310Explicit, YS303BlockHalfWritten) {
  ready();
  bench_.set(0x27, 1, 1, hex("08"));
  bench_.set(0x27, 1, 3, hex("00 F4 01 00"));
  start_block_1();
  EXPECT_EQ(bench_.rules(), "YS303");
  EXPECT_EQ(bench_.last("YS303").arguments[1], 4);  // the speed
}
TEST_F(Ns310Explicit, YS303ThroughALink) {
  ready();
  set_block(1, "06 02 08 00 00 00");
  bench_.set(0x27, 2, 1, hex("06"));
  start_block_1();
  EXPECT_EQ(bench_.rules(), "YS303");
  EXPECT_EQ(bench_.last("YS303").arguments[0], 2);
}
TEST_F(Ns310Explicit, YS303ZeroIsAValueOfPositionAndMode) {
  ready();
  bench_.set(0x27, 1, 1, hex("08"));
  bench_.set(0x27, 1, 4, hex("40 1F 00 00"));
  start_block_1();
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(Ns310Explicit, YS304EmptyBlockIsAnError) {
  ready();
  set_block(1, "06 02 08 00 00 00");
  bench_.get(0x27, 2, 1, hex("00"));
  start_block_1();
  EXPECT_EQ(bench_.rules(), "YS304");
  EXPECT_EQ(bench_.last("YS304").severity, Severity::kError);
}
TEST_F(Ns310Explicit, YS304EndlessLoopIsAWarning) {
  ready();
  set_block(1, "09 02 40 1F 00 00");
  set_block(2, "09 01 00 10 00 00");
  start_block_1();
  EXPECT_EQ(bench_.rules(), "YS304");
  EXPECT_EQ(bench_.last("YS304").severity, Severity::kWarning);
}
TEST_F(Ns310Explicit, YS304AWaitOrABranchInTheLoopIsEnough) {
  ready();
  set_block(1, "09 02 40 1F 00 00");
  set_block(2, "06 01 08 00 00 00");  // a delay
  start_block_1();
  set_block(2, "03 01 25 01 0D 03 00 00 00 00");  // link if greater
  set_block(3, "09 00 40 1F 00 00");
  start_block_1();
  EXPECT_EQ(bench_.rules(), "");
}
TEST_F(Ns310Explicit, YS304UnknownBlocksAreNoFault) {
  ready();
  set_block(1, "09 02 40 1F 00 00");
  start_block_1();
  EXPECT_EQ(bench_.rules(), "");
}

// B.8: 26h/1 names the block, a Set of 26h/2 to 1 starts it.
TEST_F(Ns310Explicit, YS303AndYS304ByTheSequencer) {
  ready();
  set_block(1, "09 02 40 1F 00 00");
  set_block(2, "09 01 00 10 00 00");
  bench_.set(0x26, 1, 1, hex("01"));
  EXPECT_EQ(bench_.rules(), "");
  bench_.set(0x26, 1, 2, hex("00"));
  EXPECT_EQ(bench_.rules(), "");
  bench_.set(0x26, 1, 2, hex("01"));
  EXPECT_EQ(bench_.rules(), "YS304");
  bench_.set(0x27, 7, 1, hex("08"));
  bench_.get(0x26, 1, 1, hex("07"));
  bench_.set(0x26, 1, 2, hex("01"));
  EXPECT_EQ(bench_.rules(), "YS303 YS304");
}
// YS104 and YS301 are of the bit Start_Block (5.3.1, 5.3.3): B.8 says neither that 26h/2 is ignored with the servo off
// nor that a running chain refuses it.
TEST_F(Ns310Explicit, NeitherYS104NorYS301ByTheSequencer) {
  poll("40 00 20 21 00 00 00 00", "40 00 01 21 00 00 00 00", 2);  // servo off
  set_block(1, "06 00 08 00 00 00");
  bench_.set(0x26, 1, 1, hex("01"));
  bench_.set(0x26, 1, 2, hex("01"));
  poll(kIdle, kBlocksRun, 2);
  bench_.set(0x26, 1, 2, hex("01"));
  EXPECT_EQ(bench_.rules(), "");
}
TEST_F(Ns310Explicit, YS304TheSequencersBlockIsNotKnown) {
  ready();
  set_block(1, "09 01 40 1F 00 00");
  bench_.set(0x26, 1, 2, hex("01"));
  EXPECT_EQ(bench_.rules(), "");
}
// A Set may be among the records lost: what is known of blocks is not held against anyone.
TEST_F(Ns310Explicit, YS303AndYS304AfterAGap) {
  ready();
  bench_.set(0x27, 1, 1, hex("08"));
  set_block(2, "09 02 40 1F 00 00");
  bench_.gap();
  ready();
  start_block_1();
  bench_.set(0x26, 1, 1, hex("02"));
  bench_.set(0x26, 1, 2, hex("01"));
  EXPECT_EQ(bench_.rules(), "");
  set_block(2, "09 02 40 1F 00 00");
  bench_.set(0x26, 1, 2, hex("01"));
  EXPECT_EQ(bench_.rules(), "YS304");
}

TEST_F(Ns310Explicit, YS401YS402AndYS403AfterAGap) {
  ready();
  set(0x64, 30, "E8 03 00 00");  // 1000
  set(0x64, 58, "03");
  bench_.gap();
  ready();
  set(0x64, 31, "05 00 00 00");  // over 5: the numerator may have been set anew, too
  set(0x64, 56, "02");
  bench_.gap();
  ready();
  poll("C1 00 21 21 00 F4 01 00", kMoving);
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(Ns310Explicit, YS305BlockAttribute) {
  ready();
  set_block(1, "01 00 25 01 07 40 1F 00 00");  // target speed is not in Table 5.4
  EXPECT_EQ(bench_.rules(), "YS305");
  set_block(2, "02 00 25 01 08 00 00 00 00 00 00 00 00");  // acceleration cannot be compared
  EXPECT_EQ(bench_.count("YS305"), 2);
}
TEST_F(Ns310Explicit, YS305EveryAttributeOfTheTables) {
  ready();
  for (const char* good :
       {"01 00 25 01 08 40 1F 00 00", "01 00 25 01 09 40 1F 00 00", "01 00 64 01 34 64 00 00 00",
        "01 00 64 01 35 64 00 00 00", "02 00 25 01 0D 00 00 00 00 00 00 00 00", "03 00 25 01 0F 02 00 00 00 00",
        "04 00 25 01 13 02 00 00 00 00", "04 00 25 01 15 02 00 00 00 00"}) {
    set_block(1, good);
  }
  bench_.set(0x27, 1, 1, hex("01"));  // one by one: whole only at the end
  bench_.set(0x27, 1, 3, hex("25"));
  bench_.set(0x27, 1, 4, hex("01"));
  bench_.set(0x27, 1, 5, hex("08"));
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(Ns310Explicit, YS306BlockDelayTruncated) {
  ready();
  set_block(1, "06 00 64 00 00 00");  // 100 ms
  EXPECT_EQ(bench_.rules(), "YS306");
  EXPECT_EQ(bench_.last("YS306").severity, Severity::kNote);
}
TEST_F(Ns310Explicit, YS306MultiplesOf8AreKept) {
  ready();
  set_block(1, "06 00 68 00 00 00");  // 104 ms
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(Ns310Explicit, YS401GearRatio) {
  ready();
  set(0x64, 30, "65 00 00 00");  // 101
  set(0x64, 31, "01 00 00 00");
  EXPECT_EQ(bench_.rules(), "");  // more may follow
  bench_.wait_ms(1000);
  bench_.other_frame();
  EXPECT_EQ(bench_.rules(), "YS401");
}
TEST_F(Ns310Explicit, YS401TheBordersAndOneUnknownAreSilent) {
  ready();
  set(0x64, 30, "FF FF 00 00");
  bench_.wait_ms(1100);
  bench_.other_frame();
  set(0x64, 30, "64 00 00 00");  // 100 : 1
  set(0x64, 31, "01 00 00 00");
  bench_.wait_ms(1100);
  bench_.other_frame();
  set(0x64, 30, "01 00 00 00");  // 1 : 100
  set(0x64, 31, "64 00 00 00");
  bench_.wait_ms(1100);
  bench_.other_frame();
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(Ns310Explicit, YS402EveryPairOfTable429) {
  for (int filter = 0; filter < 4; ++filter) {
    for (int type = 0; type < 4; ++type) {
      test::DriveBench bench{kProfile};
      bench.poll(hex(kIdle), hex(kOn), 2);
      bench.set(0x64, 1, 58, {static_cast<std::uint8_t>(filter)});
      bench.set(0x64, 1, 56, {static_cast<std::uint8_t>(type)});
      bench.wait_ms(1100);
      bench.other_frame();
      const bool legal = filter == 0 || type == 0 || (filter == 3 && type != 2);
      EXPECT_EQ(bench.rules(), legal ? "" : "YS402") << filter << " " << type;
    }
  }
}

TEST_F(Ns310Explicit, YS403ParameterNeedsReset) {
  ready();
  set(0x25, 24, "01");
  poll(kGo, kMoving);
  EXPECT_EQ(bench_.rules(), "YS403");
}
TEST_F(Ns310Explicit, YS403NotAfterAResetNorForAnImmediateOne) {
  ready();
  set(0x25, 24, "01");
  bench_.start();
  ready();
  set(0x25, 38, "08");
  poll(kGo, kMoving);
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(Ns310Explicit, YS404FlashWear) {
  ready();
  for (int i = 0; i < 11; ++i) {
    set(0x25, 38, "08");
    poll(kGo, kMoving);
    poll(kIdle, kOn);
  }
  EXPECT_EQ(bench_.rules(), "YS404");
}
TEST_F(Ns310Explicit, YS404NotForTheProfileOfAMoveNorForTen) {
  ready();
  for (int i = 0; i < 30; ++i) {
    set(0x25, 8, "40 1F 00 00");
    if (i < 10) set(0x25, 38, "08");
    poll(kGo, kMoving);
    poll(kIdle, kOn);
  }
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(Ns310Explicit, YS905WithItsCode) {
  ready();
  poll(kIdle, "C0 00 41 21 00 00 00 00");
  bench_.get(0x26, 1, 5, hex("01"));
  EXPECT_EQ(bench_.rules(), "YS905");
  EXPECT_EQ(message(bench_.last("YS905")), "Block Fault now: 1 (invalid or empty block data)");
}

TEST_F(Ns310Explicit, YS201WithTheReferenceDirectionRead) {
  ready();
  bench_.get(0x25, 1, 24, hex("00"));
  poll(kIdle, "C0 00 03 21 00 00 00 00", 2);
  poll("C9 00 31 21 40 1F 00 00", "C0 00 03 21 00 00 00 00");
  EXPECT_EQ(bench_.count("YS201"), 1);
  EXPECT_EQ(bench_.last("YS201").severity, Severity::kError);
  EXPECT_EQ(bench_.last("YS201").basis.kind, BasisKind::kCapture);
}

TEST_F(Ns310Explicit, ChainsAreShownAsAProgram) {
  ready();
  set_block(1, "08 02 00 F4 01 00 40 1F 00 00 00");
  set_block(2, "06 01 08 00 00 00");
  bench_.command(hex("C2 01 20 21 00 00 00 00"));
  std::string shown;
  for (const Derived& derived : bench_.dissection().derived) shown = std::string(derived.text);
  EXPECT_EQ(shown,
            "block 1: trajectory and wait, target_position 128000, target_speed 8000, incremental 0, then 2; "
            "block 2: delay, delay 8, then 1; again from 1");
}

TEST_F(Ns310Explicit, Object25hAttribute8IsOneOfThree) {
  const devicenet::ObjectClass* found = devicenet::find_class(kProfile.objects, 0x25);
  ASSERT_NE(found, nullptr);
  const devicenet::Attribute* acceleration = found->find(8);
  ASSERT_NE(acceleration, nullptr);
  EXPECT_EQ(acceleration->type, devicenet::DataType::kDint);
  EXPECT_EQ(acceleration->unit, Unit::kStepPerSecond2);
  // 5.6.2: the answer 0x00001234.
  EXPECT_EQ(read(slot_of(found->layout_of(*acceleration)->fields[0]), hex("34 12 00 00")), 0x1234);
}

}  // namespace
}  // namespace servotrace::ns310
