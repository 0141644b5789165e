// SPDX-License-Identifier: MIT
#include "replay/capture/interrupt.hpp"

#include <csignal>

#include "replay/capture/live.hpp"

namespace servotrace::replay {
namespace {

std::atomic<bool> is_interrupted{false};
std::atomic<LiveSource*> live_source{nullptr};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<LiveSource*>::is_always_lock_free);

void on_signal(int) {
  is_interrupted.store(true, std::memory_order_relaxed);
  if (LiveSource* const source = live_source.load(std::memory_order_relaxed)) source->stop();
}

}  // namespace

const std::atomic<bool>& interrupted() { return is_interrupted; }

void catch_interrupts() {
  struct sigaction action = {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  // No SA_RESTART: a read that waits ends. SA_RESETHAND: the second signal is not caught.
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

void stop_on_interrupt(LiveSource* source) { live_source.store(source, std::memory_order_relaxed); }

}  // namespace servotrace::replay
