// SPDX-License-Identifier: MIT
#include "decoder/render/json.hpp"

#include <fmt/format.h>

#include "decoder/findings/catalogue.hpp"
#include "decoder/render/message.hpp"
#include "decoder/render/node.hpp"
#include "decoder/render/value.hpp"
#include "replay/report/analysis.hpp"
#include "replay/report/pages.hpp"

namespace servotrace::report {
namespace {

class Writer {
 public:
  Writer(const Built& built, const Settings& settings, JsonWriter& json)
      : model_(built.model), buses_(built.buses), settings_(settings), json_(json) {}

  void write() {
    json_.begin_object();
    capture();
    verdict();
    comparison();
    json_.key("faults").begin_array();
    for (const Fault& fault : model_.faults) write(fault);
    json_.end_array();
    json_.member("more_faults", model_.more_faults);
    json_.key("findings").begin_array();
    for (const Finding& finding : model_.findings) write(finding);
    json_.end_array();
    buses();
    accesses();
    histograms();
    tracks();
    signals();
    rules();
    json_.key("cannot_show").begin_array();
    for (const std::string& text : model_.cannot_show) json_.value(text);
    json_.end_array();
    json_.end_object();
  }

 private:
  void time(std::string_view key, TimeNs value) { json_.member(key, seconds_text(value)); }

  void node(std::string_view key, const NodeRef& reference) {
    json_.key(key).begin_object();
    const std::string_view bus = buses_.name(reference.bus);
    if (bus.empty()) {
      json_.key("bus").null();
    } else {
      json_.member("bus", bus);
    }
    if (reference.protocol == Protocol::kNone) {
      json_.key("protocol").null();
    } else {
      json_.member("protocol", name_of(reference.protocol));
    }
    if (reference.mac_id == kNoMacId) {
      json_.key("mac_id").null();
    } else {
      json_.member("mac_id", static_cast<int>(reference.mac_id));
    }
    const std::string_view name = configured_name(settings_, reference);
    if (!name.empty()) json_.member("name", name);
    if (reference.channel != Channel::kNone) json_.member("channel", name_of(reference.channel));
    json_.end_object();
  }

  void capture() {
    const Capture& capture = model_.capture;
    json_.key("capture").begin_object();
    json_.member("file", capture.file).member("format", capture.format).member("frames", capture.frames);
    json_.member("checked_frames", capture.checked_frames);
    if (capture.has_time) {
      time("first_time", capture.first_ns);
      time("last_time", capture.last_ns);
    }
    if (!capture.broken.empty()) json_.member("broken", capture.broken);
    json_.end_object();
  }

  void verdict() {
    constexpr std::string_view kKinds[] = {"nothing-checked", "clean", "violations", "fault"};
    json_.key("verdict").begin_object();
    json_.member("kind", kKinds[static_cast<std::size_t>(model_.verdict.kind)])
        .member("headline", model_.verdict.headline);
    if (model_.verdict.first) {
      const Finding& finding = model_.findings[*model_.verdict.first];
      json_.key("first").begin_object().member("rule", rule_row(finding.rule).id).member("frame", finding.frame);
      node("node", finding.node);
      json_.end_object();
    }
    if (model_.verdict.cause) {
      json_.key("cause");
      write(*model_.verdict.cause);
    }
    json_.key("sentences").begin_array();
    for (const std::string& sentence : model_.verdict.sentences) json_.value(sentence);
    json_.end_array().end_object();
  }

  void comparison() {
    if (!model_.comparison) return;
    const Comparison& other = *model_.comparison;
    json_.key("comparison").begin_object().member("file", other.file).member("headline", other.headline);
    json_.key("partings").begin_array();
    for (const Parting& row : other.partings) {
      json_.begin_object();
      node("node", row.node);
      json_.member("state", row.field->label).member("here", row.here).member("there", row.there);
      if (row.here_frame != 0) json_.member("here_frame", row.here_frame);
      if (row.there_frame != 0) json_.member("there_frame", row.there_frame);
      json_.member("after_ns", row.after_ns).end_object();
    }
    json_.end_array().member("more_partings", other.more_partings).key("settings").begin_array();
    for (const Comparison::Setting& row : other.settings) {
      json_.begin_object()
          .member("node", row.node)
          .member("setting", row.key)
          .member("here", row.here)
          .member("there", row.there)
          .end_object();
    }
    json_.end_array().key("rules").begin_array();
    for (const Comparison::RuleCount& row : other.rules) {
      json_.begin_object()
          .member("rule", rule_row(row.rule).id)
          .member("here", row.here)
          .member("there", row.there)
          .end_object();
    }
    json_.end_array().end_object();
  }

  void write(const Candidate& cause) {
    json_.begin_object();
    json_.member("text", cause.text).member("section", cause.section).member("supported", cause.supported);
    if (cause.finding) {
      const Finding& shown = model_.findings[*cause.finding];
      json_.member("rule", rule_row(shown.rule).id).member("frame", shown.frame);
      node("node", shown.node);
    }
    if (cause.access) {
      const Access& access = model_.accesses[*cause.access];
      json_.member("parameter", access.what)
          .member("before", access.before)
          .member("value", access.value)
          .member("frame", access.frame);
      node("node", access.node);
    }
    json_.end_object();
  }

  void write(const Fault& fault) {
    const Finding& finding = model_.findings[fault.finding];
    json_.begin_object();
    json_.member("rule", rule_row(finding.rule).id).member("frame", finding.frame);
    node("node", finding.node);
    json_.member("message", message(finding));
    time("time", finding.time_ns);
    if (fault.frame != finding.frame) {
      json_.member("began_frame", fault.frame);
      time("began", fault.time_ns);
    }
    if (fault.code_frame != 0) {
      json_.key("code").begin_object().member("value", fault.code).member("text", fault.code_text);
      json_.member("frame", fault.code_frame).end_object();
    }
    json_.key("advice").begin_array();
    for (const Advice& advice : fault.advice) {
      json_.begin_object()
          .member("name", advice.name)
          .member("causes", advice.causes)
          .member("remedies", advice.remedies)
          .member("section", advice.section)
          .member("likeliest", advice.likeliest)
          .end_object();
    }
    json_.end_array();
    json_.key("causes").begin_array();
    for (const Candidate& cause : fault.causes) write(cause);
    json_.end_array();
    json_.key("preceding").begin_array();
    for (const std::size_t index : fault.preceding) {
      json_.begin_object();
      json_.member("rule", rule_row(model_.findings[index].rule).id).member("frame", model_.findings[index].frame);
      json_.end_object();
    }
    json_.end_array();
    json_.key("messages").begin_array();
    for (const MessagePair& pair : fault.messages) {
      json_.begin_object();
      json_.member("direction", pair.direction == Direction::kCommand ? "command" : "response");
      json_.member("frame", pair.after_frame);
      if (pair.before_frame != 0) json_.member("before_frame", pair.before_frame);
      json_.key("fields").begin_array();
      for (const FieldRow& row : pair.rows) {
        json_.begin_object();
        json_.member("field", row.filter).member("value", row.after);
        if (row.differs) json_.member("before", row.before);
        json_.end_object();
      }
      json_.end_array().end_object();
    }
    json_.end_array();
    json_.key("led_to").begin_array();
    for (const std::size_t index : fault.followers) json_.value(std::uint64_t{index});
    json_.end_array().end_object();
  }

  void accesses() {
    json_.key("accesses").begin_array();
    for (const Access& access : model_.accesses) {
      json_.begin_object().member("kind", name_of(access.kind)).member("frame", access.frame);
      time("time", access.time_ns);
      node("node", access.node);
      json_.member("what", access.what).member("value", access.value);
      if (!access.before.empty()) json_.member("before", access.before);
      if (access.refused) json_.member("refused", true);
      json_.end_object();
    }
    json_.end_array();
    json_.member("more_accesses", model_.more_accesses);
  }

  void histograms() {
    json_.key("histograms").begin_array();
    for (const Histogram& histogram : model_.histograms) {
      json_.begin_object().member("bus", buses_.name(histogram.bus)).member("title", histogram.title);
      json_.member("first_ns", histogram.first_ns).member("bin_ns", histogram.bin_ns);
      json_.member("samples", histogram.samples).member("below", histogram.below).member("above", histogram.above);
      json_.key("counts").begin_array();
      for (const std::uint64_t count : histogram.counts) json_.value(count);
      json_.end_array().end_object();
    }
    json_.end_array();
    json_.key("loads").begin_array();
    for (const BusLoad& load : model_.loads) {
      json_.begin_object()
          .member("bus", buses_.name(load.bus))
          .member("bits", load.bits)
          .member("peak_bits", load.peak_bits)
          .end_object();
    }
    json_.end_array();
  }

  void write(const Finding& finding) {
    const Rule& row = rule_row(finding.rule);
    json_.begin_object();
    json_.member("rule", row.id)
        .member("slug", row.slug)
        .member("severity", name_of(finding.severity))
        .member("actor", name_of(finding.actor));
    node("node", finding.node);
    json_.member("frame", finding.frame)
        .member("last_frame", finding.last_frame)
        .member("count", std::uint64_t{finding.count});
    time("time", finding.time_ns);
    json_.member("message", message(finding));
    if (finding.cause.frame != 0) {
      json_.key("cause")
          .begin_object()
          .member("rule", rule_row(finding.cause.rule).id)
          .member("frame", finding.cause.frame)
          .end_object();
    }
    json_.key("evidence").begin_array();
    for (const std::uint64_t related : finding.related) {
      if (related != 0 && related != finding.frame) evidence(related, finding.node);
    }
    evidence(finding.frame, finding.node);
    json_.end_array();
    json_.end_object();
  }

  void evidence(std::uint64_t frame, const NodeRef& node) {
    const auto found = model_.evidence.find(frame_key(frame, node));
    if (found == model_.evidence.end()) return;
    const ShownFrame& shown = found->second;
    json_.begin_object().member("frame", frame).member("text", shown.sentence);
    if (!shown.bytes.empty()) {
      json_.member("bytes", shown.bytes).key("fields").begin_array();
      for (const ShownField& field : shown.fields) {
        json_.begin_object().member("label", field.label).member("value", field.value);
        if (field.marked) json_.member("marked", true);
        json_.end_object();
      }
      json_.end_array();
    }
    json_.end_object();
  }

  void facts(const std::vector<Fact>& list) {
    json_.key("facts").begin_array();
    for (const Fact& fact : list) {
      json_.begin_object().member("key", fact.key).member("value", fact.value);
      const std::string basis = basis_text(fact.basis);
      if (!basis.empty()) json_.member("basis", basis);
      json_.end_object();
    }
    json_.end_array();
  }

  void buses() {
    json_.key("buses").begin_array();
    for (const BusSummary& bus : model_.summary.buses) {
      json_.begin_object()
          .member("bus", buses_.name(bus.bus))
          .member("protocol", name_of(bus.protocol))
          .member("recognised", bus.recognised);
      json_.member("frames", bus.frames).member("sampled", bus.sampled);
      facts(bus.facts);
      json_.key("nodes").begin_array();
      for (const NodeSummary& entry : bus.nodes) {
        json_.begin_object();
        node("node", entry.node);
        json_.member("profile", entry.profile).member("recognised", entry.recognised);
        facts(entry.facts);
        json_.end_object();
      }
      json_.end_array().key("statistics").begin_array();
      for (const Statistic& statistic : bus.statistics) {
        json_.begin_object().member("key", statistic.key);
        node("node", statistic.node);
        json_.member("count", statistic.count)
            .member("minimum_ns", statistic.minimum_ns)
            .member("maximum_ns", statistic.maximum_ns);
        json_.key("mean_ns").raw(fmt::format("{:.0f}", statistic.mean_ns));
        json_.member("percentile_99_ns", statistic.percentile_99_ns).end_object();
      }
      json_.end_array().end_object();
    }
    json_.end_array();
  }

  void tracks() {
    json_.key("states").begin_array();
    for (const StateTrack& track : model_.tracks) {
      json_.begin_object().member("field", filter_name(*track.layout, *track.field));
      node("node", track.node);
      json_.member("first", track.first_value).member("total", track.total);
      json_.key("changes").begin_array();
      for (const Event& event : track.changes) {
        json_.begin_object().member("frame", event.frame);
        time("time", event.time_ns);
        json_.member("value", event.after);
        if (event.joined != 0) json_.member("joined", std::uint64_t{event.joined});
        json_.end_object();
      }
      json_.end_array().end_object();
    }
    json_.end_array();
  }

  void signals() {
    json_.key("signals").begin_array();
    for (const Signal& signal : model_.signals) {
      json_.begin_object().member("field", signal.filter);
      node("node", signal.node);
      json_.member("unit", symbol(signal.field->unit)).member("samples", signal.series.samples());
      json_.key("bins").begin_array();
      for (const Series::Bin& bin : signal.series.bins()) {
        json_.begin_array()
            .value(seconds_text(bin.time_ns))
            .raw(scaled_text(bin.minimum, signal.field->scale))
            .raw(scaled_text(bin.maximum, signal.field->scale))
            .end_array();
      }
      json_.end_array().end_object();
    }
    json_.end_array();
  }

  void rules() {
    json_.key("rules").begin_array();
    for (const RuleTotal& total : model_.rules) {
      json_.begin_object()
          .member("rule", rule_row(total.rule).id)
          .member("checked", total.checked)
          .member("findings", total.findings)
          .end_object();
    }
    json_.end_array();
  }

  const Model& model_;
  const replay::BusNames& buses_;
  const Settings& settings_;
  JsonWriter& json_;
};

}  // namespace

std::string json(std::span<const Built> captures, const Settings& settings) {
  std::string out;
  JsonWriter json(out, 1);
  json.begin_object().member("format", "servotrace-report").member("version", 1).key("captures").begin_array();
  for (const Built& built : captures) Writer(built, settings, json).write();
  json.end_array().end_object();
  out += '\n';
  return out;
}

}  // namespace servotrace::report
