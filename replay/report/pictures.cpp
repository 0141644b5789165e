// SPDX-License-Identifier: MIT
#include "replay/report/pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "decoder/findings/catalogue.hpp"
#include "decoder/render/message.hpp"
#include "decoder/render/node.hpp"
#include "decoder/render/value.hpp"
#include "replay/report/svg.hpp"

namespace servotrace::report {
namespace {

constexpr double kWidth = 1100;
constexpr double kLeft = 190;
constexpr double kRight = 16;
constexpr double kBar = 12;        // height of a state's bar
constexpr double kRow = kBar + 4;  // and with the space below it
constexpr std::size_t kMaxLanes = 40;
constexpr std::size_t kMaxRows = 8;      // states a lane
constexpr std::size_t kMaxMarks = 1500;  // a picture

struct Axis {
  TimeNs begin_ns;
  TimeNs end_ns;
  double x(TimeNs time_ns) const {
    const double span = std::max(1.0, static_cast<double>(elapsed_ns(begin_ns, end_ns)));
    const double part = static_cast<double>(elapsed_ns(begin_ns, time_ns)) / span;
    return kLeft + std::clamp(part, 0.0, 1.0) * (kWidth - kLeft - kRight);
  }
};

// Seconds since the start of the capture, with as many places as the ticks need.
std::string seconds_label(double seconds, double step) {
  const int places = step >= 1 ? 0 : step >= 0.1 ? 1 : step >= 0.01 ? 2 : step >= 0.001 ? 3 : step >= 0.0001 ? 4 : 6;
  return fmt::format("{:.{}f} s", seconds, places);
}

void draw_time_axis(Svg& svg, const Model& model, const Axis& axis, double top, double bottom) {
  const double begin = static_cast<double>(elapsed_ns(model.capture.first_ns, axis.begin_ns)) / 1e9;
  const double end = static_cast<double>(elapsed_ns(model.capture.first_ns, axis.end_ns)) / 1e9;
  const std::vector<double> marks = ticks(begin, end, 9);
  for (const double mark : marks) {
    const double x = axis.x(model.capture.first_ns + static_cast<TimeNs>(mark * 1e9));
    svg.line(x, top, x, bottom, "grid");
    svg.text(x, bottom + 14, seconds_label(mark, marks.size() > 1 ? marks[1] - marks[0] : 1), "tick", "middle");
  }
}

bool same_node(const NodeRef& left, const NodeRef& right) {
  return left.bus == right.bus && left.mac_id == right.mac_id;
}

std::string_view mark_class(Severity severity) {
  return severity == Severity::kError ? "error" : severity == Severity::kWarning ? "warning" : "note";
}
Svg::Mark mark_shape(Severity severity) {
  return severity == Severity::kError     ? Svg::Mark::kTriangle
         : severity == Severity::kWarning ? Svg::Mark::kDiamond
                                          : Svg::Mark::kCircle;
}

struct Lane {
  NodeRef node;
  std::string name;
  std::vector<const StateTrack*> tracks;
  std::vector<const Finding*> findings;
};

std::vector<Lane> make_lanes(const Model& model, const Settings& settings, const replay::BusNames& buses,
                             const Axis& axis) {
  std::vector<Lane> lanes;
  const auto lane_of = [&](const NodeRef& node) -> Lane* {
    for (Lane& lane : lanes) {
      if (same_node(lane.node, node)) return &lane;
    }
    if (lanes.size() >= kMaxLanes) return nullptr;
    Lane lane;
    lane.node = node;
    lane.name = node_text(node, configured_name(settings, node));
    const std::string_view bus = buses.name(node.bus);
    if (lane.name.empty()) {
      lane.name = bus.empty() ? "capture" : std::string(bus);
    } else if (buses.size() > 1) {
      lane.name += fmt::format(", {}", bus);
    }
    lanes.push_back(std::move(lane));
    return &lanes.back();
  };
  for (const StateTrack& track : model.tracks) {
    Lane* lane = lane_of(track.node);
    if (lane == nullptr) continue;
    const bool changes = std::any_of(track.changes.begin(), track.changes.end(), [&axis](const Event& event) {
      return event.time_ns >= axis.begin_ns && event.time_ns <= axis.end_ns;
    });
    if (changes) lane->tracks.push_back(&track);
  }
  for (const Finding& finding : model.findings) {
    if (finding.time_ns < axis.begin_ns || finding.time_ns > axis.end_ns) continue;
    Lane* lane = lane_of(finding.node);
    if (lane != nullptr) lane->findings.push_back(&finding);
  }
  // A node known by name only (its place before its address was seen) has nothing to show.
  std::erase_if(lanes, [](const Lane& lane) { return lane.tracks.empty() && lane.findings.empty(); });
  for (Lane& lane : lanes) {
    std::stable_sort(lane.tracks.begin(), lane.tracks.end(), [](const StateTrack* left, const StateTrack* right) {
      return importance(*left->field) < importance(*right->field);
    });
    if (lane.tracks.size() > kMaxRows) lane.tracks.resize(kMaxRows);
  }
  return lanes;
}

double lane_height(const Lane& lane) { return 34 + kRow * static_cast<double>(lane.tracks.size()); }

// The label of the field; where command and response have a field of the same name, with the message's.
std::string row_label(const Lane& lane, const StateTrack& track) {
  const auto same = std::count_if(lane.tracks.begin(), lane.tracks.end(), [&track](const StateTrack* other) {
    return other->field->label == track.field->label;
  });
  if (same < 2) return std::string(track.field->label);
  return fmt::format("{} ({})", track.field->label, track.layout->key);
}

// The state over time as bars: dark where it is not 0, named where it has names.
void draw_track(Svg& svg, const StateTrack& track, const std::string& label, const Axis& axis, double y) {
  svg.text(kLeft - 8, y + 10, label, "state", "end");
  TimeNs since = track.first_ns;
  std::int64_t value = track.first_value;
  // Bars closer than a unit of the picture are drawn as one, so that their number is bounded.
  struct Bar {
    double begin = 0;
    double end = 0;
    std::int64_t value = 0;
    std::uint64_t states = 0;  // 0: nothing to draw
  };
  Bar open;
  const bool bad = importance(*track.field) == 0 && track.field->key != "drdy";
  const auto flush = [&] {
    if (open.states == 0) return;
    const double width = std::max(open.end - open.begin, 1.0);
    const std::string text =
        open.states == 1 ? value_text(*track.field, open.value) : fmt::format("{} changes", open.states);
    svg.rectangle(open.begin, y, width, kBar, bad ? "bar bad" : "bar", fmt::format("{}: {}", track.field->label, text));
    const ValueName* name = find_value(track.field->values, open.value);
    if (open.states == 1 && track.field->kind != Kind::kBool && name != nullptr &&
        width > 7.0 * static_cast<double>(name->name.size()) + 6)
      svg.text(open.begin + 4, y + kBar - 2.5, name->name, bad ? "in-bar on-bad" : "in-bar");
    open = {};
  };
  std::uint32_t joined = 0;
  const auto bar = [&](TimeNs until) {
    if ((value == 0 && joined == 0) || until < axis.begin_ns || since > axis.end_ns) return;
    const double begin = axis.x(since);
    // Joined changes stand for a state that went to and fro; where it ended at 0 only their place is drawn.
    const double end = value == 0 ? begin + 1 : axis.x(until);
    const std::uint64_t states = 1U + joined;
    if (open.states != 0 && begin - open.end < 2 && (end - begin < 2 || open.end - open.begin < 2)) {
      open.end = std::max(open.end, end);
      open.states += states;
      return;
    }
    flush();
    open = {begin, end, value, states};
  };
  for (const Event& event : track.changes) {
    bar(event.time_ns);
    since = event.time_ns;
    value = event.after;
    joined = event.joined;
  }
  bar(axis.end_ns);
  flush();
}

}  // namespace

int importance(const Field& field) {
  const std::string_view key = field.key;
  for (const std::string_view word :
       {"alarm", "cmd_error", "command_error", "emergency", "e_stop", "drdy", "block_fault"}) {
    if (key.find(word) != std::string_view::npos) return 0;
  }
  for (const std::string_view word : {"servo", "enable", "svon", "cyclic"}) {
    if (key.find(word) != std::string_view::npos) return 1;
  }
  for (const std::string_view word : {"progress", "busy", "homing", "warning", "limit"}) {
    if (key.find(word) != std::string_view::npos) return 2;
  }
  return 3;
}

std::string timeline(const Model& model, const Settings& settings, const replay::BusNames& buses, TimeNs begin_ns,
                     TimeNs end_ns) {
  const Axis axis{begin_ns, std::max(end_ns, begin_ns + 1)};
  const std::vector<Lane> lanes = make_lanes(model, settings, buses, axis);
  constexpr double kTop = 22;
  double height = kTop;
  for (const Lane& lane : lanes) height += lane_height(lane);
  Svg svg(kWidth, height + 26, "Timeline: states as bars, findings as marks, one lane an axis or node");
  double y = kTop;
  std::size_t marks = 0;
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    if (i % 2 == 0) svg.rectangle(0, y - 2, kWidth, lane_height(lanes[i]), "lane-back");
    y += lane_height(lanes[i]);
  }
  draw_time_axis(svg, model, axis, kTop - 4, height);
  y = kTop;
  for (const Lane& lane : lanes) {
    svg.line(0, y - 2, kWidth, y - 2, "lane");
    svg.text(4, y + 14, lane.name, "lane-name");
    std::array<double, 3> latest = {-10, -10, -10};  // of each severity: marks on top of each other are one
    for (const Finding* finding : lane.findings) {
      const double x = axis.x(finding->time_ns);
      double& before = latest[static_cast<std::size_t>(finding->severity)];
      if (x - before < 2) continue;
      before = x;
      if (++marks > kMaxMarks) break;
      if (finding->last_time_ns > finding->time_ns && axis.x(finding->last_time_ns) > x + 1)
        svg.line(x, y + 19, axis.x(finding->last_time_ns), y + 19,
                 fmt::format("episode {}", mark_class(finding->severity)));
      svg.mark(mark_shape(finding->severity), axis.x(finding->time_ns), y + 11, mark_class(finding->severity),
               fmt::format("{} {} (frame {}): {}", name_of(finding->severity), rule_row(finding->rule).id,
                           finding->frame, message(*finding)));
    }
    y += 26;
    for (const StateTrack* track : lane.tracks) {
      draw_track(svg, *track, row_label(lane, *track), axis, y);
      y += kRow;
    }
    y += 8;
  }
  if (!model.faults.empty()) {
    const Finding& first = model.findings[model.faults.front().finding];
    const TimeNs began_ns = model.faults.front().time_ns;
    if (began_ns >= axis.begin_ns && began_ns <= axis.end_ns) {
      const double x = axis.x(began_ns);
      svg.line(x, kTop - 6, x, height, "first-fault");
      const bool left = x > kWidth - 200;
      svg.text(left ? x - 5 : x + 5, kTop - 9, fmt::format("first fault: {}", rule_row(first.rule).id),
               "first-fault-text", left ? "end" : "start");
    }
  }
  return svg.str();
}

std::string curves(const Model& model, const Fault& fault) {
  constexpr std::size_t kMaxCurves = 8;
  constexpr double kCurve = 96;  // a signal: its name, and below it the curve
  constexpr double kName = 20;
  std::vector<const Signal*> shown;
  for (const Signal& signal : fault.signals) {  // what moves first, what stands still only where nothing moves
    if (!signal.series.is_constant() && shown.size() < kMaxCurves) shown.push_back(&signal);
  }
  if (shown.empty()) return {};
  const Axis axis{fault.window_begin_ns, std::max(fault.window_end_ns, fault.window_begin_ns + 1)};
  const double bottom = 14 + kCurve * static_cast<double>(shown.size());
  Svg svg(kWidth, bottom + 26, "Signals around the fault");
  draw_time_axis(svg, model, axis, 6, bottom);
  double top = 12;
  for (const Signal* signal : shown) {
    double low = 0;
    double high = 0;
    bool first = true;
    for (const Series::Bin& bin : signal->series.bins()) {
      const double minimum = scaled(*signal->field, bin.minimum);
      const double maximum = scaled(*signal->field, bin.maximum);
      low = first ? minimum : std::min(low, minimum);
      high = first ? maximum : std::max(high, maximum);
      first = false;
    }
    const double span = high > low ? high - low : 1;
    const auto y = [&](double value) { return top + kName + (kCurve - kName - 18) * (1 - (value - low) / span); };
    svg.line(kLeft, top + kCurve - 10, kWidth - kRight, top + kCurve - 10, "lane");
    const std::string_view unit = symbol(signal->field->unit);
    svg.text(4, top + 8, unit.empty() ? signal->label : fmt::format("{}, {}", signal->label, unit), "lane-name");
    for (const double mark : ticks(low, high, 3))
      svg.text(kLeft - 6, y(mark) + 3, fmt::format("{:.10g}", mark), "tick", "end");
    std::vector<std::pair<double, double>> points;
    for (const Series::Bin& bin : signal->series.bins()) {
      const double x = axis.x(bin.time_ns);
      points.emplace_back(x, y(scaled(*signal->field, bin.minimum)));
      if (bin.maximum != bin.minimum) points.emplace_back(x, y(scaled(*signal->field, bin.maximum)));
    }
    svg.polyline(points, "curve");
    top += kCurve;
  }
  const Finding& reported = model.findings[fault.finding];
  const auto draw = [&](const Finding& finding, TimeNs time_ns, std::string_view css_class) {
    if (time_ns < axis.begin_ns || time_ns > axis.end_ns) return;
    const double x = axis.x(time_ns);
    svg.line(x, 8, x, bottom, css_class);
    svg.mark(mark_shape(finding.severity), x, 8, mark_class(finding.severity),
             fmt::format("{} (frame {}): {}", rule_row(finding.rule).id, finding.frame, message(finding)));
  };
  for (const std::size_t index : fault.preceding)
    draw(model.findings[index], model.findings[index].time_ns, "violation-line");
  draw(reported, fault.time_ns, "first-fault");
  return svg.str();
}

std::string histogram(const Histogram& histogram, std::string_view bus_name) {
  if (histogram.counts.empty()) return {};
  constexpr double kHeight = 150;
  Svg svg(kWidth, kHeight + 36, fmt::format("{} on {}: how often each interval occurred", histogram.title, bus_name));
  const std::uint64_t most =
      std::max<std::uint64_t>(*std::max_element(histogram.counts.begin(), histogram.counts.end()), 1);
  const double width = (kWidth - kLeft - kRight) / static_cast<double>(histogram.counts.size());
  const double low = static_cast<double>(histogram.first_ns) / 1e3;
  const double step = static_cast<double>(histogram.bin_ns) / 1e3;
  const double high = low + step * static_cast<double>(histogram.counts.size());
  for (const double mark : ticks(low, high, 8)) {
    const double x = kLeft + (mark - low) / (high - low) * (kWidth - kLeft - kRight);
    svg.line(x, 8, x, kHeight, "grid");
    svg.text(x, kHeight + 14, high >= 10'000 ? fmt::format("{:g} ms", mark / 1e3) : fmt::format("{:g} us", mark),
             "tick", "middle");
  }
  for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
    if (histogram.counts[i] == 0) continue;
    const double height = std::max((kHeight - 14) * std::log2(1.0 + static_cast<double>(histogram.counts[i])) /
                                       std::log2(1.0 + static_cast<double>(most)),
                                   1.5);
    svg.rectangle(kLeft + width * static_cast<double>(i), kHeight - height, std::max(width - 1, 1.0), height, "bar",
                  fmt::format("{:.1f} to {:.1f} us: {}", low + step * static_cast<double>(i),
                              low + step * static_cast<double>(i + 1), histogram.counts[i]));
  }
  svg.line(kLeft, kHeight, kWidth - kRight, kHeight, "lane");
  svg.text(kLeft - 6, 16, fmt::format("{}", most), "tick", "end");
  svg.text(kLeft - 6, kHeight, "0", "tick", "end");
  svg.text(4, 20, bus_name, "lane-name");
  if (histogram.below + histogram.above != 0) {
    svg.text(kWidth - kRight, kHeight + 30,
             fmt::format("{} shorter and {} longer than shown", histogram.below, histogram.above), "tick", "end");
  }
  return svg.str();
}

}  // namespace servotrace::report
