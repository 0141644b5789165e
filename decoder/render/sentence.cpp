// SPDX-License-Identifier: MIT
#include "decoder/render/sentence.hpp"

#include "decoder/render/words.hpp"

namespace servotrace {
namespace {

// A sentence longer than this is cut between two parts: Info columns and evidence lines are one line.
constexpr std::size_t kLongest = 240;

// Of whatever channel.
bool same_place(const NodeRef& left, const NodeRef& right) {
  return left.bus == right.bus && left.protocol == right.protocol && left.mac_id == right.mac_id &&
         left.place == right.place;
}

std::string cut(std::string text) {
  if (text.size() <= kLongest) return text;
  // At a separator, so that no number is cut in two.
  const std::size_t end = text.find_last_of(",;", kLongest);
  text.resize(end == std::string::npos || end == 0 ? kLongest : end);
  return text + " ...";
}

}  // namespace

std::string sentence(const Dissection& dissection, const Settings* settings) {
  if (dissection.protocol == Protocol::kDevicenet) return cut(devicenet_sentence(dissection, settings));
  std::string text;
  for (std::size_t i = 0; i < dissection.segments.size() && text.size() <= kLongest; ++i) {
    const NodeRef& node = dissection.segments[i].node;
    bool told = node.mac_id == kNoMacId;
    for (std::size_t j = 0; j < i && !told; ++j) told = same_place(dissection.segments[j].node, node);
    if (!told) join(text, "; ", block_sentence(dissection, node, settings));
  }
  return cut(std::move(text));
}

std::string sentence_of(const Dissection& dissection, const NodeRef& node, const Settings* settings) {
  if (node.mac_id != kNoMacId && dissection.protocol == Protocol::kRtex) {
    for (const Segment& segment : dissection.segments) {
      if (same_place(segment.node, node)) return cut(block_sentence(dissection, segment.node, settings));
    }
  }
  return sentence(dissection, settings);
}

}  // namespace servotrace
