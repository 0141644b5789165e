// SPDX-License-Identifier: MIT
// The YS rules that poll messages alone decide: each raised, and as close to it as possible without.
#include <gtest/gtest.h>

#include "decoder/profiles/yaskawa_ns310/profile.hpp"
#include "decoder/profiles/yaskawa_ns310/rules.hpp"
#include "tests/support/bytes.hpp"
#include "tests/support/drive_bench.hpp"

namespace servotrace::ns310 {
namespace {

using test::hex;

// Responses: servo ready (byte 2 bit 0), response code 01h, position 0.
constexpr const char* kOff = "00 00 01 21 00 00 00 00";         // servo off
constexpr const char* kOn = "C0 00 01 21 00 00 00 00";          // servo on, Valid Data confirmed
constexpr const char* kMoving = "C1 00 21 21 00 00 00 00";      // in progress, Trajectory Start Echo
constexpr const char* kAlarmed = "48 00 01 21 00 00 00 00";     // alarm, servo off
constexpr const char* kCommandErr = "C0 00 81 21 00 00 00 00";  // command error
// Commands: enable, NOP.
constexpr const char* kIdle = "C0 00 20 21 00 00 00 00";
constexpr const char* kGo128000 = "C1 00 21 21 00 F4 01 00";  // 5.4.1, with response code 01h

class Ns310Rules : public ::testing::Test {
 protected:
  void poll(const char* command, const char* response, int times = 1) {
    bench_.poll(hex(command), hex(response), times);
  }
  // Servo on, nothing runs, both known.
  void ready() { poll(kIdle, kOn, 2); }
  test::DriveBench bench_{kProfile};
};

TEST_F(Ns310Rules, AnOrdinaryPositioningIsClean) {
  poll("00 00 20 21 00 00 00 00", "00 00 01 21 00 00 00 00", 2);
  poll("80 00 20 21 00 00 00 00", "00 00 01 21 00 00 00 00");
  poll("80 00 20 21 00 00 00 00", "80 00 01 21 00 00 00 00");
  poll("C0 00 22 21 40 1F 00 00", "C0 00 01 21 00 00 00 00");
  poll("C1 00 21 21 00 F4 01 00", "C1 00 21 21 10 00 00 00", 4);
  poll("C0 00 21 21 00 F4 01 00", "C4 00 01 21 00 F4 01 00", 3);
  bench_.finish();
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(Ns310Rules, YS101AxisInstance) {
  poll("C0 00 40 21 00 00 00 00", kOn);
  EXPECT_EQ(bench_.rules(), "YS101");
  EXPECT_EQ(bench_.last("YS101").where.offset, 2U);
  EXPECT_EQ(message(bench_.last("YS101")),
            "axis instance 2 beside the command code and 1 beside the response code; both must be 1");
}
TEST_F(Ns310Rules, YS101SilentWithoutValidData) {
  poll("80 00 40 41 00 00 00 00", "80 00 01 21 00 00 00 00");
  EXPECT_EQ(bench_.rules(), "");
}
TEST_F(Ns310Rules, YS101IsOneEpisode) {
  poll("C0 00 40 21 00 00 00 00", kOn, 5);
  EXPECT_EQ(bench_.count("YS101"), 1);
  EXPECT_EQ(bench_.last("YS101").count, 5U);
  poll(kIdle, kOn);
  poll("C0 00 40 21 00 00 00 00", kOn);
  EXPECT_EQ(bench_.count("YS101"), 2);
}

TEST_F(Ns310Rules, YS102EveryReservedCommandCode) {
  for (int code = 0; code < 32; ++code) {
    test::DriveBench bench{kProfile};
    auto command = hex(kIdle);
    command[2] = static_cast<std::uint8_t>(0x20 | code);
    command[4] = 1;  // a legal value of every code
    bench.poll(command, hex(kOn));
    const bool reserved = (code >= 0x05 && code <= 0x10) || (code >= 0x13 && code <= 0x1D) || code == 0x1F;
    EXPECT_EQ(bench.rules(), reserved ? "YS102" : "") << code;
    command[0] = 0x80;
    test::DriveBench quiet{kProfile};
    quiet.poll(command, hex("80 00 01 21 00 00 00 00"));
    EXPECT_EQ(quiet.rules(), "") << code;
  }
}

TEST_F(Ns310Rules, YS103EveryReservedResponseCode) {
  for (int code = 0; code < 32; ++code) {
    test::DriveBench bench{kProfile};
    auto command = hex(kIdle);
    command[3] = static_cast<std::uint8_t>(0x20 | code);
    bench.poll(command, hex(kOn));
    EXPECT_EQ(bench.rules(), code <= 0x03 || code == 0x1E ? "" : "YS103") << code;
  }
}

TEST_F(Ns310Rules, YS104StartServoOff) {
  poll("40 00 20 21 00 00 00 00", "40 00 01 21 00 00 00 00", 2);
  poll("41 00 21 21 00 F4 01 00", "40 00 01 21 00 00 00 00");
  EXPECT_EQ(bench_.rules(), "YS104");
  EXPECT_NE(bench_.last("YS104").related[0], 0U);
}
TEST_F(Ns310Rules, YS104StartBlockServoOff) {
  poll("40 00 20 21 00 00 00 00", "40 00 01 21 00 00 00 00", 2);
  poll("42 01 20 21 00 00 00 00", "40 00 01 21 00 00 00 00");
  EXPECT_EQ(bench_.rules(), "YS104");
}
TEST_F(Ns310Rules, YS104NotForAlarmClearNorWithoutAResponse) {
  poll("40 00 20 21 00 00 00 00", "40 00 01 21 00 00 00 00", 2);
  poll("41 00 3E 21 01 00 00 00", "40 00 01 21 00 00 00 00");
  EXPECT_EQ(bench_.rules(), "");
  test::DriveBench fresh{kProfile};
  fresh.command(hex("40 00 20 21 00 00 00 00"));
  fresh.command(hex("41 00 21 21 00 F4 01 00"));
  EXPECT_EQ(fresh.rules(), "");
}
TEST_F(Ns310Rules, YS104NotAcrossAGap) {
  poll("40 00 20 21 00 00 00 00", kOff, 2);
  bench_.gap();
  poll("41 00 21 21 00 F4 01 00", kOff);
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(Ns310Rules, YS105StartWithEnable) {
  poll("40 00 20 21 00 00 00 00", "40 00 01 21 00 00 00 00", 2);
  poll("C1 00 21 21 00 F4 01 00", "40 00 01 21 00 00 00 00");
  EXPECT_EQ(bench_.rules(), "YS105");  // and not YS104 for the same act
}
TEST_F(Ns310Rules, YS105NotForAlarmClearNorOnePollLater) {
  poll("40 00 20 21 00 00 00 00", "40 00 01 21 00 00 00 00", 2);
  poll("C1 00 3E 21 01 00 00 00", "C0 00 01 21 00 00 00 00");
  poll(kIdle, kOn);
  poll(kGo128000, kMoving);
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(Ns310Rules, YS106StartWithoutValid) {
  poll("80 00 20 21 00 00 00 00", "80 00 01 21 00 00 00 00", 2);
  poll("81 00 21 21 00 F4 01 00", "80 00 01 21 00 00 00 00");
  EXPECT_EQ(bench_.rules(), "YS106");
  EXPECT_EQ(message(bench_.last("YS106")), "Start Trajectory rises while Valid Data = 0: the data are not taken");
}
TEST_F(Ns310Rules, YS106BothTogetherIsAllowed) {
  poll("80 00 20 21 00 00 00 00", "80 00 01 21 00 00 00 00", 2);
  poll(kGo128000, kMoving);
  EXPECT_EQ(bench_.rules(), "");
}
TEST_F(Ns310Rules, YS106NeedsTheEdge) {
  poll("81 00 21 21 00 F4 01 00", "80 00 01 21 00 00 00 00", 3);  // the capture begins under a held start
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(Ns310Rules, YS107ValueNotPositive) {
  for (const char* bad :
       {"C0 00 22 21 00 00 00 00", "C0 00 23 21 FF FF FF FF", "C0 00 24 21 00 00 00 00", "C0 00 31 21 FF FF FF FF"}) {
    test::DriveBench bench{kProfile};
    bench.poll(hex(bad), hex(kOn));
    EXPECT_EQ(bench.rules(), "YS107") << bad;
  }
  for (const char* good : {"C0 00 22 21 01 00 00 00", "C0 00 31 21 00 00 00 00", "80 00 22 21 00 00 00 00"}) {
    test::DriveBench bench{kProfile};
    bench.poll(hex(good), hex(kOn));
    EXPECT_EQ(bench.rules(), "") << good;
  }
}

TEST_F(Ns310Rules, YS108PositionRange) {
  poll("C0 00 21 21 FF E0 F5 05", kOn);  // 99,999,999
  poll("C0 00 21 21 01 1F 0A FA", kOn);  // -99,999,999
  EXPECT_EQ(bench_.rules(), "");
  poll("C0 00 21 21 00 E1 F5 05", kOn);  // 100,000,000
  EXPECT_EQ(bench_.rules(), "YS108");
  EXPECT_EQ(bench_.last("YS108").arguments[0], 100'000'000);
}

TEST_F(Ns310Rules, YS109ValidNotEchoed) {
  bench_.step_ms = 20;
  poll("C0 00 20 21 00 00 00 00", "80 00 01 21 00 00 00 00", 2);
  EXPECT_EQ(bench_.rules(), "");
  poll("C0 00 20 21 00 00 00 00", "80 00 01 21 00 00 00 00", 4);
  EXPECT_EQ(bench_.count("YS109"), 1);
}
TEST_F(Ns310Rules, YS109NeedsPollsAndTime) {
  poll("C0 00 20 21 00 00 00 00", "80 00 01 21 00 00 00 00", 8);  // 80 ms
  bench_.wait_ms(1000);
  poll("80 00 20 21 00 00 00 00", "80 00 01 21 00 00 00 00");
  bench_.step_ms = 500;
  poll("C0 00 20 21 00 00 00 00", "80 00 01 21 00 00 00 00", 2);  // 2 polls, 2 s
  bench_.gap();
  poll("C0 00 20 21 00 00 00 00", "80 00 01 21 00 00 00 00", 2);
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(Ns310Rules, YS110CommandErrorNotCleared) {
  ready();
  poll("C0 00 25 21 00 00 00 00", kCommandErr);
  poll(kIdle, kCommandErr);
  EXPECT_EQ(bench_.rules(), "YS102 YS110 YS902");
}
TEST_F(Ns310Rules, YS110NotAfterValidDataWasDropped) {
  ready();
  poll("C0 00 25 21 00 00 00 00", kCommandErr);
  poll("80 00 20 21 00 00 00 00", "80 00 01 21 00 00 00 00");
  poll(kGo128000, kMoving);
  EXPECT_EQ(bench_.rules(), "YS102 YS902");
}

TEST_F(Ns310Rules, YS111StartNotEchoed) {
  ready();
  bench_.step_ms = 20;
  poll(kGo128000, kOn, 2);
  EXPECT_EQ(bench_.rules(), "");
  poll(kGo128000, kOn, 3);
  EXPECT_EQ(bench_.rules(), "YS111");
  poll(kGo128000, kOn, 5);
  EXPECT_EQ(bench_.count("YS111"), 1);
}
TEST_F(Ns310Rules, YS111NotWhereTheStartFallsOrTheDriveRefuses) {
  ready();
  bench_.step_ms = 20;
  poll(kGo128000, kOn, 2);
  poll("C0 00 21 21 00 F4 01 00", kOn, 4);
  EXPECT_EQ(bench_.rules(), "");
  poll(kGo128000, kAlarmed, 5);
  EXPECT_EQ(bench_.count("YS111"), 0);
}
TEST_F(Ns310Rules, YS111NotAfterAnotherFindingOrForAlarmClear) {
  ready();
  bench_.step_ms = 20;
  poll("C1 00 32 21 02 00 00 00", kOn, 6);  // homing type 2
  EXPECT_EQ(bench_.rules(), "YS114");
  poll(kIdle, kOn);
  poll("C1 00 3E 21 01 00 00 00", kOn, 6);
  EXPECT_EQ(bench_.rules(), "YS114");
}

TEST_F(Ns310Rules, YS112StartWhileMoving) {
  ready();
  poll(kGo128000, kMoving, 2);
  poll("C0 00 20 21 00 00 00 00", kMoving);
  poll("C1 00 32 21 00 00 00 00", kMoving);
  EXPECT_EQ(bench_.rules(), "YS112");
  EXPECT_EQ(message(bench_.last("YS112")), "a start of homing while positioning runs: it is disabled");
}
TEST_F(Ns310Rules, YS112NotForTheSameKindNorWhereTheKindIsUnknown) {
  ready();
  poll(kGo128000, kMoving, 2);
  poll("C0 00 20 21 00 00 00 00", kMoving);
  poll("C1 00 21 21 00 00 00 00", kMoving);
  EXPECT_EQ(bench_.rules(), "");
  test::DriveBench late{kProfile};
  late.poll(hex(kIdle), hex(kMoving), 2);  // the capture begins in motion
  late.poll(hex("C1 00 32 21 00 00 00 00"), hex(kMoving));
  EXPECT_EQ(late.rules(), "");
}

TEST_F(Ns310Rules, YS113StartInAlarm) {
  poll(kIdle, kAlarmed, 2);
  poll(kGo128000, kAlarmed);
  EXPECT_EQ(bench_.count("YS113"), 1);
  EXPECT_EQ(bench_.count("YS104"), 0);  // one start, one finding
}
TEST_F(Ns310Rules, YS113NotForAlarmClear) {
  poll(kIdle, kAlarmed, 2);
  poll("C1 00 3E 21 01 00 00 00", kOff);
  EXPECT_EQ(bench_.rules(), "YS901");
}

TEST_F(Ns310Rules, YS114HomingType) {
  for (int type = 0; type < 256; ++type) {
    test::DriveBench bench{kProfile};
    auto command = hex("C0 00 32 21 00 00 00 00");
    command[4] = static_cast<std::uint8_t>(type);
    bench.poll(command, hex(kOn));
    EXPECT_EQ(bench.rules(), type == 0 || type == 1 || type == 3 ? "" : "YS114") << type;
  }
}

TEST_F(Ns310Rules, YS115ReservedBytes) {
  for (const char* bad : {"C0 00 32 21 00 01 00 00", "C0 00 3E 21 03 00 00 00", "C0 00 3E 21 00 00 00 80"}) {
    test::DriveBench bench{kProfile};
    bench.poll(hex(bad), hex(kOn));
    EXPECT_EQ(bench.rules(), "YS115") << bad;
  }
  ready();
  poll("C1 00 3E 21 00 00 00 00", kOn);
  EXPECT_EQ(bench_.rules(), "YS115");
}
TEST_F(Ns310Rules, YS115NotBeforeTheStart) {
  ready();
  poll("C0 00 3E 21 00 00 00 00", kOn);
  poll("C1 00 3E 21 01 00 00 00", kOn, 2);
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(Ns310Rules, YS116NoNewEdge) {
  ready();
  bench_.step_ms = 20;
  poll(kGo128000, kMoving, 2);
  poll("C1 00 21 21 00 10 00 00", kMoving, 3);
  EXPECT_EQ(bench_.rules(), "");
  poll("C1 00 21 21 00 10 00 00", kMoving, 3);
  EXPECT_EQ(bench_.rules(), "YS116");
  poll("C1 00 21 21 00 10 00 00", kMoving, 3);
  EXPECT_EQ(bench_.count("YS116"), 1);
}
TEST_F(Ns310Rules, YS116NotForARotationsSpeedNorWithAnEdge) {
  ready();
  bench_.step_ms = 20;
  poll("C9 00 31 23 40 1F 00 00", kMoving, 2);
  poll("C9 00 31 23 00 10 00 00", kMoving, 8);
  EXPECT_EQ(bench_.rules(), "");
  test::DriveBench pulsed{kProfile};
  pulsed.step_ms = 20;
  pulsed.poll(hex(kIdle), hex(kOn), 2);
  pulsed.poll(hex(kGo128000), hex(kMoving), 2);
  pulsed.poll(hex("C0 00 21 21 00 10 00 00"), hex(kMoving));
  pulsed.poll(hex("C1 00 21 21 00 10 00 00"), hex(kMoving), 8);
  EXPECT_EQ(pulsed.rules(), "");
}

TEST_F(Ns310Rules, YS117StopReleasedEarly) {
  ready();
  poll(kGo128000, kMoving);
  poll("D0 00 21 21 00 F4 01 00", kMoving, 2);
  poll("C0 00 21 21 00 F4 01 00", kMoving);
  EXPECT_EQ(bench_.rules(), "YS117");
}
TEST_F(Ns310Rules, YS117NotAtStandstill) {
  ready();
  poll(kGo128000, kMoving);
  poll("D0 00 21 21 00 F4 01 00", kMoving, 2);
  poll("D0 00 21 21 00 F4 01 00", kOn);
  poll("C0 00 21 21 00 F4 01 00", kOn);
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(Ns310Rules, YS118EnableNotReady) {
  poll("00 00 20 21 00 00 00 00", "00 00 00 21 00 00 00 00", 2);
  poll("80 00 20 21 00 00 00 00", "00 00 00 21 00 00 00 00");
  EXPECT_EQ(bench_.rules(), "YS118");
  EXPECT_EQ(bench_.last("YS118").severity, Severity::kNote);
}

TEST_F(Ns310Rules, YS119ContinuousChangeIgnored) {
  ready();
  bench_.step_ms = 20;
  poll("C9 00 31 23 40 1F 00 00", kMoving, 2);
  poll("C8 00 31 23 00 10 00 00", kMoving, 8);  // without Start Trajectory
  EXPECT_EQ(bench_.rules(), "YS119");
  EXPECT_EQ(bench_.count("YS119"), 1);
}
TEST_F(Ns310Rules, YS119TakenWithBothBits) {
  ready();
  bench_.step_ms = 20;
  poll("C9 00 31 23 40 1F 00 00", kMoving, 2);
  poll("C8 00 31 23 40 1F 00 00", kMoving, 8);  // the start falls, the speed stays
  poll("C9 00 31 23 00 10 00 00", kMoving, 8);
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(Ns310Rules, YS120StartWhileStopHeld) {
  poll("D0 00 20 21 00 00 00 00", kOn, 2);
  poll("D1 00 21 21 00 F4 01 00", kOn);
  EXPECT_EQ(bench_.rules(), "YS120");
}

TEST_F(Ns310Rules, YS121StartNothing) {
  ready();
  poll("C1 00 22 21 40 1F 00 00", kOn);
  EXPECT_EQ(bench_.rules(), "YS121");
  poll(kIdle, kOn);
  poll("C3 01 21 21 00 F4 01 00", kOn);
  EXPECT_EQ(bench_.count("YS121"), 2);
}

TEST_F(Ns310Rules, YS201IntoSoftwareLimit) {
  poll(kIdle, "C0 00 09 21 00 01 00 00", 2);  // positive software limit, position 256
  poll("C1 00 21 21 00 02 00 00", "C0 00 09 21 00 01 00 00");
  EXPECT_EQ(bench_.count("YS201"), 1);
  EXPECT_EQ(bench_.last("YS201").severity, Severity::kError);
}
TEST_F(Ns310Rules, YS201AwayFromTheLimitIsAllowed) {
  poll(kIdle, "C0 00 09 21 00 01 00 00", 2);
  poll("C1 00 21 21 00 00 00 00", "C1 00 29 21 00 01 00 00", 2);
  EXPECT_EQ(bench_.count("YS201"), 0);
}
TEST_F(Ns310Rules, YS201HardwareLimitRestsOnTheAssumedDirection) {
  poll(kIdle, "C0 00 03 21 00 00 00 00", 2);  // CW hardware limit
  poll("C9 00 31 21 40 1F 00 00", "C0 00 03 21 00 00 00 00");
  EXPECT_EQ(bench_.count("YS201"), 1);
  EXPECT_EQ(bench_.last("YS201").severity, Severity::kWarning);
  EXPECT_EQ(bench_.last("YS201").basis.kind, BasisKind::kAssumed);
}
TEST_F(Ns310Rules, YS201TargetSideUnknown) {
  poll("C0 00 20 23 00 00 00 00", "C0 00 09 23 00 00 00 00", 2);  // the response shows the speed
  poll("C1 00 21 23 00 02 00 00", "C1 00 29 23 00 00 00 00");
  EXPECT_EQ(bench_.count("YS201"), 0);
}

TEST_F(Ns310Rules, YS203EnableDroppedInMotion) {
  ready();
  poll(kGo128000, kMoving);
  poll("40 00 21 21 00 F4 01 00", "40 00 01 21 00 00 00 00");
  EXPECT_EQ(bench_.rules(), "YS203");
}
TEST_F(Ns310Rules, YS203NotAtStandstill) {
  ready();
  poll("40 00 20 21 00 00 00 00", "40 00 01 21 00 00 00 00");
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(Ns310Rules, YS301StartBlock) {
  ready();
  poll("C2 00 20 21 00 00 00 00", kOn);
  EXPECT_EQ(bench_.rules(), "YS301");
  EXPECT_EQ(bench_.last("YS301").severity, Severity::kError);
  poll(kIdle, "C2 01 01 21 00 00 00 00");
  poll("C2 01 20 21 00 00 00 00", "C2 01 01 21 00 00 00 00");
  EXPECT_EQ(bench_.count("YS301"), 2);
  EXPECT_EQ(bench_.last("YS301").severity, Severity::kWarning);
}
TEST_F(Ns310Rules, YS301StartOfBlock1IsClean) {
  ready();
  poll("C2 01 20 21 00 00 00 00", "C2 01 01 21 00 00 00 00", 3);
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(Ns310Rules, YS901AlarmWithItsCode) {
  ready();
  poll(kIdle, kAlarmed);
  EXPECT_EQ(bench_.rules(), "");  // waits for the code
  const std::uint64_t rise = bench_.frame();
  poll("C0 00 20 3E 00 00 00 00", "48 00 01 3E 0D 00 00 00");
  EXPECT_EQ(bench_.rules(), "YS901");
  EXPECT_EQ(bench_.last("YS901").related[0], rise);
  EXPECT_EQ(bench_.last("YS901").severity, Severity::kError);
  const std::string text = message(bench_.last("YS901"));
  EXPECT_NE(text.find("alarm now: 0Dh (Deviation Excess); SGDH: A.D0"), std::string::npos) << text;
  poll("C0 00 20 3E 00 00 00 00", "48 00 01 3E 0D 00 00 00", 5);
  EXPECT_EQ(bench_.count("YS901"), 1);
}
TEST_F(Ns310Rules, YS901WithoutItsCodeAfterASecondOrWhenItFalls) {
  ready();
  poll(kIdle, kAlarmed);
  bench_.wait_ms(1000);
  bench_.other_frame();
  EXPECT_EQ(bench_.count("YS901"), 1);
  EXPECT_NE(message(bench_.last("YS901")).find("its code was not read"), std::string::npos);
  poll(kIdle, kOff);
  poll(kIdle, kAlarmed);
  poll(kIdle, kOff);
  EXPECT_EQ(bench_.count("YS901"), 2);
}
TEST_F(Ns310Rules, YS901SinceTheCaptureBeganIsANote) {
  poll(kIdle, kAlarmed);
  bench_.finish();
  EXPECT_EQ(bench_.count("YS901"), 1);
  EXPECT_EQ(bench_.last("YS901").severity, Severity::kNote);
  EXPECT_NE(message(bench_.last("YS901")).find("since the capture began"), std::string::npos);
}

TEST_F(Ns310Rules, YS902NamesItsCause) {
  ready();
  poll("C0 00 25 21 00 00 00 00", kCommandErr);
  EXPECT_EQ(bench_.rules(), "YS102 YS902");
  EXPECT_EQ(bench_.last("YS902").cause.rule, rule("YS102"));
  EXPECT_EQ(bench_.last("YS902").cause.frame, bench_.last("YS102").frame);
}
TEST_F(Ns310Rules, YS902WithoutACauseNamesNone) {
  ready();
  poll("C0 00 25 21 00 00 00 00", kOn, 2);  // reserved, but the drive did not refuse it
  poll(kIdle, kOn, 3);
  poll(kIdle, kCommandErr, 3);
  EXPECT_EQ(bench_.count("YS902"), 1);
  EXPECT_EQ(bench_.last("YS902").cause.frame, 0U);
}

TEST_F(Ns310Rules, YS903And904) {
  ready();
  poll(kIdle, "D0 00 01 21 00 00 00 00", 3);
  poll(kIdle, "C0 00 03 21 00 00 00 00", 3);
  EXPECT_EQ(bench_.count("YS903"), 1);
  EXPECT_EQ(bench_.count("YS904"), 1);
  EXPECT_EQ(message(bench_.last("YS904")), "CW hardware limit reached now");
}

TEST_F(Ns310Rules, YS905WaitsForItsCode) {
  ready();
  poll(kIdle, "C0 00 41 21 00 00 00 00");
  EXPECT_EQ(bench_.rules(), "");
  bench_.wait_ms(1000);
  poll(kIdle, "C0 00 41 21 00 00 00 00");
  EXPECT_EQ(bench_.rules(), "YS905");
}

TEST_F(Ns310Rules, AGuessedDriveIsDecodedAndNotJudged) {
  test::DriveBench guessed{kProfile, {}, true};
  guessed.poll(hex("C1 00 45 2F 00 00 00 00"), hex(kAlarmed), 3);
  guessed.finish();
  EXPECT_EQ(guessed.rules(), "");
  ASSERT_EQ(guessed.dissection().segments.size(), 2U);
  EXPECT_TRUE(guessed.dissection().segments[0].guessed);
}

TEST_F(Ns310Rules, SegmentsFollowTheCodes) {
  bench_.command(hex(kGo128000));
  ASSERT_EQ(bench_.dissection().segments.size(), 2U);
  EXPECT_EQ(bench_.dissection().segments[0].layout, &kCommand);
  EXPECT_EQ(bench_.dissection().segments[1].layout, &kTargetPosition);
  EXPECT_EQ(bench_.dissection().segments[1].offset, 4U);
  bench_.response(hex("48 00 01 3E 0D 00 00 00"));
  EXPECT_EQ(bench_.dissection().segments[1].layout, &kAlarmCode);
}

}  // namespace
}  // namespace servotrace::ns310
