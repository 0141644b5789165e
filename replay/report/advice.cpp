// SPDX-License-Identifier: MIT
// What the manuals' tables say of an alarm or error code.
#include <fmt/format.h>

#include <algorithm>

#include "decoder/findings/catalogue.hpp"
#include "decoder/profiles/nsk_esb/alarms.hpp"
#include "decoder/profiles/yaskawa_ns310/alarms.hpp"
#include "decoder/rtex/alarms.hpp"
#include "replay/report/analysis.hpp"

namespace servotrace::report {
namespace {

// SX-DSV02203 8-1: one row a sub number; without it all that share the main number.
void rtex_alarm(std::int64_t main, std::int64_t sub, std::int64_t likely_sub, std::vector<Advice>& list) {
  for (const rtex::AlarmRow& row : rtex::kAlarms) {
    if (row.main != main || (sub > 0 && row.sub != sub)) continue;
    Advice advice{.name = fmt::format("{}.{} {}", row.main, row.sub, row.name),
                  .causes = std::string(row.cause),
                  .remedies = std::string(row.action),
                  .section = std::string(row.section),
                  .likeliest = row.sub == (sub > 0 ? sub : likely_sub)};
    if (row.clearable != rtex::Clearable::kUnknown) {
      advice.remedies += fmt::format("{}{}", advice.remedies.empty() ? "" : "; ",
                                     row.clearable == rtex::Clearable::kYes
                                         ? "then clear the alarm"
                                         : "the alarm cannot be cleared: switch the control power off and on");
    }
    list.push_back(std::move(advice));
  }
  std::stable_partition(list.begin(), list.end(), [](const Advice& advice) { return advice.likeliest; });
}

}  // namespace

std::vector<Advice> advice_for(const Finding& finding, std::int64_t code, std::int64_t likely_sub) {
  std::vector<Advice> list;
  const std::string_view id = rule_row(finding.rule).id;
  if (id == "RX902") {
    rtex_alarm(code, finding.arguments[1] > 0 ? finding.arguments[1] & 0xFF : 0, likely_sub, list);
  } else if (id == "RX901") {
    if (const ValueName* row = find_value(rtex::kCommandErrors, code); row != nullptr) {
      list.push_back({.name = fmt::format("{:04X}h {}", row->value, row->name),
                      .causes = std::string(row->explanation),
                      .remedies = "correct the command; the drive did not carry it out",
                      .section = "SX-DSV02203 6-10-2"});
    }
  } else if (id == "YS901") {
    for (const ns310::Alarm& row : ns310::kAlarms) {
      if (row.code != code) continue;
      list.push_back({.name = fmt::format("{:02X}h {}", row.code, row.name),
                      .causes = fmt::format("{} (behind it: {})", row.causes, row.sgdh),
                      .remedies = std::string(row.remedies),
                      .section = std::string(ns310::kAlarmSection)});
    }
  } else if (id == "NK901") {
    // The outputs leave several alarms; the message has the set, its bits are the rows of Table 4-12.
    std::string names;
    for (std::size_t i = 0; i < esb::kAlarms.size(); ++i) {
      if ((static_cast<std::uint64_t>(finding.arguments[2]) >> i & 1U) == 0) continue;
      names += fmt::format("{}{} {}", names.empty() ? "" : ", ", esb::kAlarms[i].code, esb::kAlarms[i].name);
    }
    if (!names.empty()) {
      list.push_back({.name = names,
                      .causes = "the outputs DRDY, OVER and BRK fit each of these",
                      .remedies = "read the alarm word (TA, 800) or the drive's display to tell them apart",
                      .section = std::string(esb::kAlarmSection)});
    }
  }
  return list;
}

}  // namespace servotrace::report
