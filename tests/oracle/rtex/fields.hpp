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
  std::pair<const Field*, Bytes> find(std::string_view name) const {
    for (std::size_t i = 0; i < layouts_.count; ++i) {
      const Layout& layout = *layouts_.words[i];
      if (name.size() <= layout.key.size() || name.substr(0, layout.key.size()) != layout.key ||
          name[layout.key.size()] != '.') {
        continue;
      }
      const Field* field = layout.find(name.substr(layout.key.size() + 1));
      if (field != nullptr) return {field, Bytes(bytes_).subspan(4 * i, 4)};
    }
    return {nullptr, {}};
  }

  std::vector<std::uint8_t> bytes_;
  BlockLayouts layouts_;
};

}  // namespace servotrace::rtex::oracle
