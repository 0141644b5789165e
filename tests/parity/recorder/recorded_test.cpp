// SPDX-License-Identifier: MIT
// What the C example of the recorder writes opens in tshark with no setting: every frame is RTEX, nothing is found.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/support/paths.hpp"
#include "tests/support/tshark.hpp"

namespace servotrace::test {
namespace {

TEST(RecordedByTheExample, OpensInTsharkWithNoSetting) {
  const Tshark tshark;
  if (!tshark.available()) GTEST_SKIP() << tshark.why_not();
  const std::filesystem::path program = binary_dir() / "captures" / "servotrace_rtex_recorder_example";
  const std::filesystem::path made = std::filesystem::path(::testing::TempDir()) / "tshark_example.pcapng";
  ASSERT_EQ(std::system((program.string() + ' ' + made.string() + " 60").c_str()), 0);
  const std::filesystem::path capture = tshark.copy(made);
  const Ran ran =
      tshark.run({"-r", capture.string(), "-T", "fields", "-e", "_ws.col.Protocol", "-e", "rtex.record.sequence", "-e",
                  "rtex.command.mac_id", "-e", "rtex.command.cyclic_command", "-e", "servotrace.rule"});
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_EQ(ran.err, "");
  const auto rows = rows_of(ran.out);
  ASSERT_EQ(rows.size(), 120U);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ASSERT_EQ(rows[i].size(), 5U) << i;
    EXPECT_EQ(rows[i][0], "RTEX") << i;
    EXPECT_EQ(rows[i][1], std::to_string(i / 2)) << i;
    EXPECT_EQ(rows[i][4], "") << i;
    if (i % 2 != 0) continue;
    // Two axes, first in NOP, from cycle 20 on in CP (20h).
    EXPECT_EQ(rows[i][2], "1,2") << i;
    EXPECT_EQ(rows[i][3], i / 2 < 20 ? "0x00,0x00" : "0x02,0x02") << i;
  }
  std::filesystem::remove(made);
}

}  // namespace
}  // namespace servotrace::test
