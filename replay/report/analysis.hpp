// SPDX-License-Identifier: MIT
// From findings to faults, causes and a verdict. Pure functions of the model.
#pragma once

#include <string>

#include "decoder/pipeline/settings.hpp"
#include "replay/bus_names.hpp"
#include "replay/report/frame_times.hpp"
#include "replay/report/model.hpp"

namespace servotrace::report {

// How much of the time before a fault is looked at for its causes and shown in its close-up.
inline constexpr DurationNs kCauseWindowNs = 30 * kSecondNs;

// "axis 3 (X) on ring0", "ring0", "the capture".
std::string who(const Finding& finding, const Settings& settings, const replay::BusNames& buses);

// True where a drive's alarm was found whose code nobody had read yet.
bool is_alarm_without_code(const Finding& finding);
// Ranks the causes of every fault anew, with the codes read after it.
void rank_all_causes(Model& model);
// Fills faults (with windows and causes) from the findings; model.findings must be sorted by frame.
void find_faults(Model& model, const FrameTimes& times);
// What the manuals' tables say of the code of a fault. `likely_sub`: of an RTEX alarm whose sub number was not read,
// the one the evidence points at; below 0: none.
std::vector<Advice> advice_for(const Finding& finding, std::int64_t code, std::int64_t likely_sub);
// What failed, with the code read afterwards: "alarm 24.0 position deviation excess". No full stop.
std::string fault_text(const Model& model, const Fault& fault);
std::string capitalised(std::string text);
// "1 finding", "2 findings".
std::string plural(std::uint64_t count, std::string_view word);
// Fills the verdict and what the capture cannot show; faults must be found.
void judge(Model& model, const Settings& settings, const replay::BusNames& buses);

// "12.345678 s" after the start of the capture.
std::string at_time(const Model& model, TimeNs time_ns);

}  // namespace servotrace::report
