// SPDX-License-Identifier: MIT
// A list of fixed capacity: no allocation, ever. What does not fit is dropped and counted, so a hostile frame cannot
// grow memory and a lost entry is never silent.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace servotrace {

template <class T, std::size_t kCapacity>
class SmallVector {
 public:
  // False, and counted in dropped(), when full.
  constexpr bool push_back(const T& value) {
    if (size_ == kCapacity) {
      ++dropped_;
      return false;
    }
    items_[size_++] = value;
    return true;
  }
  constexpr void clear() { size_ = 0, dropped_ = 0; }
  constexpr std::size_t size() const { return size_; }
  constexpr bool empty() const { return size_ == 0; }
  constexpr bool full() const { return size_ == kCapacity; }
  constexpr std::uint32_t dropped() const { return dropped_; }
  static constexpr std::size_t capacity() { return kCapacity; }
  // Precondition: index < size().
  constexpr T& operator[](std::size_t index) { return items_[index]; }
  constexpr const T& operator[](std::size_t index) const { return items_[index]; }
  constexpr T& back() { return items_[size_ - 1]; }
  constexpr const T& back() const { return items_[size_ - 1]; }
  constexpr T* begin() { return items_.data(); }
  constexpr T* end() { return items_.data() + size_; }
  constexpr const T* begin() const { return items_.data(); }
  constexpr const T* end() const { return items_.data() + size_; }
  constexpr T* data() { return items_.data(); }
  constexpr const T* data() const { return items_.data(); }

 private:
  std::array<T, kCapacity> items_{};
  std::size_t size_ = 0;
  std::uint32_t dropped_ = 0;
};

}  // namespace servotrace
