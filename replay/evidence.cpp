// SPDX-License-Identifier: MIT
#include "replay/evidence.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "decoder/render/sentence.hpp"

namespace servotrace::replay {
namespace {

// One line wanted: `frame` as finding `finding` needs it.
struct Wanted {
  std::uint64_t frame = 0;
  std::size_t finding = 0;
};

class SecondLook : public FrameVisitor {
 public:
  SecondLook(std::vector<Wanted> wanted, const Settings& settings, std::span<const Finding> findings,
             CaptureRecord& capture)
      : wanted_(std::move(wanted)), settings_(settings), findings_(findings), capture_(capture) {}

  Detail wanted_of(const RawFrame& frame) override {
    while (next_ < wanted_.size() && wanted_[next_].frame < frame.number) ++next_;
    return next_ < wanted_.size() && wanted_[next_].frame == frame.number ? Detail::kAll : Detail::kNothing;
  }
  bool on_frame(const RawFrame& frame, const Dissection* dissection, const Pipeline&, const Source&) override {
    for (; dissection != nullptr && next_ < wanted_.size() && wanted_[next_].frame == frame.number; ++next_) {
      const std::size_t index = wanted_[next_].finding;
      capture_.findings[index].evidence.push_back(
          {frame.number, frame.time_ns, frame_words(frame, *dissection, findings_[index].node, settings_)});
    }
    return next_ < wanted_.size();
  }

 private:
  std::vector<Wanted> wanted_;  // by frame
  std::size_t next_ = 0;
  const Settings& settings_;
  std::span<const Finding> findings_;
  CaptureRecord& capture_;
};

}  // namespace

std::string frame_words(const RawFrame& frame, const Dissection& dissection, const NodeRef& node,
                        const Settings& settings) {
  std::string text = sentence_of(dissection, node, &settings);
  if (!text.empty()) return text;
  constexpr std::size_t kMostBytes = 32;
  text = fmt::format("{} bytes:", frame.bytes.size());
  for (const std::uint8_t byte : frame.bytes.first(std::min(frame.bytes.size(), kMostBytes))) {
    text += fmt::format(" {:02X}", byte);
  }
  return frame.bytes.size() > kMostBytes ? text + " ..." : text;
}

void add_evidence(const CaptureInput& input, const Settings& settings, std::span<const Finding> findings,
                  CaptureRecord& capture) {
  std::vector<Wanted> wanted;
  for (std::size_t i = 0; i < std::min(findings.size(), kMostEvidence); ++i) {
    std::vector<std::uint64_t> frames(findings[i].related.begin(), findings[i].related.end());
    frames.push_back(findings[i].frame);
    std::sort(frames.begin(), frames.end());
    frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
    for (const std::uint64_t frame : frames) {
      if (frame != 0) wanted.push_back({frame, i});
    }
  }
  if (wanted.empty()) return;
  std::stable_sort(wanted.begin(), wanted.end(),
                   [](const Wanted& left, const Wanted& right) { return left.frame < right.frame; });
  SecondLook look(std::move(wanted), settings, findings, capture);
  run_input(input, settings, {.visitor = &look, .stop = {}, .on_progress = {}});
}

bool StreamEvidence::on_frame(const RawFrame& frame, const Dissection* dissection, const Pipeline& pipeline,
                              const Source&) {
  for (const Finding& finding : pipeline.fresh()) {
    if (lines_.size() >= kMostEvidence || dissection == nullptr) break;
    lines_.try_emplace(key(finding), EvidenceLine{frame.number, frame.time_ns,
                                                  frame_words(frame, *dissection, finding.node, settings_)});
  }
  return true;
}

void StreamEvidence::add_to(std::span<const Finding> findings, CaptureRecord& capture) const {
  for (std::size_t i = 0; i < findings.size(); ++i) {
    const auto found = lines_.find(key(findings[i]));
    if (found != lines_.end()) capture.findings[i].evidence.push_back(found->second);
  }
}

}  // namespace servotrace::replay
