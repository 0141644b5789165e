// SPDX-License-Identifier: MIT
// The pictures of the report, as inline SVG.
#pragma once

#include <string>

#include "decoder/pipeline/settings.hpp"
#include "replay/bus_names.hpp"
#include "replay/report/model.hpp"

namespace servotrace::report {

// What a reader looks for first comes first: 0 alarms and errors, 1 servo and mode, 2 motion, homing and limits, 3 the
// rest.
int importance(const Field& field);

// A lane a node: states as bars, findings as marks, the first fault as a line. Between the two times.
std::string timeline(const Model& model, const Settings& settings, const replay::BusNames& buses, TimeNs begin_ns,
                     TimeNs end_ns);
// One curve below the other, findings of the node as lines.
std::string curves(const Model& model, const Fault& fault);
std::string histogram(const Histogram& histogram, std::string_view bus_name);

}  // namespace servotrace::report
