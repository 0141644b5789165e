// SPDX-License-Identifier: GPL-2.0-or-later
// Things that come again and again are kept once and known by a number, in the order of their first appearance.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

namespace servotrace::plugin {

constexpr std::uint64_t mix(std::uint64_t hash, std::uint64_t value) {
  return (std::rotl(hash, 23) ^ value) * 0x9E3779B97F4A7C15U;
}

inline std::uint64_t hash_of(std::string_view text) {
  std::uint64_t hash = text.size();
  for (; text.size() >= sizeof hash; text.remove_prefix(sizeof hash)) {
    std::uint64_t word = 0;
    std::memcpy(&word, text.data(), sizeof word);
    hash = mix(hash, word);
  }
  std::uint64_t rest = 0;
  if (!text.empty()) std::memcpy(&rest, text.data(), text.size());
  return mix(hash, rest);
}

template <class Entry>
std::uint64_t hash_of(const Entry& entry) {
  return entry.hash();
}

// `keep(entry)` gives what is kept of a new one: a copy of what it views.
template <class Entry>
class Dictionary {
 public:
  template <class Keep>
  std::uint32_t number(const Entry& entry, Keep keep) {
    const std::uint64_t hash = hash_of(entry);
    std::size_t place = place_of(hash);
    for (; places_[place] != kFree; place = next(place)) {
      if (entries_[places_[place]] == entry) return places_[place];
    }
    const auto result = static_cast<std::uint32_t>(entries_.size());
    entries_.push_back(keep(entry));
    places_[place] = result;
    if (entries_.size() * 2 > places_.size()) grow();
    return result;
  }
  std::uint32_t number(const Entry& entry) {
    return number(entry, [](const Entry& same) { return same; });
  }
  const Entry& operator[](std::size_t number) const { return entries_[number]; }

 private:
  static constexpr std::uint32_t kFree = UINT32_MAX;

  // Of the product of mix() the high bits are the good ones.
  std::size_t place_of(std::uint64_t hash) const { return hash >> 32U & (places_.size() - 1); }
  std::size_t next(std::size_t place) const { return (place + 1) & (places_.size() - 1); }
  void grow() {
    places_.assign(places_.size() * 2, kFree);
    for (std::uint32_t i = 0; i < entries_.size(); ++i) {
      std::size_t place = place_of(hash_of(entries_[i]));
      while (places_[place] != kFree) place = next(place);
      places_[place] = i;
    }
  }

  std::vector<Entry> entries_;
  std::vector<std::uint32_t> places_ = std::vector<std::uint32_t>(64, kFree);  // a power of two, at least half free
};

}  // namespace servotrace::plugin
