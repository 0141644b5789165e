// SPDX-License-Identifier: MIT
// From findings to faults and their causes.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "decoder/findings/catalogue.hpp"
#include "decoder/render/value.hpp"
#include "replay/report/analysis.hpp"
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

// A report of these rules waits for the code, which the drive is asked for; they name the frame in which it rose.
bool waits_for_code(const Finding& finding) {
  const std::string_view id = rule_row(finding.rule).id;
  return id == "YS901" || id == "YS905";
}

std::uint64_t began_frame(const Finding& finding) {
  return waits_for_code(finding) && finding.related[0] != 0 ? finding.related[0] : finding.frame;
}

// Nothing was said for too long: related[0] is the last message before.
bool is_silence(const Finding& finding) { return rule_row(finding.rule).id == "DN204"; }

// Violations that precede the fault where it happened, in the order of the file.
std::vector<std::size_t> preceding(const Model& model, const Fault& fault) {
  std::vector<std::size_t> result;
  const Finding& reported = model.findings[fault.finding];
  for (std::size_t i = 0; i < model.findings.size(); ++i) {
    const Finding& finding = model.findings[i];
    if (finding.frame > fault.frame) break;  // they are sorted
    if (i == fault.finding || !can_concern(finding, reported)) continue;
    if (elapsed_ns(finding.last_time_ns, fault.time_ns) > kCauseWindowNs) continue;
    if (finding.actor == Actor::kCapture || finding.severity == Severity::kNote) continue;
    result.push_back(i);
  }
  constexpr std::size_t kMost = 40;  // the nearest ones
  if (result.size() > kMost) result.erase(result.begin(), result.end() - kMost);
  return result;
}

// The number a symptom row is looked up by.
std::int64_t code_of(const Fault& fault, const Finding& reported) {
  return fault.code_frame != 0 ? fault.code : reported.arguments[0];
}

class Ranking {
 public:
  Ranking(const Model& model, Fault& fault)
      : model_(model),
        fault_(fault),
        reported_(model.findings[fault.finding]),
        id_(rule_row(reported_.rule).id),
        code_(code_of(fault, reported_)) {}

  void run() {
    fault_.causes.clear();
    ring_place();
    named_by_session();
    by_table();
    overwritten();
    if (fault_.causes.empty()) merely_before();
    only_possible();
    fault_.advice = advice_for(reported_, code_, sub_);
  }

 private:
  void add(Candidate candidate) {
    if (candidate.finding && !used_.insert(*candidate.finding).second) return;
    fault_.causes.push_back(std::move(candidate));
  }
  const Rule& row_of(std::size_t index) const { return rule_row(model_.findings[index].rule); }

  // The session itself named a cause: the drive's own answer to that act.
  void named_by_session() {
    if (reported_.cause.frame == 0) return;
    for (const std::size_t index : fault_.preceding) {
      const Finding& finding = model_.findings[index];
      if (finding.rule != reported_.cause.rule || finding.frame > fault_.frame ||
          finding.last_frame < reported_.cause.frame)
        continue;
      std::string text(rule_row(finding.rule).title);
      std::string section(rule_row(finding.rule).section);
      for (const Symptom& symptom : kSymptoms) {  // in the table's words where it has some
        if (symptom.rule != id_ || symptom.cause != rule_row(finding.rule).id || !fits(symptom.argument)) continue;
        text = symptom.text;
        section = symptom.section;
        break;
      }
      add({.text = std::move(text), .section = std::move(section), .supported = true, .finding = index, .access = {}});
    }
  }

  bool fits(std::int64_t argument) const { return argument == kAny || argument == code_; }

  void by_table() {
    for (const Symptom& symptom : kSymptoms) {
      if (symptom.rule != id_ || symptom.cause.empty() || !fits(symptom.argument)) continue;
      std::optional<std::size_t> evidence;
      if (symptom.cause == id_) evidence = fault_.finding;
      for (const std::size_t index : fault_.preceding) {
        if (!evidence && row_of(index).id == symptom.cause) evidence = index;
      }
      if (!evidence) continue;
      if (sub_ < 0) sub_ = symptom.sub;
      add({.text = std::string(symptom.text),
           .section = std::string(symptom.section),
           .supported = true,
           .finding = evidence,
           .access = {}});
    }
  }

  // CRC errors say where in the ring the cable is bad: every drive checks the data for itself.
  void ring_place() {
    if (reported_.node.protocol != Protocol::kRtex ||
        (id_ != "RX110" && id_ != "RX101" && (id_ != "RX902" || code_ != 83)))
      return;
    std::set<std::int16_t> hit;
    std::optional<std::size_t> first;
    for (std::size_t i = 0; i < model_.findings.size(); ++i) {
      const Finding& finding = model_.findings[i];
      if (rule_row(finding.rule).id != "RX101" || !(finding.node.bus == reported_.node.bus)) continue;
      hit.insert(finding.node.mac_id);
      if (!first && finding.node.mac_id == reported_.node.mac_id && i != fault_.finding) first = i;
    }
    std::size_t drives = 0;
    for (const BusSummary& bus : model_.summary.buses) {
      if (bus.bus == reported_.node.bus) drives = bus.nodes.size();
    }
    if (!first || hit.size() != 1 || drives < 2) return;
    add({.text =
             fmt::format("only place {} of the {} of this ring saw CRC errors: the cable or connector before it, or "
                         "noise there, rather than the master or the whole ring",
                         reported_.node.place + 1, drives),
         .section = "SX-DSV02203 8-1-2",
         .supported = true,
         .finding = first,
         .access = {}});
  }

  // Parameters act until they are written again: the whole capture before the fault counts.
  void overwritten() {
    for (const ParameterSymptom& symptom : kParameterSymptoms) {
      if (symptom.rule != id_ || !fits(symptom.argument)) continue;
      std::optional<std::size_t> latest;
      for (std::size_t i = 0; i < model_.accesses.size(); ++i) {
        const Access& access = model_.accesses[i];
        if (access.frame >= fault_.frame) break;
        if (same_node(access.node, reported_.node) && access.changes() && access.what.starts_with(symptom.parameter) &&
            written_.count(i) == 0)
          latest = i;
      }
      if (!latest) continue;
      written_.insert(*latest);
      // A row that names the parameter explains the fault; that some parameter was changed is only worth a look.
      add({.text = std::string(symptom.text),
           .section = std::string(symptom.section),
           .supported = !symptom.parameter.empty(),
           .finding = {},
           .access = latest});
    }
  }

  // Nothing explains it by the table: what was done wrong just before is still worth a look.
  void merely_before() {
    for (auto index = fault_.preceding.rbegin(); index != fault_.preceding.rend() && fault_.causes.size() < 3;
         ++index) {
      if (model_.findings[*index].actor == Actor::kDrive) continue;
      add({.text = fmt::format("{}; no table links it to this fault, it only came before it", row_of(*index).title),
           .section = std::string(row_of(*index).section),
           .supported = false,
           .finding = *index,
           .access = {}});
    }
  }

  void only_possible() {
    for (const Symptom& symptom : kSymptoms) {
      if (symptom.rule != id_ || !symptom.cause.empty() || !fits(symptom.argument)) continue;
      add({.text = std::string(symptom.text),
           .section = std::string(symptom.section),
           .supported = false,
           .finding = {},
           .access = {}});
    }
  }

  const Model& model_;
  Fault& fault_;
  const Finding& reported_;
  std::string_view id_;
  std::int64_t code_;
  std::int64_t sub_ = -1;  // the evidence points at this sub number
  std::set<std::size_t> used_;
  std::set<std::size_t> written_;
};

bool is_supported_by(const Fault& fault, std::size_t finding) {
  return std::any_of(fault.causes.begin(), fault.causes.end(),
                     [finding](const Candidate& cause) { return cause.supported && cause.finding == finding; });
}

// Some report of the same rule and node as `finding` explains the fault.
bool is_kind_of_cause(const Model& model, const Fault& fault, const Finding& finding) {
  return std::any_of(fault.causes.begin(), fault.causes.end(), [&](const Candidate& cause) {
    if (!cause.supported || !cause.finding) return false;
    const Finding& shown = model.findings[*cause.finding];
    return shown.rule == finding.rule && same_node(shown.node, finding.node);
  });
}

// Refusals and single reports that explain a graver fault are told there, not as faults of their own; and every fault
// names those it led to.
void link_faults(Model& model) {
  std::vector<Fault>& faults = model.faults;
  std::vector<Fault> kept;
  for (const Fault& fault : faults) {
    const Finding& finding = model.findings[fault.finding];
    const bool told_there =
        fault_weight(finding.rule) < 2 && std::any_of(faults.begin(), faults.end(), [&](const Fault& other) {
          return fault_weight(model.findings[other.finding].rule) == 2 && is_kind_of_cause(model, other, finding);
        });
    if (!told_there) kept.push_back(fault);
  }
  faults = std::move(kept);
  for (std::size_t i = 0; i < faults.size(); ++i) {
    for (std::size_t later = 0; later < faults.size(); ++later) {
      if (later != i && is_supported_by(faults[later], faults[i].finding)) faults[i].followers.push_back(later);
    }
  }
}

}  // namespace

bool is_alarm_without_code(const Finding& finding) {
  const std::string_view id = rule_row(finding.rule).id;
  return (id == "RX902" || id == "YS901") && finding.arguments[0] <= 0;
}

void rank_all_causes(Model& model) {
  for (Fault& fault : model.faults) Ranking(model, fault).run();
  link_faults(model);
}

void find_faults(Model& model, const FrameTimes& times) {
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
    return began_frame(model.findings[left]) < began_frame(model.findings[right]);
  });
  if (found.size() > kMaxFaults) {
    model.more_faults = found.size() - kMaxFaults;
    found.resize(kMaxFaults);
  }
  for (const std::size_t index : found) {
    Fault fault;
    fault.finding = index;
    const Finding& finding = model.findings[index];
    fault.frame = began_frame(finding);
    fault.time_ns = fault.frame == finding.frame ? finding.time_ns : times.at(fault.frame, finding.time_ns);
    fault.preceding = preceding(model, fault);
    Ranking(model, fault).run();
    // The close-up: from the earliest supported cause or, of a silence, from the last message before it; but no less
    // than a fifth of a second and no more than five.
    DurationNs before = kSecondNs / 5;
    if (is_silence(finding)) {
      const TimeNs last_ns = times.at(finding.related[0], finding.time_ns);
      before = std::max(before, elapsed_ns(last_ns, fault.time_ns) * 5 / 4);
    }
    for (const Candidate& cause : fault.causes) {
      if (!cause.finding) continue;
      before = std::max(before, elapsed_ns(model.findings[*cause.finding].time_ns, fault.time_ns) * 5 / 4);
    }
    before = std::min(before, 5 * kSecondNs);
    fault.window_begin_ns = std::max(fault.time_ns - before, model.capture.first_ns);
    fault.window_end_ns = std::min(fault.time_ns + before / 3, model.capture.last_ns);
    model.faults.push_back(std::move(fault));
  }
}

}  // namespace servotrace::report
