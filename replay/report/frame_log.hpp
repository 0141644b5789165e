// SPDX-License-Identifier: MIT
// The frames that findings name, in words and in full: filled while the capture is read again.
#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "decoder/link/raw_frame.hpp"
#include "decoder/pipeline/dissection.hpp"
#include "decoder/pipeline/settings.hpp"

namespace servotrace::report {

// A frame as one node sees it: an RTEX record holds many.
struct FrameKey {
  std::uint64_t frame = 0;
  std::int16_t mac_id = kNoMacId;
  std::uint8_t place = 0;
  auto operator<=>(const FrameKey&) const = default;
};
inline FrameKey frame_key(std::uint64_t frame, const NodeRef& node) { return {frame, node.mac_id, node.place}; }

struct ShownField {
  std::string label;
  std::string value;
  bool marked = false;  // under the bytes a finding points at
};

struct ShownFrame {
  std::string sentence;
  std::string bytes;               // hexadecimal; empty where only the sentence is wanted
  std::vector<ShownField> fields;  // with `bytes`
};
using ShownFrames = std::map<FrameKey, ShownFrame>;

struct WantedFrame {
  std::uint64_t frame = 0;
  NodeRef node;
  bool in_full = false;
  ByteRange where;  // bytes to mark; length 0: none
};

class FrameLog {
 public:
  explicit FrameLog(std::vector<WantedFrame> wanted);
  // True where add() has to see this frame.
  bool is_due(std::uint64_t frame) const { return next_ < wanted_.size() && wanted_[next_].frame <= frame; }
  // Frames come in the order of their numbers.
  void add(const RawFrame& frame, const Dissection& dissection, const Settings& settings);
  ShownFrames take() { return std::move(shown_); }

 private:
  std::vector<WantedFrame> wanted_;  // by frame
  std::size_t next_ = 0;
  ShownFrames shown_;
};

}  // namespace servotrace::report
