// SPDX-License-Identifier: MIT
// Looks values up by their names in a hand-typed block.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "decoder/core/slot.hpp"
#include "decoder/rtex/decode.hpp"
#include "tests/support/bytes.hpp"

namespace servotrace::rtex::oracle {

// A block typed in hexadecimal, decoded with what is known of the drive.
class Block {
 public:
  static Block command(std::string_view text, const BlockFormat& format = {}) { return {text, true, format}; }
  static Block response(std::string_view text, const BlockFormat& format = {}) { return {text, false, format}; }

  // "command.servo_on"; nothing where no layout of the block has it.
  std::optional<std::int64_t> operator[](std::string_view name) const {
    const auto [field, bytes] = find(name);
    if (field == nullptr) return std::nullopt;
    return read(slot_of(*field), bytes);
  }
  // The same, of the last word of the block that has the name.
  std::optional<std::int64_t> last(std::string_view name) const {
    for (std::size_t i = layouts_.count; i-- > 0;) {
      const Field* field = field_in(*layouts_.words[i], name);
      if (field != nullptr) return read(slot_of(*field), Bytes(bytes_).subspan(4 * i, 4));
    }
    return std::nullopt;
  }
  const Field* field(std::string_view name) const { return find(name).first; }
  // The name of the value, or "" where it has none.
  std::string_view name(std::string_view key) const {
    const auto [field, bytes] = find(key);
    if (field == nullptr) return "(no field)";
    const ValueName* row = find_value(field->values, read(slot_of(*field), bytes));
    return row == nullptr ? "" : row->name;
  }
  std::string text(std::string_view key) const {
    const auto [field, bytes] = find(key);
    if (field == nullptr) return "(no field)";
    const Bytes raw = bytes_of(*field, bytes);
    return {raw.begin(), raw.end()};
  }
  std::size_t words() const { return layouts_.count; }

 private:
  Block(std::string_view text, bool is_command, const BlockFormat& format) : bytes_(test::hex(text)) {
    const BlockSize size = bytes_.size() >= kWideBlockSize ? BlockSize::kWide : BlockSize::kNarrow;
    layouts_ = is_command ? layouts_of_command(bytes_, size, format) : layouts_of_response(bytes_, size, format);
  }
  // `name`: the key of the layout, a dot, the key of the field.
  static const Field* field_in(const Layout& layout, std::string_view name) {
    if (name.size() <= layout.key.size() || !name.starts_with(layout.key) || name[layout.key.size()] != '.')
      return nullptr;
    return layout.find(name.substr(layout.key.size() + 1));
  }
  std::pair<const Field*, Bytes> find(std::string_view name) const {
    for (std::size_t i = 0; i < layouts_.count; ++i) {
      if (const Field* field = field_in(*layouts_.words[i], name)) return {field, Bytes(bytes_).subspan(4 * i, 4)};
    }
    return {nullptr, {}};
  }

  std::vector<std::uint8_t> bytes_;
  BlockLayouts layouts_;
};

}  // namespace servotrace::rtex::oracle
