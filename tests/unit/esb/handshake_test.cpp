// SPDX-License-Identifier: MIT
// The parameter handshake and what is asked for: NK101-NK112, NK201-NK206, each raised and nearly raised.
#include "tests/unit/esb/esb_bench.hpp"

namespace servotrace::esb {
namespace {

class EsbHandshake : public EsbRules {
 protected:
  const In asked_{.request = true, .write = true, .number = 2, .data = 450};
  const Out done_{.ack = true, .sts = true, .number = 2, .data = 450};
};

TEST_F(EsbHandshake, WritingAndReadingIsClean) {
  ready();
  write(2, 450);
  read(1, 400);
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(EsbHandshake, NK101RequestNotIdle) {
  ready();
  poll(asked_);
  poll(asked_, done_);
  poll({.number = 2}, done_);
  poll(asked_, done_);
  EXPECT_EQ(bench_.rules(), "NK101");
}
TEST_F(EsbHandshake, NK101FromTheFirstMessagesOn) {
  poll({}, done_);
  poll(asked_, done_);
  EXPECT_EQ(bench_.rules(), "NK101");
}
TEST_F(EsbHandshake, NK101NotAcrossAGap) {
  poll({}, done_);
  bench_.gap();
  poll(asked_, done_);
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(EsbHandshake, NK102RequestDropped) {
  ready();
  poll(asked_);
  poll({.number = 2, .data = 450});
  EXPECT_EQ(bench_.rules(), "NK102");
}
TEST_F(EsbHandshake, NK102NotInThePollAfterTheAnswer) {
  ready();
  poll(asked_, done_);
  poll({.number = 2, .data = 450}, done_);
  poll({}, {});
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(EsbHandshake, NK103RequestChanged) {
  ready();
  poll(asked_);
  poll({.request = true, .write = true, .number = 2, .data = 451});
  EXPECT_EQ(bench_.rules(), "NK103");
}
TEST_F(EsbHandshake, NK103DataOfAReadMayChange) {
  ready();
  poll({.request = true, .number = 1, .data = 7});
  poll({.request = true, .number = 1, .data = 8});
  poll({.request = true, .number = 1, .data = 9}, {.ack = true, .sts = true, .number = 1, .data = 400});
  poll({.request = true, .number = 5}, {.ack = true, .sts = true, .number = 1, .data = 400});  // after the answer
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(EsbHandshake, NK104AckMissing) {
  ready();
  poll(asked_);
  bench_.wait_ms(990);
  bench_.other_frame();
  EXPECT_EQ(bench_.rules(), "");
  bench_.wait_ms(20);
  bench_.other_frame();
  EXPECT_EQ(bench_.rules(), "NK104");
  poll(asked_, {}, 5);
  EXPECT_EQ(bench_.count("NK104"), 1);
}
TEST_F(EsbHandshake, NK104LongCommandsHaveSixtySeconds) {
  ready();
  poll({.request = true, .write = true, .number = 301});
  bench_.wait_ms(59'000);
  poll({.request = true, .write = true, .number = 301});
  EXPECT_EQ(bench_.rules(), "");
  bench_.wait_ms(1'100);
  bench_.other_frame();
  EXPECT_EQ(bench_.rules(), "NK104");
}
TEST_F(EsbHandshake, NK104NotWithoutAnyAnswerOrAcrossAGap) {
  ready();
  bench_.command(bytes_of(asked_));
  bench_.wait_ms(5'000);
  bench_.other_frame();  // the polls themselves stay unanswered: that is the link's finding
  bench_.gap();
  poll(asked_);
  bench_.wait_ms(5'000);
  poll(asked_);
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(EsbHandshake, NK105AckStuck) {
  ready();
  poll(asked_, done_);
  poll({}, done_);
  bench_.wait_ms(900);
  poll({}, done_);
  EXPECT_EQ(bench_.rules(), "");
  bench_.wait_ms(200);
  poll({}, done_);
  EXPECT_EQ(bench_.rules(), "NK105");
}

TEST_F(EsbHandshake, NK106ProcessingFailedNamesItsCause) {
  ready();
  transact(true, 1, 2000, 0, false);
  EXPECT_EQ(bench_.rules(), "NK106 NK109");
  EXPECT_EQ(bench_.last("NK106").cause.rule, rule("NK109"));
  EXPECT_EQ(bench_.last("NK106").cause.frame, bench_.last("NK109").frame);
  EXPECT_EQ(bench_.last("NK106").related[0], bench_.last("NK109").frame);
  transact(true, 1, 500, 0, false);
  EXPECT_EQ(bench_.count("NK106"), 2);
  EXPECT_EQ(bench_.last("NK106").cause.frame, 0U);  // the old finding is not its cause
}

TEST_F(EsbHandshake, NK107NumberNotEchoed) {
  ready();
  transact(false, 1, 0, 400, true, 2);
  EXPECT_EQ(bench_.rules(), "NK107");
}
TEST_F(EsbHandshake, NK107NotForAFailureNorForProgramReadOut) {
  ready();
  write(501, 5);
  transact(false, 820, 0, 9000, true, 600);
  transact(false, 820, 0, 0, true, -1);
  write(502);
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(EsbHandshake, NK108EveryNumberOfTheListAndNoOther) {
  for (int number = -1; number <= 900; ++number) {
    test::DriveBench bench{kProfile};
    const bool listed = find_number(number) != nullptr;
    const bool write = number >= 300 && number < 700;
    bench.poll(bytes_of(In{}), bytes_of(Out{}), 2);
    bench.poll(bytes_of(In{.request = true, .write = write, .number = number, .data = 3}), bytes_of(Out{}));
    EXPECT_EQ(bench.count("NK108"), listed ? 0 : 1) << number;
  }
  EXPECT_EQ(find_number(11), nullptr);
  EXPECT_EQ(find_number(413), nullptr);
  EXPECT_NE(find_number(850), nullptr);
}

TEST_F(EsbHandshake, NK109DataRange) {
  struct Case {
    int number;
    int data;
    bool legal;
  };
  const Case cases[] = {{1, 9, false},    {1, 10, true},        {1, 1000, true},     {1, 1001, false},
                        {2, 450, true},   {2, 2551, false},     {42, 0, true},       {42, 2, false},
                        {42, 3, true},    {43, -1000, true},    {43, -2, false},     {43, 0, true},
                        {62, -3, true},   {62, 0, false},       {140, 2, false},     {140, 6, true},
                        {21, 0, true},    {21, 9, false},       {320, 4, false},     {412, 63, true},
                        {412, 64, false}, {400, 35999, true},   {400, 36000, false}, {411, -1, false},
                        {410, -1, true},  {143, -802816, true}, {143, 802817, false}};
  for (const Case& one : cases) {
    test::DriveBench bench{kProfile};
    bench.poll(bytes_of(In{}), bytes_of(Out{}), 2);
    bench.poll(bytes_of(In{.request = true, .write = true, .number = one.number, .data = one.data}), bytes_of(Out{}));
    EXPECT_EQ(bench.count("NK109"), one.legal ? 0 : 1) << one.number << " = " << one.data;
  }
}
TEST_F(EsbHandshake, NK109ResolutionIsANoteAndAccelerationReaches1280) {
  ready();
  transact(true, 82, 2);
  EXPECT_EQ(bench_.last("NK109").severity, Severity::kNote);
  write(500, 1);
  write(600, 9000);
  write(663, 128000);
  EXPECT_EQ(bench_.count("NK109"), 1);
}
TEST_F(EsbHandshake, NK109DataOfAReadAreNotJudged) {
  ready();
  transact(false, 1, 5000, 400);
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(EsbHandshake, NK110WrongDirection) {
  for (const auto& [number, write] : {std::pair{800, true}, {847, true}, {321, false}, {400, false}, {600, false}}) {
    test::DriveBench bench{kProfile};
    bench.poll(bytes_of(In{}), bytes_of(Out{}), 2);
    bench.poll(bytes_of(In{.request = true, .write = write, .number = number}), bytes_of(Out{}));
    EXPECT_EQ(bench.rules(), "NK110") << number;
  }
  ready();
  read(800, 0);
  read(200, 0);
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(EsbHandshake, NK111FunctionNotAvailable) {
  ready();
  poll({.request = true, .write = true, .number = 240, .data = 2});
  EXPECT_EQ(bench_.rules(), "NK111");
  test::DriveBench torque{kProfile};
  torque.poll(bytes_of(In{}), bytes_of(Out{}), 2);
  torque.poll(bytes_of(In{.request = true, .write = true, .number = 440, .data = 9}), bytes_of(Out{}));
  EXPECT_EQ(torque.rules(), "NK111");
}
TEST_F(EsbHandshake, NK111PositionControlMayBeWrittenAndRead) {
  ready();
  write(240, 3);
  read(240, 1);
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(EsbHandshake, NK112FlashWear) {
  ready();
  for (int i = 0; i < 10; ++i) write(2, 450 + i);
  EXPECT_EQ(bench_.rules(), "");
  write(2, 470);
  EXPECT_EQ(bench_.rules(), "NK112");
  EXPECT_EQ(bench_.last("NK112").basis.kind, BasisKind::kAssumed);
}
TEST_F(EsbHandshake, NK112NotWithoutBackupNorSlowly) {
  ready();
  write(200, 1);
  for (int i = 0; i < 30; ++i) write(2, 450 + i);
  write(200, 0);
  bench_.wait_ms(3'600'000);
  for (int i = 0; i < 30; ++i) {
    write(2, 450 + i);
    bench_.wait_ms(370'000);
  }
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(EsbHandshake, NK201ProgramOutsideEdit) {
  ready();
  write(2, 450);  // proof that no edit is open
  write(600, 9000);
  EXPECT_EQ(bench_.rules(), "NK201");
}
TEST_F(EsbHandshake, NK201SilentWhereTheSessionIsUnknown) {
  ready();
  write(600, 9000);  // the edit may have been opened before the capture
  EXPECT_EQ(bench_.rules(), "");
}
TEST_F(EsbHandshake, NK201SilentAfterAFailedProof) {
  ready();
  transact(true, 2, 450, 0, false);
  write(600, 9000);
  EXPECT_EQ(bench_.rules(), "NK106");
}

TEST_F(EsbHandshake, NK202NotProgramInEdit) {
  ready();
  write(500, 5);
  write(2, 450);
  EXPECT_EQ(bench_.rules(), "NK202");
}
TEST_F(EsbHandshake, NK202WholeEditIsClean) {
  ready();
  write(500, 5);
  write(601, 9000);
  write(661, 2);
  write(662, 15000);
  write(663, 1000);
  write(502);
  write(2, 450);
  EXPECT_EQ(bench_.rules(), "");
}
TEST_F(EsbHandshake, NK202NotAfterAFailed500) {
  ready();
  transact(true, 500, 5, 0, false);
  write(2, 450);
  EXPECT_EQ(bench_.rules(), "NK106");
}

TEST_F(EsbHandshake, NK203OptionsByTable52) {
  const int commands[] = {600, 601, 602, 603, 604, 605, 606, 607, 608, 609, 610, 611, 620, 640, 641};
  for (const int command : commands) {
    for (int option = 660; option <= 663; ++option) {
      const bool allowed = command <= 607   ? option != 660
                           : command <= 611 ? true
                           : command == 620 ? option == 661
                                            : false;
      EXPECT_EQ(option_allowed(command, option), allowed) << command << " " << option;
    }
  }
  ready();
  write(500, 5);
  write(640, 6);
  write(662, 100);
  EXPECT_EQ(bench_.rules(), "NK203");
}
TEST_F(EsbHandshake, NK203BeforeAnyCommand) {
  ready();
  write(500, 5);
  write(661, 1);
  EXPECT_EQ(bench_.rules(), "NK203");
}

TEST_F(EsbHandshake, NK204ReadOutsideSession) {
  ready();
  write(502);
  transact(false, 820, 0, 0, true, -1);
  EXPECT_EQ(bench_.rules(), "NK204");
}

TEST_F(EsbHandshake, NK205NotReadInSession) {
  ready();
  write(501, 5);
  read(1, 400);
  EXPECT_EQ(bench_.rules(), "NK205");
}

TEST_F(EsbHandshake, NK206SessionLeftOpen) {
  ready();
  write(500, 5);
  write(600, 9000);
  poll({.byte0 = kSvon | kRun, .prg = 5}, {.byte0 = kReady | kBusy, .ack_prg = 5});
  EXPECT_EQ(bench_.rules(), "NK206");
  EXPECT_EQ(bench_.last("NK206").severity, Severity::kWarning);
}
TEST_F(EsbHandshake, NK206AtTheEndIsANote) {
  ready();
  write(501, 5);
  bench_.finish();
  EXPECT_EQ(bench_.rules(), "NK206");
  EXPECT_EQ(bench_.last("NK206").severity, Severity::kNote);
}
TEST_F(EsbHandshake, NK206NotAfterASuccessful502) {
  ready();
  write(500, 5);
  write(600, 9000);
  write(502);
  poll({.byte0 = kSvon | kRun, .prg = 5}, {.byte0 = kReady | kBusy, .ack_prg = 5});
  bench_.finish();
  EXPECT_EQ(bench_.rules(), "");
}

TEST_F(EsbHandshake, TransactionsAndListingsAreShown) {
  ready();
  poll(asked_);
  const auto shown = [this](std::string_view key) -> std::string {
    for (const Derived& derived : bench_.dissection().derived) {
      if (derived.field->key == key) return std::string(derived.text);
    }
    return "(none)";
  };
  bench_.command(bytes_of(asked_));
  poll(asked_, done_);
  EXPECT_EQ(shown("transaction"), "write VG45.0: successful");
  ASSERT_EQ(bench_.dissection().links.size(), 1U);
  EXPECT_EQ(bench_.dissection().links[0].kind, LinkKind::kRequestIn);
  poll({}, done_);
  poll({});
  poll({.request = true, .number = 1}, {.ack = true, .sts = true, .number = 1, .data = 400});
  EXPECT_EQ(shown("transaction"), "read PG: 0.400");
  poll({}, {.ack = true});
  poll({});
  write(500, 5);
  write(609, -3000);
  write(660, 12);
  write(662, 15000);
  write(663, 1000);
  poll({.request = true, .write = true, .number = 661, .data = 2},
       {.ack = true, .sts = true, .number = 661, .data = 2});
  EXPECT_EQ(shown("listing"), "CH5: ID/EX-3000/12&, CV1.5000, CA10.00");
  poll({}, {.ack = true});
  poll({});
  poll({.request = true, .write = true, .number = 600, .data = 9000},
       {.ack = true, .sts = true, .number = 600, .data = 9000});
  EXPECT_EQ(shown("listing"), "CH5: ID/EX-3000/12&, CV1.5000, CA10.00; AD9000");
}

TEST_F(EsbHandshake, AGuessedDriveIsDecodedAndNotJudged) {
  test::DriveBench guessed{kProfile, {}, true};
  guessed.poll(bytes_of(Out{}), bytes_of(Out{.byte0 = 0}), 2);
  guessed.poll(bytes_of(In{.byte0 = 0xFF, .byte2 = 0xFF, .request = true, .write = true, .number = 2, .data = -7}),
               bytes_of(Out{.byte0 = 0}), 2);
  guessed.finish();
  EXPECT_EQ(guessed.rules(), "");
}

}  // namespace
}  // namespace servotrace::esb
