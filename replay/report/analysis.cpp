// SPDX-License-Identifier: MIT
// The verdict: what failed first, when, with what, and what the evidence says preceded it.
#include <fmt/format.h>

#include <algorithm>

#include "decoder/findings/catalogue.hpp"
#include "decoder/render/message.hpp"
#include "decoder/render/node.hpp"
#include "decoder/render/value.hpp"
#include "replay/report/analysis.hpp"

namespace servotrace::report {
namespace {

// The rules of a drive are off where the drive is unknown or only guessed.
bool judged_as_drive(const BusSummary& bus, const NodeSummary& node) {
  if (bus.protocol != Protocol::kDevicenet) return true;  // every axis of a ring is taken for a MINAS A5N
  return is_judged_as_drive(node.profile, node.recognised);
}

class Judge {
 public:
  Judge(Model& model, const Settings& settings, const replay::BusNames& buses)
      : model_(model), settings_(settings), buses_(buses), verdict_(model.verdict) {
    for (const Finding& finding : model.findings) ++by_severity_[static_cast<std::size_t>(finding.severity)];
  }

  void run() {
    if (model_.capture.checked_frames == 0) {
      verdict_.kind = VerdictKind::kNothingChecked;
      verdict_.headline = "Nothing was checked: the capture holds no frame of a known bus.";
      say("RTEX is recorded as servotrace RTEX records; CAN counts as DeviceNet where the traffic shows it, or with "
          "--devicenet.");
    } else if (!model_.faults.empty()) {
      failed();
    } else if (by_severity_[2] + by_severity_[1] != 0) {
      violated();
    } else {
      verdict_.kind = VerdictKind::kClean;
      const std::string drives = unjudged_drives();
      verdict_.headline =
          fmt::format("Nothing failed, and no rule was broken in this capture{}{}.",
                      drives.empty() ? "" : "; what the drive itself reports was not judged of ", drives);
      if (by_severity_[0] != 0)
        say(fmt::format("{} listed below.", plural(by_severity_[0], "note") + (by_severity_[0] == 1 ? " is" : " are")));
      if (!drives.empty()) say("The profile of a drive is named in servotrace.toml, or read from its Identity object.");
    }
  }

 private:
  void say(std::string sentence) { verdict_.sentences.push_back(std::move(sentence)); }
  std::string name(const Finding& finding) const { return who(finding, settings_, buses_); }

  // A clean verdict must not stand for a drive nobody looked into.
  std::string unjudged_drives() const {
    std::string nodes;
    for (const BusSummary& bus : model_.summary.buses) {
      for (const NodeSummary& node : bus.nodes) {
        if (!judged_as_drive(bus, node))
          nodes += fmt::format("{}{}", nodes.empty() ? "" : ", ", node_text(node.node, node.name));
      }
    }
    return nodes;
  }

  void failed() {
    verdict_.kind = VerdictKind::kFault;
    const Fault& first = model_.faults.front();
    const Finding& finding = model_.findings[first.finding];
    verdict_.first = first.finding;
    verdict_.headline = fmt::format("{} failed first, {} after the start (frame {}): {}.", capitalised(name(finding)),
                                    at_time(model_, first.time_ns), first.frame, fault_text(model_, first));
    if (first.code_frame != 0)
      say(fmt::format("The code was read out of the drive afterwards, in frame {}.", first.code_frame));
    if (first.frame != finding.frame && !is_alarm_without_code(finding))
      say(fmt::format("It was reported {} later, when the drive was asked for the code, in frame {}.",
                      duration_text(elapsed_ns(first.time_ns, finding.time_ns)), finding.frame));
    alarm_state(first);
    const auto cause =
        std::find_if(first.causes.begin(), first.causes.end(), [](const Candidate& entry) { return entry.supported; });
    if (cause != first.causes.end()) {
      verdict_.cause = *cause;
      say(fmt::format("The likely cause: {} ({}).", cause->text, cause->section));
      if (const std::string text = evidence(*cause, first); !text.empty()) say(text);
    } else {
      say("No violation the symptom table knows preceded it: the capture does not show the cause.");
      for (const Candidate& entry : first.causes) possible(entry, first);
    }
    for (const std::size_t follower : first.followers) {
      const Fault& fault = model_.faults[follower];
      const Finding& later = model_.findings[fault.finding];
      say(fmt::format("It led to: {}, {} later (frame {}): {}.", name(later),
                      duration_text(elapsed_ns(first.time_ns, fault.time_ns)), fault.frame, fault_text(model_, fault)));
    }
    if (const std::size_t others = model_.faults.size() - 1 - first.followers.size() + model_.more_faults; others != 0)
      say(fmt::format("{} described below.",
                      others == 1 ? "1 more fault is" : fmt::format("{} more faults are", others)));
  }

  // A fault that shows in a message only later (a code that had to be asked for) may have shown as a state before.
  void alarm_state(const Fault& fault) {
    const Event* risen = nullptr;
    const NodeRef& node = model_.findings[fault.finding].node;
    for (const StateTrack& track : model_.tracks) {
      if (!(track.node.bus == node.bus) || track.node.mac_id != node.mac_id || track.field->key != "alarm") continue;
      for (const Event& event : track.changes) {
        if (event.frame <= fault.frame) risen = event.after != 0 ? &event : nullptr;
      }
    }
    if (risen == nullptr || risen->frame == fault.frame) return;
    say(fmt::format("Its state {} had risen {} before, in frame {}.", risen->field->label,
                    duration_text(elapsed_ns(risen->time_ns, fault.time_ns)), risen->frame));
  }

  // The sentence that proves a cause; empty where the fault proves it itself.
  std::string evidence(const Candidate& cause, const Fault& fault) const {
    if (cause.access) {
      const Access& access = model_.accesses[*cause.access];
      return fmt::format("Evidence: {} was written in frame {}, {} before the fault: {} became {}.", access.what,
                         access.frame, duration_text(elapsed_ns(access.time_ns, fault.time_ns)), access.before,
                         access.value);
    }
    if (!cause.finding) return {};
    const Finding& shown = model_.findings[*cause.finding];
    if (*cause.finding == fault.finding) return {};
    return fmt::format("Evidence: {} at {}, frame {}, {} before the fault: {}{}.", rule_row(shown.rule).id, name(shown),
                       shown.frame, duration_text(elapsed_ns(shown.time_ns, fault.time_ns)), message(shown),
                       shown.count > 1 ? fmt::format(" ({} times up to frame {})", shown.count, shown.last_frame) : "");
  }

  void possible(const Candidate& cause, const Fault& fault) {
    const std::string text = evidence(cause, fault);
    say(fmt::format("Possible, but not shown by the capture: {} ({}).{}{}", cause.text, cause.section,
                    text.empty() ? "" : " ", text));
  }

  void violated() {
    verdict_.kind = VerdictKind::kViolations;
    const Severity worst = by_severity_[2] != 0 ? Severity::kError : Severity::kWarning;
    const auto first = std::find_if(model_.findings.begin(), model_.findings.end(),
                                    [worst](const Finding& finding) { return finding.severity == worst; });
    const Rule& row = rule_row(first->rule);
    verdict_.first = static_cast<std::size_t>(first - model_.findings.begin());
    verdict_.headline =
        fmt::format("No drive reported a fault. The first {}: {}, {} after the start (frame {}): {}.", name_of(worst),
                    name(*first), at_time(model_, first->time_ns), first->frame, message(*first));
    verdict_.cause = Candidate{.text = std::string(row.title),
                               .section = std::string(row.section),
                               .supported = true,
                               .finding = verdict_.first,
                               .access = {}};
    say(fmt::format("{}: {} ({}). {}", row.id, row.title, row.section, row.why));
    say(fmt::format("The capture holds {} and {} in all.", plural(by_severity_[2], "error"),
                    plural(by_severity_[1], "warning")));
  }

  Model& model_;
  const Settings& settings_;
  const replay::BusNames& buses_;
  Verdict& verdict_;
  std::array<std::uint64_t, 3> by_severity_{};
};

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
        fmt::format("Records were lost in {} while recording; across them nothing was compared and nothing is "
                    "blamed on the bus.",
                    plural(lost, "place")));
  if (cut != 0)
    list.push_back(fmt::format("{} captured only in part; what the missing bytes said is unknown.",
                               cut == 1 ? "1 record was" : fmt::format("{} records were", cut)));
  if (model.capture.untracked_frames != 0)
    list.push_back(fmt::format("Not looked at, of interfaces or buses above the limit: {}.",
                               plural(model.capture.untracked_frames, "frame")));
  if (!model.capture.has_time)
    list.push_back("The capture has no timestamps: nothing that depends on time could be judged.");
  for (const BusSummary& bus : model.summary.buses) {
    const std::string_view name = buses.name(bus.bus);
    if (bus.sampled)
      list.push_back(fmt::format(
          "{} was sampled: the recorder did not take every cycle, and rules that need every cycle stayed silent.",
          name));
    if (bus.protocol == Protocol::kNone)
      list.push_back(fmt::format("{} is CAN without evidence of DeviceNet ({}): it was not checked.", name,
                                 plural(bus.frames, "frame")));
    for (const NodeSummary& node : bus.nodes) {
      if (!judged_as_drive(bus, node))
        list.push_back(fmt::format(
            "{} on {}: {}; no rule of a drive was applied to it.", capitalised(node_text(node.node, node.name)), name,
            node.recognised.empty() ? "its drive is not known" : node.profile + ", " + node.recognised));
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

std::string plural(std::uint64_t count, std::string_view word) {
  return fmt::format("{} {}{}", count, word, count == 1 ? "" : "s");
}

std::string capitalised(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

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

std::string fault_text(const Model& model, const Fault& fault) {
  const Finding& finding = model.findings[fault.finding];
  const bool named = !fault.advice.empty() && (fault.advice.size() == 1 || fault.advice.front().likeliest);
  const bool is_alarm = rule_row(finding.rule).id == "YS901" || rule_row(finding.rule).id == "RX902";
  if (!is_alarm || (fault.code_frame == 0 && !named)) return message(finding);
  // The main number stands for several alarms; the evidence may point at one.
  if (named && fault.advice.size() > 1)
    return fmt::format("alarm {}, by the evidence {}", fault.code_frame != 0 ? fault.code : finding.arguments[0],
                       fault.advice.front().name);
  return named ? fmt::format("alarm {}", fault.advice.front().name) : fmt::format("alarm {}", fault.code_text);
}

void judge(Model& model, const Settings& settings, const replay::BusNames& buses) {
  Judge(model, settings, buses).run();
  list_limits(model, buses);
}

}  // namespace servotrace::report
