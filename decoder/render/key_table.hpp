// SPDX-License-Identifier: MIT
// What a field's key stands for, found without comparing it with every key there is: the rows are ordered by length.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace servotrace {

template <class Value>
struct KeyRow {
  std::string_view key;
  Value value{};
};

template <class Value, std::size_t N>
class KeyTable {
 public:
  explicit consteval KeyTable(const KeyRow<Value> (&rows)[N]) {
    std::copy(std::begin(rows), std::end(rows), rows_.begin());
    std::sort(rows_.begin(), rows_.end(),
              [](const auto& left, const auto& right) { return left.key.size() < right.key.size(); });
    for (std::size_t size = 0; size < first_.size(); ++size) {
      first_[size] = static_cast<std::uint8_t>(
          std::count_if(rows_.begin(), rows_.end(), [size](const auto& row) { return row.key.size() < size; }));
    }
    if (rows_.back().key.size() > kLongest) throw "a key is longer than the table is made for";
  }

  // nullptr: the key is none of the table's.
  constexpr const Value* find(std::string_view key) const {
    if (key.size() > kLongest) return nullptr;
    for (std::size_t i = first_[key.size()]; i < first_[key.size() + 1]; ++i) {
      if (rows_[i].key == key) return &rows_[i].value;
    }
    return nullptr;
  }

 private:
  static constexpr std::size_t kLongest = 30;
  static_assert(N < 256);

  std::array<KeyRow<Value>, N> rows_{};
  std::array<std::uint8_t, kLongest + 2> first_{};  // the first row of at least this length
};

}  // namespace servotrace
