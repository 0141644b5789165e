// SPDX-License-Identifier: MIT
#include "replay/capture/join.hpp"

#include <algorithm>

#include "replay/capture/limits.hpp"

namespace servotrace::replay {
namespace {

constexpr std::uint32_t kUnknown = 0xFFFF'FFFF;
constexpr std::size_t kNobody = static_cast<std::size_t>(-1);

struct Part {
  std::filesystem::path path;
  TimeNs first_ns = 0;
  std::size_t order = 0;  // as given
};

// A file being read, one frame ahead.
struct Active {
  std::unique_ptr<Source> source;
  RawFrame frame;
  TimeNs time_ns = 0;  // of `frame`; of a frame without time, that of the one before
  std::size_t order = 0;
  std::vector<std::uint32_t> interfaces;  // its interfaces to ours
};

class JoinedSource final : public Source {
 public:
  Result<void> open(const std::vector<std::filesystem::path>& paths) {
    for (const std::filesystem::path& path : paths) {
      auto source = open_capture(path);
      if (!source) return source.error();
      total_ += (*source)->total();
      RawFrame frame;
      switch ((*source)->next(frame)) {
        case Step::kFrame:
          parts_.push_back({path, frame.time_ns, parts_.size()});
          break;
        case Step::kEnd:
          keep_truncation(**source);
          break;
        case Step::kError:
          return (*source)->error();
      }
    }
    std::stable_sort(parts_.begin(), parts_.end(),
                     [](const Part& a, const Part& b) { return a.first_ns < b.first_ns; });
    format_ = std::to_string(paths.size()) + " joined captures";
    return {};
  }

  std::uint64_t consumed() const override {
    std::uint64_t bytes = ended_bytes_;
    for (const Active& part : active_) bytes += part.source->consumed();
    return bytes;
  }
  std::uint64_t total() const override { return total_; }

  Step next(RawFrame& frame) override {
    if (!error_.what.empty()) return Step::kError;
    if (last_ != kNobody && !advance(last_)) return Step::kError;
    last_ = kNobody;
    std::size_t first = earliest();
    while (next_part_ < parts_.size() && (first == kNobody || parts_[next_part_].first_ns <= active_[first].time_ns)) {
      if (!start(parts_[next_part_++])) return Step::kError;
      first = earliest();
    }
    if (first == kNobody) return Step::kEnd;
    Active& part = active_[first];
    const std::uint32_t interface = interface_of(part, part.frame.interface_id);
    if (interface == kUnknown) return Step::kError;
    take_drops(part);
    frame = part.frame;
    frame.number = ++number_;
    frame.interface_id = interface;
    byte_offset_ = 0;
    last_ = first;
    return Step::kFrame;
  }

 private:
  std::size_t earliest() const {
    std::size_t best = kNobody;
    for (std::size_t i = 0; i < active_.size(); ++i) {
      if (best == kNobody || active_[i].time_ns < active_[best].time_ns ||
          (active_[i].time_ns == active_[best].time_ns && active_[i].order < active_[best].order))
        best = i;
    }
    return best;
  }

  bool start(const Part& part) {
    auto source = open_capture(part.path);
    if (!source) {
      error_ = source.error();
      return false;
    }
    Active active;
    active.source = std::move(source.value());
    active.order = part.order;
    active.time_ns = part.first_ns;
    active_.push_back(std::move(active));
    return advance(active_.size() - 1);
  }

  // The next frame of active_[index]; the part goes where it has ended.
  bool advance(std::size_t index) {
    Active& part = active_[index];
    switch (part.source->next(part.frame)) {
      case Step::kFrame:
        if (part.frame.has_time) part.time_ns = part.frame.time_ns;
        return true;
      case Step::kEnd:
        take_drops(part);
        keep_truncation(*part.source);
        ended_bytes_ += part.source->consumed();
        for (std::uint32_t interface : part.interfaces) {
          if (interface != kUnknown) in_use_[interface] = false;
        }
        active_.erase(active_.begin() + static_cast<std::ptrdiff_t>(index));
        return true;
      case Step::kError:
        break;
    }
    error_ = part.source->error();
    return false;
  }

  std::uint32_t interface_of(Active& part, std::uint32_t local) {
    if (local >= part.interfaces.size()) part.interfaces.resize(local + 1, kUnknown);
    std::uint32_t& ours = part.interfaces[local];
    if (ours != kUnknown) return ours;
    const InterfaceInfo& info = part.source->interfaces()[local];
    for (std::uint32_t i = 0; i < interfaces_.size(); ++i) {
      if (in_use_[i] || interfaces_[i].link_type != info.link_type || interfaces_[i].name != info.name) continue;
      in_use_[i] = true;
      interfaces_[i].time_resolution_ns = std::max(interfaces_[i].time_resolution_ns, info.time_resolution_ns);
      dropped_.push_back({i, 0, number_});
      return ours = i;
    }
    if (interfaces_.size() == kMaxInterfaces) {
      error_ = Error{format_, "more than " + std::to_string(kMaxInterfaces) + " interfaces"};
      return kUnknown;
    }
    interfaces_.push_back(info);
    in_use_.push_back(true);
    return ours = static_cast<std::uint32_t>(interfaces_.size() - 1);
  }

  // Drops a part reports before its frame at hand.
  void take_drops(Active& part) {
    for (const Dropped& drop : part.source->dropped()) {
      const std::uint32_t interface = interface_of(part, drop.interface_id);
      if (interface != kUnknown && dropped_.size() < kMaxDropReports)
        dropped_.push_back({interface, drop.count, number_});
    }
    part.source->clear_dropped();
  }

  void keep_truncation(const Source& source) {
    if (!truncation_) truncation_ = source.truncation();
  }

  std::vector<Part> parts_;  // by their first time
  std::size_t next_part_ = 0;
  std::vector<Active> active_;
  std::vector<bool> in_use_;    // of interfaces_: by a part that has not ended
  std::size_t last_ = kNobody;  // the part whose frame was handed over last
  std::uint64_t number_ = 0;
  std::uint64_t ended_bytes_ = 0;
  std::uint64_t total_ = 0;
};

}  // namespace

Result<std::unique_ptr<Source>> join_captures(const std::vector<std::filesystem::path>& paths) {
  auto source = std::make_unique<JoinedSource>();
  const Result<void> opened = source->open(paths);
  if (!opened) return opened.error();
  return std::unique_ptr<Source>(std::move(source));
}

}  // namespace servotrace::replay
