// SPDX-License-Identifier: MIT
// What a user wants to hear of: rules ignored or selected, severities changed, known findings suppressed. For every
// host (command line, plugin), so that all of them show the same.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "decoder/core/result.hpp"
#include "decoder/findings/catalogue.hpp"
#include "decoder/findings/finding.hpp"

namespace servotrace::replay {

struct Date {
  int year = 0;
  int month = 0;  // 1..12
  int day = 0;    // 1..31
  auto operator<=>(const Date&) const = default;
};
std::string to_string(const Date& date);  // "2027-01-31"
// Today in UTC; where the environment holds SOURCE_DATE_EPOCH, that day, so that results can be made again.
Date today();

// One [[suppress]] table.
struct Suppression {
  std::string rule;                    // id or prefix of ids
  std::optional<std::int16_t> mac_id;  // empty: every node, ring and bus
  std::string reason;
  std::optional<Date> until;  // the last day it holds
  std::string where;          // "servotrace.toml:41:1"
};

struct SeverityChange {
  std::string rule;  // id or prefix of ids; a longer one wins over a shorter
  Severity severity = Severity::kNote;
};

// [rules] and [[suppress]].
struct RuleSettings {
  std::vector<std::string> ignore;  // ids or prefixes of ids
  std::vector<SeverityChange> severity;
  std::vector<Suppression> suppressions;
};

// True where `pattern` is a rule's id or begins the id of one ("RX3", "DN"); capitals only.
bool names_rules(std::string_view pattern);
// " (did you mean 'RX304'?)", or empty.
std::string did_you_mean_rule(std::string_view pattern);

class RuleFilter {
 public:
  // `day`: suppressions whose `until` lies before it have expired and hide nothing.
  explicit RuleFilter(const RuleSettings& settings = {}, Date day = today());

  // Show only these rules, and these not (ids or prefixes; --select, --ignore). An unknown one is an error.
  Result<void> select(std::span<const std::string> patterns);
  Result<void> ignore(std::span<const std::string> patterns);

  bool is_shown(RuleId rule) const { return shown_[static_cast<std::size_t>(rule)]; }
  // The severity the settings give this rule, else its own.
  Severity severity(RuleId rule) const;
  // Changes the finding's severity where the settings say so. False: it must not be shown.
  bool apply(Finding& finding);

  // What each suppression did, in the order of the settings. One that has expired hides nothing; `matched` counts what
  // it would have hidden.
  struct Use {
    Suppression suppression;
    bool expired = false;
    std::uint64_t matched = 0;
  };
  std::span<const Use> uses() const { return uses_; }
  std::uint64_t suppressed() const { return suppressed_; }  // findings hidden by suppressions

 private:
  std::array<bool, kRuleCount> shown_ = {};
  std::array<std::optional<Severity>, kRuleCount> severity_ = {};
  std::vector<Use> uses_;
  std::uint64_t suppressed_ = 0;
};

}  // namespace servotrace::replay
