// SPDX-License-Identifier: MIT
// Every link field, both ways, and every statistic, of five captures in one file and one run of tshark: what a link
// says at one end the other end says too, and a statistic counts what the fields show.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <sstream>

#include "tests/support/paths.hpp"
#include "tests/support/recording.hpp"
#include "tests/support/tshark.hpp"

namespace servotrace::test {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;

constexpr const char* kCaptures[] = {"lost_update", "rtex_clean", "rx101_communication_error", "esb_clean",
                                     "ns310_clean"};
constexpr const char* kFields[] = {
    "frame.number",           "frame.time_epoch",      "rtex.request_in",       "rtex.response_in",
    "rtex.response_time",     "rtex.accepted_command", "rtex.accepted_in",      "rtex.previous_in",
    "rtex.next_in",           "dnet.request_in",       "dnet.response_in",      "dnet.response_time",
    "dnet.previous_in",       "dnet.next_in",          "dnet.first_fragment",   "dnet.fragment",
    "dnet.reassembled_in",    "servotrace.rule",       "servotrace.related",    "servotrace.cause",
    "servotrace.cause_frame", "servotrace.count",      "servotrace.last_frame", "servotrace.basis",
    "dnet.message",           "rtex.record.sequence",  "rtex.handshake",        "esb.transaction"};
constexpr const char* kStatistics[] = {"servotrace_findings,tree", "rtex_ring,tree", "rtex_handshake,tree",
                                       "dnet_nodes,tree", "expert"};

// Values of one field by frame.
using Column = std::map<std::uint64_t, std::vector<std::string>>;
using Pairs = std::set<std::pair<std::uint64_t, std::uint64_t>>;

class Links : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const Tshark tshark;
    why_not_ = tshark.why_not();
    if (!tshark.available()) return;
    std::vector<Recording> all;
    for (const char* const name : kCaptures)
      all.push_back(read_recording(source_dir() / "captures" / (std::string(name) + ".pcapng")));
    write_capture(tshark.folder() / "links.pcapng", all);
    std::vector<std::string> arguments = {"-2", "-r", tshark.copy(tshark.folder() / "links.pcapng").string(), "-T",
                                          "fields"};
    for (const char* const field : kFields) arguments.insert(arguments.end(), {"-e", field});
    for (const char* const statistic : kStatistics) arguments.insert(arguments.end(), {"-z", statistic});
    const Ran ran = tshark.run(arguments);
    ASSERT_EQ(ran.status, 0) << ran.err;
    ASSERT_EQ(ran.err, "");
    const std::size_t end = std::min(ran.out.find("\n=="), ran.out.find("\n\n"));
    ASSERT_NE(end, std::string::npos);
    statistics_ = ran.out.substr(end);
    for (const auto& row : rows_of(ran.out.substr(0, end))) {
      ASSERT_EQ(row.size(), std::size(kFields));
      for (std::size_t i = 0; i < row.size(); ++i) {
        if (!row[i].empty()) columns_[kFields[i]][std::stoull(row[0])] = parts_of(row[i], ',');
      }
    }
  }
  void SetUp() override {
    if (!why_not_.empty()) GTEST_SKIP() << why_not_;
  }

  static Pairs pairs_of(const std::string& field) {
    Pairs pairs;
    for (const auto& [frame, values] : columns_[field]) {
      for (const std::string& value : values) pairs.emplace(frame, std::stoull(value));
    }
    return pairs;
  }
  static Pairs turned(const Pairs& pairs) {
    Pairs result;
    for (const auto& [from, to] : pairs) result.emplace(to, from);
    return result;
  }
  static void expect_both_ways(const std::string& there, const std::string& back) {
    const Pairs pairs = pairs_of(there);
    EXPECT_FALSE(pairs.empty()) << there;
    for (const auto& [from, to] : pairs) EXPECT_LT(to, from) << there;
    EXPECT_EQ(turned(pairs), pairs_of(back)) << there << " and " << back;
  }
  static std::size_t count_of(const std::string& field, const std::string& value = {}) {
    std::size_t count = 0;
    for (const auto& [frame, values] : columns_[field]) {
      for (const std::string& one : values) count += value.empty() || one == value ? 1U : 0U;
    }
    return count;
  }
  static std::int64_t nanoseconds(const std::string& seconds) {
    const std::size_t point = seconds.find('.');
    return std::stoll(seconds.substr(0, point)) * 1'000'000'000 + std::stoll(seconds.substr(point + 1));
  }
  // The first column of numbers, added up over the lines of this name.
  static std::size_t counted(const std::string& name) {
    std::size_t sum = 0;
    std::istringstream lines(statistics_);
    for (std::string line; std::getline(lines, line);) {
      const std::size_t begin = line.find_first_not_of(' ');
      if (begin == std::string::npos || line.compare(begin, name.size() + 2, name + "  ") != 0) continue;
      sum += std::stoull(line.substr(begin + name.size()));
    }
    return sum;
  }

  static inline std::string why_not_;
  static inline std::string statistics_;
  static inline std::map<std::string, Column> columns_;
};

TEST_F(Links, BothWays) {
  expect_both_ways("rtex.request_in", "rtex.response_in");
  expect_both_ways("rtex.accepted_command", "rtex.accepted_in");
  expect_both_ways("rtex.previous_in", "rtex.next_in");
  expect_both_ways("dnet.request_in", "dnet.response_in");
  expect_both_ways("dnet.previous_in", "dnet.next_in");
}

TEST_F(Links, ResponseTimeIsTheTimeBetweenTheFrames) {
  for (const std::string protocol : {"rtex", "dnet"}) {
    Column& requests = columns_[protocol + ".request_in"];
    Column& times = columns_[protocol + ".response_time"];
    ASSERT_EQ(requests.size(), times.size());
    for (const auto& [frame, values] : requests) {
      ASSERT_EQ(times[frame].size(), values.size()) << frame;
      for (std::size_t i = 0; i < values.size(); ++i) {
        EXPECT_EQ(nanoseconds(times[frame][i]),
                  nanoseconds(columns_["frame.time_epoch"][frame][0]) -
                      nanoseconds(columns_["frame.time_epoch"][std::stoull(values[i])][0]))
            << "frame " << frame;
      }
    }
  }
}

TEST_F(Links, FragmentsAndTheMessageTheyMake) {
  Pairs parts = pairs_of("dnet.first_fragment");
  EXPECT_FALSE(parts.empty());
  parts.merge(pairs_of("dnet.fragment"));
  EXPECT_EQ(turned(parts), pairs_of("dnet.reassembled_in"));
}

// A command is sent, accepted, completed: in this order.
TEST_F(Links, CommandAcceptanceCompletion) {
  std::size_t complete = 0;
  for (const auto& [frame, accepted] : columns_["rtex.accepted_in"]) {
    for (const std::string& completed : columns_["rtex.response_in"][frame]) {
      EXPECT_LE(std::stoull(accepted[0]), std::stoull(completed));
      ++complete;
    }
    EXPECT_THAT(columns_["rtex.handshake"][frame], testing::Contains("1")) << frame;  // waiting for echo
  }
  EXPECT_GT(complete, 0U);
  EXPECT_GT(count_of("esb.transaction"), 0U);
}

// captures/scenarios/lost_update.toml: RX201 and the alarm that answers it, and what each names.
TEST_F(Links, FindingsNameTheirFrames) {
  std::uint64_t lost = 0;
  std::uint64_t alarm = 0;
  for (const auto& [frame, rules] : columns_["servotrace.rule"]) {
    if (rules[0] == "RX201") lost = frame;
    if (rules[0] == "RX902" && alarm == 0) alarm = frame;
  }
  ASSERT_NE(lost, 0U);
  ASSERT_GT(alarm, lost);
  EXPECT_EQ(columns_["servotrace.cause"][alarm], std::vector<std::string>{"RX201"});
  EXPECT_EQ(columns_["servotrace.cause_frame"][alarm], std::vector<std::string>{std::to_string(lost)});
  ASSERT_FALSE(columns_["servotrace.related"][lost].empty());
  for (const std::string& related : columns_["servotrace.related"][lost]) EXPECT_LT(std::stoull(related), lost);
}

TEST_F(Links, StatisticsCountWhatTheFieldsShow) {
  const Column& rules = columns_["servotrace.rule"];
  ASSERT_FALSE(rules.empty());
  for (const auto& [frame, values] : rules) {
    for (const std::string& rule : values) {
      EXPECT_THAT(statistics_,
                  ContainsRegex(rule + " [^\n]* +" + std::to_string(count_of("servotrace.rule", rule)) + " "));
    }
  }
  EXPECT_EQ(counted("Until accepted (ms)"), count_of("rtex.accepted_command"));
  EXPECT_EQ(counted("Until completed (ms)"), count_of("rtex.request_in"));
  EXPECT_EQ(counted("Command records") + counted("Response records"), count_of("rtex.record.sequence"));
  EXPECT_EQ(counted("Communication error responses"), 1U);
  EXPECT_EQ(counted("Update_Counter findings"), count_of("servotrace.rule", "RX201"));
  for (const char* const message : {"Poll command", "Poll response", "Explicit request", "Explicit response"}) {
    EXPECT_GT(count_of("dnet.message", message), 0U);
    EXPECT_EQ(counted(message), count_of("dnet.message", message)) << message;
  }
  EXPECT_GT(counted("Request answered after (ms)"), 0U);
  EXPECT_THAT(statistics_, ContainsRegex("Errors \\([0-9]+\\)"));  // of -z expert
  EXPECT_THAT(statistics_, HasSubstr("RX201 axis 2"));
}

}  // namespace
}  // namespace servotrace::test
