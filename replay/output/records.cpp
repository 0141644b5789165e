// SPDX-License-Identifier: MIT
#include "replay/output/records.hpp"

#include <fmt/format.h>

#include "decoder/render/value.hpp"

namespace servotrace::replay {
namespace {

void write_text_or_null(JsonWriter& json, std::string_view key, std::string_view text) {
  json.key(key);
  if (text.empty()) {
    json.null();
  } else {
    json.value(text);
  }
}

void write_name(JsonWriter& json, const NodeName& node) {
  json.begin_object();
  write_text_or_null(json, "bus", node.bus);
  write_text_or_null(json, "protocol", node.protocol);
  json.key("mac_id");
  if (node.mac_id) {
    json.value(*node.mac_id);
  } else {
    json.null();
  }
  write_text_or_null(json, "name", node.name);
  if (!node.channel.empty()) json.member("channel", node.channel);
  json.end_object();
}

void write_basis(JsonWriter& json, const Basis& basis) {
  if (basis.kind == BasisKind::kNone) return;
  json.key("basis").begin_object();
  constexpr std::string_view kNames[] = {"", "configured", "capture", "assumed"};
  json.member("kind", kNames[static_cast<unsigned>(basis.kind)]);
  if (basis.kind == BasisKind::kCapture) json.member("frame", basis.frame);
  json.end_object();
}

void write_time(JsonWriter& json, std::string_view key, const std::optional<TimeNs>& time_ns) {
  json.key(key);
  if (time_ns) {
    json.value(seconds_text(*time_ns));
  } else {
    json.null();
  }
}

}  // namespace

void write_capture(JsonWriter& json, const CaptureRecord& capture) {
  json.member("file", capture.file);
  write_text_or_null(json, "format", capture.format);
  json.key("link_types").begin_array();
  for (const std::uint16_t type : capture.link_types) json.value(unsigned{type});
  json.end_array();
  json.member("frames", capture.frames);
  json.member("checked_frames", capture.checked_frames);
  write_time(json, "first_time", capture.first_time_ns);
  write_time(json, "last_time", capture.last_time_ns);
  if (!capture.error.empty()) json.member("error", capture.error);
  if (capture.suppressed != 0) json.member("suppressed", capture.suppressed);
  if (capture.baselined != 0) json.member("baselined", capture.baselined);
  json.member("errors", capture.counts.errors);
  json.member("warnings", capture.counts.warnings);
  json.member("notes", capture.counts.notes);
  json.member("status", capture.status);
}

void write_node(JsonWriter& json, const NodeRecord& node) {
  json.key("node");
  write_name(json, node.node);
  write_text_or_null(json, "protocol", node.node.protocol);
  write_text_or_null(json, "profile", node.profile);
  write_text_or_null(json, "name", node.node.name);
  write_text_or_null(json, "recognised", node.recognised);
  if (!node.node.mac_id) {
    json.member("frames", node.frames);
    if (node.sampled) json.member("sampled", true);
  }
  json.key("settings").begin_array();
  for (const Fact& fact : node.settings) {
    json.begin_object().member("key", fact.key).member("value", fact.value);
    write_basis(json, fact.basis);
    json.end_object();
  }
  json.end_array();
}

void write_statistic(JsonWriter& json, const StatisticRecord& statistic) {
  json.key("node");
  write_name(json, statistic.node);
  const Statistic& values = statistic.values;
  json.member("key", values.key);
  json.member("count", values.count);
  json.member("minimum_ns", values.minimum_ns);
  json.key("mean_ns").raw(fmt::format("{:.1f}", values.mean_ns));
  json.member("percentile_99_ns", values.percentile_99_ns);
  json.member("maximum_ns", values.maximum_ns);
}

void write_finding(JsonWriter& json, const FindingRecord& finding) {
  const Rule& row = finding.row();
  json.member("rule", row.id);
  json.member("slug", row.slug);
  json.member("severity", name_of(finding.severity));
  json.member("actor", name_of(finding.actor));
  json.key("node");
  write_name(json, finding.node);
  json.member("frame", finding.frame);
  json.member("last_frame", finding.last_frame);
  json.member("count", finding.count);
  json.member("time", seconds_text(finding.time_ns));
  json.member("message", finding.message);
  json.key("related").begin_array();
  for (const std::uint64_t frame : finding.related) json.value(frame);
  json.end_array();
  if (finding.cause.frame != 0) {
    json.key("cause").begin_object();
    json.member("rule", rule_row(finding.cause.rule).id).member("frame", finding.cause.frame).end_object();
  }
  write_basis(json, finding.basis);
  if (finding.place.length != 0) {
    json.member("byte_offset", finding.place.offset);
    json.member("byte_length", std::uint64_t{finding.place.length});
  }
  if (finding.evidence.empty()) return;
  json.key("evidence").begin_array();
  for (const EvidenceLine& line : finding.evidence) {
    json.begin_object().member("frame", line.frame).member("time", seconds_text(line.time_ns));
    json.member("text", line.text).end_object();
  }
  json.end_array();
}

void write_rule(JsonWriter& json, const RuleRecord& rule) {
  json.member("rule", rule_row(rule.rule).id);
  json.member("checked", rule.checked);
  json.member("findings", rule.findings);
}

void write_end(JsonWriter& json, const RunTotals& totals) {
  json.member("verdict", totals.verdict());
  json.member("errors", totals.counts.errors);
  json.member("warnings", totals.counts.warnings);
  json.member("notes", totals.counts.notes);
  json.member("captures", totals.captures);
  json.member("exit_status", totals.status);
}

}  // namespace servotrace::replay
