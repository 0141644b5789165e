// SPDX-License-Identifier: MIT
// Every shipped capture by itself, as a user opens it: with no setting, and with the settings of its scenario.
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/paths.hpp"
#include "tests/support/plugin_findings.hpp"
#include "tests/support/recording.hpp"

namespace servotrace::test {
namespace {

namespace fs = std::filesystem;

TEST(ParityOfEach, ShippedCapture) {
  const Tshark tshark;
  if (!tshark.available()) GTEST_SKIP() << tshark.why_not();
  for (const fs::path& capture : shipped_captures()) {
    expect_parity(tshark, capture, {}, {"rtex.user_link_type:147"});
    const auto scenario =
        simulator::read_scenario(source_dir() / "captures" / "scenarios" / (capture.stem().string() + ".toml"));
    if (!scenario || scenario->settings.empty()) continue;
    const auto settings = replay::parse_settings(scenario->settings, capture.stem().string());
    ASSERT_TRUE(settings) << settings.error().text();
    const fs::path file = tshark.folder() / "servotrace.toml";
    std::ofstream(file) << scenario->settings;
    expect_parity(tshark, capture, *settings, {"servotrace.settings_file:" + file.string()});
  }
}

}  // namespace
}  // namespace servotrace::test
