// SPDX-License-Identifier: MIT
// What the frames of a finding say, for people. A frame's meaning depends on what came before it, so a file is read a
// second time up to the last frame that is wanted; of a stream only the frame that proves the finding is kept.
#pragma once

#include <map>

#include "replay/inputs.hpp"
#include "replay/results.hpp"

namespace servotrace::replay {

// Of the first kMostEvidence findings of a capture; more would be no help to anybody.
inline constexpr std::size_t kMostEvidence = 500;

// What a frame says about a node; the first bytes where nothing was recognised in it (a malformed record).
std::string frame_words(const RawFrame& frame, const Dissection& dissection, const NodeRef& node,
                        const Settings& settings);

// Fills FindingRecord::evidence of `capture`, whose findings[i] was made of findings[i].
void add_evidence(const CaptureInput& input, const Settings& settings, std::span<const Finding> findings,
                  CaptureRecord& capture);

// Keeps a sentence for every frame that brings a finding: for streams.
class StreamEvidence : public FrameVisitor {
 public:
  explicit StreamEvidence(const Settings& settings) : settings_(settings) {}
  bool on_frame(const RawFrame& frame, const Dissection* dissection, const Pipeline& pipeline,
                const Source& source) override;
  void add_to(std::span<const Finding> findings, CaptureRecord& capture) const;

 private:
  struct Key {
    std::uint64_t frame;
    std::int16_t mac_id;
    std::uint8_t place;
    auto operator<=>(const Key&) const = default;
  };
  static Key key(const Finding& finding) { return {finding.frame, finding.node.mac_id, finding.node.place}; }

  const Settings& settings_;
  std::map<Key, EvidenceLine> lines_;
};

}  // namespace servotrace::replay
