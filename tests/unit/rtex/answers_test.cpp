// SPDX-License-Identifier: MIT
// What answers tell: the alarm code and what it answers, the strings of the system ID, how long a command took.
#include <gtest/gtest.h>

#include "tests/unit/rtex/bench.hpp"

namespace servotrace::rtex::test {
namespace {

void exchange(Bench& bench, std::uint8_t code, std::uint16_t type, std::uint16_t index = 0, unsigned held = 6) {
  bench.non_cyclic(0, code, type, index);
  bench.cycles(held);
  bench.normal();
  bench.cycles(4);
}
Settings with(std::map<std::uint16_t, std::int32_t> parameters) {
  Settings settings;
  settings.rtex.axes.push_back({.mac_id = 0, .parameters = std::move(parameters)});
  return settings;
}

TEST(Answers, AlarmGetsItsCodeWhenItIsRead) {
  Bench bench;
  bench.cycles(40);
  bench.at(0).alarm = true;
  bench.cycle();
  const std::uint64_t rise = bench.frame();
  ASSERT_EQ(bench.rules(), "RX902");
  EXPECT_EQ(bench.found("RX902").at(0).arguments[0], 0);
  EXPECT_EQ(bench.found("RX902").at(0).arguments[1], kSubUnknown);
  bench.at(0).data = 91;  // the sub number is not told
  exchange(bench, 5, 0x000);
  ASSERT_EQ(bench.found("RX902").size(), 1U);
  EXPECT_EQ(bench.found("RX902").at(0).frame, rise);
  EXPECT_EQ(bench.found("RX902").at(0).arguments[0], 91);
  EXPECT_EQ(bench.found("RX902").at(0).arguments[1], kSubUnknown);
  bench.at(0).data = 86;  // another code of the same alarm changes nothing
  exchange(bench, 5, 0x000);
  EXPECT_EQ(bench.found("RX902").at(0).arguments[0], 91);
}

TEST(Answers, AlarmSubNumber) {
  for (const bool known : {false, true}) {
    Bench bench(1, known ? with({{0x0717, 2}}) : Settings{});
    bench.cycles(40);
    bench.at(0).alarm = true;
    bench.cycles(3);
    bench.at(0).data = 84;
    exchange(bench, 5, 0x000);
    EXPECT_EQ(bench.found("RX902").at(0).arguments[1], known ? 84 << 8 : kSubUnknown);
  }
  Bench bench;
  bench.cycles(40);
  bench.at(0).alarm = true;
  bench.cycles(3);
  bench.at(0).data = 0x0256;  // 86.2: byte 13 is not 0
  exchange(bench, 5, 0x000);
  EXPECT_EQ(bench.found("RX902").at(0).arguments[1], 0x5602);
}

// History entries are not the present alarm, and an alarm that fell is over.
TEST(Answers, AlarmCodeOfSomethingElse) {
  Bench bench;
  bench.cycles(40);
  bench.at(0).alarm = true;
  bench.cycles(3);
  bench.at(0).data = 86;
  exchange(bench, 5, 0x000, 1);  // the first of the history
  bench.at(0).alarm = false;
  bench.cycles(3);
  exchange(bench, 5, 0x000);
  EXPECT_EQ(bench.found("RX902").at(0).arguments[0], 0);
}

TEST(Answers, AlarmNamesTheFaultItsCodeAnswers) {
  for (const std::uint32_t code : {86U, 83U}) {
    Bench bench;
    bench.cycles(60);
    bench.set(0, "cr", 1);  // RX103
    bench.cycle();
    bench.set(0, "cr", 0);
    bench.cycles(3);
    bench.at(0).alarm = true;
    bench.cycles(3);
    bench.at(0).data = code;
    exchange(bench, 5, 0x000);
    const Finding alarm = bench.found("RX902").at(0);
    EXPECT_EQ(alarm.cause.frame, code == 86 ? bench.found("RX103").at(0).frame : 0U);
  }
}

TEST(Answers, AlarmOfASilentRingNamesTheTimeout) {
  Bench bench;
  bench.cycles(60);
  bench.extra_ns = milliseconds(20);
  bench.cycles(1);
  bench.at(0).alarm = true;
  bench.cycles(3);
  bench.at(0).data = 84;
  exchange(bench, 5, 0x000);
  ASSERT_EQ(bench.found("RX902").size(), 1U);
  EXPECT_EQ(bench.found("RX902").at(0).cause.rule, rule("RX112"));
}

TEST(Answers, WarningGetsItsCode) {
  Bench bench;
  bench.cycles(60);
  bench.count = false;
  bench.cycle();
  bench.count = true;
  bench.at(0).warning = true;
  bench.cycles(3);
  bench.at(0).data = 0x00C2'0000;
  exchange(bench, 5, 0x000);
  ASSERT_EQ(bench.found("RX903").size(), 1U);
  EXPECT_EQ(bench.found("RX903").at(0).arguments[0], 0xC2);
  EXPECT_EQ(bench.found("RX903").at(0).cause.rule, rule("RX201"));
}

// SX-DSV02203 6-4-2: "Panasonic" over three values of Index.
TEST(Answers, SystemIdIsJoinedOverIndex) {
  Bench bench;
  std::string shown;
  std::uint64_t shown_in = 0;
  bench.on_frame = [&](std::uint64_t frame, const Dissection& dissection) {
    for (const Derived& entry : dissection.derived) {
      if (entry.field->key != "vendor_name") continue;
      shown += entry.text;
      shown_in = frame;
    }
  };
  bench.cycles(5);
  const std::uint32_t parts[] = {0x616E6150, 0x696E6F73, 0x00000063};  // "Pana", "soni", "c"
  for (std::uint16_t index = 0; index < 3; ++index) {
    EXPECT_EQ(shown, "");
    bench.at(0).data = parts[index];
    exchange(bench, 2, 0x010, index);  // the conventional code
  }
  EXPECT_EQ(shown, "Panasonic");
  const Summary summary = bench.pipeline().summary();
  const auto& facts = summary.buses.at(0).nodes.at(0).facts;
  const auto found =
      std::find_if(facts.begin(), facts.end(), [](const Fact& fact) { return fact.key == "vendor_name"; });
  ASSERT_NE(found, facts.end());
  EXPECT_EQ(found->value, "Panasonic");
  EXPECT_EQ(found->basis.frame, shown_in);
  EXPECT_EQ(bench.rules(), "");
}

// 6-4-4: "1011", then "11" and NUL. A part that is missing is no string.
TEST(Answers, DriverTypeAndAHole) {
  Bench bench;
  bench.cycles(5);
  const auto value_of = [&bench](std::string_view key) -> std::string {
    const Summary summary = bench.pipeline().summary();
    for (const Fact& fact : summary.buses.at(0).nodes.at(0).facts) {
      if (fact.key == key) return fact.value;
    }
    return "(none)";
  };
  bench.at(0).data = 0x00003131;
  exchange(bench, 2, 0x15, 1);
  EXPECT_EQ(value_of("driver_type"), "(none)");
  bench.at(0).data = 0x31313031;
  exchange(bench, 2, 0x15, 0);
  EXPECT_EQ(value_of("driver_type"), "(none)");
  bench.at(0).data = 0x00003131;
  exchange(bench, 2, 0x15, 1);
  EXPECT_EQ(value_of("driver_type"), "101111");
}

// Commands and responses alternate, 0.5 ms a cycle: the one before is two frames back.
TEST(Answers, EachRecordNamesTheOneBefore) {
  Bench bench;
  std::size_t links = 0;
  bench.on_frame = [&links](std::uint64_t frame, const Dissection& dissection) {
    for (const Link& link : dissection.links) {
      if (link.kind != LinkKind::kPreviousOfNode) continue;
      EXPECT_EQ(link.frame, frame - 2);
      EXPECT_EQ(link.after_ns, 500'000);
      EXPECT_EQ(link.node.mac_id, kNoMacId);
      ++links;
    }
  };
  bench.cycles(4);
  EXPECT_EQ(links, 2U * 4U - 2U);
}

// SX-DSV02203 3-3-4: sent, not yet echoed; echoed with Busy = 1; then nothing is waited for.
TEST(Answers, CommandsSayHowFarTheirHandshakeIs) {
  Bench bench;
  bench.cycles(5);
  std::vector<std::int64_t> shown;
  bench.on_frame = [&shown](std::uint64_t, const Dissection& dissection) {
    for (const Derived& entry : dissection.derived) {
      if (entry.field->key == "handshake") shown.push_back(entry.value);
    }
  };
  bench.at(0).busy = true;
  bench.non_cyclic(0, 6, 0x010, 0x0008);
  bench.cycles(5);
  bench.at(0).busy = false;
  bench.cycles(3);
  bench.normal();
  bench.cycles(5);
  EXPECT_EQ(shown, (std::vector<std::int64_t>{1, 1, 1, 2, 2, 2}));
}

TEST(Answers, CommandsAreLinkedToEchoAndAnswer) {
  Bench bench;
  bench.cycles(5);
  std::uint64_t command = 0;
  std::vector<std::pair<LinkKind, std::uint64_t>> links;
  std::vector<std::int64_t> times;
  bench.on_frame = [&](std::uint64_t frame, const Dissection& dissection) {
    for (const Link& link : dissection.links) {
      if (link.kind == LinkKind::kPreviousOfNode) continue;
      EXPECT_EQ(link.frame, command);
      links.emplace_back(link.kind, frame);
    }
    for (const Derived& entry : dissection.derived) {
      if (entry.field->key == "echo_time_ns" || entry.field->key == "completion_time_ns") times.push_back(entry.value);
    }
  };
  bench.at(0).busy = true;
  bench.non_cyclic(0, 6, 0x010, 0x0008);
  command = bench.frame() + 1;
  bench.cycles(5);
  bench.at(0).busy = false;
  bench.cycles(3);
  bench.normal();
  bench.cycles(5);
  ASSERT_EQ(links.size(), 2U);  // the echo two cycles later, the answer with Busy = 0 five cycles later
  EXPECT_EQ(links[0], std::make_pair(LinkKind::kAcceptedIn, command + 5));
  EXPECT_EQ(links[1], std::make_pair(LinkKind::kRequestIn, command + 11));
  EXPECT_EQ(times, (std::vector<std::int64_t>{1'100'000, 2'600'000}));
}

// A read of Pr7.30 or Pr7.35 says what the data words hold from then on, not before.
TEST(Answers, MonitorsAndFeedforwardAreLearnt) {
  Bench bench;
  std::string response2, command3;
  bench.on_frame = [&](std::uint64_t, const Dissection& dissection) {
    for (const Segment& segment : dissection.segments) {
      if (segment.offset == 24 + 8 && segment.direction == Direction::kResponse)
        response2 = segment.layout->fields.front().key;
      if (segment.offset == 24 + 12 && segment.direction == Direction::kCommand)
        command3 = segment.layout->fields.front().key;
    }
  };
  bench.cycles(5);
  EXPECT_EQ(response2, "actual_speed");
  EXPECT_EQ(command3, "command_data3");
  bench.at(0).data = 0x0C;
  exchange(bench, 6, 0x010, 0x071E);
  EXPECT_EQ(response2, "command_velocity");
  bench.at(0).data = 2;
  exchange(bench, 6, 0x010, 0x0723);
  EXPECT_EQ(command3, "torque_feedforward");
}

TEST(Answers, MonitorsAndFeedforwardAreConfigured) {
  Bench bench(1, with({{0x071F, 0x62}, {0x0723, 1}}));
  std::string response3, command3;
  bench.on_frame = [&](std::uint64_t, const Dissection& dissection) {
    for (const Segment& segment : dissection.segments) {
      if (segment.offset != 24 + 12) continue;
      (segment.direction == Direction::kResponse ? response3 : command3) = segment.layout->fields.front().key;
    }
  };
  bench.cycles(5);
  EXPECT_EQ(response3, "driver_temperature");
  EXPECT_EQ(command3, "velocity_feedforward");
}

}  // namespace
}  // namespace servotrace::rtex::test
