// SPDX-License-Identifier: MIT
// Starts, levels and reports: NK301-NK311, NK901-NK905, each raised and nearly raised.
#include "tests/unit/esb/esb_bench.hpp"

namespace servotrace::esb {
namespace {

class EsbMotion : public EsbRules {
 protected:
  // Programs the channel and closes the edit.
  void program(int channel, std::initializer_list<std::pair<int, int>> steps) {
    write(500, channel);
    for (const auto& [number, data] : steps) write(number, data);
    write(502);
  }
  void run(unsigned channel, const Out& out) { poll({.byte0 = kSvon | kRun, .prg = channel}, out); }
  const Out busy_{.byte0 = kReady | kBusy};
};

TEST_F(EsbMotion, ARunIsClean) {
  ready();
  poll({.prg = 5}, {.ack_prg = 5});
  run(5, {.byte0 = kReady | kBusy, .ack_prg = 5});
  poll({}, {.byte0 = kReady | kBusy, .ack_prg = 5}, 4);
  poll({}, {}, 3);
  bench_.finish();
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(EsbMotion, NK301StartNotReady) {
  poll({.byte0 = 0}, {.byte0 = kDrdy | kHcmp}, 2);
  poll({.byte0 = kRun}, {.byte0 = kDrdy | kHcmp});
  EXPECT_EQ(bench_.rules(), "NK301");
  test::DriveBench hos{kProfile};
  hos.poll(bytes_of(In{}), bytes_of(Out{.byte0 = kHcmp | kBrk}), 2);
  hos.poll(bytes_of(In{.byte0 = kSvon | kHos}), bytes_of(Out{.byte0 = kHcmp | kBrk}));
  EXPECT_EQ(hos.count("NK301"), 1);
  test::DriveBench jog{kProfile};
  jog.poll(bytes_of(In{.byte0 = 0}), bytes_of(Out{}), 2);
  jog.poll(bytes_of(In{.byte0 = 0, .byte2 = kJog}), bytes_of(Out{}));
  EXPECT_EQ(jog.count("NK301"), 1);
  test::DriveBench command{kProfile};
  command.poll(bytes_of(In{.byte0 = 0}), bytes_of(Out{}), 2);
  command.poll(bytes_of(In{.byte0 = 0, .request = true, .write = true, .number = 408, .data = 9}), bytes_of(Out{}));
  EXPECT_EQ(command.rules(), "NK301");
}
TEST_F(EsbMotion, NK301NotForAHeldInputOrAParameter) {
  poll({.byte0 = kRun}, {.byte0 = kDrdy | kHcmp}, 3);  // the capture begins under RUN
  poll({.byte0 = kRun, .request = true, .write = true, .number = 2, .data = 450}, {.byte0 = kDrdy | kHcmp});
  EXPECT_EQ(bench_.rules(), "");
}
TEST_F(EsbMotion, NK301SvonInTheSameMessageIsEnough) {
  poll({.byte0 = 0}, {}, 2);
  run(0, busy_);
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(EsbMotion, NK302StartWhileBusy) {
  ready();
  program(5, {{600, 9000}});
  run(5, {.byte0 = kReady | kBusy, .ack_prg = 5});
  poll({.prg = 5}, {.byte0 = kReady | kBusy, .ack_prg = 5});
  run(5, {.byte0 = kReady | kBusy, .ack_prg = 5});
  EXPECT_EQ(bench_.rules(), "NK302");
  EXPECT_EQ(bench_.last("NK302").severity, Severity::kWarning);
}
TEST_F(EsbMotion, NK302NotWhereTheChannelWaitsForRun) {
  ready();
  program(5, {{600, 9000}, {661, 2}});
  run(5, {.byte0 = kReady | kBusy, .ack_prg = 5});
  poll({.prg = 5}, {.byte0 = kReady | kBusy, .ack_prg = 5});
  run(5, {.byte0 = kReady | kBusy, .ack_prg = 5});
  EXPECT_EQ(bench_.rules(), "");
}
TEST_F(EsbMotion, NK302NotWhereALineOfTheChannelWaitsForRun) {
  ready();
  program(5, {{610, 40000}, {661, 2}, {610, 40000}});
  run(5, {.byte0 = kReady | kBusy, .ack_prg = 5});
  poll({.prg = 5}, {.byte0 = kReady | kBusy, .ack_prg = 5});
  run(5, {.byte0 = kReady | kBusy, .ack_prg = 5});
  EXPECT_EQ(bench_.rules(), "");
}
TEST_F(EsbMotion, NK309NotWhereTheFirstLineHomes) {
  const Out no_home{.byte0 = kDrdy | kBrk};
  ready();
  program(0, {{620, 0}, {661, 1}, {600, 9000}, {663, 1000}});
  poll({}, no_home, 2);
  poll({.byte0 = kSvon | kRun}, no_home);
  EXPECT_EQ(bench_.count("NK309"), 0);
}
TEST_F(EsbMotion, NK302UnknownProgramIsANoteForRunOnly) {
  ready();
  run(5, {.byte0 = kReady | kBusy, .ack_prg = 5});
  poll({}, {.byte0 = kReady | kBusy, .ack_prg = 5});
  run(6, {.byte0 = kReady | kBusy, .ack_prg = 5});
  EXPECT_EQ(bench_.last("NK302").severity, Severity::kNote);
  poll({.byte0 = kSvon | kHos}, {.byte0 = kReady | kBusy, .ack_prg = 5});
  EXPECT_EQ(bench_.last("NK302").severity, Severity::kWarning);
  EXPECT_EQ(bench_.count("NK302"), 2);
}
// The program may have been edited among the records lost.
TEST_F(EsbMotion, NK302AProgramBeforeAGapIsANote) {
  ready();
  program(5, {{610, 4000}});
  bench_.gap();
  ready();
  run(5, {.byte0 = kReady | kBusy, .ack_prg = 5});
  poll({}, {.byte0 = kReady | kBusy, .ack_prg = 5});
  run(6, {.byte0 = kReady | kBusy, .ack_prg = 5});
  EXPECT_EQ(bench_.last("NK302").severity, Severity::kNote);
}
TEST_F(EsbMotion, NK302NotForJog) {
  ready();
  poll({.byte0 = kSvon | kHos}, busy_);
  poll({.byte2 = kJog}, busy_);
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(EsbMotion, NK303StartWhileStopped) {
  poll({.byte0 = kSvon | kStp}, {}, 2);
  poll({.byte0 = kSvon | kStp | kRun}, {});
  EXPECT_EQ(bench_.rules(), "NK303");
}
TEST_F(EsbMotion, NK303StpAlreadyReleased) {
  poll({.byte0 = kSvon | kStp}, {}, 2);
  run(0, busy_);
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(EsbMotion, NK304StartInEmergencyComesFirst) {
  poll({.byte0 = kEmst | kStp}, {.byte2 = kEmsta}, 2);
  poll({.byte0 = kEmst | kStp | kRun}, {.byte2 = kEmsta});
  EXPECT_EQ(bench_.count("NK304"), 1);
  EXPECT_EQ(bench_.count("NK303") + bench_.count("NK301"), 0);
}

TEST_F(EsbMotion, NK305StartNotSeen) {
  ready();
  run(5, {.ack_prg = 5});
  poll({.byte0 = kSvon | kRun, .prg = 5}, {.ack_prg = 5}, 10);
  EXPECT_EQ(bench_.rules(), "");
  bench_.wait_ms(150);
  poll({.byte0 = kSvon, .prg = 5}, {.ack_prg = 5});
  EXPECT_EQ(bench_.rules(), "NK305");
  EXPECT_EQ(bench_.last("NK305").severity, Severity::kNote);
}
TEST_F(EsbMotion, NK305NotWhereItWasStoppedOrSeen) {
  ready();
  run(5, {.byte0 = kReady | kBusy, .ack_prg = 5});
  poll({.prg = 5}, {.ack_prg = 5});
  bench_.wait_ms(500);
  poll({.prg = 5}, {.ack_prg = 5});
  run(5, {.ack_prg = 5});
  poll({.byte0 = kSvon | kStp, .prg = 5}, {.ack_prg = 5});
  bench_.wait_ms(500);
  poll({.byte0 = kSvon | kStp, .prg = 5}, {.ack_prg = 5});
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(EsbMotion, NK306And307And311InMotionOnly) {
  ready();
  poll({.byte0 = kSvon | kClr | kOrd}, {});
  poll({}, {});
  EXPECT_EQ(bench_.rules(), "");
  run(5, busy_);
  poll({}, busy_);
  poll({.byte0 = kSvon | kClr}, busy_);
  EXPECT_EQ(bench_.rules(), "NK306");
  poll({.byte0 = kSvon | kClr | kOrd}, busy_);
  EXPECT_EQ(bench_.rules(), "NK306 NK307");
  poll({.byte0 = 0}, {.byte0 = kDrdy | kHcmp});
  EXPECT_EQ(bench_.rules(), "NK306 NK307 NK311");
}
TEST_F(EsbMotion, NK311NotAtStandstill) {
  ready();
  poll({.byte0 = 0}, {.byte0 = kDrdy | kHcmp});
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(EsbMotion, NK308ReservedBit) {
  ready();
  poll({.byte2 = 0x04}, {}, 3);
  EXPECT_EQ(bench_.rules(), "NK308");
  EXPECT_EQ(bench_.count("NK308"), 1);
  test::DriveBench all{kProfile};
  all.poll(bytes_of(In{.byte0 = 0xFE & ~(kRun | kStp | kHos), .prg = 63, .byte2 = 2}), bytes_of(Out{}), 3);
  EXPECT_EQ(all.count("NK308"), 0);
}

TEST_F(EsbMotion, NK309RunBeforeHome) {
  const Out no_home{.byte0 = kDrdy | kBrk};
  ready();
  program(5, {{600, 9000}});
  poll({}, no_home, 2);
  EXPECT_EQ(bench_.count("NK905"), 1);
  poll({.byte0 = kSvon | kRun, .prg = 5}, no_home);
  EXPECT_EQ(bench_.count("NK309"), 1);
  EXPECT_EQ(bench_.last("NK309").severity, Severity::kWarning);
}
TEST_F(EsbMotion, NK309UnknownProgramIsANote) {
  const Out no_home{.byte0 = kDrdy | kBrk};
  poll({}, no_home, 2);
  poll({.byte0 = kSvon | kRun, .prg = 5}, no_home);
  EXPECT_EQ(bench_.rules(), "NK309");
  EXPECT_EQ(bench_.last("NK309").severity, Severity::kNote);
}
TEST_F(EsbMotion, NK309NotWhereItHomesFirst) {
  const Out no_home{.byte0 = kDrdy | kBrk};
  ready();
  program(5, {{640, 7}});
  program(7, {{620, 0}, {661, 1}});
  poll({}, no_home, 2);
  poll({.byte0 = kSvon | kRun, .prg = 5}, no_home);
  poll({}, no_home);
  poll({.byte0 = kSvon | kHos}, no_home);
  EXPECT_EQ(bench_.count("NK309"), 0);
}
TEST_F(EsbMotion, NK309NotWithAutomaticHoming) {
  const Out no_home{.byte0 = kDrdy | kBrk};
  ready();
  write(141, 1);
  poll({}, no_home, 2);
  poll({.byte0 = kSvon | kRun, .prg = 5}, no_home);
  EXPECT_EQ(bench_.count("NK309"), 0);
}
TEST_F(EsbMotion, NK309PositioningCommand) {
  const Out no_home{.byte0 = kDrdy | kBrk};
  poll({}, no_home, 2);
  poll({.request = true, .write = true, .number = 400, .data = 9000}, no_home);
  EXPECT_EQ(bench_.rules(), "NK309");
  test::DriveBench incremental{kProfile};
  incremental.poll(bytes_of(In{}), bytes_of(no_home), 2);
  incremental.poll(bytes_of(In{.request = true, .write = true, .number = 410, .data = 9000}), bytes_of(no_home));
  EXPECT_EQ(incremental.rules(), "");
}

TEST_F(EsbMotion, NK310OverrideZero) {
  ready();
  write(131, 0);
  poll({.byte0 = kSvon | kRun | kOrd, .prg = 5}, {.ack_prg = 5});
  EXPECT_EQ(bench_.rules(), "NK310");
  EXPECT_EQ(bench_.last("NK310").basis.kind, BasisKind::kCapture);
}
TEST_F(EsbMotion, NK310NotWithoutOverrideOrWithAnotherRatio) {
  ready();
  write(131, 0);
  run(5, busy_);
  poll({}, {});
  write(131, 1);
  poll({.byte0 = kSvon | kRun | kOrd, .prg = 5}, busy_);
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(EsbMotion, NK901WithThePatternAndThenTheWord) {
  ready();
  write(281, 1);
  poll({}, {.byte0 = kBrk | kHcmp});  // DRDY 0, OVER 0, BRK 1
  EXPECT_EQ(bench_.rules(), "");
  bench_.wait_ms(1000);
  bench_.other_frame();
  ASSERT_EQ(bench_.rules(), "NK901");
  EXPECT_EQ(message(bench_.last("NK901")),
            "DRDY is 0 now (DRDY 0, OVER 0, BRK 1); alarms that fit: F1 Excess position error, F2 Software over travel "
            "limit, F3 Hardware over travel limit, C2 RS-232C error; alarm word: not read");
}
TEST_F(EsbMotion, NK901NarrowedByTheAlarmWord) {
  ready();
  const Out down{.byte0 = kBrk | kHcmp};
  poll({}, down);
  poll({.request = true, .number = 800}, down);
  poll({.request = true, .number = 800},
       {.byte0 = kBrk | kHcmp, .ack = true, .sts = true, .number = 800, .data = 0x00000004});
  ASSERT_EQ(bench_.rules(), "NK901");
  EXPECT_EQ(message(bench_.last("NK901")),
            "DRDY is 0 now (DRDY 0, OVER 0, BRK 1); alarms that fit: F2 Software over travel limit; alarm word: "
            "00000004h");
}
TEST_F(EsbMotion, NK901AZeroWordLeavesTheAlarmsWithoutABit) {
  ready();
  poll({}, {.byte0 = kHcmp});
  poll({.request = true, .number = 800}, {.byte0 = kHcmp, .ack = true, .sts = true, .number = 800});
  EXPECT_EQ(message(bench_.last("NK901")),
            "DRDY is 0 now (DRDY 0, OVER 0, BRK 0); alarms that fit: E0 Memory error, E2 EEPROM error, E8 Interface "
            "error; alarm word: 00000000h");
}
TEST_F(EsbMotion, NK901SinceTheCaptureBeganIsANote) {
  poll({.byte0 = 0}, {.byte0 = 0}, 3);
  bench_.finish();
  EXPECT_EQ(bench_.rules(), "NK901");
  EXPECT_EQ(bench_.last("NK901").severity, Severity::kNote);
}
TEST_F(EsbMotion, NK901NotWhileANodeStarts) {
  bench_.start();
  poll({.byte0 = 0}, {.byte0 = 0}, 3);
  poll({.byte0 = 0}, {}, 3);
  bench_.finish();
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(EsbMotion, NK902Warning) {
  ready();
  poll({}, {.byte0 = kReady | kOver});
  poll({}, {});
  EXPECT_EQ(bench_.rules(), "NK902");
  EXPECT_EQ(bench_.last("NK902").severity, Severity::kWarning);
}
TEST_F(EsbMotion, NK902NotWhereDrdyFallsWithIt) {
  ready();
  poll({}, {.byte0 = kOver | kHcmp});
  bench_.finish();
  EXPECT_EQ(bench_.rules(), "NK901");
  EXPECT_NE(message(bench_.last("NK901")).find("A4 Velocity error over"), std::string::npos);
}

TEST_F(EsbMotion, NK903And904And905) {
  ready();
  poll({}, {.byte2 = kEmsta}, 3);
  EXPECT_EQ(bench_.rules(), "NK903");
  poll({}, {.byte2 = kOtpa}, 3);
  EXPECT_EQ(bench_.rules(), "NK903 NK904");
  EXPECT_EQ(message(bench_.last("NK904")), "OTPA (+) is 1 now");
  poll({}, {.byte0 = kDrdy | kBrk});
  EXPECT_EQ(bench_.rules(), "NK903 NK904 NK905");
}
TEST_F(EsbMotion, NK905NamesTheDirectionInversion) {
  ready();
  write(101, 1);
  poll({}, {.byte0 = kDrdy | kBrk});
  EXPECT_EQ(message(bench_.last("NK905")), "HCMP falls: DI (101) was written");
}
TEST_F(EsbMotion, ReportsOfTheFirstOutputAreNotes) {
  poll({}, {.byte0 = kDrdy | kBrk | kOver, .byte2 = kEmsta | kOtpa});
  bench_.finish();
  EXPECT_EQ(bench_.rules(), "NK902 NK903 NK904");
  for (const Finding& finding : bench_.findings().all()) EXPECT_EQ(finding.severity, Severity::kNote);
}
TEST_F(EsbMotion, ARiseHiddenByAGapIsReported) {
  ready();
  bench_.gap();
  poll({}, {.byte2 = kEmsta});
  EXPECT_EQ(bench_.rules(), "NK903");
  EXPECT_EQ(bench_.last("NK903").severity, Severity::kWarning);
}

}  // namespace
}  // namespace servotrace::esb
