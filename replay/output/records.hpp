// SPDX-License-Identifier: MIT
// The JSON objects of results: the same in `jsonl` (one a line, with a type) and `json` (in lists).
#pragma once

#include "decoder/render/json.hpp"
#include "replay/results.hpp"

namespace servotrace::replay {

// Each writes members into the object that is open.
void write_capture(JsonWriter& json, const CaptureRecord& capture);
void write_node(JsonWriter& json, const NodeRecord& node);
void write_statistic(JsonWriter& json, const StatisticRecord& statistic);
void write_finding(JsonWriter& json, const FindingRecord& finding);
void write_rule(JsonWriter& json, const RuleRecord& rule);
void write_end(JsonWriter& json, const RunTotals& totals);

}  // namespace servotrace::replay
