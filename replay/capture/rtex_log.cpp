// SPDX-License-Identifier: MIT
#include "replay/capture/rtex_log.hpp"

#include <algorithm>
#include <cassert>
#include <deque>

#include "decoder/link/rtex_record.hpp"
#include "replay/capture/compressed.hpp"
#include "replay/capture/rtex_log_rows.hpp"
#include "replay/capture/text_source.hpp"

namespace servotrace::replay {
namespace {

constexpr std::size_t kLookahead = 512;  // records read before the first is handed on: they tell the time's resolution
constexpr std::uint8_t kTags[] = {0, 12, 0, 4, 'r', 't', 'e', 'x', 0, 0, 0, 0};  // exported PDU: "rtex", end

// What a cycle holds so far, one direction.
struct Memory {
  std::vector<std::uint8_t> bytes;
  std::vector<bool> filled;
  std::size_t count = 0;
  TimeNs time_ns = 0;
};

// Cells of a row, and characters of the last one.
struct RowShape {
  std::size_t cells = 0;
  std::size_t last = 0;
  bool operator==(const RowShape&) const = default;
};

struct Ready {
  TimeNs time_ns = 0;
  std::vector<std::uint8_t> frame;
};

class LogReader final : public RtexLogSource {
 public:
  // Lines come from a LineSource; this one only hands them out.
  class Lines final : public LineSource {
   public:
    Lines(std::unique_ptr<Input> input, std::string name) : LineSource(std::move(input), std::move(name), "log") {}
    Step next(RawFrame&) override { return Step::kEnd; }
    Step line(std::string_view& text) { return read_line(text); }
    using LineSource::unfinished;
    Error broken_line(std::string what) {
      static_cast<void>(fail_line(std::move(what)));
      return error_;
    }
  };

  LogReader(std::unique_ptr<Input> input, std::string name, const std::string& packed, const RtexLogMap& map)
      : map_(map), lines_(std::move(input), std::move(name)), separator_(map.separator) {
    format_ = "RTEX log" + packed;
    std::size_t offset = 0;
    for (const LogNode& node : map_.nodes) {
      offsets_.push_back(offset);
      offset += node.block_size();
    }
    for (Memory& memory : cycle_) {
      memory.bytes.assign(offset, 0);
      memory.filled.assign(map_.nodes.size(), false);
    }
    interfaces_.push_back({.link_type = LinkType::kWiresharkUpperPdu, .name = "log"});
  }

  Step next(RawFrame& frame) override {
    if (!error_.what.empty()) return Step::kError;
    while (!ended_ && ready_.size() < (number_ == 0 ? kLookahead : 1)) {
      if (!read_row()) break;
    }
    if (!ready_.empty()) {
      if (number_ == 0) interfaces_[0].time_resolution_ns = resolution_ns_;
      current_ = std::move(ready_.front());
      ready_.pop_front();
      frame = RawFrame{.number = ++number_,
                       .time_ns = current_.time_ns,
                       .link_type = LinkType::kWiresharkUpperPdu,
                       .bytes = current_.frame,
                       .original_length = static_cast<std::uint32_t>(current_.frame.size()),
                       .time_resolution_ns = interfaces_[0].time_resolution_ns};
      return Step::kFrame;
    }
    if (failed_) {
      error_ = *failed_;
      return Step::kError;
    }
    if (!last_is_whole_) truncation_ = lines_.truncation();
    return Step::kEnd;
  }

  std::uint64_t incomplete() const override { return incomplete_; }
  std::uint64_t consumed() const override { return lines_.consumed(); }
  std::uint64_t total() const override { return lines_.total(); }

 private:
  bool fail(std::string what) {
    failed_ = lines_.broken_line(std::move(what));
    ended_ = true;
    return false;
  }

  // False where nothing more comes.
  bool read_row() {
    std::string_view line;
    const Step step = lines_.line(line);
    if (step != Step::kFrame) {
      if (step == Step::kError) failed_ = lines_.error();
      if (step == Step::kEnd) take_unfinished();
      flush();
      ended_ = true;
      return false;
    }
    if (skipped_ < map_.skip_lines) {
      ++skipped_;
      return true;
    }
    if (line.empty() || (!map_.comment.empty() && line.starts_with(map_.comment))) return true;
    if (!located_) {
      if (separator_ == '\0') separator_ = separator_of(line);
      split_row(line, separator_, cells_);
      located_ = true;
      if (!rows_.locate(cells_)) return fail(rows_.what());
      if (map_.header) return true;
    }
    if (!map_.lines_with.empty() && line.find(map_.lines_with) == std::string_view::npos) return true;
    split_row(line, separator_, cells_);
    const RowShape shape{cells_.size(), cells_.back().size()};
    alike_ = row_count_ == 0 || (alike_ && shape == shape_);
    shape_ = shape;
    ++row_count_;
    return take_row();
  }

  // A last line without its end is taken where it cannot be cut: all rows end in cells of one width, and so does it.
  void take_unfinished() {
    const std::string_view line = lines_.unfinished();
    if (line.empty() || row_count_ < 2 || !alike_) return;
    if (!map_.lines_with.empty() && line.find(map_.lines_with) == std::string_view::npos) return;
    split_row(line, separator_, cells_);
    if (shape_ == RowShape{cells_.size(), cells_.back().size()}) last_is_whole_ = take_row();
  }

  bool take_row() {
    LogRow row;
    if (!rows_.read(cells_, row)) return fail(rows_.what());
    resolution_ns_ = std::min(resolution_ns_, row.resolution_ns);
    for (const bool response : {false, true}) {
      if (response ? !row.of_response : !row.of_command) continue;
      for (std::size_t i = row.first_node; i < row.end_node; ++i) {
        if (!take_block(i, response, row)) return false;
      }
    }
    return true;
  }

  bool take_block(std::size_t i, bool response, const LogRow& row) {
    std::array<std::uint8_t, 32> bytes = {};
    const MutableBytes block = MutableBytes(bytes).first(map_.nodes[i].block_size());
    bool blank = true;
    if (!rows_.read_block(cells_, i, response, block, blank)) return fail(rows_.what());
    if (blank) return true;  // the row does not hold this one
    begin_cycle(i, response, row.sequence);
    Memory& memory = cycle_[response ? 1 : 0];
    if (memory.count == 0) memory.time_ns = row.time_ns;
    std::copy(block.begin(), block.end(), memory.bytes.begin() + static_cast<std::ptrdiff_t>(offsets_[i]));
    memory.filled[i] = true;
    ++memory.count;
    return true;
  }

  // --- cycles -------------------------------------------------------------------------------------------------------

  // Without cycle numbers a new cycle begins where an axis comes again, or with a command after responses.
  void begin_cycle(std::size_t i, bool response, std::optional<std::uint32_t> sequence) {
    const bool another = sequence != cycle_sequence_;
    const bool again = cycle_[response ? 1 : 0].filled[i];
    const bool command_after_response = !sequence && !response && cycle_[1].count > 0;
    if (!another && !again && !command_after_response) return;
    flush();
    cycle_sequence_ = sequence;
  }

  void flush() {
    // A cycle's command stands before its response, also where the controller reads before it writes.
    if (cycle_[0].count > 0 && cycle_[1].count > 0) cycle_[1].time_ns = std::max(cycle_[1].time_ns, cycle_[0].time_ns);
    for (const bool response : {false, true}) {
      Memory& memory = cycle_[response ? 1 : 0];
      if (memory.count == map_.nodes.size()) {
        emit(memory, response);
      } else if (memory.count > 0) {
        ++incomplete_;
      }
      memory.count = 0;
      memory.filled.assign(map_.nodes.size(), false);
    }
  }

  void emit(const Memory& memory, bool response) {
    std::vector<std::uint8_t> frame(std::begin(kTags), std::end(kTags));
    std::vector<std::uint8_t> record(rtex::kRecord.size, 0);
    std::uint32_t wide = 0;
    for (std::size_t i = 0; i < map_.nodes.size(); ++i) wide |= map_.nodes[i].wide ? 1U << i : 0U;
    bool written = true;
    const auto set = [&](Slot place, std::int64_t value) { written = write(place, record, value) && written; };
    std::copy_n("RTEX", 4, record.begin());
    set(slot(rtex::kRecord, "version"), 1);
    set(slot(rtex::kRecord, "header_length"), rtex::kRecord.size);
    set(slot(rtex::kRecord, "direction"), response ? 1 : 0);
    set(slot(rtex::kRecord, "sequence_valid"), cycle_sequence_ ? 1 : 0);
    set(slot(rtex::kRecord, "cycle_valid"), map_.cycle_ns != 0 ? 1 : 0);
    set(slot(rtex::kRecord, "sampled"), map_.sampled ? 1 : 0);
    set(slot(rtex::kRecord, "ring"), map_.ring);
    set(slot(rtex::kRecord, "sequence"), cycle_sequence_.value_or(0));
    set(slot(rtex::kRecord, "cycle_ns"), map_.cycle_ns);
    set(slot(rtex::kRecord, "wide_nodes"), wide);
    set(slot(rtex::kRecord, "node_count"), static_cast<std::int64_t>(map_.nodes.size()));
    assert(written);
    static_cast<void>(written);
    frame.insert(frame.end(), record.begin(), record.end());
    frame.insert(frame.end(), memory.bytes.begin(), memory.bytes.end());
    ready_.push_back({memory.time_ns, std::move(frame)});
  }

  const RtexLogMap map_;
  Lines lines_;
  char separator_;
  Cells cells_;
  bool located_ = false;
  std::size_t skipped_ = 0;
  std::uint64_t row_count_ = 0;
  RowShape shape_;
  bool alike_ = false;  // all rows have shape_
  bool last_is_whole_ = false;
  LogRows rows_{map_};
  std::vector<std::size_t> offsets_;

  std::array<Memory, 2> cycle_;
  std::optional<std::uint32_t> cycle_sequence_;
  std::deque<Ready> ready_;
  Ready current_;
  std::uint64_t number_ = 0;
  std::uint64_t incomplete_ = 0;
  std::uint32_t resolution_ns_ = 0xFFFF'FFFF;
  bool ended_ = false;
  std::optional<Error> failed_;
};

Result<std::unique_ptr<RtexLogSource>> open(std::unique_ptr<Input> input, std::string name, const RtexLogMap& map) {
  std::string packed;
  const Bytes head = input->peek(4);
  if (head.size() >= 2 && head[0] == 0x1F && head[1] == 0x8B) {
    input = gzip_input(std::move(input));
    packed = " (gzip)";
  } else if (head.size() == 4 && load_le(head, 0, 4) == 0xFD2FB528U) {
    input = zstd_input(std::move(input));
    packed = " (zstd)";
  }
  return std::unique_ptr<RtexLogSource>(
      std::make_unique<LogReader>(std::move(input), std::move(name), std::move(packed), map));
}

}  // namespace

Result<std::unique_ptr<RtexLogSource>> open_rtex_log(const std::filesystem::path& path, const RtexLogMap& map) {
  Result<std::unique_ptr<Input>> input = open_input(path);
  if (!input) return input.error();
  return open(std::move(input.value()), path.string(), map);
}

Result<std::unique_ptr<RtexLogSource>> open_rtex_log_stream(int descriptor, std::string name, const RtexLogMap& map) {
  return open(descriptor_input(descriptor), std::move(name), map);
}

}  // namespace servotrace::replay
