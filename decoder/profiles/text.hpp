// SPDX-License-Identifier: MIT
// Text made by a session (listings, transactions) in fixed space: what does not fit is cut off, nothing is allocated.
#pragma once

#include <array>
#include <charconv>
#include <cstdint>
#include <string_view>

namespace servotrace {

template <std::size_t kCapacity>
class Text {
 public:
  void clear() { size_ = 0; }
  std::string_view view() const { return {characters_.data(), size_}; }
  Text& operator<<(std::string_view text) {
    for (const char c : text) {
      if (size_ == kCapacity) break;
      characters_[size_++] = c;
    }
    return *this;
  }
  Text& operator<<(std::int64_t value) {
    std::array<char, 24> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    return *this << std::string_view(digits.data(), static_cast<std::size_t>(end - digits.data()));
  }
  // 450 with one place: 45.0.
  Text& decimal(std::int64_t value, unsigned places) {
    std::int64_t unit = 1;
    for (unsigned i = 0; i < places; ++i) unit *= 10;
    if (value < 0) {
      *this << "-";
      value = -value;
    }
    *this << value / unit;
    if (places == 0) return *this;
    *this << ".";
    std::int64_t rest = value % unit;
    for (unsigned i = 0; i < places; ++i) {
      unit /= 10;
      *this << rest / unit;
      rest %= unit;
    }
    return *this;
  }

 private:
  std::array<char, kCapacity> characters_{};
  std::size_t size_ = 0;
};

}  // namespace servotrace
