// SPDX-License-Identifier: MIT
#include "replay/capture/mapped_file.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <system_error>
#include <thread>

namespace servotrace::replay {
namespace {

// Only what a signal handler may touch: plain words, no locks.
struct Slot {
  std::atomic<bool> taken = false;
  std::atomic<std::uintptr_t> begin = 0;
  std::atomic<std::uintptr_t> end = 0;
  volatile std::sig_atomic_t lost = 0;
};
constexpr std::size_t kSlots = 64;  // files mapped at once; more are read instead
Slot slots[kSlots];
struct sigaction previous = {};
std::uintptr_t page_size = 4096;

void on_bus_error(int signal, siginfo_t* info, void* context) {
  const auto address = reinterpret_cast<std::uintptr_t>(info->si_addr);
  for (Slot& slot : slots) {
    if (address < slot.begin.load(std::memory_order_acquire) || address >= slot.end.load(std::memory_order_acquire))
      continue;
    void* const page = static_cast<char*>(info->si_addr) - address % page_size;
    if (::mmap(page, page_size, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED, -1, 0) == MAP_FAILED) break;
    slot.lost = 1;
    return;
  }
  if ((previous.sa_flags & SA_SIGINFO) != 0 && previous.sa_sigaction != nullptr) {
    previous.sa_sigaction(signal, info, context);
  } else if (previous.sa_handler != SIG_DFL && previous.sa_handler != SIG_IGN) {
    previous.sa_handler(signal);
  } else {
    ::signal(SIGBUS, SIG_DFL);  // the access is tried again, and ends the program
  }
}

void install() {
  page_size = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
  struct sigaction action = {};
  action.sa_sigaction = on_bus_error;
  action.sa_flags = SA_SIGINFO | SA_NODEFER;
  ::sigemptyset(&action.sa_mask);
  ::sigaction(SIGBUS, &action, &previous);
}

}  // namespace

MappedFile::MappedFile(void* address, std::size_t length, std::size_t slot)
    : address_(address), length_(length), slot_(slot), lost_(&slots[slot].lost) {}

std::unique_ptr<MappedFile> MappedFile::map(int descriptor, std::size_t length) {
  static std::once_flag once;
  std::call_once(once, install);
  for (std::size_t i = 0; i < kSlots; ++i) {
    bool taken = false;
    if (!slots[i].taken.compare_exchange_strong(taken, true)) continue;
    void* const address = ::mmap(nullptr, length, PROT_READ, MAP_PRIVATE, descriptor, 0);
    if (address == MAP_FAILED) {
      slots[i].taken = false;
      return nullptr;
    }
    ::madvise(address, length, MADV_SEQUENTIAL);
    slots[i].lost = 0;
    slots[i].begin = reinterpret_cast<std::uintptr_t>(address);
    slots[i].end = reinterpret_cast<std::uintptr_t>(address) + length;
    return std::unique_ptr<MappedFile>(new MappedFile(address, length, i));
  }
  return nullptr;
}

// Does one task at a time beside the reader. Nothing is promised: what it has not done yet the reader's own touch does.
struct MappedFile::Ahead {
  explicit Ahead(const MappedFile& mapped) : file(mapped) {
    // Signals are the reader's.
    sigset_t all, before;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before);
    try {
      thread = std::thread([this] { work(); });
    } catch (const std::system_error&) {  // no thread to be had: take() says so
    }
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  }
  Ahead(const Ahead&) = delete;
  Ahead& operator=(const Ahead&) = delete;
  ~Ahead() {
    {
      const std::lock_guard lock(mutex);
      stop = true;
    }
    wake.notify_one();
    if (thread.joinable()) thread.join();
  }

  // False, and nothing was taken, where the task before is not done or there is no thread.
  bool take(const Task& given) {
    {
      const std::lock_guard lock(mutex);
      if (busy || !thread.joinable()) return false;
      task = given;
      busy = true;
    }
    wake.notify_one();
    return true;
  }

  void work() {
    std::unique_lock lock(mutex);
    for (;;) {
      wake.wait(lock, [this] { return busy || stop; });
      if (stop) return;
      const Task now = task;
      lock.unlock();
      file.run(now);
      lock.lock();
      busy = false;
    }
  }

  const MappedFile& file;
  std::mutex mutex;
  std::condition_variable wake;
  Task task;
  bool busy = false;
  bool stop = false;
  std::thread thread;
};

void MappedFile::run(const Task& task) const {
  const auto advise = [this](std::size_t from, std::size_t to, int advice) {
    return from >= to || ::madvise(static_cast<char*>(address_) + from, to - from, advice) == 0;
  };
  advise(task.release_from, task.release_to, MADV_DONTNEED);
  // What cannot be read ahead shows when it is touched.
  const std::size_t begin = std::max(task.wanted_from - task.wanted_from % page_size, passed_.load());
#ifdef MADV_POPULATE_READ
  const bool populated = advise(begin, task.wanted_to, MADV_POPULATE_READ);
#else
  const bool populated = false;
#endif
  if (!populated) advise(begin, task.wanted_to, MADV_WILLNEED);
  // The reader may have overtaken this thread, and let go of these before they were there.
  advise(begin, std::min(task.wanted_to, passed_.load()), MADV_DONTNEED);
}

void MappedFile::advance(std::size_t passed, std::size_t from, std::size_t to) {
  constexpr std::size_t kLong = std::size_t{16} << 20U;  // bytes left from which a thread is worth its start
  Task task{.release_from = released_,
            .release_to = std::max(released_, passed - passed % page_size),
            .wanted_from = from,
            .wanted_to = std::min(to, length_)};
  released_ = task.release_to;
  passed_ = task.release_to;
  if (ahead_ == nullptr && length_ - task.wanted_to >= kLong) {
    run(task);  // these are read at once
    task.release_from = task.release_to;
    ahead_ = std::make_unique<Ahead>(*this);
  }
  if (ahead_ == nullptr) {
    run(task);
    return;
  }
  const std::size_t step = task.wanted_to - std::min(from, task.wanted_to);
  task.wanted_from = task.wanted_to;
  task.wanted_to = std::min(task.wanted_to + step, length_);
  if (ahead_->take(task)) return;
  task.wanted_to = task.wanted_from;
  run(task);
}

MappedFile::~MappedFile() {
  ahead_.reset();
  slots[slot_].end = 0;
  slots[slot_].begin = 0;
  ::munmap(address_, length_);
  slots[slot_].taken = false;
}

}  // namespace servotrace::replay
