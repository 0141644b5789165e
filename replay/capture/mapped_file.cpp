// SPDX-License-Identifier: MIT
#include "replay/capture/mapped_file.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <mutex>

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

void MappedFile::advance(std::size_t passed, std::size_t from, std::size_t to) {
  const auto at = [this](std::size_t offset) { return static_cast<char*>(address_) + offset; };
  const std::size_t whole = passed - passed % page_size;
  if (whole > released_) {
    ::madvise(at(released_), whole - released_, MADV_DONTNEED);
    released_ = whole;
  }
  // What cannot be read ahead shows when it is touched.
  const std::size_t begin = from - from % page_size;
  const std::size_t end = std::min(to, length_);
  if (begin >= end) return;
#ifdef MADV_POPULATE_READ
  if (::madvise(at(begin), end - begin, MADV_POPULATE_READ) == 0) return;
#endif
  ::madvise(at(begin), end - begin, MADV_WILLNEED);
}

MappedFile::~MappedFile() {
  slots[slot_].end = 0;
  slots[slot_].begin = 0;
  ::munmap(address_, length_);
  slots[slot_].taken = false;
}

}  // namespace servotrace::replay
