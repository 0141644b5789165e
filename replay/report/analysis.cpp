// SPDX-License-Identifier: MIT
#include "replay/report/analysis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "decoder/findings/catalogue.hpp"
#include "decoder/render/message.hpp"
#include "decoder/render/node.hpp"
#include "decoder/render/value.hpp"
#include "replay/report/symptoms.hpp"

namespace servotrace::report {
namespace {

int fault_weight(RuleId id) {
  for (const FaultRule& row : kFaultRules) {
    if (rule_row(id).id == row.rule) return row.weight;
  }
  return 0;
}

bool same_node(const NodeRef& left, const NodeRef& right) {
  return left.bus == right.bus && left.mac_id == right.mac_id;
}

// A cause may lie at the node itself or at its bus as a whole.
bool can_concern(const Finding& cause, const Finding& fault) {
  if (same_node(cause.node, fault.node)) return true;
  return cause.node.bus == fault.node.bus && (cause.node.mac_id == kNoMacId || fault.node.mac_id == kNoMacId);
}

bool lies_before(const Finding& cause, const Finding& fault) {
  return cause.frame <= fault.frame && elapsed_ns(cause.last_time_ns, fault.time_ns) <= kCauseWindowNs;
}

// Violations that precede the fault where it happened, in the order of the file.
std::vector<std::size_t> preceding(const Model& model, std::size_t fault) {
  std::vector<std::size_t> result;
  const Finding& reported = model.findings[fault];
  for (std::size_t i = 0; i < model.findings.size(); ++i) {
    const Finding& finding = model.findings[i];
    if (i == fault || !can_concern(finding, reported) || !lies_before(finding, reported)) continue;
    if (rule_row(finding.rule).actor == Actor::kCapture || finding.severity == Severity::kNote) continue;
    result.push_back(i);
  }
  constexpr std::size_t kMost = 40;  // the nearest ones
  if (result.size() > kMost) result.erase(result.begin(), result.end() - kMost);
  return result;
}

void rank_causes(Model& model, Fault& fault) {
  const Finding& reported = model.findings[fault.finding];
  fault.causes.clear();
  const std::int64_t argument = fault.code_frame != 0 ? fault.code : reported.arguments[0];
  const std::string_view id = rule_row(reported.rule).id;
  std::set<std::size_t> used;
  const auto add = [&](Candidate candidate) {
    if (candidate.finding && !used.insert(*candidate.finding).second) return;
    fault.causes.push_back(std::move(candidate));
  };
  // The session itself named a cause: the drive's own answer to that act.
  if (reported.cause.frame != 0) {
    for (const std::size_t index : fault.preceding) {
      const Finding& finding = model.findings[index];
      if (finding.rule != reported.cause.rule || finding.frame > reported.frame ||
          finding.last_frame < reported.cause.frame)
        continue;
      add({.text = std::string(rule_row(finding.rule).title),
           .section = std::string(rule_row(finding.rule).section),
           .supported = true,
           .finding = index});
    }
  }
  for (const Symptom& symptom : kSymptoms) {
    if (symptom.rule != id || symptom.cause.empty()) continue;
    if (symptom.argument != kAny && symptom.argument != argument) continue;
    for (auto index = fault.preceding.rbegin(); index != fault.preceding.rend(); ++index) {
      if (rule_row(model.findings[*index].rule).id != symptom.cause) continue;
      add({.text = std::string(symptom.text),
           .section = std::string(symptom.section),
           .supported = true,
           .finding = *index});
      break;
    }
  }
  // Nothing explains it by the table: what the master did wrong just before is still worth a look.
  if (fault.causes.empty()) {
    for (auto index = fault.preceding.rbegin(); index != fault.preceding.rend() && fault.causes.size() < 3; ++index) {
      const Rule& row = rule_row(model.findings[*index].rule);
      if (row.actor == Actor::kDrive) continue;
      add({.text = fmt::format("{}; no table links it to this fault, it only came before it", row.title),
           .section = std::string(row.section),
           .supported = false,
           .finding = *index});
    }
  }
  for (const Symptom& symptom : kSymptoms) {
    if (symptom.rule != id || !symptom.cause.empty()) continue;
    if (symptom.argument != kAny && symptom.argument != argument) continue;
    add({.text = std::string(symptom.text),
         .section = std::string(symptom.section),
         .supported = false,
         .finding = std::nullopt});
  }
}

std::string capitalised(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

void list_limits(Model& model, const replay::BusNames& buses) {
  std::vector<std::string>& list = model.cannot_show;
  if (!model.capture.broken.empty())
    list.push_back(fmt::format("The file could not be read to its end: {}.", model.capture.broken));
  std::uint64_t lost = 0;
  std::uint64_t cut = 0;
  for (const Finding& finding : model.findings) {
    const std::string_view id = rule_row(finding.rule).id;
    if (id == "CP103") lost += finding.count;
    if (id == "CP101") cut += finding.count;
  }
  if (lost != 0)
    list.push_back(
        fmt::format("Records were lost in {} places while recording; across them nothing was compared and nothing is "
                    "blamed on the bus.",
                    lost));
  if (cut != 0)
    list.push_back(
        fmt::format("{} records were captured only in part; what their missing bytes said is unknown.", cut));
  if (model.capture.untracked_frames != 0)
    list.push_back(fmt::format("{} frames of interfaces or buses above the limit were not looked at.",
                               model.capture.untracked_frames));
  if (!model.capture.has_time)
    list.push_back("The capture has no timestamps: nothing that depends on time could be judged.");
  for (const BusSummary& bus : model.summary.buses) {
    const std::string_view name = buses.name(bus.bus);
    if (bus.sampled)
      list.push_back(fmt::format(
          "{} was sampled: the recorder did not take every cycle, and rules that need every cycle stayed silent.",
          name));
    if (bus.protocol == Protocol::kNone)
      list.push_back(
          fmt::format("{} is CAN without evidence of DeviceNet ({} frames): it was not checked.", name, bus.frames));
    for (const NodeSummary& node : bus.nodes) {
      std::string assumed;
      for (const Fact& fact : node.facts) {
        if (fact.basis.kind == BasisKind::kAssumed)
          assumed += fmt::format("{}{} = {}", assumed.empty() ? "" : ", ", fact.key, fact.value);
      }
      if (!assumed.empty())
        list.push_back(fmt::format("{} on {}: assumed, for neither settings nor capture say it: {}.",
                                   capitalised(node_text(node.node, node.name)), name, assumed));
    }
  }
  std::uint64_t never = 0;
  for (const RuleTotal& total : model.rules) never += total.checked == 0 ? 1 : 0;
  if (never != 0)
    list.push_back(fmt::format("{} of {} rules had no opportunity in this capture.", never, model.rules.size()));
  list.push_back(
      "What happened before the first and after the last frame, and whatever the drives did not report on the bus.");
}

}  // namespace

std::string who(const Finding& finding, const Settings& settings, const replay::BusNames& buses) {
  const std::string_view bus = buses.name(finding.node.bus);
  const std::string node = node_text(finding.node, configured_name(settings, finding.node));
  if (node.empty()) return bus.empty() ? "the capture" : std::string(bus);
  return buses.size() > 1 ? fmt::format("{} on {}", node, bus) : node;
}

std::string at_time(const Model& model, TimeNs time_ns) {
  if (!model.capture.has_time) return "an unknown time";
  return fmt::format("{:.6f} s", static_cast<double>(elapsed_ns(model.capture.first_ns, time_ns)) / 1e9);
}

bool is_alarm_without_code(const Finding& finding) {
  const std::string_view id = rule_row(finding.rule).id;
  return (id == "RX902" || id == "YS901") && finding.arguments[0] <= 0;
}

void rank_all_causes(Model& model) {
  for (Fault& fault : model.faults) rank_causes(model, fault);
}

void find_faults(Model& model, const Settings&, const replay::BusNames&) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < model.findings.size(); ++i) {
    // A state from before the capture is a note: it is told, but nothing in this capture failed with it.
    if (fault_weight(model.findings[i].rule) == 0 || model.findings[i].severity == Severity::kNote) continue;
    found.push_back(i);
  }
  // Stops and losses before refusals, each in the order of time; the first is what failed first.
  std::stable_sort(found.begin(), found.end(), [&model](std::size_t left, std::size_t right) {
    const int left_weight = fault_weight(model.findings[left].rule);
    const int right_weight = fault_weight(model.findings[right].rule);
    if (left_weight != right_weight) return left_weight > right_weight;
    return model.findings[left].frame < model.findings[right].frame;
  });
  if (found.size() > kMaxFaults) {
    model.more_faults = found.size() - kMaxFaults;
    found.resize(kMaxFaults);
  }
  for (const std::size_t index : found) {
    Fault fault;
    fault.finding = index;
    const Finding& finding = model.findings[index];
    fault.preceding = preceding(model, index);
    rank_causes(model, fault);
    // The close-up: from the earliest supported cause, but no less than a fifth of a second and no more than five.
    DurationNs before = kSecondNs / 5;
    for (const Candidate& cause : fault.causes) {
      if (!cause.finding) continue;
      before = std::max(before, elapsed_ns(model.findings[*cause.finding].time_ns, finding.time_ns) * 5 / 4);
    }
    before = std::min(before, 5 * kSecondNs);
    fault.window_begin_ns = finding.time_ns - before;
    fault.window_end_ns = finding.time_ns + before / 3;
    model.faults.push_back(std::move(fault));
  }
}

void judge(Model& model, const Settings& settings, const replay::BusNames& buses) {
  Verdict& verdict = model.verdict;
  std::array<std::uint64_t, 3> by_severity{};
  for (const Finding& finding : model.findings) ++by_severity[static_cast<std::size_t>(finding.severity)];
  const std::uint64_t errors = by_severity[2];
  const std::uint64_t warnings = by_severity[1];
  if (model.capture.checked_frames == 0) {
    verdict.kind = VerdictKind::kNothingChecked;
    verdict.headline = "Nothing was checked: the capture holds no frame of a known bus.";
    verdict.sentences.push_back(
        "RTEX is recorded as servotrace RTEX records; CAN counts as DeviceNet where the traffic shows it, or with "
        "--devicenet.");
  } else if (!model.faults.empty()) {
    verdict.kind = VerdictKind::kFault;
    const Fault& first = model.faults.front();
    const Finding& finding = model.findings[first.finding];
    const std::string name = who(finding, settings, buses);
    verdict.headline = fmt::format("{} failed first, {} after the start (frame {}): {}.", capitalised(name),
                                   at_time(model, finding.time_ns), finding.frame, message(finding));
    if (first.code_frame != 0) {
      verdict.sentences.push_back(fmt::format("The drive was asked afterwards and answered alarm {} (frame {}).",
                                              first.code_text, first.code_frame));
    }
    const auto supported =
        std::find_if(first.causes.begin(), first.causes.end(), [](const Candidate& cause) { return cause.supported; });
    if (supported != first.causes.end() && supported->finding) {
      const Finding& cause = model.findings[*supported->finding];
      verdict.sentences.push_back(
          fmt::format("The likely cause: {} ({}). Evidence: {} at {}, frame {}, {} before the fault: {}.",
                      supported->text, supported->section, rule_row(cause.rule).id, who(cause, settings, buses),
                      cause.frame, duration_text(elapsed_ns(cause.time_ns, finding.time_ns)), message(cause)));
    } else {
      verdict.sentences.push_back(
          "Nothing this program checks was wrong on the bus before it, so the capture does not show the cause.");
      for (const Candidate& cause : first.causes) {
        if (cause.supported || cause.finding) continue;
        verdict.sentences.push_back(
            fmt::format("Possible, but not shown by the capture: {} ({}).", cause.text, cause.section));
      }
    }
    if (model.faults.size() > 1 || model.more_faults != 0) {
      verdict.sentences.push_back(
          fmt::format("{} more faults and refusals are described below.", model.faults.size() - 1 + model.more_faults));
    }
  } else if (errors + warnings != 0) {
    verdict.kind = VerdictKind::kViolations;
    const auto first = std::find_if(model.findings.begin(), model.findings.end(), [errors](const Finding& finding) {
      return finding.severity == (errors != 0 ? Severity::kError : Severity::kWarning);
    });
    verdict.headline =
        fmt::format("No drive reported a fault, but the capture holds {} errors and {} warnings.", errors, warnings);
    verdict.sentences.push_back(fmt::format("The first {}: {} at {}, {} after the start (frame {}): {}.",
                                            name_of(first->severity), rule_row(first->rule).id,
                                            who(*first, settings, buses), at_time(model, first->time_ns), first->frame,
                                            message(*first)));
  } else {
    verdict.kind = VerdictKind::kClean;
    verdict.headline = "Nothing failed, and no rule was broken in this capture.";
    if (by_severity[0] != 0) verdict.sentences.push_back(fmt::format("{} notes are listed below.", by_severity[0]));
  }
  list_limits(model, buses);
}

}  // namespace servotrace::report
