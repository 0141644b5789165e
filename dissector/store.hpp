// SPDX-License-Identifier: GPL-2.0-or-later
// What the pipeline said of each frame, kept for the whole file: Wireshark shows frames in any order and as often as
// it likes, the pipeline sees each of them once. Frames of a cyclic network look alike, so what they have in common
// (which layouts at which bytes of which node: the shape) is kept once and a frame holds its number and what differs.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "decoder/pipeline/dissection.hpp"
#include "dissector/dictionary.hpp"

namespace servotrace::plugin {

class FrameStore {
 public:
  // Which findings a frame has: indices into Findings::all(), whose order never changes while frames are pushed.
  struct Found {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
  };
  static constexpr std::uint32_t kNoShape = UINT32_MAX;

  // Keeps what `dissection` says of frame `number`, and returns the number of its shape. A later call for the same
  // frame replaces the earlier one.
  std::uint32_t put(std::uint32_t number, const Dissection& dissection, Found found);
  // Fills `dissection` as it was put. `frame` are the frame's bytes again; views of reassembled data are valid as long
  // as the store. kNoShape (and an empty dissection) where nothing was kept.
  std::uint32_t get(std::uint32_t number, Bytes frame, Dissection& dissection, Found& found) const;

  // Frames that name `number` as the one they answer, in the order they were put.
  struct Answer {
    LinkKind kind = LinkKind::kRequestIn;
    std::uint32_t frame = 0;
    DurationNs after_ns = 0;
    NodeRef node;
  };
  void answers(std::uint32_t number, std::vector<Answer>& out) const;

  // The frame that names `number` as the one before it of the same node; 0: none.
  std::uint32_t next_of(std::uint32_t number) const { return number < frames_.size() ? frames_[number].next : 0; }

  std::size_t bytes_used() const;

 private:
  // What frames have in common with others: each of the rows once.
  struct HeadRow {
    Protocol protocol = Protocol::kNone;
    Direction direction = Direction::kNone;
    BusRef bus;
    bool operator==(const HeadRow&) const = default;
    std::uint64_t hash() const;
  };
  struct SegmentRow {
    Segment segment;
    bool operator==(const SegmentRow& other) const;
    std::uint64_t hash() const;
  };
  struct DerivedRow {
    const Field* field = nullptr;
    std::string_view protocol;
    NodeRef node;
    bool operator==(const DerivedRow&) const = default;
    std::uint64_t hash() const;
  };
  struct LinkRow {
    LinkKind kind = LinkKind::kRequestIn;
    NodeRef node;
    bool operator==(const LinkRow&) const = default;
    std::uint64_t hash() const;
  };
  struct FrameRow {
    const std::uint8_t* data = nullptr;  // nullptr: nothing was kept
    std::uint32_t size = 0;
    std::uint32_t next = 0;  // the frame that names this one as the one before it; 0: none
  };
  struct AnswerRow {
    std::uint32_t next = 0;  // index of the next one; of the last one that of the first
    std::uint32_t frame = 0;
    DurationNs after_ns = 0;
    std::uint32_t link = 0;  // in links_
  };
  // Numbers of any size in as few bytes as they need.
  class Writer {
   public:
    // Forgets what was written. `numbers` and `bytes`: at most so many of each will be.
    void begin(std::size_t numbers, std::size_t bytes);
    void number(std::uint64_t value);
    void signed_number(std::int64_t value);
    void append(Bytes bytes);
    std::string_view written() const;

   private:
    std::vector<std::uint8_t> buffer_;
    std::uint8_t* next_ = nullptr;
  };

  std::string_view keep(std::string_view bytes);
  std::uint32_t kept(Dictionary<std::string_view>& dictionary, std::string_view text);
  std::uint32_t shape_of(const Dissection& dissection);
  void add_link(const Link& link, std::uint32_t row, std::uint32_t number);
  void add_answer(const Link& link, std::uint32_t row, std::uint32_t number);

  Dictionary<HeadRow> heads_;
  Dictionary<SegmentRow> segments_;
  Dictionary<DerivedRow> derived_;
  Dictionary<LinkRow> links_;
  Dictionary<std::string_view> texts_;
  Dictionary<std::string_view> shapes_;
  std::vector<std::unique_ptr<std::uint8_t[]>> chunks_;
  std::size_t chunk_used_ = 0;
  std::size_t chunk_size_ = 0;
  std::size_t chunk_bytes_ = 0;
  std::vector<FrameRow> frames_;  // by frame number
  std::vector<AnswerRow> answer_rows_;
  std::vector<std::uint32_t> last_answers_;  // by the frame answered: index + 1 of the last one, 0: none
  std::vector<std::uint32_t> link_rows_;     // of the frame being put
  Writer shape_;
  Writer values_;
};

}  // namespace servotrace::plugin
