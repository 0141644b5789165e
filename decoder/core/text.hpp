// SPDX-License-Identifier: MIT
// Text in fixed space, made by a session (listings, transactions) or by the compiler (what a table says of a row): what
// does not fit is cut off, nothing is allocated.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace servotrace {

template <std::size_t kCapacity>
class Text {
 public:
  constexpr void clear() { size_ = 0; }
  constexpr std::string_view view() const { return {characters_.data(), size_}; }
  constexpr bool is_full() const { return size_ == kCapacity; }
  constexpr Text& operator<<(std::string_view text) {
    for (const char c : text) {
      if (size_ == kCapacity) break;
      characters_[size_++] = c;
    }
    return *this;
  }
  constexpr Text& operator<<(std::int64_t value) {
    std::array<char, 24> digits{};
    std::size_t first = digits.size();
    const bool negative = value < 0;
    auto rest = negative ? std::uint64_t{0} - static_cast<std::uint64_t>(value) : static_cast<std::uint64_t>(value);
    do {
      digits[--first] = static_cast<char>('0' + rest % 10);
      rest /= 10;
    } while (rest != 0);
    if (negative) digits[--first] = '-';
    return *this << std::string_view(digits.data() + first, digits.size() - first);
  }
  // 450 with one place: 45.0.
  constexpr Text& decimal(std::int64_t value, unsigned places) {
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
