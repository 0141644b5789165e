// SPDX-License-Identifier: MIT
// The drive models, against the examples of their manuals (bytes typed by hand).
#include "tests/unit/simcan/simulated_frames.hpp"

namespace servotrace::test {
namespace {

const std::string kNs310 = "nodes = [{ mac_id = 5, model = \"ns310\" }]\nsteps = [{ do = \"was_running\" }, ";
const std::string kEsb = "nodes = [{ mac_id = 9, model = \"esb\" }]\nsteps = [{ do = \"was_running\" }, ";

// SIE-C718-7 5.4.1: absolute, 128,000 steps, response code 03h.
TEST(Ns310Model, ExamplePositioning) {
  const auto texts = texts_of(kNs310 + "{ do = \"enable\" }, { do = \"move\", to = 128_000, response_code = 3 }]\n");
  EXPECT_TRUE(contains(texts, "42D#C100212300F40100"));
  // In the end the drive reports: servo on, valid, on target, ready, speed 0.
  EXPECT_EQ(texts.back(), "3C5#C400012300000000");
}

// SIE-C718-7 5.4.2: clockwise at 8,000 steps/s.
TEST(Ns310Model, ExampleContinuousRotation) {
  const auto texts = texts_of(kNs310 + "{ do = \"enable\" }, { do = \"rotate\", speed = 8_000 }]\n");
  EXPECT_TRUE(contains(texts, "42D#C9003123401F0000"));
  // Servo on, valid, in progress; start echo, ready; current speed 8,000 steps/s.
  EXPECT_EQ(texts.back(), "3C5#C1002123401F0000");
}

// SIE-C718-7 5.4.3: homing of type 0; the axis ends at position 0.
TEST(Ns310Model, ExampleHoming) {
  for (const char* type : {"0", "1", "3"}) {
    const auto texts = texts_of(
        kNs310 + "{ do = \"enable\" }, { do = \"command\", response_code = 1 }, { do = \"home\", type = " + type +
        " }]\n");
    EXPECT_TRUE(contains(texts, std::string("42D#C10032210") + type + "000000")) << type;
    // On target, home position 0; the home signal depends on where the switch is.
    EXPECT_EQ(texts.back().substr(6), "00012100000000") << type;
    EXPECT_EQ(texts.back()[5], '4') << type << ' ' << texts.back();
  }
}

// SIE-C718-7 5.5.1: blocks from block 1 on.
TEST(Ns310Model, ExampleStartBlock) {
  const std::string steps =
      "{ do = \"write_block\", block = 1, command = 8, link = 2, to = 5000, speed = 50000 }, "
      "{ do = \"write_block\", block = 2, command = 6, delay_ms = 40 }, { do = \"enable\" }, "
      "{ do = \"command\", response_code = 1 }, { do = \"run_block\", block = 1 }]\n";
  const auto texts = texts_of(kNs310 + steps);
  EXPECT_TRUE(contains(texts, "42D#C201202100000000"));
  // Block In Execution with block 1, then with block 2, then the end at 5,000 steps.
  const auto starts = [&](const char* text) {
    return std::any_of(texts.begin(), texts.end(), [&](const std::string& seen) { return seen.rfind(text, 0) == 0; });
  };
  EXPECT_TRUE(starts("3C5#C301"));
  EXPECT_TRUE(starts("3C5#C602"));
  EXPECT_EQ(texts.back(), "3C5#C400012188130000");
}

// SIE-C718-7 5.6.2: reading acceleration 1234h.
TEST(Ns310Model, ExampleReadingAcceleration) {
  const std::string steps =
      "{ do = \"set_attribute\", class = 0x25, attribute = 8, value = 0x1234 }, "
      "{ do = \"get_attribute\", class = 0x25, attribute = 8 }]\n";
  const auto texts = texts_of(kNs310 + steps);
  EXPECT_TRUE(contains(texts, "42C#400E250108"));
  EXPECT_TRUE(contains(texts, "42B#408E34120000"));
}

// SIE-C718-7 5.3.1, 5.3.3: a wrong axis instance is a command error, cleared by Valid Data = 0.
TEST(Ns310Model, CommandErrorOnAWrongAxis) {
  const std::string steps =
      "{ do = \"command\", command_axis = 2, valid_data = true, polls = 2 }, "
      "{ do = \"command\", command_axis = 1, valid_data = false, polls = 2 }]\n";
  const auto texts = texts_of(kNs310 + steps);
  EXPECT_TRUE(contains(texts, "3C5#4400812000000000"));
  EXPECT_EQ(texts.back(), "3C5#0400012000000000");
}

// SIE-C718-7 5.3.2: alarm clear on the rising edge of Start Trajectory, with its bit 0 set.
TEST(Ns310Model, AlarmAndAlarmClear) {
  const std::string steps =
      "{ do = \"enable\" }, { do = \"machine\", alarm = 0x0D }, { do = \"read_code\", code = 0x1E }, "
      "{ do = \"command\", enable = false }, { do = \"clear_alarm\" }, { do = \"poll\" }]\n";
  const auto texts = texts_of(kNs310 + steps);
  EXPECT_TRUE(contains(texts, "3C5#4C00003E0D000000")) << "alarm, not ready, code 0Dh";
  EXPECT_TRUE(contains(texts, "42D#41003E3E01000000"));
  EXPECT_EQ(texts.back(), "3C5#4400013E00000000");
}

// ESB 5.4.7: VG 45.0 is number 2 with the data 450.
TEST(EsbModel, ExampleWritingVg) {
  const auto texts = texts_of(kEsb + "{ do = \"write\", number = 2, value = 450 }]\n");
  // Bytes 0-6 in the first fragment, 7-9 in the last.
  EXPECT_TRUE(contains(texts, "44D#00000000C00200C2"));
  EXPECT_TRUE(contains(texts, "44D#81010000"));
  const auto answered = std::find_if(texts.begin(), texts.end(), [](const std::string& text) {
    return text.rfind("3C9#00", 0) == 0 && text.substr(12) == "C00200C2";
  });
  EXPECT_NE(answered, texts.end()) << "PRM_ACK, PRM_STS, number and a copy of the data";
}

// ESB 5.4.7: PG set to 400 reads out as 190h.
TEST(EsbModel, ExampleReadingPg) {
  const auto texts =
      texts_of(kEsb + "{ do = \"drive\", parameter = 1, value = 400 }, { do = \"read\", number = 1 }]\n");
  EXPECT_TRUE(contains(texts, "44D#0000000040010000"));
  const auto answered = std::find_if(texts.begin(), texts.end(), [](const std::string& text) {
    return text.rfind("3C9#00", 0) == 0 && text.substr(12) == "C0010090";
  });
  ASSERT_NE(answered, texts.end());
  EXPECT_EQ(*(answered + 1), "3C9#81010000");
}

// ESB 5.3: what was edited is what is read out, and -1 ends it.
TEST(EsbModel, ProgramEditAndReadOut) {
  const std::string steps =
      "{ do = \"edit_program\", channel = 5, lines = [{ command = 600, data = 9000, oe = 1 }] }, "
      "{ do = \"read_program\", channel = 5 }]\n";
  const auto texts = texts_of(kEsb + steps);
  const auto answered = [&](const std::string& number, const std::string& rest) {
    for (std::size_t i = 0; i + 1 < texts.size(); ++i) {
      if (texts[i].rfind("3C9#00", 0) == 0 && texts[i].substr(12) == "C0" + number && texts[i + 1] == "3C9#81" + rest)
        return true;
    }
    return false;
  };
  EXPECT_TRUE(answered("580228", "230000")) << "600, 9000 = 2328h";
  EXPECT_TRUE(answered("950201", "000000")) << "661, 1";
  EXPECT_TRUE(answered("FFFF00", "000000")) << "the end";
}

// ESB 4.4.3, 4.4.9: RUN moves, BUSY and the channel show it, and the position is reached.
TEST(EsbModel, RunsAProgram) {
  const std::string steps =
      "{ do = \"servo_on\" }, { do = \"write\", number = 121, value = 1000 }, "
      "{ do = \"edit_program\", channel = 3, lines = [{ command = 600, data = 9000 }] }, "
      "{ do = \"run\", channel = 3 }, { do = \"read\", number = 848 }]\n";
  const auto texts = texts_of(kEsb + steps);
  const auto busy = std::any_of(texts.begin(), texts.end(), [](const std::string& text) {
    return text.rfind("3C9#003903", 0) == 0;  // DRDY, BUSY, BRK, HCMP; channel 3
  });
  EXPECT_TRUE(busy);
  bool read_back = false;
  for (std::size_t i = 0; i + 1 < texts.size(); ++i) {
    read_back = read_back || (texts[i].rfind("3C9#00", 0) == 0 && texts[i].substr(12) == "C0500328" &&
                              texts[i + 1] == "3C9#81230000");
  }
  EXPECT_TRUE(read_back) << "848 reads 9000 hundredths of a degree";
}

// ESB 5.4.5 (660): a divided incremental positioning goes one part a start; the parts make up the whole.
TEST(EsbModel, DividesAPositioning) {
  const std::string runs = "{ do = \"run\", channel = 3 }, { do = \"read\", number = 848 }";
  const auto texts = texts_of(kEsb +
                              "{ do = \"servo_on\" }, { do = \"write\", number = 121, value = 1000 }, "
                              "{ do = \"edit_program\", channel = 3, lines = [{ command = 608, data = 9000, "
                              "division = 4 }] }, " +
                              runs + ", " + runs + ", " + runs + ", " + runs + "]\n");
  std::vector<std::string> read;
  for (std::size_t i = 0; i + 1 < texts.size(); ++i) {
    if (texts[i].rfind("3C9#00", 0) == 0 && texts[i].substr(12, 6) == "C05003") {
      read.push_back(texts[i].substr(18) + texts[i + 1].substr(6, 2));
    }
  }
  read.erase(std::unique(read.begin(), read.end()), read.end());
  // From 18 degrees on: 4050, 6300, 8550 and 10800 hundredths.
  EXPECT_EQ(read, (std::vector<std::string>{"D20F", "9C18", "6621", "302A"}));
}

}  // namespace
}  // namespace servotrace::test
