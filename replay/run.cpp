// SPDX-License-Identifier: MIT
#include "replay/run.hpp"

#include <algorithm>
#include <memory>
#include <tuple>

namespace servotrace::replay {
namespace {

// Rules whose findings rest on a frame that is missing: where drops are known only as a total, at the end of the
// capture, they lose one severity.
constexpr std::string_view kRestOnMissing[] = {"DN204", "DN205", "DN207", "DN302", "DN303", "NK104"};

class Runner {
 public:
  Runner(Source& source, const Settings& settings, const RunOptions& options, CaptureResult& result)
      : source_(source), options_(options), result_(result), pipeline_(settings) {
    if (options.visitor != nullptr) dissection_ = std::make_unique<Dissection>();
  }

  void run() {
    RawFrame frame;
    for (bool go_on = true; go_on;) {
      const Source::Step step = is_told_to_stop() ? Source::Step::kEnd : source_.next(frame);
      if (step == Source::Step::kFrame) [[likely]] {
        if (!source_.dropped().empty()) [[unlikely]]
          take_drops(frame.number - 1);
        go_on = push(frame);
        continue;
      }
      // A source that was stopped may end inside a record: that is no fault of the capture.
      result_.stopped = is_told_to_stop();
      if (step == Source::Step::kError && !result_.stopped) result_.error = source_.error();
      finish();
      go_on = false;
    }
    if (options_.on_progress) options_.on_progress(source_);
    collect();
  }

 private:
  bool is_told_to_stop() const { return options_.stop != nullptr && options_.stop->load(std::memory_order_relaxed); }

  bool push(const RawFrame& frame) {
    FrameVisitor* const visitor = options_.visitor;
    const Detail detail = visitor != nullptr ? visitor->wanted_of(frame) : Detail::kNothing;
    Dissection* const wanted = detail != Detail::kNothing ? dissection_.get() : nullptr;
    if (wanted != nullptr) wanted->only_news = detail == Detail::kNews;
    pipeline_.push(frame, wanted);
    ++result_.frames;
    if (frame.has_time) {
      first_time_ns_ = std::min(first_time_ns_, frame.time_ns);
      last_time_ns_ = std::max(last_time_ns_, frame.time_ns);
    }
    last_ = {frame.number, source_.byte_offset(), static_cast<std::uint32_t>(frame.bytes.size())};
    if (!pipeline_.fresh().empty()) keep_place();
    if (options_.on_progress && result_.frames % 4096 == 0) options_.on_progress(source_);
    return visitor == nullptr || visitor->on_frame(frame, wanted, pipeline_, source_);
  }

  void keep_place() {
    if (result_.places.empty() || result_.places.back().frame != last_.frame) result_.places.push_back(last_);
  }

  void tell_end() {
    if (options_.visitor != nullptr) options_.visitor->on_end(pipeline_);
  }

  // Drop reports that are known once `frame` was read.
  void take_drops(std::uint64_t frame) {
    const std::span<const Dropped> dropped = source_.dropped();
    while (drops_taken_ < dropped.size() && dropped[drops_taken_].after_frame <= frame) {
      const Dropped& entry = dropped[drops_taken_++];
      pipeline_.add_dropped(entry.interface_id, entry.count);
      if (!pipeline_.fresh().empty()) keep_place();
      tell_end();
    }
    if (drops_taken_ == dropped.size() && drops_taken_ != 0) {
      source_.clear_dropped();
      drops_taken_ = 0;
    }
  }

  void finish() {
    const std::span<const Dropped> rest = source_.dropped();
    for (std::size_t i = drops_taken_; i < rest.size(); ++i) {
      if (rest[i].count != 0) total_only_.push_back(rest[i].interface_id);
    }
    take_drops(UINT64_MAX);
    if (source_.truncation() && !result_.stopped) {
      pipeline_.truncated_end(source_.truncation()->captured, source_.truncation()->expected);
      tell_end();
    }
    pipeline_.finish();
    tell_end();
    if (last_.frame != 0) keep_place();
  }

  void collect() {
    if (first_time_ns_ <= last_time_ns_) {
      result_.first_time_ns = first_time_ns_;
      result_.last_time_ns = last_time_ns_;
    }
    const Findings& findings = pipeline_.findings();
    result_.findings.assign(findings.all().begin(), findings.all().end());
    for (Finding& finding : result_.findings) lower_if_dropped(finding);
    std::stable_sort(result_.findings.begin(), result_.findings.end(), comes_before);
    for (std::size_t i = 0; i < kRuleCount; ++i) {
      result_.checked[i] = findings.times_checked(static_cast<RuleId>(i));
      result_.total[i] = findings.total(static_cast<RuleId>(i));
    }
    result_.format = source_.format();
    result_.interfaces.assign(source_.interfaces().begin(), source_.interfaces().end());
    result_.summary = pipeline_.summary();
    result_.buses = BusNames(result_.summary, result_.interfaces);
  }

  void lower_if_dropped(Finding& finding) const {
    if (std::find(total_only_.begin(), total_only_.end(), finding.node.bus.interface_id) == total_only_.end()) return;
    const std::string_view id = rule_row(finding.rule).id;
    if (std::find(std::begin(kRestOnMissing), std::end(kRestOnMissing), id) == std::end(kRestOnMissing)) return;
    finding.severity = lowered(finding.severity);
  }

  Source& source_;
  const RunOptions& options_;
  CaptureResult& result_;
  Pipeline pipeline_;
  std::unique_ptr<Dissection> dissection_;
  std::size_t drops_taken_ = 0;
  std::vector<std::uint32_t> total_only_;  // interfaces whose drops were first known at the end
  FramePlace last_;
  TimeNs first_time_ns_ = INT64_MAX;  // until a frame has a time these two are the wrong way round
  TimeNs last_time_ns_ = INT64_MIN;
};

}  // namespace

bool comes_before(const Finding& left, const Finding& right) {
  const auto key = [](const Finding& finding) {
    const NodeRef& node = finding.node;
    return std::tuple(finding.frame, finding.rule, node.bus.interface_id, node.bus.kind, node.bus.number, node.mac_id,
                      node.place, node.channel);
  };
  return key(left) < key(right);
}

const FramePlace* CaptureResult::place(std::uint64_t frame) const {
  const auto found =
      std::lower_bound(places.begin(), places.end(), frame,
                       [](const FramePlace& entry, std::uint64_t wanted) { return entry.frame < wanted; });
  return found != places.end() && found->frame == frame ? &*found : nullptr;
}

CaptureResult run(Source& source, std::string name, const Settings& settings, const RunOptions& options) {
  CaptureResult result;
  result.name = std::move(name);
  Runner(source, settings, options, result).run();
  return result;
}

}  // namespace servotrace::replay
