// SPDX-License-Identifier: MIT
// Records of rings with headers that hold: the sessions behind the record reader. Byte 0: nodes and mode. Then records:
// a byte of flags (what of header and time is out of order), and for every node a byte that says what its block is (as
// before, as before with the counter moved on, a bit flipped, or bytes of the input).
#include <cstdlib>
#include <vector>

#include "decoder/core/slot.hpp"
#include "decoder/link/rtex_record.hpp"
#include "decoder/rtex/layouts.hpp"
#include "tests/support/harness.hpp"

namespace {

using namespace servotrace;

class Input {
 public:
  explicit Input(Bytes bytes) : rest_(bytes) {}
  bool empty() const { return rest_.empty(); }
  std::uint8_t take() {
    if (rest_.empty()) return 0;
    const std::uint8_t value = rest_.front();
    rest_ = rest_.subspan(1);
    return value;
  }

 private:
  Bytes rest_;
};

void put(Slot slot, MutableBytes bytes, std::int64_t value) {
  if (!write(slot, bytes, value)) std::abort();
}

// One direction of the ring: its blocks, from record to record.
struct Memory {
  std::vector<std::uint8_t> blocks;
};

void change_block(MutableBytes block, Input& input) {
  const std::uint8_t what = input.take();
  switch (what & 3U) {
    case 0:
      return;
    case 1:
      block[0] = static_cast<std::uint8_t>((block[0] & 0x9FU) | ((block[0] + 0x20U) & 0x60U));
      return;
    case 2: {
      const std::uint8_t where = input.take();
      std::uint8_t& byte = block[where / 8U % block.size()];
      byte = static_cast<std::uint8_t>(byte ^ (1U << (where & 7U)));
      return;
    }
    default:
      for (std::size_t i = 0; i < std::min<std::size_t>(block.size(), 1U + (what >> 2U)); ++i) block[i] = input.take();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input input({data, size});
  const std::uint8_t choice = input.take();
  const std::size_t nodes = 1 + choice % 4U;
  const bool wide = (choice & 4U) != 0;
  Settings settings;
  settings.judge_every_block = (choice & 8U) != 0;
  if ((choice & 16U) != 0) settings.rtex.command_update_ratio = 1 + (choice >> 5U & 1U);
  if ((choice & 64U) != 0) settings.rtex.communication_cycle_ns = 500'000;
  Pipeline pipeline(settings);
  const std::size_t block_size = wide ? 32 : 16;
  Memory memories[2];
  for (Memory& memory : memories) memory.blocks.resize(nodes * block_size);
  std::vector<std::uint8_t> record(rtex::kRecord.size);
  RawFrame frame{.link_type = LinkType::kUser0};
  std::uint32_t sequence = 0;
  bool response = false;
  while (!input.empty()) {
    const std::uint8_t flags = input.take();
    if ((flags & 0x80U) == 0) response = !response;  // else one is missing, or there twice
    if (!response) ++sequence;
    if ((flags & 0x40U) != 0) sequence += input.take();
    Memory& memory = memories[response ? 1 : 0];
    for (std::size_t i = 0; i < nodes; ++i)
      change_block(MutableBytes(memory.blocks).subspan(i * block_size, block_size), input);
    const MutableBytes header = MutableBytes(record).first(rtex::kRecord.size);
    std::fill(header.begin(), header.end(), std::uint8_t{0});
    for (std::size_t i = 0; i < 4; ++i) header[i] = static_cast<std::uint8_t>(rtex::kMagic >> (8 * i));
    put(slot(rtex::kRecord, "version"), header, 1);
    put(slot(rtex::kRecord, "header_length"), header, rtex::kRecord.size);
    put(slot(rtex::kRecord, "direction"), header, response ? 1 : 0);
    put(slot(rtex::kRecord, "sequence_valid"), header, (flags & 0x20U) == 0 ? 1 : 0);
    put(slot(rtex::kRecord, "sampled"), header, (flags & 0x10U) != 0 ? 1 : 0);
    put(slot(rtex::kRecord, "sequence"), header, sequence);
    put(slot(rtex::kRecord, "wide_nodes"), header, wide ? (1 << nodes) - 1 : 0);
    put(slot(rtex::kRecord, "node_count"), header, static_cast<std::int64_t>(nodes));
    record.resize(rtex::kRecord.size);
    record.insert(record.end(), memory.blocks.begin(), memory.blocks.end());
    ++frame.number;
    frame.time_ns += (flags & 0x08U) != 0 ? 250'000 + 20'000 * input.take() : 250'000;
    frame.bytes = record;
    frame.original_length = static_cast<std::uint32_t>(record.size());
    pipeline.push(frame);
  }
  pipeline.finish();
  if (!test::nonsense(pipeline.findings().all(), frame.number).empty()) std::abort();
  return 0;
}
