// SPDX-License-Identifier: MIT
// The proofs a layout must pass to compile: static_assert(well_formed(kMyLayout)).
#pragma once

#include <string_view>

#include "decoder/core/layout.hpp"

namespace servotrace {

enum class LayoutError : std::uint8_t {
  kNone,
  kNoTitle,
  kNoSection,
  kBadProtocol,
  kBadKey,
  kDuplicateKey,
  kNoLabel,
  kBadWidth,
  kOutsideSize,
  kOverlapOrOrder,  // rows stand in the order of their bits and do not overlap
  kGap,             // an unlisted bit must be a reserved row
  kValuesNotSorted,
  kValueDoesNotFit,
  kValueWithoutName,
  kClosedWithoutValues,
  kBadRange,
  kBadScale,
  kBadBigEndian,
  kRestNotLast,
};

namespace detail {
constexpr bool legal_key(std::string_view key) {
  if (key.empty() || key.front() < 'a' || key.front() > 'z') return false;
  for (const char c : key) {
    if (!((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_')) return false;
  }
  return true;
}

// The smallest and largest number a field of this width holds.
constexpr bool fits(const Field& field, std::int64_t value) {
  if (field.kind == Kind::kBytes || field.kind == Kind::kText) return false;
  if (field.width >= 64) return true;
  if (field.kind == Kind::kSigned) {
    const std::int64_t limit = std::int64_t{1} << (field.width - 1);
    return value >= -limit && value < limit;
  }
  return value >= 0 && (field.width == 63 || value < (std::int64_t{1} << field.width));
}

constexpr LayoutError check_field(const Layout& layout, const Field& field, bool last) {
  if (!legal_key(field.key)) return LayoutError::kBadKey;
  if (field.label.empty()) return LayoutError::kNoLabel;
  if (field.section.empty()) return LayoutError::kNoSection;
  const bool raw = field.kind == Kind::kBytes || field.kind == Kind::kText;
  if (field.width == 0) {
    if (!raw) return LayoutError::kBadWidth;
    if (!last || field.first_bit != layout.size * 8U) return LayoutError::kRestNotLast;
    return LayoutError::kNone;
  }
  if (raw && (field.width % 8 != 0 || field.first_bit % 8 != 0)) return LayoutError::kBadWidth;
  if (!raw && (field.width > 64 || field.byte_count() > 8)) return LayoutError::kBadWidth;
  if (field.kind == Kind::kBool && field.width != 1) return LayoutError::kBadWidth;
  if (field.first_bit + field.width > layout.size * 8U) return LayoutError::kOutsideSize;
  if (field.order == ByteOrder::kBig && (field.width % 8 != 0 || field.first_bit % 8 != 0))
    return LayoutError::kBadBigEndian;
  if (field.scale.numerator <= 0 || field.scale.denominator <= 0) return LayoutError::kBadScale;
  if (field.closed && field.values.empty()) return LayoutError::kClosedWithoutValues;
  for (std::size_t i = 0; i < field.values.size(); ++i) {
    if (field.values[i].name.empty()) return LayoutError::kValueWithoutName;
    if (!fits(field, field.values[i].value)) return LayoutError::kValueDoesNotFit;
    if (i > 0 && field.values[i - 1].value >= field.values[i].value) return LayoutError::kValuesNotSorted;
  }
  if (field.has_range() && (field.range.minimum > field.range.maximum || !fits(field, field.range.minimum) ||
                            !fits(field, field.range.maximum))) {
    return LayoutError::kBadRange;
  }
  return LayoutError::kNone;
}
}  // namespace detail

// The first thing wrong with a layout.
constexpr LayoutError check(const Layout& layout) {
  if (layout.title.empty()) return LayoutError::kNoTitle;
  if (layout.section.empty()) return LayoutError::kNoSection;
  if (!detail::legal_key(layout.protocol)) return LayoutError::kBadProtocol;
  if (!layout.key.empty() && !detail::legal_key(layout.key)) return LayoutError::kBadKey;
  std::size_t next_bit = 0;
  for (std::size_t i = 0; i < layout.fields.size(); ++i) {
    const Field& field = layout.fields[i];
    const LayoutError error = detail::check_field(layout, field, i + 1 == layout.fields.size());
    if (error != LayoutError::kNone) return error;
    for (std::size_t j = 0; j < i; ++j) {
      if (layout.fields[j].key == field.key) return LayoutError::kDuplicateKey;
    }
    if (field.first_bit < next_bit) return LayoutError::kOverlapOrOrder;
    if (field.first_bit > next_bit) return LayoutError::kGap;
    next_bit = std::size_t{field.first_bit} + field.width;
  }
  return next_bit == layout.size * 8U ? LayoutError::kNone : LayoutError::kGap;
}

constexpr bool well_formed(const Layout& layout) { return check(layout) == LayoutError::kNone; }

}  // namespace servotrace
