// SPDX-License-Identifier: MIT
// Slots: the only place where the bytes of a packet are touched. `slot(kLayout, "key")` is evaluated by the compiler (a
// wrong name does not compile) and yields a small value; read() of a constant slot folds to a load, a shift and a mask.
// Bounds are checked once a layout, by whoever makes the view (`fits`), not once a field.
#pragma once

#include <bit>
#include <cassert>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "decoder/core/bytes.hpp"
#include "decoder/core/layout.hpp"

namespace servotrace {

struct Slot {
  std::uint16_t first_byte = 0;
  std::uint8_t byte_count = 0;  // 1..8
  std::uint8_t shift = 0;       // bits, 0..7
  std::uint8_t width = 0;       // bits, 1..64
  bool is_signed = false;
  ByteOrder order = ByteOrder::kLittle;
};

// The slot of a numeric row. Of a bytes or text row, or a row wider than 64 bits: a slot of width 0, which reads as 0.
constexpr Slot slot_of(const Field& field) {
  if (field.kind == Kind::kBytes || field.kind == Kind::kText || field.width == 0 || field.width > 64) return {};
  return Slot{static_cast<std::uint16_t>(field.first_byte()),
              static_cast<std::uint8_t>(field.byte_count()),
              static_cast<std::uint8_t>(field.first_bit % 8U),
              static_cast<std::uint8_t>(field.width),
              field.kind == Kind::kSigned,
              field.order};
}

// Walks the rows itself: a pointer compared with null is no constant for g++ 12 with -fsanitize=undefined.
consteval Slot slot(const Layout& layout, std::string_view key) {
  for (const Field& field : layout.fields) {
    if (field.key != key) continue;
    const Slot result = slot_of(field);
    if (result.width == 0) throw "this field is no number";
    return result;
  }
  throw "no such field in this layout";
}

namespace detail {
// One load, where the machine has it: compilers do not make one of the loop.
template <class Word>
[[gnu::always_inline]] inline std::uint64_t load_word(const std::uint8_t* from) {
  Word word;
  std::memcpy(&word, from, sizeof word);
  return word;
}

// The whole number in `byte_count` (0 to 8) bytes from `from` on.
[[gnu::always_inline]] constexpr std::uint64_t load_little(const std::uint8_t* from, unsigned byte_count) {
  if (!std::is_constant_evaluated() && std::endian::native == std::endian::little) {
    switch (byte_count) {
      case 1:
        return *from;
      case 2:
        return load_word<std::uint16_t>(from);
      case 3:
        return load_word<std::uint16_t>(from) | std::uint64_t{from[2]} << 16U;
      case 4:
        return load_word<std::uint32_t>(from);
      case 8:
        return load_word<std::uint64_t>(from);
      default:
        break;
    }
  }
  std::uint64_t raw = 0;
  for (unsigned i = 0; i < byte_count; ++i) raw |= std::uint64_t{from[i]} << (8U * i);
  return raw;
}
[[gnu::always_inline]] constexpr std::uint64_t load_big(const std::uint8_t* from, unsigned byte_count) {
  if (!std::is_constant_evaluated() && std::endian::native == std::endian::little) {
    if (byte_count == 1) return *from;
    if (byte_count == 2) return __builtin_bswap16(static_cast<std::uint16_t>(load_word<std::uint16_t>(from)));
    if (byte_count == 4) return __builtin_bswap32(static_cast<std::uint32_t>(load_word<std::uint32_t>(from)));
  }
  std::uint64_t raw = 0;
  for (unsigned i = 0; i < byte_count; ++i) raw = raw << 8U | from[i];
  return raw;
}
}  // namespace detail

constexpr bool fits(const Layout& layout, Bytes bytes) { return bytes.size() >= layout.size; }

// The value of a slot, sign-extended where the row is signed. Precondition: fits(layout, bytes).
[[gnu::always_inline]] constexpr std::int64_t read(Slot slot, Bytes bytes) {
  assert(std::size_t{slot.first_byte} + slot.byte_count <= bytes.size());
  const std::uint8_t* const at_byte = bytes.data() + slot.first_byte;
  std::uint64_t raw = slot.order == ByteOrder::kLittle ? detail::load_little(at_byte, slot.byte_count)
                                                       : detail::load_big(at_byte, slot.byte_count);
  raw >>= slot.shift;
  if (slot.width == 0) return 0;
  if (slot.width < 64) {
    const std::uint64_t mask = (std::uint64_t{1} << slot.width) - 1;
    raw &= mask;
    if (slot.is_signed && (raw >> (slot.width - 1U) & 1U) != 0) raw |= ~mask;
  }
  return static_cast<std::int64_t>(raw);
}

// Puts `value` into its place and leaves every other bit alone. False, and nothing written, where the value does not
// fit the slot or the slot does not fit the buffer.
[[nodiscard]] constexpr bool write(Slot slot, MutableBytes bytes, std::int64_t value) {
  if (slot.width == 0 || std::size_t{slot.first_byte} + slot.byte_count > bytes.size()) return false;
  const std::uint64_t mask = slot.width >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << slot.width) - 1;
  if (slot.width < 64) {
    if (slot.is_signed) {
      const std::int64_t limit = std::int64_t{1} << (slot.width - 1U);
      if (value < -limit || value >= limit) return false;
    } else if (value < 0 || (static_cast<std::uint64_t>(value) & ~mask) != 0) {
      return false;
    }
  }
  const std::uint64_t raw = (static_cast<std::uint64_t>(value) & mask) << slot.shift;
  const std::uint64_t keep = ~(mask << slot.shift);
  for (unsigned i = 0; i < slot.byte_count; ++i) {
    const unsigned place = slot.order == ByteOrder::kLittle ? i : slot.byte_count - 1U - i;
    std::uint8_t& byte = bytes[slot.first_byte + place];
    byte = static_cast<std::uint8_t>((byte & (keep >> (8U * i) & 0xFFU)) | (raw >> (8U * i) & 0xFFU));
  }
  return true;
}

// The raw bytes of a row (bytes and text rows too). Precondition: fits(layout, bytes).
constexpr Bytes bytes_of(const Field& field, Bytes bytes) {
  if (field.first_byte() > bytes.size()) return {};
  const Bytes rest = bytes.subspan(field.first_byte());
  return field.width == 0 || field.byte_count() > rest.size() ? rest : rest.first(field.byte_count());
}

// Whole numbers at a place known only at run time (the length of a fragment's payload, a parameter's size).
// Precondition: offset + width <= size.
[[gnu::always_inline]] constexpr std::uint32_t load_le(Bytes bytes, std::size_t offset, unsigned byte_count) {
  assert(offset + byte_count <= bytes.size() && byte_count <= 4);
  return static_cast<std::uint32_t>(detail::load_little(bytes.data() + offset, byte_count));
}
// Eight bytes at once, for comparing a block with the one before. Precondition: offset + 8 <= size.
[[gnu::always_inline]] constexpr std::uint64_t load_le64(Bytes bytes, std::size_t offset) {
  assert(offset + 8 <= bytes.size());
  return detail::load_little(bytes.data() + offset, 8);
}
[[gnu::always_inline]] constexpr std::uint32_t load_be(Bytes bytes, std::size_t offset, unsigned byte_count) {
  assert(offset + byte_count <= bytes.size() && byte_count <= 4);
  return static_cast<std::uint32_t>(detail::load_big(bytes.data() + offset, byte_count));
}

}  // namespace servotrace
