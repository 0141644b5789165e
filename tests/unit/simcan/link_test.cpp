// SPDX-License-Identifier: MIT
// The frames of the simulated DeviceNet, against bytes typed by hand from the DeviceNet link layer.
#include "captures/simulator/can_fragments.hpp"
#include "captures/simulator/can_frame.hpp"
#include "tests/support/bytes.hpp"
#include "tests/unit/simcan/simulated_frames.hpp"

namespace servotrace::test {
namespace {

using simulator::ByteVector;

TEST(CanFrame, SocketcanBytesHoldTheIdentifierBigEndian) {
  EXPECT_EQ(simulator::socketcan_bytes(simulator::can_frame(0x42D, hex("C1 00 21"))),
            hex("00 00 04 2D 03 00 00 00 C1 00 21 00 00 00 00 00"));
  simulator::CanFrame frame = simulator::can_frame(0x18FEF100, {});
  frame.extended = true;
  EXPECT_EQ(simulator::socketcan_bytes(frame), hex("98 FE F1 00 00 00 00 00 00 00 00 00 00 00 00 00"));
}

TEST(CanFrame, WireBitsLieWithinTheBoundsOfStuffing) {
  for (unsigned length = 0; length <= 8; ++length) {
    const ByteVector zeros(length, 0x00);
    const ByteVector alternating(length, 0x55);
    const unsigned plain = 47 + 8 * length;  // 1991 CAN specification: frame and intermission without stuff bits
    const unsigned most = plain + (34 + 8 * length - 1) / 4;
    for (const ByteVector& payload : {zeros, alternating}) {
      const unsigned bits = simulator::wire_bits(simulator::can_frame(0x555, payload));
      EXPECT_GE(bits, plain);
      EXPECT_LE(bits, most);
    }
    if (length > 1) {
      EXPECT_GT(simulator::wire_bits(simulator::can_frame(0x000, zeros)),
                simulator::wire_bits(simulator::can_frame(0x555, alternating)));
    }
  }
}

TEST(IoFragments, TenBytesAreSevenAndThree) {
  const auto frames = simulator::split_io(hex("01 02 03 04 05 06 07 08 09 0A"));
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0], hex("00 01 02 03 04 05 06 07"));
  EXPECT_EQ(frames[1], hex("81 08 09 0A"));
  simulator::IoAssembler assembler;
  EXPECT_FALSE(assembler.add(frames[0]));
  EXPECT_EQ(assembler.add(frames[1]), hex("01 02 03 04 05 06 07 08 09 0A"));
  EXPECT_FALSE(assembler.add(frames[1])) << "a last fragment without a first";
}

TEST(ExplicitFragments, SetOfADintTravelsInTwo) {
  // Set_Attribute_Single 25h/1/54 = 12345678h: nine bytes with the header.
  const auto frames = simulator::split_explicit(hex("40 10 25 01 36 78 56 34 12"));
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0], hex("C0 00 10 25 01 36 78 56"));
  EXPECT_EQ(frames[1], hex("C0 81 34 12"));
  simulator::ExplicitAssembler assembler;
  auto step = assembler.add(frames[0]);
  EXPECT_FALSE(step.message);
  EXPECT_EQ(step.acknowledge, hex("C0 C0 00"));
  step = assembler.add(frames[1]);
  EXPECT_EQ(step.acknowledge, hex("C0 C1 00"));
  EXPECT_EQ(step.message, hex("40 10 25 01 36 78 56 34 12"));
}

TEST(ExplicitFragments, ARepeatedMiddleIsAcknowledgedAndNotStored) {
  simulator::ExplicitAssembler assembler;
  assembler.add(hex("80 00 02 27 01 08 00 01"));
  assembler.add(hex("80 41 02 03 04 05 06 07"));
  const auto step = assembler.add(hex("80 41 02 03 04 05 06 07"));
  EXPECT_EQ(step.acknowledge, hex("80 C1 00"));
  EXPECT_EQ(assembler.add(hex("80 82 08")).message, hex("00 02 27 01 08 00 01 02 03 04 05 06 07 08"));
}

constexpr const char* kPlain = "nodes = [{ mac_id = 5, serial_number = 0x12345678 }]\n";

TEST(Link, PowerUpSendsTwoMacChecksOneSecondApart) {
  const auto frames = frames_of(std::string(kPlain) + "steps = [{ do = \"power_up\" }]\n");
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].text, "42F#00BC0278563412");
  EXPECT_EQ(frames[1].text, "42F#00BC0278563412");
  EXPECT_EQ(frames[1].time_ns - frames[0].time_ns, kSecondNs);
}

TEST(Link, AllocationPacketRateAndFirstPoll) {
  const auto texts = texts_of(std::string(kPlain) + "steps = [{ do = \"connect\", epr_ms = 100 }]\n");
  ASSERT_EQ(texts.size(), 10U);
  EXPECT_EQ(texts[2], "42E#004B03010300");
  EXPECT_EQ(texts[3], "42B#00CB00");
  EXPECT_EQ(texts[4], "42C#40100502096400");
  EXPECT_EQ(texts[5], "42B#40906400");
  EXPECT_EQ(texts[6], "42D#0000");
  EXPECT_EQ(texts[7], "3C5#0000");
}

TEST(Link, PollingKeepsItsPeriod) {
  const auto frames = frames_of(std::string(kPlain) +
                                "poll_ms = 20\nsteps = [{ do = \"was_running\" }, { do = \"poll\", cycles = 3 }]\n");
  ASSERT_EQ(frames.size(), 6U);
  EXPECT_EQ(frames[2].time_ns - frames[0].time_ns, 20 * kMillisecondNs);
  EXPECT_EQ(frames[4].time_ns - frames[2].time_ns, 20 * kMillisecondNs);
}

TEST(Link, AllocationErrors) {
  const std::string steps =
      "steps = [{ do = \"power_up\" }, { do = \"allocate\", choice = [] }, { do = \"allocate\", choice = [\"cos\"] }, "
      "{ do = \"allocate\" }, { do = \"allocate\" }, { do = \"allocate\", master = 2 }, { do = \"release\" }, "
      "{ do = \"release\" }]\n";
  const auto texts = texts_of(std::string(kPlain) + steps);
  EXPECT_EQ(texts[3], "42B#00940902") << "a bad choice";
  EXPECT_EQ(texts[5], "42B#00940202") << "a choice not supported";
  EXPECT_EQ(texts[7], "42B#00CB00");
  EXPECT_EQ(texts[9], "42B#00940B02") << "already allocated";
  EXPECT_EQ(texts[11], "42B#02940C01") << "owned by another master";
  EXPECT_EQ(texts[13].substr(6), "CC") << "released";
  EXPECT_EQ(texts[15].substr(6), "940B02") << "not allocated";
}

TEST(Link, AnOnLineNodeAnswersTheMacCheckOfATwin) {
  const std::string can =
      "nodes = [{ mac_id = 5, serial_number = 1 }, { mac_id = 5, serial_number = 2 }]\n"
      "steps = [{ do = \"power_up\" }, { do = \"power_up_twin\" }]\n";
  const auto texts = texts_of(can);
  ASSERT_EQ(texts.size(), 4U) << "the twin must not go on";
  EXPECT_EQ(texts[2], "42F#00BC0202000000");
  EXPECT_EQ(texts[3], "42F#80BC0201000000");
}

TEST(Link, ALongAnswerIsFragmentedAndAcknowledged) {
  const std::string can =
      "nodes = [{ mac_id = 63, model = \"ns310\" }]\nsteps = [{ do = \"was_running\" }, "
      "{ do = \"get_attribute\", class = 1, attribute = 7 }]\n";
  const std::vector<std::string> expected = {"5FC#000E010107", "5FB#80008E0A4A555350", "5FC#80C000",
                                             "5FB#80812D4E53333130", "5FC#80C100"};
  const auto texts = texts_of(can);
  std::vector<std::string> explicit_only;
  for (const std::string& text : texts) {
    if (text[0] == '5' && text[2] != 'D') explicit_only.push_back(text);
  }
  EXPECT_EQ(explicit_only, expected);
}

TEST(Link, TheSameScenarioGivesTheSameBytes) {
  const std::string can = std::string(kPlain) + "steps = [{ do = \"connect\" }, { do = \"poll\", cycles = 50 }]\n";
  const auto first = frames_of(can);
  const auto second = frames_of(can);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].time_ns, second[i].time_ns);
    EXPECT_EQ(first[i].text, second[i].text);
  }
}

TEST(Link, AStepNobodyKnowsIsNamedWithItsPlace) {
  Result<simulator::Scenario> scenario =
      simulator::parse_scenario("title = \"t\"\n[[can]]\nsteps = [{ do = \"dance\" }]\n", "test.toml");
  ASSERT_TRUE(scenario);
  const Result<simulator::Simulation> simulation = simulator::simulate(*scenario);
  ASSERT_FALSE(simulation);
  EXPECT_EQ(simulation.error().text(), "test.toml:3:17: there is no step \"dance\"");
}

}  // namespace
}  // namespace servotrace::test
