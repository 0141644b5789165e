// SPDX-License-Identifier: MIT
#include "replay/results_reader.hpp"

#include <fmt/format.h>

#include <charconv>
#include <nlohmann/json.hpp>

#include "replay/command_line.hpp"
#include "replay/exit_status.hpp"

namespace servotrace::replay {
namespace {

using nlohmann::json;

// Members of an object; what is missing or of another type is at its default.
std::string text_of(const json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}
std::uint64_t number_of(const json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number_unsigned() ? found->get<std::uint64_t>() : 0;
}
std::int64_t signed_of(const json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number_integer() ? found->get<std::int64_t>() : 0;
}
const json& member(const json& object, const char* key) {
  static const json kNull;
  const auto found = object.find(key);
  return found != object.end() ? *found : kNull;
}

// "12.000000001" to nanoseconds.
std::optional<TimeNs> time_of(const json& object, const char* key) {
  const std::string text = text_of(object, key);
  const std::size_t dot = text.find('.');
  if (dot == std::string::npos || text.size() - dot != 10) return {};
  std::string digits = text;
  digits.erase(dot, 1);
  TimeNs value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size()) return {};
  return value;
}

NodeName node_of(const json& object) {
  NodeName node;
  const json& source = member(object, "node");
  if (!source.is_object()) return node;
  node.bus = text_of(source, "bus");
  node.protocol = text_of(source, "protocol");
  node.name = text_of(source, "name");
  node.channel = text_of(source, "channel");
  const json& mac_id = member(source, "mac_id");
  if (mac_id.is_number_unsigned() && mac_id.get<std::uint64_t>() < 64) node.mac_id = mac_id.get<int>();
  return node;
}

Basis basis_of(const json& object) {
  const json& source = member(object, "basis");
  if (!source.is_object()) return {};
  const std::string kind = text_of(source, "kind");
  if (kind == "configured") return {BasisKind::kConfigured, 0};
  if (kind == "capture") return {BasisKind::kCapture, number_of(source, "frame")};
  return {kind == "assumed" ? BasisKind::kAssumed : BasisKind::kNone, 0};
}

std::optional<RuleId> rule_of(const json& object) {
  const std::size_t index = find_rule(text_of(object, "rule"));
  if (index == kRuleCount) return {};
  return static_cast<RuleId>(index);
}

CaptureRecord capture_of(const json& line) {
  CaptureRecord capture;
  capture.file = text_of(line, "file");
  capture.format = text_of(line, "format");
  for (const json& type : member(line, "link_types")) {
    if (type.is_number_unsigned()) capture.link_types.push_back(type.get<std::uint16_t>());
  }
  capture.frames = number_of(line, "frames");
  capture.checked_frames = number_of(line, "checked_frames");
  capture.first_time_ns = time_of(line, "first_time");
  capture.last_time_ns = time_of(line, "last_time");
  capture.error = text_of(line, "error");
  capture.suppressed = number_of(line, "suppressed");
  capture.baselined = number_of(line, "baselined");
  capture.counts = {number_of(line, "errors"), number_of(line, "warnings"), number_of(line, "notes")};
  capture.status = static_cast<int>(std::min<std::uint64_t>(number_of(line, "status"), kExitNothing));
  return capture;
}

FindingRecord finding_of(const json& line, RuleId rule) {
  FindingRecord finding;
  finding.rule = rule;
  finding.severity = severity_of(text_of(line, "severity")).value_or(rule_row(rule).severity);
  finding.actor = actor_of(text_of(line, "actor")).value_or(rule_row(rule).actor);
  finding.node = node_of(line);
  finding.frame = number_of(line, "frame");
  finding.last_frame = number_of(line, "last_frame");
  finding.count = number_of(line, "count");
  finding.time_ns = time_of(line, "time").value_or(0);
  finding.message = text_of(line, "message");
  for (const json& frame : member(line, "related")) {
    if (frame.is_number_unsigned()) finding.related.push_back(frame.get<std::uint64_t>());
  }
  if (const json& cause = member(line, "cause"); cause.is_object()) {
    if (const auto cause_rule = rule_of(cause)) finding.cause = {*cause_rule, number_of(cause, "frame")};
  }
  finding.basis = basis_of(line);
  finding.place = {finding.frame, number_of(line, "byte_offset"),
                   static_cast<std::uint32_t>(number_of(line, "byte_length"))};
  for (const json& entry : member(line, "evidence")) {
    if (entry.is_object())
      finding.evidence.push_back(
          {number_of(entry, "frame"), time_of(entry, "time").value_or(0), text_of(entry, "text")});
  }
  return finding;
}

NodeRecord node_record_of(const json& line) {
  NodeRecord node;
  node.node = node_of(line);
  node.profile = text_of(line, "profile");
  node.recognised = text_of(line, "recognised");
  node.frames = number_of(line, "frames");
  node.sampled = member(line, "sampled") == true;
  for (const json& fact : member(line, "settings")) {
    if (fact.is_object()) node.settings.push_back({text_of(fact, "key"), text_of(fact, "value"), basis_of(fact)});
  }
  return node;
}

StatisticRecord statistic_of(const json& line) {
  StatisticRecord record;
  record.node = node_of(line);
  record.values.key = text_of(line, "key");
  record.values.count = number_of(line, "count");
  record.values.minimum_ns = signed_of(line, "minimum_ns");
  record.values.maximum_ns = signed_of(line, "maximum_ns");
  record.values.percentile_99_ns = signed_of(line, "percentile_99_ns");
  if (const json& mean = member(line, "mean_ns"); mean.is_number()) record.values.mean_ns = mean.get<double>();
  return record;
}

}  // namespace

Error ResultsReader::wrong(std::string what) const {
  return Error{fmt::format("{}:{}", origin_, line_), std::move(what)};
}

Result<ResultsReader::Line> ResultsReader::take(std::string_view text) {
  ++line_;
  if (text.empty()) return Line::kMore;
  const json line = json::parse(text, nullptr, false);
  if (line.is_discarded() || !line.is_object())
    return wrong("is no JSON object: only results of '--output jsonl' merge");
  const std::string type = text_of(line, "type");
  if (type == "end") {
    status_ =
        worse_status(status_, static_cast<int>(std::min<std::uint64_t>(number_of(line, "exit_status"), kExitNothing)));
    ended_ = true;
    return Line::kEnd;
  }
  if (type == "capture") {
    capture_ = capture_of(line);
    has_capture_ = true;
    return Line::kCapture;
  }
  if (!has_capture_ || capture_.file != text_of(line, "file")) {
    return wrong("stands behind no 'capture' line of its file");
  }
  const std::optional<RuleId> rule = rule_of(line);
  if ((type == "finding" || type == "rule") && !rule) {
    return wrong(fmt::format("rule '{}' is not known to this version", text_of(line, "rule")));
  }
  if (type == "finding") capture_.findings.push_back(finding_of(line, *rule));
  if (type == "rule") capture_.rules.push_back({*rule, number_of(line, "checked"), number_of(line, "findings")});
  if (type == "node") capture_.nodes.push_back(node_record_of(line));
  if (type == "statistic") capture_.statistics.push_back(statistic_of(line));
  return Line::kMore;
}

Result<void> ResultsReader::finish() const {
  if (!ended_) return Error{origin_, "has no 'end' line: the check that wrote it did not finish"};
  return {};
}

}  // namespace servotrace::replay
