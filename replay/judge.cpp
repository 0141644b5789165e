// SPDX-License-Identifier: MIT
#include "replay/judge.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "replay/command_line.hpp"
#include "replay/console.hpp"
#include "replay/exit_status.hpp"

namespace servotrace::replay {

Result<Selection> Selection::make(const std::vector<std::string>& select, const std::vector<std::string>& ignore,
                                  const std::vector<std::string>& actors, std::string_view fail_on) {
  Selection selection;
  selection.select_ = split_list(select);
  selection.ignore_ = split_list(ignore);
  RuleFilter probe({}, Date{});
  if (const Result<void> known = probe.select(selection.select_); !known) return Error{"--select", known.error().what};
  if (const Result<void> known = probe.ignore(selection.ignore_); !known) return Error{"--ignore", known.error().what};
  for (const std::string& word : split_list(actors)) {
    const std::optional<Actor> actor = actor_of(word);
    if (!actor) return Error{"--actor", fmt::format("'{}': must be master, drive, network or capture", word)};
    selection.actors_.push_back(*actor);
  }
  selection.fail_on_.reset();
  if (fail_on != "never") {
    selection.fail_on_ = severity_of(fail_on);
    if (!selection.fail_on_) {
      return Error{"--fail-on", fmt::format("'{}': must be error, warning, note or never", fail_on)};
    }
  }
  return selection;
}

RuleFilter Selection::filter(const RuleSettings& settings) const {
  RuleFilter filter(settings, day_);
  // Both were probed when the selection was made.
  static_cast<void>(filter.select(select_));
  static_cast<void>(filter.ignore(ignore_));
  return filter;
}

bool Selection::is_of_actor(Actor actor) const {
  return actors_.empty() || std::find(actors_.begin(), actors_.end(), actor) != actors_.end();
}

int Selection::status(const CaptureRecord& capture) const {
  if (!capture.error.empty()) return kExitFailed;
  if (fail_on_ && capture.counts.at_least(*fail_on_) != 0) return kExitFindings;
  return capture.checked_frames == 0 && !allow_empty ? kExitNothing : kExitClean;
}

CaptureRecord judge(CaptureResult& result, const FileSettings& settings, const Selection& selection,
                    RuleFilter& filter) {
  CaptureRecord record = describe(result, settings.decoder);
  std::array<std::uint64_t, kRuleCount> kept = {};
  std::array<std::uint64_t, kRuleCount> shown = {};
  std::vector<Finding> findings;
  for (Finding& finding : result.findings) {
    const auto index = static_cast<std::size_t>(finding.rule);
    ++kept[index];
    if (!selection.is_of_actor(finding.actor) || !filter.apply(finding)) continue;
    ++shown[index];
    record.findings.push_back(make_record(finding, result, settings.decoder));
    record.counts.add(finding.severity);
    findings.push_back(finding);
  }
  for (std::size_t i = 0; i < kRuleCount; ++i) {
    const auto rule = static_cast<RuleId>(i);
    if (!filter.is_shown(rule)) continue;
    // Those above --max-findings are counted as far as the kept ones of the rule are shown.
    const std::uint64_t above = shown[i] == 0 ? 0 : result.total[i] - kept[i];
    record.counts.add(filter.severity(rule), above);
    record.rules.push_back({rule, result.checked[i], shown[i] + above});
  }
  record.suppressed = filter.suppressed();
  record.status = selection.status(record);
  result.findings = std::move(findings);
  return record;
}

void SuppressionReport::add(const RuleFilter& filter) {
  for (const RuleFilter::Use& use : filter.uses()) {
    const auto [entry, is_new] = uses_.try_emplace(use.suppression.where, use);
    if (!is_new) entry->second.matched += use.matched;
  }
}

void SuppressionReport::complain_of_leftovers() const {
  for (const auto& [where, use] : uses_) {
    const Suppression& suppression = use.suppression;
    if (use.expired) {
      complain(Error{where, fmt::format("the suppression of {} has expired on {} ({})", suppression.rule,
                                        to_string(*suppression.until), suppression.reason)});
    } else if (use.matched == 0) {
      complain(
          Error{where, fmt::format("the suppression of {} hides nothing ({})", suppression.rule, suppression.reason)});
    }
  }
}

}  // namespace servotrace::replay
