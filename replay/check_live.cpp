// SPDX-License-Identifier: MIT
#include "replay/check_live.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "decoder/render/sentence.hpp"
#include "decoder/render/value.hpp"
#include "replay/capture/interrupt.hpp"
#include "replay/capture/live.hpp"

namespace servotrace::replay {
namespace {

// Findings of a live capture, as they happen.
class LiveText : public FrameVisitor {
 public:
  LiveText(std::string name, const FileSettings& settings, const Selection& selection, Style style)
      : name_(std::move(name)),
        settings_(settings),
        selection_(selection),
        filter_(selection.filter(settings.rules)),
        style_(style) {}

  bool on_frame(const RawFrame& frame, const Dissection* dissection, const Pipeline& pipeline,
                const Source& source) override {
    const std::span<const Finding> fresh = pipeline.fresh();
    if (fresh.empty()) return true;
    CaptureResult names;
    names.name = name_;
    names.summary = pipeline.summary();
    names.buses = BusNames(names.summary, source.interfaces());
    for (Finding finding : fresh) {
      if (!selection_.is_of_actor(finding.actor) || !filter_.apply(finding)) continue;
      const FindingRecord record = make_record(finding, names, settings_.decoder);
      const std::string who = record.node.text();
      fmt::print(stderr, "{} {}[{}] {}{}{}\n", time_text(frame.time_ns), name_of(record.severity), record.row().id, who,
                 who.empty() ? "" : ": ", record.message);
      if (dissection != nullptr) {
        fmt::print(stderr, "  {}{}{}\n", style_.dim(), sentence_of(*dissection, finding.node, &settings_.decoder),
                   style_.reset());
      }
    }
    return true;
  }

 private:
  std::string name_;
  const FileSettings& settings_;
  const Selection& selection_;
  RuleFilter filter_;
  Style style_;
};

}  // namespace

Result<Checked> check_live(const std::string& interface, const FileSettings& settings, const Selection& selection,
                           Style style) {
  Result<std::unique_ptr<LiveSource>> source = open_live({.interface = interface, .filter = {}});
  if (!source) return source.error();
  stop_on_interrupt(source->get());
  complain(fmt::format("checking what {} carries; Ctrl-C ends it with the results", interface));
  LiveText text(interface, settings, selection, style);
  CaptureResult result =
      run(**source, interface, settings.decoder, {.visitor = &text, .stop = &interrupted(), .on_progress = {}});
  stop_on_interrupt(nullptr);
  Checked checked{.record = {}, .filter = selection.filter(settings.rules)};
  checked.record = judge(result, settings, selection, checked.filter);
  return checked;
}

}  // namespace servotrace::replay
