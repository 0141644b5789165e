// SPDX-License-Identifier: MIT
#include "replay/report/build.hpp"

#include <array>

#include "replay/report/analysis.hpp"
#include "replay/report/collector.hpp"

namespace servotrace::report {
namespace {

constexpr std::size_t kMaxEvidence = 20'000;  // frames kept
constexpr std::size_t kFullFindings = 3;      // of a rule, whose frames are kept field by field

class Gather : public replay::FrameVisitor {
 public:
  explicit Gather(Collector& collector) : collector_(collector) {}
  replay::Detail wanted_of(const RawFrame& frame) override {
    return collector_.wants_all(frame) ? replay::Detail::kAll : replay::Detail::kNews;
  }
  bool on_frame(const RawFrame& frame, const Dissection* dissection, const Pipeline&, const replay::Source&) override {
    if (dissection != nullptr) collector_.add(frame, *dissection);
    return true;
  }

 private:
  Collector& collector_;
};

// The first look: findings, and when every frame was recorded.
class Clock : public replay::FrameVisitor {
 public:
  replay::Detail wanted_of(const RawFrame&) override { return replay::Detail::kNothing; }
  bool on_frame(const RawFrame& frame, const Dissection*, const Pipeline&, const replay::Source&) override {
    times_.add(frame.number, frame.time_ns);
    return true;
  }
  const FrameTimes& times() const { return times_; }

 private:
  FrameTimes times_;
};

// The frames of all findings in words, those of the first findings of a rule in full.
std::vector<WantedFrame> wanted_frames(const Model& model) {
  std::vector<WantedFrame> wanted;
  std::array<std::size_t, kRuleCount> seen = {};
  for (const Finding& finding : model.findings) {
    if (wanted.size() >= kMaxEvidence) break;
    const bool in_full = seen[static_cast<std::size_t>(finding.rule)]++ < kFullFindings;
    for (const std::uint64_t related : finding.related) {
      if (related != 0 && related != finding.frame)
        wanted.push_back({.frame = related, .node = finding.node, .in_full = in_full, .where = {}});
    }
    wanted.push_back({.frame = finding.frame, .node = finding.node, .in_full = in_full, .where = finding.where});
  }
  return wanted;
}

}  // namespace

Result<Built> build_model(const replay::CaptureInput& input, const Settings& settings, replay::RuleFilter filter) {
  Clock clock;
  replay::CaptureResult result = replay::run_input(input, settings, {.visitor = &clock});
  if (result.error && result.format.empty()) return *result.error;
  Built built;
  Model& model = built.model;
  built.buses = result.buses;
  model.capture.file = input.name;
  model.capture.format = result.format;
  model.capture.frames = result.frames;
  model.capture.checked_frames = result.summary.checked_frames;
  model.capture.untracked_frames = result.summary.untracked_frames;
  model.capture.has_time = result.first_time_ns.has_value();
  model.capture.first_ns = result.first_time_ns.value_or(0);
  model.capture.last_ns = result.last_time_ns.value_or(0);
  if (result.error) model.capture.broken = result.error->text();
  for (const replay::InterfaceInfo& interface : result.interfaces) model.interface_names.push_back(interface.name);
  for (Finding& finding : result.findings) {
    if (filter.apply(finding)) model.findings.push_back(finding);
  }
  for (std::size_t i = 0; i < kRuleCount; ++i) {
    if (!filter.is_shown(static_cast<RuleId>(i))) continue;
    model.rules.push_back({static_cast<RuleId>(i), result.checked[i], result.total[i]});
  }
  model.summary = std::move(result.summary);
  find_faults(model, clock.times());

  std::vector<Watch> watches;
  for (const Fault& fault : model.faults) {
    const Finding& finding = model.findings[fault.finding];
    watches.push_back({fault.frame, fault.time_ns, finding.node, fault.window_begin_ns, fault.window_end_ns,
                       is_alarm_without_code(finding)});
  }
  Collector collector(settings, watches, wanted_frames(model));
  Gather gather(collector);
  const replay::CaptureResult again = replay::run_input(input, settings, {.visitor = &gather});
  if (again.error && model.capture.broken.empty()) model.capture.broken = again.error->text();
  collector.finish(model);
  rank_all_causes(model);
  judge(model, settings, built.buses);
  return built;
}

}  // namespace servotrace::report
