// SPDX-License-Identifier: MIT
// Ctrl-C: a flag that the loops look at, so that a live check ends with its summary and no half-written file is left.
#pragma once

#include <atomic>

namespace servotrace::replay {

class LiveSource;

// Set by SIGINT and SIGTERM once catch_interrupts() was called. A second signal ends the program at once.
const std::atomic<bool>& interrupted();
void catch_interrupts();

// The source that waits for traffic and has to be told; nullptr: none. It must outlive its registration.
void stop_on_interrupt(LiveSource* source);

}  // namespace servotrace::replay
