// SPDX-License-Identifier: MIT
#include "decoder/profiles/yaskawa_ns310/blocks.hpp"

namespace servotrace::ns310 {
namespace {

bool is_conditional(std::uint8_t command) {
  return command == static_cast<std::uint8_t>(BlockCommand::kLinkGreater) ||
         command == static_cast<std::uint8_t>(BlockCommand::kLinkLess);
}

// None of the waits 02h, 06h, 08h and 10h, and no branch: a loop of such blocks alone never rests.
bool never_waits(std::uint8_t command) {
  return command == static_cast<std::uint8_t>(BlockCommand::kModifyAttribute) ||
         command == static_cast<std::uint8_t>(BlockCommand::kSpeedChange) ||
         command == static_cast<std::uint8_t>(BlockCommand::kTrajectory);
}

std::int32_t number_of(Bytes data) {
  return data.size() >= 4 ? static_cast<std::int32_t>(load_le(data, 0, 4))
                          : static_cast<std::int32_t>(load_le(data, 0, static_cast<unsigned>(data.size())));
}

}  // namespace

const std::int32_t* Block::find(BlockValue what) const {
  const BlockFormat* row = format();
  if (row == nullptr) return nullptr;
  for (std::size_t i = 0; i < row->count; ++i) {
    if (row->attributes[i]->what == what) return (known >> i & 1U) != 0 ? &values[i] : nullptr;
  }
  return nullptr;
}

unsigned Block::unwritten() const {
  const BlockFormat* row = format();
  if (row == nullptr || !set_singly || !certain) return 0;
  for (std::size_t i = 0; i < row->count; ++i) {
    if (!row->attributes[i]->zero_is_value && (written >> i & 1U) == 0) return static_cast<unsigned>(i) + 3;
  }
  return 0;
}

void Blocks::set(Block& block, unsigned attribute, Bytes data, bool written, std::uint64_t frame) {
  if (data.empty() || attribute == 0 || attribute > 2 + kMaxBlockAttributes) return;
  block.frame = frame;
  if (attribute == 1) {
    if (written) {
      block = Block{.command_known = true, .link_known = true, .set_singly = true, .known = 0xFF, .frame = frame};
    }
    block.certain = true;
    block.command_known = true;
    block.command = data[0];
  } else if (attribute == 2) {
    block.link_known = true;
    block.link = data[0];
  } else {
    const unsigned index = attribute - 3;
    block.values[index] = number_of(data);
    block.known = static_cast<std::uint8_t>(block.known | 1U << index);
    if (written) block.written = static_cast<std::uint8_t>(block.written | 1U << index);
  }
}

bool Blocks::set_all(Block& block, Bytes data, std::uint64_t frame) {
  if (data.size() < 2) return false;
  const BlockFormat* format = find_block_format(data[0]);
  if (format == nullptr) {
    block = Block{.command_known = true,
                  .link_known = true,
                  .certain = true,
                  .command = data[0],
                  .link = data[1],
                  .frame = frame};
    return true;
  }
  std::size_t size = 2;
  std::size_t printed = 2;
  for (std::size_t i = 0; i < format->count; ++i) {
    size += format->attributes[i]->size;
    printed += format->attributes[i]->printed_size;
  }
  if (data.size() != size && data.size() != printed) return false;
  block = Block{.command_known = true,
                .link_known = true,
                .certain = true,
                .command = data[0],
                .link = data[1],
                .known = 0xFF,
                .written = 0xFF,
                .frame = frame};
  std::size_t offset = 2;
  for (std::size_t i = 0; i < format->count; ++i) {
    const std::size_t width = data.size() == size ? format->attributes[i]->size : format->attributes[i]->printed_size;
    block.values[i] = number_of(data.subspan(offset, width));
    offset += width;
  }
  return true;
}

void Blocks::reach(std::uint8_t number, Reached& reached) const {
  std::array<std::uint8_t, 256> open{};
  std::size_t count = 0;
  const auto visit = [&](std::uint8_t next) {
    if (next == 0 || reached[next]) return;
    reached[next] = true;
    open[count++] = next;
  };
  visit(number);
  while (count > 0) {
    const Block& block = blocks_[open[--count]];
    if (!block.command_known) continue;
    if (block.link_known) visit(block.link);
    if (is_conditional(block.command)) {
      if (const std::int32_t* other = block.find(BlockValue::kCompareLink)) visit(static_cast<std::uint8_t>(*other));
    }
  }
}

// True where the links from `number` lead through blocks that never wait, and never end.
bool Blocks::runs_forever(std::uint8_t number) const {
  for (std::size_t hops = 0; hops < blocks_.size(); ++hops) {
    const Block& block = blocks_[number];
    if (number == 0 || !block.command_known || !block.link_known || !block.certain || !never_waits(block.command)) {
      return false;
    }
    number = block.link;
  }
  return true;
}

Blocks::Fault Blocks::chain_fault(std::uint8_t number) const {
  Reached reached{};
  reach(number, reached);
  for (std::size_t i = 1; i < reached.size(); ++i) {
    const Block& block = blocks_[i];
    if (!reached[i] || !block.command_known || !block.certain || block.format() != nullptr) continue;
    return {Fault::Kind::kEmpty, static_cast<std::uint8_t>(i), 0, block.frame};
  }
  for (std::size_t i = 1; i < reached.size(); ++i) {
    if (reached[i] && runs_forever(static_cast<std::uint8_t>(i))) {
      return {Fault::Kind::kEndless, static_cast<std::uint8_t>(i), 0, blocks_[i].frame};
    }
  }
  return {};
}

Blocks::Fault Blocks::half_written(std::uint8_t number) const {
  Reached reached{};
  reach(number, reached);
  for (std::size_t i = 1; i < reached.size(); ++i) {
    if (!reached[i]) continue;
    if (const unsigned attribute = blocks_[i].unwritten()) {
      return {Fault::Kind::kHalfWritten, static_cast<std::uint8_t>(i), attribute, blocks_[i].frame};
    }
  }
  return {};
}

void append_block(BlockText& text, std::uint8_t number, const Block& block) {
  text << "block " << std::int64_t{number} << ": ";
  const BlockFormat* format = block.format();
  if (format == nullptr) {
    text << (block.command_known ? (block.command == 0 ? "(empty)" : "(undefined)") : "(unknown)");
    return;
  }
  text << find_value(kBlockCommands, block.command)->name;
  for (std::size_t i = 0; i < format->count; ++i) {
    text << ", " << format->attributes[i]->key << " ";
    if ((block.known >> i & 1U) != 0) {
      text << std::int64_t{block.values[i]};
    } else {
      text << "?";
    }
  }
  if (!block.link_known) {
    text << ", then ?";
  } else if (block.link == 0) {
    text << ", end";
  } else {
    text << ", then " << std::int64_t{block.link};
  }
}

// Along the links first; the other ways of conditional blocks follow behind.
void append_chain(BlockText& text, const Blocks& blocks, std::uint8_t number) {
  std::array<bool, 256> seen{};
  std::array<std::uint8_t, 256> open{};
  std::size_t count = 0;
  open[count++] = number;
  bool first = true;
  for (std::size_t i = 0; i < count; ++i) {
    std::uint8_t at = open[i];
    while (at != 0 && !seen[at]) {
      seen[at] = true;
      if (!first) text << "; ";
      first = false;
      const Block& block = blocks.at(at);
      append_block(text, at, block);
      if (is_conditional(block.command) && count < open.size()) {
        if (const std::int32_t* other = block.find(BlockValue::kCompareLink)) {
          open[count++] = static_cast<std::uint8_t>(*other);
        }
      }
      if (!block.link_known) break;
      at = block.link;
      if (at != 0 && seen[at]) text << "; again from " << std::int64_t{at};
    }
  }
}

}  // namespace servotrace::ns310
