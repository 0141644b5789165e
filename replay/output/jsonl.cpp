// SPDX-License-Identifier: MIT
// JSON Lines: `capture`, its nodes, statistics, findings and rules; `end` closes the run.
#include "decoder/render/json.hpp"
#include "replay/output/output.hpp"
#include "replay/output/records.hpp"

namespace servotrace::replay {
namespace {

class Jsonl : public Output {
 public:
  using Output::Output;

  // For merge, which shows it as `check` would.
  bool wants_evidence() const override { return true; }

  void capture(const CaptureRecord& capture) override {
    line("capture", [&](JsonWriter& json) { write_capture(json, capture); });
    const auto of_file = [&](std::string_view type, auto write, const auto& record) {
      line(type, [&](JsonWriter& json) {
        json.member("file", capture.file);
        write(json, record);
      });
    };
    for (const NodeRecord& node : capture.nodes) of_file("node", write_node, node);
    for (const StatisticRecord& statistic : capture.statistics) of_file("statistic", write_statistic, statistic);
    for (const FindingRecord& finding : capture.findings) of_file("finding", write_finding, finding);
    for (const RuleRecord& rule : capture.rules) of_file("rule", write_rule, rule);
  }

  void end(const RunTotals& totals) override {
    line("end", [&](JsonWriter& json) { write_end(json, totals); });
  }

 private:
  template <class Write>
  void line(std::string_view type, Write write) {
    text_.clear();
    JsonWriter json(text_);
    json.begin_object().member("type", type);
    write(json);
    json.end_object();
    text_ += '\n';
    out().write(text_);
  }

  std::string text_;
};

}  // namespace

std::unique_ptr<Output> make_jsonl(Out& out, const OutputOptions&) { return std::make_unique<Jsonl>(out); }

}  // namespace servotrace::replay
