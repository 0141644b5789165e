// SPDX-License-Identifier: MIT
// The names a log's map has for the fields of RTEX blocks (SX-DSV02203 4-2 to 4-5): those of the decoder's tables, and
// for whole words those of what they carry.
#include <algorithm>

#include "decoder/rtex/layouts.hpp"
#include "replay/settings/rtex_log_map.hpp"

namespace servotrace::replay {
namespace {

struct Row {
  std::string_view key;
  Slot slot;
};

constexpr Slot whole(unsigned first_byte, unsigned bits) {
  return {static_cast<std::uint16_t>(first_byte), static_cast<std::uint8_t>((bits + 7) / 8), 0,
          static_cast<std::uint8_t>(bits)};
}
constexpr Slot at(unsigned first_byte, Slot slot) {
  slot.first_byte = static_cast<std::uint16_t>(slot.first_byte + first_byte);
  slot.is_signed = false;
  return slot;
}

constexpr unsigned kData1 = rtex::kData1At;
constexpr unsigned kData2 = rtex::kData2At;
constexpr unsigned kData3 = rtex::kData3At;
constexpr unsigned kSub = rtex::kSubHeaderAt;

constexpr Row kCommandRows[] = {
    {"command_code", whole(1, 7)},  // cyclic and non-cyclic code as one number: 21h
    {"command_data1", whole(kData1, 32)},
    {"target_position", whole(kData1, 32)},
    {"command_position", whole(kData1, 32)},
    {"command_speed", whole(kData1, 32)},
    {"command_torque", whole(kData1, 32)},
    {"command_data2", whole(kData2, 32)},
    {"type_code", at(kData2, slot(rtex::kMonitor, "type_code"))},
    {"index", at(kData2, slot(rtex::kMonitor, "index"))},
    {"command_data3", whole(kData3, 32)},
    {"setting_data", whole(kData3, 32)},
    {"target_speed", whole(kData3, 32)},
    {"sub_chk", at(kSub, slot(rtex::kSubCommand, "sub_chk"))},
    {"sub_command_code", at(kSub, slot(rtex::kSubCommand, "command"))},
    {"sub_type_code", at(kSub, slot(rtex::kSubCommand, "type_code"))},
    {"sub_index", at(kSub, slot(rtex::kSubCommand, "index"))},
    {"sub_command_data1", whole(rtex::kSubData1At, 32)},
    {"sub_command_data2", whole(rtex::kSubData2At, 32)},
    {"sub_command_data3", whole(rtex::kSubData3At, 32)},
};
constexpr Row kResponseRows[] = {
    {"command_code_echo", whole(1, 7)},
    {"response_data1", whole(kData1, 32)},
    {"actual_position", whole(kData1, 32)},
    {"response_data2", whole(kData2, 32)},
    {"actual_speed", whole(kData2, 32)},
    {"error_code", at(kData2, slot(rtex::kError, "error_code"))},
    {"type_code_echo", at(kData2, slot(rtex::kMonitorEcho, "type_code_echo"))},
    {"busy", at(kData2, slot(rtex::kMonitorEcho, "busy"))},
    {"wng", at(kData2, slot(rtex::kMonitorEcho, "wng"))},
    {"err", at(kData2, slot(rtex::kMonitorEcho, "err"))},
    {"index_echo", at(kData2, slot(rtex::kMonitorEcho, "index_echo"))},
    {"response_data3", whole(kData3, 32)},
    {"actual_torque", whole(kData3, 32)},
    {"monitor_data", whole(kData3, 32)},
    {"sub_cmd_err", at(kSub, slot(rtex::kSubResponse, "cmd_err"))},
    {"sub_err", at(kSub, slot(rtex::kSubResponse, "err"))},
    {"sub_wng", at(kSub, slot(rtex::kSubResponse, "wng"))},
    {"sub_busy", at(kSub, slot(rtex::kSubResponse, "busy"))},
    {"sub_command_code_echo", at(kSub, slot(rtex::kSubResponse, "command_echo"))},
    {"sub_type_code_echo", at(kSub, slot(rtex::kSubResponse, "type_code_echo"))},
    {"sub_index_echo", at(kSub, slot(rtex::kSubResponse, "index_echo"))},
    {"sub_response_data1", whole(rtex::kSubData1At, 32)},
    {"sub_response_data2", whole(rtex::kSubData2At, 32)},
    {"sub_response_data3", whole(rtex::kSubData3At, 32)},
};

}  // namespace

std::optional<Slot> log_field(std::string_view key, bool response) {
  const Layout& header = response ? rtex::kResponse : rtex::kCommand;
  if (const Field* const field = header.find(key)) return slot_of(*field);
  const std::span<const Row> rows = response ? std::span<const Row>(kResponseRows) : std::span<const Row>(kCommandRows);
  const auto found = std::find_if(rows.begin(), rows.end(), [key](const Row& row) { return row.key == key; });
  return found == rows.end() ? std::nullopt : std::optional(found->slot);
}

}  // namespace servotrace::replay
