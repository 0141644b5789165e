// SPDX-License-Identifier: MIT
// Makes the model of a capture: one pass that finds, one that looks closely at what was found.
#pragma once

#include "decoder/core/result.hpp"
#include "replay/inputs.hpp"
#include "replay/report/model.hpp"
#include "replay/run.hpp"
#include "replay/settings/rule_filter.hpp"

namespace servotrace::report {

struct Built {
  Model model;
  replay::BusNames buses;
};

// `path` must be a file: it is read twice. What is broken inside the file is told by the model; only a file that cannot
// be opened is an error.
Result<Built> build_model(const replay::CaptureInput& input, const Settings& settings, replay::RuleFilter filter);

}  // namespace servotrace::report
