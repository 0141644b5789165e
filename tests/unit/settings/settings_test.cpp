// SPDX-License-Identifier: MIT
// servotrace.toml: every key arrives where the decoder looks for it; every mistake is named with its place.
#include "replay/settings/settings.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace servotrace::replay {
namespace {

constexpr std::string_view kEverything = R"([rtex]
communication_cycle_us = 166.6
command_update_ratio = 2
sync = "full"
user_link_type = 150
ethertype = 0x88B6
udp_port = 4000

[[rtex.axis]]
ring = 1
mac_id = 3
name = "X"
data_size = 32
control = "full-closed"
position = "absolute"
parameters = { "7.23" = 0x20, "7.35" = 1, "0.08" = -5 }
inputs = { SI-MON5 = "E-STOP", SI-MON1 = "SI-MON1" }
max_speed = 200000

[[rtex.axis]]
mac_id = 3
control = "semi-closed"
position = "incremental"

[[devicenet.node]]
mac_id = 5
name = "indexer"
profile = "nsk-esb"

[limits]
echo_ms = 101
busy_ms = 102
busy_long_ms = 103
communication_errors = 4
jitter_percent = 51
timeout_cycles = 6
servo_on_units = 1001
inhibit_units = 1002
moving_speed = 31
dead_band_units = 1
mode_change_velocity_percent = 21
torque_limited_ms = 104
eeprom_writes_per_hour = 11
explicit_response_ms = 105
epr_factor = 5
poll_echo_count = 7
prm_ack_ms = 106
prm_ack_long_ms = 107
start_seen_ms = 108
handshake_ms = 109
fragment_ms = 110
fragment_ack_ms = 111
first_io_ms = 112
flash_writes_per_hour = 12

[rules]
ignore = ["CP103"]
severity = { CP102 = "error" }

[[suppress]]
rule = "CP101"
mac_id = 3
reason = "known start-up glitch"
until = 2027-01-31
)";

TEST(Settings, EveryKeyArrives) {
  const Result<FileSettings> result = parse_settings(kEverything, "s.toml");
  ASSERT_TRUE(result) << result.error().text();
  const RtexSettings& rtex = result->decoder.rtex;
  EXPECT_EQ(rtex.communication_cycle_ns, 166667);
  EXPECT_EQ(rtex.command_update_ratio, 2);
  EXPECT_EQ(rtex.full_sync, true);
  EXPECT_EQ(rtex.user_link_type, 150);
  EXPECT_EQ(rtex.ethertype, 0x88B6);
  EXPECT_EQ(rtex.udp_port, 4000);
  ASSERT_EQ(rtex.axes.size(), 2U);
  const RtexAxisSettings& axis = rtex.axes[0];
  EXPECT_EQ(axis.ring, 1);
  EXPECT_EQ(axis.mac_id, 3);
  EXPECT_EQ(axis.name, "X");
  EXPECT_EQ(axis.data_size, 32);
  EXPECT_EQ(axis.full_closed, true);
  EXPECT_EQ(axis.absolute, true);
  const std::map<std::uint16_t, std::int32_t> parameters{{0x0717, 0x20}, {0x0723, 1}, {0x0008, -5}};
  EXPECT_EQ(axis.parameters, parameters);
  EXPECT_EQ(axis.input_second_meaning[7], true);
  EXPECT_EQ(axis.input_second_meaning[3], false);
  EXPECT_EQ(axis.input_second_meaning[4], std::nullopt);
  EXPECT_EQ(axis.max_speed, 200000);
  EXPECT_EQ(rtex.axes[1].ring, std::nullopt);
  EXPECT_EQ(rtex.axes[1].full_closed, false);
  EXPECT_EQ(rtex.axes[1].absolute, false);
  ASSERT_EQ(result->decoder.devicenet.nodes.size(), 1U);
  EXPECT_EQ(result->decoder.devicenet.nodes[0].mac_id, 5);
  EXPECT_EQ(result->decoder.devicenet.nodes[0].name, "indexer");
  EXPECT_EQ(result->decoder.devicenet.nodes[0].profile, "nsk-esb");
  const Limits& limits = result->decoder.limits;
  EXPECT_EQ(limits.echo_ms, 101);
  EXPECT_EQ(limits.busy_ms, 102);
  EXPECT_EQ(limits.busy_long_ms, 103);
  EXPECT_EQ(limits.communication_errors, 4);
  EXPECT_EQ(limits.jitter_percent, 51);
  EXPECT_EQ(limits.timeout_cycles, 6);
  EXPECT_EQ(limits.servo_on_units, 1001);
  EXPECT_EQ(limits.inhibit_units, 1002);
  EXPECT_EQ(limits.moving_speed, 31);
  EXPECT_EQ(limits.dead_band_units, 1);
  EXPECT_EQ(limits.mode_change_velocity_percent, 21);
  EXPECT_EQ(limits.torque_limited_ms, 104);
  EXPECT_EQ(limits.eeprom_writes_per_hour, 11);
  EXPECT_EQ(limits.explicit_response_ms, 105);
  EXPECT_EQ(limits.epr_factor, 5);
  EXPECT_EQ(limits.poll_echo_count, 7);
  EXPECT_EQ(limits.prm_ack_ms, 106);
  EXPECT_EQ(limits.prm_ack_long_ms, 107);
  EXPECT_EQ(limits.start_seen_ms, 108);
  EXPECT_EQ(limits.handshake_ms, 109);
  EXPECT_EQ(limits.fragment_ms, 110);
  EXPECT_EQ(limits.fragment_ack_ms, 111);
  EXPECT_EQ(limits.first_io_ms, 112);
  EXPECT_EQ(limits.flash_writes_per_hour, 12);
  EXPECT_EQ(result->rules.ignore, std::vector<std::string>{"CP103"});
  ASSERT_EQ(result->rules.severity.size(), 1U);
  EXPECT_EQ(result->rules.severity[0].severity, Severity::kError);
  ASSERT_EQ(result->rules.suppressions.size(), 1U);
  const Suppression& suppression = result->rules.suppressions[0];
  EXPECT_EQ(suppression.rule, "CP101");
  EXPECT_EQ(suppression.mac_id, 3);
  EXPECT_EQ(suppression.reason, "known start-up glitch");
  EXPECT_EQ(suppression.until, (Date{2027, 1, 31}));
  EXPECT_EQ(suppression.where, "s.toml:60:1");
}

TEST(Settings, EmptyTextIsTheDefaults) {
  const Result<FileSettings> result = parse_settings("", "s.toml");
  ASSERT_TRUE(result);
  EXPECT_EQ(result->decoder.limits.echo_ms, 100);
  EXPECT_EQ(result->decoder.limits.moving_speed, std::nullopt);
  EXPECT_EQ(result->decoder.rtex.communication_cycle_ns, std::nullopt);
}

struct Mistake {
  std::string_view text;
  std::string_view error;
};

class SettingsMistake : public ::testing::TestWithParam<Mistake> {};

TEST_P(SettingsMistake, IsNamedWithItsPlace) {
  const Result<FileSettings> result = parse_settings(GetParam().text, "s.toml");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().text(), GetParam().error);
}

INSTANTIATE_TEST_SUITE_P(
    All, SettingsMistake,
    ::testing::Values(
        Mistake{"[rtx]\n", "s.toml:1:2: unknown key 'rtx' (did you mean 'rtex'?)"},
        Mistake{"[limits]\nehco_ms = 5\n", "s.toml:2:1: unknown key 'ehco_ms' in [limits] (did you mean 'echo_ms'?)"},
        Mistake{"[limits]\nweather = 5\n", "s.toml:2:1: unknown key 'weather' in [limits]"},
        Mistake{"[limits]\necho_ms = \"5\"\n", "s.toml:2:11: 'echo_ms' must be an integer, not a string"},
        Mistake{"[limits]\necho_ms = 0\n", "s.toml:2:11: 'echo_ms' = 0: must be 1 to 86400000"},
        Mistake{"limits = 3\n", "s.toml:1:10: 'limits' must be a table, not an integer"},
        Mistake{"[rtex]\ncommunication_cycle_us = 250\n",
                "s.toml:2:26: 'communication_cycle_us' = 250: must be 83.333, 166.667, 500 or 1000 (within 2 %)"},
        Mistake{"[rtex]\ncommunication_cycle_us = nan\n",
                "s.toml:2:26: 'communication_cycle_us' must be a finite number"},
        Mistake{"[rtex]\ncommand_update_ratio = 3\n", "s.toml:2:24: 'command_update_ratio' = 3: must be 1 to 2"},
        Mistake{"[rtex]\nsync = \"none\"\n", "s.toml:2:8: 'sync' = \"none\": must be \"semi\" or \"full\""},
        Mistake{"[[rtex.axis]]\nname = \"X\"\n", "s.toml:1:1: [[rtex.axis]] needs 'mac_id'"},
        Mistake{"[rtex.axis]\nmac_id = 1\n", "s.toml:1:1: 'axis' must be written as [[axis]], not [axis]"},
        Mistake{"[[rtex.axis]]\nmac_id = 32\n", "s.toml:2:10: 'mac_id' = 32: must be 0 to 31"},
        Mistake{"[[rtex.axis]]\nmac_id = 1\n[[rtex.axis]]\nmac_id = 1\n",
                "s.toml:4:10: axis 1 of this ring is given twice"},
        Mistake{"[[rtex.axis]]\nmac_id = 1\ndata_size = 24\n", "s.toml:3:13: 'data_size' = 24: must be 16 or 32"},
        Mistake{"[[rtex.axis]]\nmac_id = 1\nparameters = { \"Pr7\" = 1 }\n",
                "s.toml:3:16: 'Pr7' is no parameter: write class and number in quotes, \"7.23\""},
        Mistake{"[[rtex.axis]]\nmac_id = 1\nparameters = { 7.23 = 1 }\n",
                "s.toml:3:16: '7' is no parameter: write class and number in quotes, \"7.23\""},
        Mistake{"[[rtex.axis]]\nmac_id = 1\nparameters = { \"7.23\" = 1, \"7.023\" = 2 }\n",
                "s.toml:3:16: Pr7.23 is given twice"},
        Mistake{"[[rtex.axis]]\nmac_id = 1\nparameters = { \"7.23\" = 4294967296 }\n",
                "s.toml:3:25: 'Pr7.23' = 4294967296: must be -2147483648 to 2147483647"},
        Mistake{"[[rtex.axis]]\nmac_id = 1\ninputs = { SI-MON5 = \"EXT1\" }\n",
                "s.toml:3:22: 'SI-MON5' = \"EXT1\": must be \"SI-MON5\" or \"E-STOP\""},
        Mistake{"[[rtex.axis]]\nmac_id = 1\nname = \"\"\n", "s.toml:3:8: 'name' must not be empty"},
        Mistake{"[[devicenet.node]]\nmac_id = 64\n", "s.toml:2:10: 'mac_id' = 64: must be 0 to 63"},
        Mistake{"[[devicenet.node]]\nmac_id = 1\nprofile = \"nsk\"\n",
                "s.toml:3:11: 'profile' = \"nsk\": must be \"yaskawa-ns310\", \"nsk-esb\" or \"generic\""},
        Mistake{"[rules]\nignore = \"CP101\"\n", "s.toml:2:10: 'ignore' must be an array, not a string"},
        Mistake{"[rules]\nignore = [1]\n", "s.toml:2:11: 'ignore' must hold strings, not an integer"},
        Mistake{"[rules]\nignore = [\"ZZ9\"]\n", "s.toml:2:11: no rule 'ZZ9'"},
        Mistake{"[rules]\nignore = [\"time-backward\"]\n",
                "s.toml:2:11: no rule 'time-backward' (did you mean 'CP102', time-backwards?)"},
        Mistake{"[rules]\nseverity = { CP101 = \"fatal\" }\n",
                "s.toml:2:22: the severity of 'CP101' must be \"error\", \"warning\" or \"note\""},
        Mistake{"[[suppress]]\nrule = \"CP101\"\n", "s.toml:1:1: [[suppress]] needs 'reason'"},
        Mistake{"[[suppress]]\nreason = \"x\"\n", "s.toml:1:1: [[suppress]] needs 'rule'"},
        Mistake{"[[suppress]]\nrule = \"CP101\"\nreason = \"x\"\nuntil = \"2027-01-31\"\n",
                "s.toml:4:9: 'until' must be a date such as 2027-01-31 (no quotes), not a string"},
        // The first mistake of the file is told, whatever is read first.
        Mistake{"[limits]\necho_ms = 0\n[rtex]\nudp_port = 0\n", "s.toml:2:11: 'echo_ms' = 0: must be 1 to 86400000"}));

TEST(Settings, SyntaxErrorHasAPlace) {
  const Result<FileSettings> result = parse_settings("[rtex\nudp_port = 1\n", "s.toml");
  ASSERT_FALSE(result);
  EXPECT_TRUE(result.error().where.starts_with("s.toml:1:")) << result.error().text();
}

TEST(Settings, IsFoundUpward) {
  const std::filesystem::path root = std::filesystem::path(::testing::TempDir()) / "settings_upward";
  std::filesystem::remove_all(root);
  std::filesystem::create_directories(root / "a" / "b");
  std::ofstream(root / "servotrace.toml") << "[limits]\n";
  EXPECT_EQ(find_settings_above(root / "a" / "b"), root / "servotrace.toml");
  EXPECT_EQ(find_settings(root / "a" / "b" / "run.pcapng"), root / "servotrace.toml");
  EXPECT_EQ(find_settings(root / "a"), root / "servotrace.toml");
  std::ofstream(root / "a" / "servotrace.toml") << "[limits]\n";
  EXPECT_EQ(find_settings_above(root / "a" / "b"), root / "a" / "servotrace.toml");
}

TEST(Settings, MissingFileIsNamed) {
  const Result<FileSettings> result = read_settings("no/such/file.toml");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().text(), "no/such/file.toml: cannot be opened");
}

}  // namespace
}  // namespace servotrace::replay
