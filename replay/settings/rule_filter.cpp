// SPDX-License-Identifier: MIT
#include "replay/settings/rule_filter.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <ctime>

#include "replay/settings/suggest.hpp"

namespace servotrace::replay {
namespace {

// Howard Hinnant's civil-from-days, for days since 1970-01-01.
Date date_of_days(std::int64_t days) {
  days += 719468;
  const std::int64_t era = (days >= 0 ? days : days - 146096) / 146097;
  const std::int64_t day_of_era = days - era * 146097;
  const std::int64_t year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36524 - day_of_era / 146096) / 365;
  const std::int64_t day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
  const std::int64_t shifted_month = (5 * day_of_year + 2) / 153;
  const auto day = static_cast<int>(day_of_year - (153 * shifted_month + 2) / 5 + 1);
  const auto month = static_cast<int>(shifted_month < 10 ? shifted_month + 3 : shifted_month - 9);
  return {static_cast<int>(year_of_era + era * 400 + (month <= 2 ? 1 : 0)), month, day};
}

Error unknown_rule(std::string_view pattern) {
  return Error{"", fmt::format("no rule '{}'{}", pattern, did_you_mean_rule(pattern))};
}

}  // namespace

std::string to_string(const Date& date) { return fmt::format("{:04}-{:02}-{:02}", date.year, date.month, date.day); }

Date today() {
  auto seconds_since_epoch = static_cast<std::int64_t>(std::time(nullptr));
  if (const char* const fixed = std::getenv("SOURCE_DATE_EPOCH"); fixed != nullptr && *fixed != '\0') {
    char* end = nullptr;
    const long long value = std::strtoll(fixed, &end, 10);
    if (*end == '\0' && value >= 0 && value < 253402300800) seconds_since_epoch = value;
  }
  return date_of_days(seconds_since_epoch / 86400);
}

bool names_rules(std::string_view pattern) {
  if (pattern.empty()) return false;
  for (const Rule& row : kCatalogue) {
    if (row.id.starts_with(pattern)) return true;
  }
  return false;
}

std::string did_you_mean_rule(std::string_view pattern) {
  std::vector<std::string_view> ids;
  std::vector<std::string_view> slugs;
  for (const Rule& row : kCatalogue) {
    ids.push_back(row.id);
    slugs.push_back(row.slug);
  }
  if (const std::string_view slug = nearest(pattern, slugs); !slug.empty()) {
    for (const Rule& row : kCatalogue) {
      if (row.slug == slug) return fmt::format(" (did you mean '{}', {}?)", row.id, slug);
    }
  }
  return did_you_mean(pattern, ids);
}

RuleFilter::RuleFilter(const RuleSettings& settings, Date day) {
  shown_.fill(true);
  for (std::size_t i = 0; i < kRuleCount; ++i) {
    const std::string_view id = kCatalogue[i].id;
    for (const std::string& pattern : settings.ignore) {
      if (id.starts_with(pattern)) shown_[i] = false;
    }
    std::size_t longest = 0;
    for (const SeverityChange& change : settings.severity) {
      if (!id.starts_with(change.rule) || change.rule.size() < longest) continue;
      longest = change.rule.size();
      severity_[i] = change.severity;
    }
  }
  for (const Suppression& suppression : settings.suppressions) {
    uses_.push_back(Use{.suppression = suppression, .expired = suppression.until && *suppression.until < day});
  }
}

Result<void> RuleFilter::select(std::span<const std::string> patterns) {
  if (patterns.empty()) return {};
  std::array<bool, kRuleCount> selected = {};
  for (const std::string& pattern : patterns) {
    if (!names_rules(pattern)) return unknown_rule(pattern);
    for (std::size_t i = 0; i < kRuleCount; ++i) {
      if (kCatalogue[i].id.starts_with(pattern)) selected[i] = true;
    }
  }
  // What the command line asks for by name is shown even where the settings ignore it.
  shown_ = selected;
  return {};
}

Result<void> RuleFilter::ignore(std::span<const std::string> patterns) {
  for (const std::string& pattern : patterns) {
    if (!names_rules(pattern)) return unknown_rule(pattern);
    for (std::size_t i = 0; i < kRuleCount; ++i) {
      if (kCatalogue[i].id.starts_with(pattern)) shown_[i] = false;
    }
  }
  return {};
}

bool RuleFilter::apply(Finding& finding) {
  const auto index = static_cast<std::size_t>(finding.rule);
  if (!shown_[index]) return false;
  bool hidden = false;
  for (Use& entry : uses_) {
    const Suppression& suppression = entry.suppression;
    if (!kCatalogue[index].id.starts_with(suppression.rule)) continue;
    if (suppression.mac_id && *suppression.mac_id != finding.node.mac_id) continue;
    ++entry.matched;
    if (!entry.expired) hidden = true;
  }
  if (hidden) {
    ++suppressed_;
    return false;
  }
  if (severity_[index]) finding.severity = *severity_[index];
  return true;
}

Severity RuleFilter::severity(RuleId rule) const {
  return severity_[static_cast<std::size_t>(rule)].value_or(rule_row(rule).severity);
}

}  // namespace servotrace::replay
