// SPDX-License-Identifier: MIT
// Texts that are asked for again and again, by what they are made of. Of fixed size: what is seldom asked for is made
// anew.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace servotrace {

// Key: two of them can be compared, and it has a member `std::uint64_t hash() const`.
template <class Key>
class TextCache {
 public:
  // size_bits: there is room for 2^size_bits texts.
  explicit TextCache(unsigned size_bits) : shift_(65U - size_bits), entries_(std::size_t{1} << size_bits) {}

  // The text of `key`; where it is not known, make(text) appends it to an empty one. Valid until the next call.
  template <class Make>
  std::string_view get(const Key& key, Make make) {
    constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15U;
    Entry* const pair = &entries_[2 * static_cast<std::size_t>(key.hash() * kGolden >> shift_)];
    if (pair[0].is(key)) return pair[0].text;
    if (pair[1].is(key)) return pair[1].text;
    std::swap(pair[0], pair[1]);  // the one that came last stays
    pair[0].used = true;
    pair[0].key = key;
    pair[0].text.clear();
    make(pair[0].text);
    return pair[0].text;
  }

 private:
  struct Entry {
    Key key{};
    bool used = false;
    std::string text;
    bool is(const Key& wanted) const { return used && key == wanted; }
  };

  unsigned shift_;
  std::vector<Entry> entries_;
};

}  // namespace servotrace
