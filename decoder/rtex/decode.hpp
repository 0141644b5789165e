// SPDX-License-Identifier: MIT
// Which layout lies where in an RTEX block. Plain C++: the layouts themselves are flat.
#pragma once

#include <array>

#include "decoder/pipeline/dissection.hpp"
#include "decoder/rtex/layouts.hpp"

namespace servotrace::rtex {

// What the bytes of a node mean, beside what they say themselves: parameters of the drive. All at 0 is the assumption.
struct BlockFormat {
  std::array<std::uint8_t, 6> monitor = {};      // Pr7.29 to Pr7.34: Type_Codes of response data; 0: the default
  std::array<std::uint8_t, 3> feedforward = {};  // Pr7.35 to Pr7.37: 0 none, 1 velocity, 2 torque
  bool speed_in_units = false;                   // Pr7.25 = 1
  bool limits_swapped = false;                   // Pr7.23 bit 7
  bool status_known = false;                     // the next two are known, and not assumed
  bool inhibit_swapped = false;                  // Pr7.23 bit 3
  bool ac_off = false;                           // Pr7.23 bit 8
  bool operator==(const BlockFormat&) const = default;
};

enum class BlockSize : std::uint8_t { kNarrow = 16, kWide = 32 };  // bytes

// The layouts of a block, in the order of their bytes. `bytes` is the block: 16 or 32 of it are read, no more.
struct BlockLayouts {
  std::array<const Layout*, 8> words = {};
  std::size_t count = 0;
};
BlockLayouts layouts_of_command(Bytes block, BlockSize size, const BlockFormat& format);
BlockLayouts layouts_of_response(Bytes block, BlockSize size, const BlockFormat& format);

// Adds the segments of a block that starts at `offset` of the frame.
void decode_block(const BlockLayouts& layouts, std::uint32_t offset, const NodeRef& node, Direction direction,
                  Dissection& dissection);

// True where byte 1 is FFh and bytes 8-15 are 0: the drive saw a CRC error (6-11). Precondition: 16 bytes.
inline bool is_communication_error(Bytes block) {
  return read(slot(kResponse, "cmd_error"), block) != 0 &&
         read(slot(kResponse, "non_cyclic_command_echo"), block) == 15 &&
         read(slot(kResponse, "cyclic_command_echo"), block) == 7 && load_le(block, kData2At, 4) == 0 &&
         load_le(block, kData3At, 4) == 0;
}

// True where bytes 12-15 of a non-cyclic command are Setting_Data, not feedforward (7-7-1).
constexpr bool has_setting_data(std::uint8_t non_cyclic, std::uint16_t type_code) {
  switch (static_cast<NonCyclic>(non_cyclic)) {
    case NonCyclic::kProfile:
      return true;
    case NonCyclic::kHoming:
      return type_code == 0x21 || type_code == 0x22;
    case NonCyclic::kParameter:
      return type_code == kParameterWrite;
    default:
      return false;
  }
}

}  // namespace servotrace::rtex
