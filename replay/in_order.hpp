// SPDX-License-Identifier: MIT
// Work done by several threads, its results used in order by one: the output does not depend on how many there are.
#pragma once

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

namespace servotrace::replay {

// work(index) for 0 <= index < count on up to `threads` threads; use(result) in the order of the indices on the calling
// thread. A few results wait at most, so memory does not grow with `count`. use() returns false to stop early. What
// work() throws is thrown here.
template <class Work, class Use>
void in_order(std::size_t count, unsigned threads, Work work, Use use) {
  using Value = decltype(work(std::size_t{}));
  if (threads <= 1 || count <= 1) {
    for (std::size_t i = 0; i < count; ++i) {
      if (!use(work(i))) return;
    }
    return;
  }
  const std::size_t window = std::size_t{threads} * 4;
  std::mutex mutex;
  std::condition_variable changed;
  std::map<std::size_t, Value> done;
  std::size_t next_work = 0;
  std::size_t next_use = 0;
  bool stopped = false;
  std::exception_ptr failure;
  const auto worker = [&] {
    while (true) {
      std::unique_lock lock(mutex);
      changed.wait(lock, [&] { return stopped || next_work >= count || next_work < next_use + window; });
      if (stopped || next_work >= count) return;
      const std::size_t index = next_work++;
      lock.unlock();
      try {
        Value value = work(index);
        lock.lock();
        done.emplace(index, std::move(value));
      } catch (...) {
        if (!lock.owns_lock()) lock.lock();
        failure = std::current_exception();
        stopped = true;
      }
      changed.notify_all();
    }
  };
  std::vector<std::thread> pool;
  for (std::size_t i = 0; i < std::min<std::size_t>(threads, count); ++i) pool.emplace_back(worker);
  std::unique_lock lock(mutex);
  while (next_use < count) {
    changed.wait(lock, [&] { return stopped || done.count(next_use) != 0; });
    if (stopped) break;
    auto node = done.extract(next_use);
    ++next_use;
    lock.unlock();
    changed.notify_all();
    bool go_on = false;
    try {
      go_on = use(std::move(node.mapped()));
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    if (!go_on) stopped = true;
    if (stopped) break;
  }
  stopped = true;
  lock.unlock();
  changed.notify_all();
  for (std::thread& thread : pool) thread.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace servotrace::replay
