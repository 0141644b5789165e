// SPDX-License-Identifier: MIT
#include "tests/support/plugin_findings.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace servotrace::test {
namespace {

std::vector<std::string> texts(const std::vector<Seen>& all) {
  std::vector<std::string> result;
  for (const Seen& seen : all) result.push_back(to_string(seen));
  return result;
}

// CAN buses are called after their interfaces, which the command line makes unique once it knows all of them.
std::string of_any_can(const std::string& node) {
  for (const char* const other : {"axis ", "node ", "ring", "capture"}) {
    if (node.rfind(other, 0) == 0) return node;
  }
  return "can";
}

}  // namespace

std::vector<Seen> seen_by(const Tshark& tshark, std::vector<std::string> arguments) {
  const std::vector<std::string> tail = {"-Y", "servotrace",          "-T", "fields",
                                         "-e", "frame.number",        "-e", "servotrace.rule",
                                         "-e", "servotrace.severity", "-e", "servotrace.node"};
  arguments.insert(arguments.end(), tail.begin(), tail.end());
  const Ran ran = tshark.run(arguments);
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_EQ(ran.err, "");
  std::vector<Seen> all;
  for (const auto& row : rows_of(ran.out)) {
    if (row.size() != 4) {
      ADD_FAILURE() << "a line of " << row.size() << " columns";
      continue;
    }
    const auto rules = parts_of(row[1], ',');
    const auto severities = parts_of(row[2], ',');
    const auto nodes = parts_of(row[3], ',');
    EXPECT_EQ(rules.size(), severities.size());
    EXPECT_EQ(rules.size(), nodes.size());
    for (std::size_t i = 0; i < std::min({rules.size(), severities.size(), nodes.size()}); ++i)
      all.push_back({std::stoull(row[0]), rules[i], severities[i], of_any_can(nodes[i])});
  }
  std::sort(all.begin(), all.end());
  return all;
}

void expect_parity(const Tshark& tshark, const std::filesystem::path& capture, const replay::FileSettings& settings,
                   const std::vector<std::string>& preferences) {
  SCOPED_TRACE(capture.filename().string());
  const std::vector<std::string> expected = texts(check_capture(capture, settings));
  std::vector<std::string> arguments = {"-r", tshark.copy(capture).string()};
  for (const std::string& preference : preferences) {
    arguments.emplace_back("-o");
    arguments.push_back(preference);
  }
  EXPECT_EQ(texts(seen_by(tshark, arguments)), expected) << "one pass";
  arguments.emplace_back("-2");
  EXPECT_EQ(texts(seen_by(tshark, arguments)), expected) << "two passes";
}

}  // namespace servotrace::test
