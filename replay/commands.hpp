// SPDX-License-Identifier: MIT
// The subcommands there are. A new one is a declaration here and a line in commands.cpp.
#pragma once

#include <span>
#include <string_view>

#include "replay/command_line.hpp"

namespace servotrace::replay {

// One subcommand. `run` returns the exit status.
struct Command {
  std::string_view name;
  std::string_view summary;  // a line, lower case, without a full stop
  int (*run)(const Arguments& arguments) = nullptr;
};
// In the order of the help.
std::span<const Command> commands();

int run_check(const Arguments& arguments);
int run_report(const Arguments& arguments);
int run_decode(const Arguments& arguments);
int run_info(const Arguments& arguments);
int run_explain(const Arguments& arguments);
int run_rules(const Arguments& arguments);
int run_simulate(const Arguments& arguments);
int run_annotate(const Arguments& arguments);
int run_export(const Arguments& arguments);
int run_config(const Arguments& arguments);
int run_convert(const Arguments& arguments);
int run_merge(const Arguments& arguments);

// The whole program, without its name in front. Used by main() and the tests.
int run_servotrace(const Arguments& arguments);

}  // namespace servotrace::replay
