// SPDX-License-Identifier: GPL-2.0-or-later
// What the pipeline said of each frame, kept for the whole file: Wireshark shows frames in any order and as often as
// it likes, the pipeline sees each of them once. Frames of a cyclic network look alike, so what they have in common
// (which layouts at which bytes of which node) is kept once and a frame holds its number and what differs.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "decoder/pipeline/dissection.hpp"
#include "decoder/pipeline/registry.hpp"

namespace servotrace::plugin {

class FrameStore {
 public:
  // Views of all rows there are; they live as long as the program.
  FrameStore();

  // Which findings a frame has: indices into Findings::all(), whose order never changes while frames are pushed.
  struct Found {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
  };

  // Keeps what `dissection` says of frame `number`. A later call for the same frame replaces the earlier one.
  void put(std::uint32_t number, const Dissection& dissection, Found found);
  // Fills `dissection` as it was put. `frame` are the frame's bytes again; views of reassembled data are valid as long
  // as the store. False (and an empty dissection) where nothing was kept.
  bool get(std::uint32_t number, Bytes frame, Dissection& dissection, Found& found) const;

  // Frames that name `number` as the one they answer, in the order they were put.
  struct Answer {
    LinkKind kind = LinkKind::kRequestIn;
    std::uint32_t frame = 0;
    DurationNs after_ns = 0;
    NodeRef node;
  };
  void answers(std::uint32_t number, std::vector<Answer>& out) const;

  // The frame that names `number` as the one before it of the same node; 0: none.
  std::uint32_t next_of(std::uint32_t number) const { return number < next_.size() ? next_[number] : 0; }

  std::size_t bytes_used() const;
  // Rows that all_layouts() and all_derived() do not list were left out: an error of ours, shown and not hidden.
  std::uint64_t unregistered() const { return unregistered_; }

 private:
  using Writer = std::vector<std::uint8_t>;
  struct Blob {
    const std::uint8_t* data = nullptr;
    std::uint32_t size = 0;
  };
  struct AnswerRow {
    std::uint32_t next = 0;  // index + 1 of the next one, 0: none
    std::uint32_t frame = 0;
    DurationNs after_ns = 0;
    std::uint32_t node = 0;
    LinkKind kind = LinkKind::kRequestIn;
  };
  struct AnswerEnds {
    std::uint32_t first = 0;
    std::uint32_t last = 0;
  };

  Blob keep(Bytes bytes);
  std::uint32_t node_id(const NodeRef& node);
  std::uint32_t text_id(std::string_view text);
  void add_answer(const Link& link, std::uint32_t number);

  std::unordered_map<const Layout*, std::uint32_t> layout_ids_;
  std::vector<const Layout*> layouts_;
  std::map<std::pair<const Field*, std::string_view>, std::uint32_t> derived_ids_;
  std::vector<DerivedField> derived_;
  std::unordered_map<std::uint64_t, std::uint32_t> node_ids_;
  std::vector<NodeRef> nodes_;
  std::unordered_map<std::string, std::uint32_t> text_ids_;
  std::vector<std::string_view> texts_;  // keys of text_ids_
  std::unordered_map<std::string, std::uint32_t> shape_ids_;
  std::vector<std::string_view> shapes_;  // keys of shape_ids_
  std::vector<std::unique_ptr<std::uint8_t[]>> chunks_;
  std::size_t chunk_used_ = 0;
  std::size_t chunk_size_ = 0;
  std::size_t chunk_bytes_ = 0;
  std::vector<Blob> frames_;         // by frame number
  std::vector<std::uint32_t> next_;  // by frame number
  std::vector<AnswerRow> answer_rows_;
  std::unordered_map<std::uint32_t, AnswerEnds> answer_ends_;  // by the frame answered
  Writer shape_;                                               // scratch
  Writer values_;
  std::uint64_t unregistered_ = 0;
};

}  // namespace servotrace::plugin
