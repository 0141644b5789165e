// SPDX-License-Identifier: MIT
// The list of output formats: a new one is one line.
#include "replay/output/output.hpp"

namespace servotrace::replay {
namespace {

constexpr OutputFormat kFormats[] = {
    {"text", "for people: findings, evidence, a table of rules, a verdict", &make_text},
    {"jsonl", "one JSON object a line", &make_jsonl},
};

}  // namespace

std::span<const OutputFormat> output_formats() { return kFormats; }

}  // namespace servotrace::replay
