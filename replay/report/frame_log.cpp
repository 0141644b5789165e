// SPDX-License-Identifier: MIT
#include "replay/report/frame_log.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "decoder/render/sentence.hpp"
#include "decoder/render/value.hpp"

namespace servotrace::report {
namespace {

constexpr std::size_t kMaxBytes = 64;
constexpr std::size_t kMaxFields = 96;

std::string hexadecimal(Bytes bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes.first(std::min(bytes.size(), kMaxBytes))) {
    text += fmt::format("{}{:02X}", text.empty() ? "" : " ", byte);
  }
  return bytes.size() > kMaxBytes ? text + " ..." : text;
}

void show_in_full(const Dissection& dissection, const WantedFrame& wanted, ShownFrame& shown) {
  const auto is_of_node = [&wanted](const Segment& segment) {
    return segment.node.mac_id == wanted.node.mac_id && segment.node.place == wanted.node.place &&
           segment.node.bus == wanted.node.bus;
  };
  // Of an RTEX record the node's block, of anything else the whole frame.
  const bool block = dissection.protocol == Protocol::kRtex &&
                     std::any_of(dissection.segments.begin(), dissection.segments.end(), is_of_node);
  std::size_t begin = dissection.frame.size();
  std::size_t end = 0;
  for (const Segment& segment : dissection.segments) {
    if (block && !is_of_node(segment)) continue;
    if (segment.buffer == Buffer::kFrame) {
      begin = std::min<std::size_t>(begin, segment.offset);
      end = std::max<std::size_t>(end, segment.offset + segment.length);
    }
    for_each_field(*segment.layout, dissection.bytes(segment), [&](const Field& field, std::int64_t raw, Bytes under) {
      if (field.reserved || shown.fields.size() >= kMaxFields) return;
      const std::size_t at = segment.offset + field.first_byte();
      const std::size_t past = field.width == 0 ? segment.offset + segment.length : at + field.byte_count();
      shown.fields.push_back(
          {std::string(field.label),
           field.kind == Kind::kBytes || field.kind == Kind::kText ? bytes_text(field, under) : value_text(field, raw),
           segment.buffer == Buffer::kFrame && wanted.where.length != 0 &&
               at < wanted.where.offset + wanted.where.length && wanted.where.offset < past});
    });
  }
  shown.bytes = hexadecimal(block && end > begin ? dissection.frame.subspan(begin, end - begin) : dissection.frame);
}

}  // namespace

FrameLog::FrameLog(std::vector<WantedFrame> wanted) : wanted_(std::move(wanted)) {
  std::stable_sort(wanted_.begin(), wanted_.end(),
                   [](const WantedFrame& left, const WantedFrame& right) { return left.frame < right.frame; });
}

void FrameLog::add(const RawFrame& frame, const Dissection& dissection, const Settings& settings) {
  while (next_ < wanted_.size() && wanted_[next_].frame < frame.number) ++next_;
  for (; next_ < wanted_.size() && wanted_[next_].frame == frame.number; ++next_) {
    const WantedFrame& wanted = wanted_[next_];
    ShownFrame& shown = shown_[frame_key(frame.number, wanted.node)];
    if (shown.sentence.empty()) shown.sentence = sentence_of(dissection, wanted.node, &settings);
    if (wanted.in_full && shown.bytes.empty()) show_in_full(dissection, wanted, shown);
  }
}

}  // namespace servotrace::report
