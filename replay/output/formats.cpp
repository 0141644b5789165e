// SPDX-License-Identifier: MIT
// The list of output formats: a new one is one line.
#include "replay/output/output.hpp"

namespace servotrace::replay {
namespace {

constexpr OutputFormat kFormats[] = {
    {"text", "for people: findings, evidence, a table of rules, a verdict", &make_text},
    {"jsonl", "one JSON object a line", &make_jsonl},
    {"json", "the same as one document", &make_json},
    {"sarif", "SARIF 2.1.0 with byte regions", &make_sarif},
    {"sarif-github", "SARIF 2.1.0 with line = frame, collapsed and capped", &make_sarif_github},
    {"junit", "JUnit XML: a test case a capture and rule", &make_junit},
    {"github", "GitHub workflow annotations, worst first", &make_github},
    {"markdown", "for a job summary", &make_markdown},
};

}  // namespace

std::span<const OutputFormat> output_formats() { return kFormats; }

}  // namespace servotrace::replay
