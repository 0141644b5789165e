// SPDX-License-Identifier: MIT
#include "tests/support/harness.hpp"

#include <algorithm>

#include "decoder/findings/catalogue.hpp"
#include "decoder/render/message.hpp"

namespace servotrace::test {
namespace {

std::string nonsense(const Dissection& dissection, const RawFrame& frame) {
  for (const Segment& segment : dissection.segments) {
    if (segment.layout == nullptr) return "a segment without a layout";
    if (dissection.bytes(segment).size() < segment.layout->size) return "a segment outside its bytes";
  }
  for (const Link& link : dissection.links) {
    if (link.frame == 0 || link.frame > frame.number) return "a link to a frame that was not seen yet";
  }
  for (const Derived& derived : dissection.derived) {
    if (derived.field == nullptr) return "a derived value without a field";
  }
  return {};
}

class Reader {
 public:
  explicit Reader(Bytes bytes) : rest_(bytes) {}
  bool empty() const { return rest_.empty(); }
  std::uint64_t take(std::size_t count) {
    std::uint64_t value = 0;
    for (; count > 0 && !rest_.empty(); --count) {
      value = value << 8U | rest_.front();
      rest_ = rest_.subspan(1);
    }
    return value;
  }
  Bytes bytes(std::size_t count) {
    const Bytes result = rest_.first(std::min(count, rest_.size()));
    rest_ = rest_.subspan(result.size());
    return result;
  }

 private:
  Bytes rest_;
};

constexpr LinkType kLinks[] = {LinkType::kCanSocketcan, LinkType::kWiresharkUpperPdu,
                               LinkType::kEthernet,     LinkType::kLinuxSll,
                               LinkType::kLinuxSll2,    LinkType::kUser0,
                               LinkType::kIpv4,         LinkType::kRawIp,
                               LinkType::kNull,         LinkType::kIpv6};

void finish(Pipeline& pipeline, Outcome& outcome) {
  pipeline.finish();
  const std::span<const Finding> all = pipeline.findings().all();
  outcome.findings.assign(all.begin(), all.end());
  if (outcome.nonsense.empty()) outcome.nonsense = test::nonsense(all, outcome.last_frame);
  (void)pipeline.summary();
}

}  // namespace

std::string nonsense(std::span<const Finding> findings, std::uint64_t last_frame) {
  for (const Finding& finding : findings) {
    if (static_cast<std::size_t>(finding.rule) >= kRuleCount) return "no rule of the catalogue";
    const std::string id(rule_row(finding.rule).id);
    if (finding.frame > last_frame) return id + " at a frame that was never pushed";
    if (finding.last_frame < finding.frame || finding.last_frame > last_frame) return id + " ends at no frame";
    if (finding.count == 0) return id + " that never happened";
    for (const std::uint64_t related : finding.related) {
      if (related > last_frame) return id + " related to a frame that was never pushed";
    }
    if (finding.cause.frame > finding.frame) return id + " caused by a later frame";
    if (message(finding).empty()) return id + " without a text";
  }
  return {};
}

Outcome check_bytes(Bytes bytes, const Settings& settings, bool dissect) {
  Outcome outcome;
  auto opened = replay::open_bytes(bytes, "bytes");
  if (!opened) {
    outcome.broken = true;
    if (opened.error().what.empty()) outcome.nonsense = "an error without a text";
    return outcome;
  }
  replay::Source& source = **opened;
  Pipeline pipeline(settings);
  Dissection dissection;
  RawFrame frame;
  std::size_t drops = 0;
  const auto report_drops = [&] {
    for (; drops < source.dropped().size(); ++drops)
      pipeline.add_dropped(source.dropped()[drops].interface_id, source.dropped()[drops].count);
  };
  replay::Source::Step step = replay::Source::Step::kEnd;
  while ((step = source.next(frame)) == replay::Source::Step::kFrame) {
    if (frame.number <= outcome.last_frame) outcome.nonsense = "a frame number that does not grow";
    if (frame.interface_id >= source.interfaces().size()) outcome.nonsense = "a frame of no interface";
    report_drops();
    pipeline.push(frame, dissect ? &dissection : nullptr);
    ++outcome.frames;
    outcome.last_frame = frame.number;
    if (dissect && outcome.nonsense.empty()) outcome.nonsense = nonsense(dissection, frame);
  }
  report_drops();
  outcome.broken = step == replay::Source::Step::kError;
  outcome.truncated = source.truncation().has_value();
  if (outcome.truncated) pipeline.truncated_end(source.truncation()->captured, source.truncation()->expected);
  if (outcome.truncated && source.truncation()->captured >= source.truncation()->expected)
    outcome.nonsense = "a truncation that misses nothing";
  finish(pipeline, outcome);
  return outcome;
}

// Byte 0: settings. Then frames: a byte for link type and interface, one for flags, one for the time since the frame
// before in units the flags choose, one for the length, and the bytes. A CAN frame's 8-byte header is made of two of
// its bytes, so that identifiers of DeviceNet are likely.
Outcome check_frames(Bytes bytes) {
  Reader reader(bytes);
  const std::uint64_t choice = reader.take(1);
  Settings settings;
  settings.devicenet.assumed = (choice & 1U) != 0;
  settings.max_findings = (choice & 2U) != 0 ? 2 : 100;
  if ((choice & 4U) != 0)
    settings.devicenet.nodes = {{.mac_id = 1, .name = "a", .profile = "nsk-esb"},
                                {.mac_id = 2, .name = "b", .profile = "yaskawa-ns310"}};
  if ((choice & 8U) != 0) settings.rtex.command_update_ratio = 2;
  if ((choice & 16U) != 0) settings.rtex.full_sync = true;
  if ((choice & 32U) != 0) settings.rtex.communication_cycle_ns = 500'000;
  if ((choice & 64U) != 0) {
    settings.rtex.axes = {
        {.mac_id = 1, .name = "x", .parameters = {{0x0717, 0x1FF}, {0x0723, 3}, {0x0719, 1}}, .max_speed = 1000}};
  }
  Outcome outcome;
  Pipeline pipeline(settings);
  Dissection dissection;
  RawFrame frame;
  std::vector<std::uint8_t> buffer;
  while (!reader.empty()) {
    const std::uint64_t where = reader.take(1);
    const std::uint64_t flags = reader.take(1);
    frame.link_type = kLinks[(where & 0xFU) % std::size(kLinks)];
    frame.interface_id = static_cast<std::uint32_t>(where >> 4U & 0x3U);
    frame.number = ++outcome.last_frame;
    constexpr DurationNs kUnits[] = {1'000, 250'000, 10'000'000, 1'000'000'000};
    // Any time may be followed by any other: past the last one it stays there.
    const DurationNs later = static_cast<DurationNs>(reader.take(1)) * kUnits[flags & 3U];
    if (__builtin_add_overflow(frame.time_ns, later, &frame.time_ns)) frame.time_ns = INT64_MAX;
    if ((flags & 4U) != 0) frame.time_ns = static_cast<TimeNs>(reader.take(8));
    frame.has_time = (flags & 8U) == 0;
    frame.file_order = (flags & 16U) != 0 ? ByteOrder::kBig : ByteOrder::kLittle;
    const Bytes content = reader.bytes(reader.take(1) * ((flags & 32U) != 0 ? 5U : 1U));
    buffer.assign(content.begin(), content.end());
    if (frame.link_type == LinkType::kCanSocketcan && (flags & 64U) == 0 && buffer.size() >= 2) {
      const std::uint8_t head[8] = {0,
                                    0,
                                    static_cast<std::uint8_t>(buffer[0] & 7U),
                                    buffer[1],
                                    static_cast<std::uint8_t>(std::min<std::size_t>(buffer.size() - 2, 8)),
                                    0,
                                    0,
                                    0};
      buffer.erase(buffer.begin(), buffer.begin() + 2);
      buffer.insert(buffer.begin(), std::begin(head), std::end(head));
    }
    frame.bytes = buffer;
    frame.original_length = static_cast<std::uint32_t>(buffer.size() + ((flags & 128U) != 0 ? 1U : 0U));
    pipeline.push(frame, &dissection);
    ++outcome.frames;
    if (outcome.nonsense.empty()) outcome.nonsense = nonsense(dissection, frame);
  }
  finish(pipeline, outcome);
  return outcome;
}

}  // namespace servotrace::test
