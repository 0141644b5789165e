// SPDX-License-Identifier: MIT
// What the command list says of a number (ESB 5.4), in one line made by the compiler: the explanation of its field, so
// that `decode --explain`, the reference and Wireshark show range, unit, decimal place and initial value.
#pragma once

#include <array>

#include "decoder/core/text.hpp"
#include "decoder/profiles/nsk_esb/numbers.hpp"

namespace servotrace::esb {

using NumberFacts = Text<320>;

namespace detail {

constexpr std::int64_t power_of_ten(unsigned places) {
  std::int64_t result = 1;
  for (unsigned i = 0; i < places; ++i) result *= 10;
  return result;
}

// "Hz", "100 ms": what one unit of the printed value (with its decimal point) is.
constexpr void append_printed_unit(NumberFacts& text, const Number& row) {
  if (row.unit == Unit::kNone) return;
  std::int64_t above = row.scale.numerator * power_of_ten(row.decimals);
  std::int64_t below = row.scale.denominator;
  if (above % below == 0) {
    above /= below;
    below = 1;
  }
  text << " ";
  if (below != 1) {
    text << "x " << above << "/" << below << " ";
  } else if (above != 1) {
    text << "x " << above << " ";
  }
  text << symbol(row.unit);
}

constexpr void append_range(NumberFacts& text, const Number& row) {
  const auto between = [&](const Range& range) {
    text.decimal(range.minimum, row.decimals) << " to ";
    text.decimal(range.maximum, row.decimals);
  };
  if (!row.values.empty()) {
    for (std::size_t i = 0; i < row.values.size(); ++i) text << (i == 0 ? "" : ", ") << row.values[i].value;
    return;
  }
  if (row.or_zero) text << "0 or ";
  between(row.range);
  if (row.second.minimum != 0 || row.second.maximum != 0) {
    text << " or ";
    between(row.second);
  }
}

constexpr NumberFacts number_facts(const Number& row) {
  NumberFacts text;
  text << row.name;
  if (!row.has_data) return text << "; takes no data";
  if (row.has_range() || !row.values.empty()) {
    text << "; ";
    append_range(text, row);
    append_printed_unit(text, row);
  }
  if (row.decimals != 0) text << "; decimal places: " << std::int64_t{row.decimals};
  if (!row.initial.empty()) text << "; initial: " << row.initial;
  if (!row.explanation.empty()) text << "; " << row.explanation;
  return text;
}

consteval auto all_number_facts() {
  std::array<NumberFacts, kNumbers.size()> facts{};
  for (std::size_t i = 0; i < facts.size(); ++i) {
    facts[i] = number_facts(kNumbers[i]);
    if (facts[i].is_full()) throw "a number's facts do not fit";
  }
  return facts;
}

}  // namespace detail

// One a row of kNumbers, in their order.
inline constexpr auto kNumberFacts = detail::all_number_facts();

}  // namespace servotrace::esb
