// SPDX-License-Identifier: MIT
#include "replay/report/bus_times.hpp"

#include <algorithm>

#include "decoder/devicenet/derived.hpp"

namespace servotrace::report {
namespace {

constexpr std::size_t kMaxKept = 64;       // histograms, and loads
constexpr std::size_t kScaleSamples = 64;  // intervals that choose the histogram's scale
constexpr std::size_t kHistogramBins = 60;

void count(Histogram& histogram, DurationNs value) {
  ++histogram.samples;
  if (value < histogram.first_ns) {
    ++histogram.below;
    return;
  }
  const auto bin = static_cast<std::size_t>((value - histogram.first_ns) / histogram.bin_ns);
  if (bin >= histogram.counts.size()) {
    ++histogram.above;
  } else {
    ++histogram.counts[bin];
  }
}

}  // namespace

void BusTimes::scale(Intervals& intervals) {
  // The middle of the picture is the median, its width a fifth of it each way: jitter is what is looked for.
  std::vector<DurationNs> sorted = intervals.first;
  std::sort(sorted.begin(), sorted.end());
  const DurationNs median = std::max<DurationNs>(sorted[sorted.size() / 2], 1);
  DurationNs spread = std::max<DurationNs>(median / 5, static_cast<DurationNs>(kHistogramBins));
  const DurationNs widest = std::max(sorted.back() - median, median - sorted.front());
  while (spread < widest && spread < median) spread *= 2;
  Histogram& histogram = intervals.histogram;
  histogram.first_ns = std::max<DurationNs>(median - spread, 0);
  histogram.bin_ns = std::max<DurationNs>(2 * spread / static_cast<DurationNs>(kHistogramBins), 1);
  histogram.counts.assign(kHistogramBins, 0);
}

BusTimes::Intervals* BusTimes::intervals_of(const BusRef& bus, What what) {
  constexpr std::string_view kTitles[] = {"Time between command records", "Time between poll commands of a node",
                                          "Poll response time", "Explicit response time"};
  for (Intervals& intervals : intervals_) {
    if (intervals.what == what && intervals.bus == bus) return &intervals;
  }
  if (intervals_.size() >= kMaxKept) return nullptr;
  Intervals& intervals = intervals_.emplace_back();
  intervals.bus = bus;
  intervals.what = what;
  intervals.histogram.bus = bus;
  intervals.histogram.title = std::string(kTitles[static_cast<std::size_t>(what)]);
  return &intervals;
}

void BusTimes::add_interval(Intervals& intervals, DurationNs interval) {
  if (!intervals.histogram.counts.empty()) {
    count(intervals.histogram, interval);
    return;
  }
  intervals.first.push_back(interval);
  if (intervals.first.size() < kScaleSamples) return;
  scale(intervals);
  for (const DurationNs value : intervals.first) count(intervals.histogram, value);
}

void BusTimes::add_cycle(const RawFrame& frame, const Dissection& dissection) {
  if (dissection.protocol != Protocol::kRtex || dissection.direction != Direction::kCommand || !frame.has_time) return;
  Intervals* const intervals = intervals_of(dissection.bus, What::kCommandRecord);
  if (intervals == nullptr) return;
  const DurationNs interval = elapsed_ns(intervals->last_ns, frame.time_ns);
  const bool usable = intervals->has_last && interval >= 0;
  intervals->last_ns = frame.time_ns;
  intervals->has_last = true;
  if (usable) add_interval(*intervals, interval);
}

// Poll intervals and response times of DeviceNet: the session measured them.
void BusTimes::add_times(const Dissection& dissection) {
  if (dissection.protocol != Protocol::kDevicenet) return;
  bool is_poll = false;
  for (const Derived& derived : dissection.derived) {
    if (derived.field == &devicenet::kMessageField) is_poll = derived.text.starts_with("Poll");
  }
  for (const Derived& derived : dissection.derived) {
    const bool is_interval = derived.field == &devicenet::kPollIntervalField;
    if ((!is_interval && derived.field != &devicenet::kResponseTimeField) || derived.value < 0) continue;
    const What what = is_interval ? What::kPoll : is_poll ? What::kPollResponse : What::kExplicitResponse;
    if (Intervals* const intervals = intervals_of(dissection.bus, what); intervals != nullptr)
      add_interval(*intervals, derived.value);
  }
}

// A base frame of n data bytes takes 47 + 8n bits with the space behind it, without stuff bits (ISO 11898-1). The data
// of a SocketCAN record begins at byte 8.
void BusTimes::add_load(const RawFrame& frame, const Dissection& dissection) {
  if (dissection.protocol != Protocol::kDevicenet || !frame.has_time || frame.bytes.size() < 8) return;
  auto found =
      std::find_if(loads_.begin(), loads_.end(), [&](const Load& load) { return load.load.bus == dissection.bus; });
  if (found == loads_.end()) {
    if (loads_.size() >= kMaxKept) return;
    loads_.push_back({{.bus = dissection.bus}, frame.time_ns, 0});
    found = loads_.end() - 1;
  }
  const std::uint64_t bits = 47 + 8 * std::min<std::uint64_t>(frame.bytes.size() - 8, 8);
  found->load.bits += bits;
  const DurationNs into = elapsed_ns(found->window_ns, frame.time_ns);
  if (into < 0 || into >= kLoadWindowNs) {
    found->window_ns = frame.time_ns;
    found->window_bits = 0;
  }
  found->window_bits += bits;
  found->load.peak_bits = std::max(found->load.peak_bits, found->window_bits);
}

void BusTimes::add(const RawFrame& frame, const Dissection& dissection) {
  add_cycle(frame, dissection);
  add_times(dissection);
  add_load(frame, dissection);
}

void BusTimes::finish(Model& model) {
  for (const Load& load : loads_) model.loads.push_back(load.load);
  for (Intervals& intervals : intervals_) {
    if (intervals.histogram.counts.empty()) {
      if (intervals.first.empty()) continue;
      scale(intervals);
      for (const DurationNs value : intervals.first) count(intervals.histogram, value);
    }
    model.histograms.push_back(std::move(intervals.histogram));
  }
}

}  // namespace servotrace::report
