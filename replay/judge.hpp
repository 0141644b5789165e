// SPDX-License-Identifier: MIT
// Judging a capture that was run: which findings are shown, how many there are, what exit status follows. Shared by
// check, annotate and the report.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "decoder/core/result.hpp"
#include "replay/results.hpp"
#include "replay/settings/settings.hpp"

namespace servotrace::replay {

// --select, --ignore, --actor, --fail-on, --allow-empty.
class Selection {
 public:
  // Lists may hold commas. `fail_on`: "error", "warning", "note" or "never".
  static Result<Selection> make(const std::vector<std::string>& select, const std::vector<std::string>& ignore,
                                const std::vector<std::string>& actors, std::string_view fail_on);

  RuleFilter filter(const RuleSettings& settings) const;
  bool is_of_actor(Actor actor) const;
  std::optional<Severity> fail_on() const { return fail_on_; }
  // Exit status of one capture.
  int status(const CaptureRecord& capture) const;

  bool allow_empty = false;

 private:
  std::vector<std::string> select_;
  std::vector<std::string> ignore_;
  std::vector<Actor> actors_;                           // empty: all
  std::optional<Severity> fail_on_ = Severity::kError;  // empty: never
  Date day_ = today();
};

// The results of a capture. Leaves in `result.findings` those that are shown, record.findings[i] made of findings[i].
CaptureRecord judge(CaptureResult& result, const FileSettings& settings, const Selection& selection,
                    RuleFilter& filter);

// Suppressions over all captures: those that hid nothing and those that have expired, on standard error.
class SuppressionReport {
 public:
  void add(const RuleFilter& filter);
  void complain_of_leftovers() const;

 private:
  std::map<std::string, RuleFilter::Use> uses_;  // by place in the settings
};

}  // namespace servotrace::replay
