// SPDX-License-Identifier: MIT
// Command blocks of the NS310, object 27h (SIE-C718-7 5.5): what the attributes of each block command are, what the
// capture shows of the 255 blocks, and how a chain of them runs.
#pragma once

#include <array>
#include <cstdint>

#include "decoder/core/layout_check.hpp"
#include "decoder/core/slot.hpp"
#include "decoder/core/text.hpp"
#include "decoder/profiles/yaskawa_ns310/codes.hpp"

namespace servotrace::ns310 {

enum class BlockCommand : std::uint8_t {
  kModifyAttribute = 0x01,
  kWaitEquals = 0x02,
  kLinkGreater = 0x03,
  kLinkLess = 0x04,
  kDelay = 0x06,
  kTrajectory = 0x07,
  kTrajectoryWait = 0x08,
  kSpeedChange = 0x09,  // Table 5.15 misprints 08h
  kHomeTravel = 0x10,
};
// What an attribute of a block is (5.5.2).
enum class BlockValue : std::uint8_t {
  kClass,
  kInstance,
  kAttribute,
  kValue,
  kTimeout,
  kCompare,
  kCompareLink,
  kDelay,
  kPosition,
  kSpeed,
  kIncremental,
  kHomeOffset,
};
struct BlockAttribute {
  BlockValue what = BlockValue::kValue;
  std::string_view key;
  std::string_view name;
  std::uint8_t size = 4;          // bytes
  std::uint8_t printed_size = 4;  // where the manual's data type contradicts its range
  bool zero_is_value = true;
  Unit unit = Unit::kNone;
};
inline constexpr BlockAttribute kBlockClass{BlockValue::kClass, "target_class", "Target Class", 1, 1, false};
inline constexpr BlockAttribute kBlockInstance{
    BlockValue::kInstance, "target_instance", "Target Instance", 1, 1, false};
inline constexpr BlockAttribute kBlockNumber{
    BlockValue::kAttribute, "attribute_number", "Attribute Number", 1, 1, false};
inline constexpr BlockAttribute kBlockValueRow{BlockValue::kValue, "attribute_value", "Attribute Value"};
inline constexpr BlockAttribute kBlockTimeout{
    BlockValue::kTimeout, "compare_timeout", "Compare Timeout Value", 4, 4, true, Unit::kMillisecond};
inline constexpr BlockAttribute kBlockCompare{BlockValue::kCompare, "compare_data", "Compare Data"};
inline constexpr BlockAttribute kBlockCompareLink{
    BlockValue::kCompareLink, "compare_link", "Compare Link Number", 1, 1, true};
inline constexpr BlockAttribute kBlockDelay{BlockValue::kDelay, "delay", "Delay", 4, 1, false, Unit::kMillisecond};
inline constexpr BlockAttribute kBlockPosition{
    BlockValue::kPosition, "target_position", "Target Position", 4, 1, true, Unit::kStep};
inline constexpr BlockAttribute kBlockSpeed{BlockValue::kSpeed,  "target_speed", "Target Speed", 4, 1, false,
                                            Unit::kStepPerSecond};
inline constexpr BlockAttribute kBlockIncremental{
    BlockValue::kIncremental, "incremental", "Incremental/Absolute", 1, 1, true};
inline constexpr BlockAttribute kBlockOffset{
    BlockValue::kHomeOffset, "home_offset", "Home Offset", 4, 4, true, Unit::kStep};

inline constexpr std::size_t kMaxBlockAttributes = 5;  // attributes 3 to 7
struct BlockFormat {
  BlockCommand command{};
  std::string_view section;
  std::uint8_t count = 0;
  std::array<const BlockAttribute*, kMaxBlockAttributes> attributes = {};
};
inline constexpr auto kBlockFormats = std::to_array<BlockFormat>({
    {BlockCommand::kModifyAttribute,
     "SIE-C718-7 5.5.2 (Table 5.5)",
     4,
     {&kBlockClass, &kBlockInstance, &kBlockNumber, &kBlockValueRow}},
    {BlockCommand::kWaitEquals,
     "SIE-C718-7 5.5.2 (Table 5.7)",
     5,
     {&kBlockClass, &kBlockInstance, &kBlockNumber, &kBlockTimeout, &kBlockCompare}},
    {BlockCommand::kLinkGreater,
     "SIE-C718-7 5.5.2 (Table 5.9)",
     5,
     {&kBlockClass, &kBlockInstance, &kBlockNumber, &kBlockCompareLink, &kBlockCompare}},
    {BlockCommand::kLinkLess,
     "SIE-C718-7 5.5.2 (Table 5.11)",
     5,
     {&kBlockClass, &kBlockInstance, &kBlockNumber, &kBlockCompareLink, &kBlockCompare}},
    {BlockCommand::kDelay, "SIE-C718-7 5.5.2 (Table 5.12)", 1, {&kBlockDelay}},
    {BlockCommand::kTrajectory,
     "SIE-C718-7 5.5.2 (Table 5.13)",
     3,
     {&kBlockPosition, &kBlockSpeed, &kBlockIncremental}},
    {BlockCommand::kTrajectoryWait,
     "SIE-C718-7 5.5.2 (Table 5.14)",
     3,
     {&kBlockPosition, &kBlockSpeed, &kBlockIncremental}},
    {BlockCommand::kSpeedChange, "SIE-C718-7 5.5.2 (Table 5.15)", 1, {&kBlockSpeed}},
    {BlockCommand::kHomeTravel, "SIE-C718-7 5.5.2 (Table 5.16)", 2, {&kBlockOffset, &kBlockSpeed}},
});
constexpr const BlockFormat* find_block_format(std::int64_t command) {
  for (const BlockFormat& row : kBlockFormats) {
    if (static_cast<std::int64_t>(row.command) == command) return &row;
  }
  return nullptr;
}

namespace detail {
inline constexpr std::size_t kBlockRows = 2 + kMaxBlockAttributes;
consteval auto block_fields() {
  std::array<std::array<Field, kBlockRows>, kBlockFormats.size()> fields{};
  for (std::size_t i = 0; i < kBlockFormats.size(); ++i) {
    const BlockFormat& format = kBlockFormats[i];
    fields[i][0] = Field{.key = "block_command",
                         .label = "Block Command",
                         .first_bit = at(0),
                         .width = 8,
                         .base = Base::kHex,
                         .values = kBlockCommands,
                         .section = format.section};
    fields[i][1] = Field{.key = "block_link",
                         .label = "Block Link Number",
                         .first_bit = at(1),
                         .width = 8,
                         .section = format.section,
                         .explanation = "0 ends the chain."};
    unsigned byte = 2;
    for (std::size_t j = 0; j < format.count; ++j) {
      const BlockAttribute& row = *format.attributes[j];
      fields[i][2 + j] = Field{.key = row.key,
                               .label = row.name,
                               .first_bit = at(byte),
                               .width = static_cast<std::uint16_t>(row.size * 8U),
                               .kind = row.size == 4 ? Kind::kSigned : Kind::kUnsigned,
                               .unit = row.unit,
                               .section = format.section};
      byte += row.size;
    }
  }
  return fields;
}
inline constexpr auto kBlockFields = block_fields();
consteval auto block_layouts() {
  std::array<Layout, kBlockFormats.size()> layouts{};
  for (std::size_t i = 0; i < kBlockFormats.size(); ++i) {
    const BlockFormat& format = kBlockFormats[i];
    std::uint16_t size = 2;
    for (std::size_t j = 0; j < format.count; ++j) size = static_cast<std::uint16_t>(size + format.attributes[j]->size);
    layouts[i] = Layout{.protocol = "ns310",
                        .key = "block",
                        .title = find_value(kBlockCommands, static_cast<std::int64_t>(format.command))->name,
                        .size = size,
                        .fields = {kBlockFields[i].data(), std::size_t{2} + format.count},
                        .section = format.section};
    if (!well_formed(layouts[i])) throw "a block format makes no legal layout";
  }
  return layouts;
}
}  // namespace detail
// A whole command block (Get/Set_Attribute_All), in the order of kBlockFormats.
inline constexpr auto kBlockLayouts = detail::block_layouts();

// What the capture shows of one block.
struct Block {
  bool command_known = false;
  bool link_known = false;
  bool set_singly = false;  // attribute 1 was set alone: the others began at 0
  bool certain = false;     // no record was lost since its command was seen
  std::uint8_t command = 0;
  std::uint8_t link = 0;
  std::uint8_t known = 0;    // bit n: value n (attribute n + 3) is known
  std::uint8_t written = 0;  // bit n: and was written since attribute 1 was
  std::array<std::int32_t, kMaxBlockAttributes> values = {};
  std::uint64_t frame = 0;  // that showed it last

  const BlockFormat* format() const { return command_known ? find_block_format(command) : nullptr; }
  // The value of the first attribute that is `what`; nullptr where it is unknown or the command has none.
  const std::int32_t* find(BlockValue what) const;
  // Attribute number (3 to 7) that 0 is no value for and that was not written since the command was; 0: none.
  unsigned unwritten() const;
};

class Blocks {
 public:
  const Block& at(std::uint8_t number) const { return blocks_[number]; }
  void forget() { blocks_ = {}; }
  // Records were lost: a Set may be among them.
  void doubt() {
    for (Block& block : blocks_) block.certain = false;
  }
  // `data`: of one attribute. A command sets every other attribute to 0 (5.5.2).
  static void set(Block& block, unsigned attribute, Bytes data, bool written, std::uint64_t frame);
  // `data`: of Get/Set_Attribute_All. False where it fits no format.
  static bool set_all(Block& block, Bytes data, std::uint64_t frame);
  Block& mutable_at(std::uint8_t number) { return blocks_[number]; }

  // What is wrong with the chain that begins at `number`.
  struct Fault {
    enum class Kind : std::uint8_t { kNone, kEmpty, kEndless, kHalfWritten } kind = Kind::kNone;
    std::uint8_t block = 0;
    unsigned attribute = 0;
    std::uint64_t frame = 0;
  };
  Fault chain_fault(std::uint8_t number) const;
  Fault half_written(std::uint8_t number) const;

 private:
  using Reached = std::array<bool, 256>;
  void reach(std::uint8_t number, Reached& reached) const;
  bool runs_forever(std::uint8_t number) const;

  std::array<Block, 256> blocks_{};
};

// Room for a chain of all 255 blocks.
using BlockText = Text<32'768>;
// "block 1: trajectory and wait, target_position 128000, target_speed 8000, incremental 0, then 2".
void append_block(BlockText& text, std::uint8_t number, const Block& block);
// The chain from `number` on, link by link.
void append_chain(BlockText& text, const Blocks& blocks, std::uint8_t number);

}  // namespace servotrace::ns310
