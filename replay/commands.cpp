// SPDX-License-Identifier: MIT
// The list of subcommands: a new one is one line.
#include "replay/commands.hpp"

namespace servotrace::replay {
namespace {

constexpr Command kCommands[] = {
    {"check", "verifies captures against the rules", &run_check},
    {"report", "the post-mortem report: what failed first, what preceded it", &run_report},
    {"decode", "prints every message, field by field", &run_decode},
    {"info", "what is in a capture: buses, nodes, drives, cycles, learnt settings", &run_info},
    {"explain", "a rule's page: what, why, fix, manual section, examples", &run_explain},
    {"rules", "the catalogue of rules", &run_rules},
    {"convert", "captures and logs to pcapng, RTEX records into another carrier", &run_convert},
    {"simulate", "makes a capture from a scenario", &run_simulate},
    {"annotate", "the capture again with every finding as a packet comment", &run_annotate},
    {"export", "signals as CSV, states as a Perfetto trace", &run_export},
    {"config", "writes a commented servotrace.toml from what a capture shows", &run_config},
    {"merge", "joins the results of many checks", &run_merge},
};

}  // namespace

std::span<const Command> commands() { return kCommands; }

}  // namespace servotrace::replay
