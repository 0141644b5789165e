// SPDX-License-Identifier: MIT
#include <csignal>
#include <exception>

#include "replay/commands.hpp"
#include "replay/console.hpp"
#include "replay/exit_status.hpp"

int main(int argc, char** argv) {
  // A closed pipe is noticed where it is written to.
  std::signal(SIGPIPE, SIG_IGN);
  try {
    return servotrace::replay::run_servotrace({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    servotrace::replay::complain(servotrace::Error{"internal error", error.what()});
    return servotrace::replay::kExitFailed;
  }
}
