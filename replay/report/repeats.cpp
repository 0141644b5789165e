// SPDX-License-Identifier: MIT
#include "replay/report/repeats.hpp"

namespace servotrace::report {
namespace {

constexpr std::size_t kMostTimes = 1024;  // kept of a stretch before they are added

}  // namespace

Repeats::Kind& Repeats::kind_of(const BusRef& bus, Direction direction) {
  for (Kind& kind : kinds_) {
    if (kind.direction == direction && kind.bus == bus) return kind;
  }
  Kind& kind = kinds_.emplace_back();
  kind.bus = bus;
  kind.direction = direction;
  kind.times.reserve(kMostTimes);
  return kind;
}

void Repeats::begin(const Dissection& dissection) {
  ++frames_;
  present_ = nullptr;
  if (entangled_ || dissection.protocol != Protocol::kRtex || dissection.direction == Direction::kNone) return;
  present_ = &kind_of(dissection.bus, dissection.direction);
  settle(*present_);
  present_->samples.clear();
}

void Repeats::note_sample(std::size_t signal, std::int64_t value) {
  if (present_ == nullptr) return;
  touch(series_, signal);
  present_->samples.push_back({signal, value});
}

void Repeats::touch(std::vector<Toucher>& list, std::size_t index) {
  if (present_ == nullptr) return;
  if (index >= list.size()) list.resize(index + 1);
  Toucher& last = list[index];
  if (last.frame == frames_ || (last.kind != nullptr && last.kind != present_)) {
    entangled_ = true;
    finish();
  }
  last = {present_, frames_};
}

void Repeats::add(TimeNs time_ns, const Dissection& dissection) {
  Kind& kind = kind_of(dissection.bus, dissection.direction);
  if (kind.times.size() == kMostTimes || (!kind.times.empty() && time_ns < kind.times.back())) settle(kind);
  kind.times.push_back(time_ns);
}

void Repeats::settle(Kind& kind) {
  if (kind.times.empty()) return;
  for (const Sample& sample : kind.samples) signals_[sample.signal].series.add(kind.times, sample.value);
  kind.times.clear();
}

void Repeats::finish() {
  for (Kind& kind : kinds_) settle(kind);
}

}  // namespace servotrace::report
