// SPDX-License-Identifier: MIT
// JSON: what JSON Lines says, as one document.
#include "decoder/render/json.hpp"

#include "replay/output/output.hpp"
#include "replay/output/records.hpp"

namespace servotrace::replay {
namespace {

class Json : public Output {
 public:
  using Output::Output;

  bool wants_evidence() const override { return true; }

  void begin() override {
    json_.begin_object().key("captures").begin_array();
    hand_over();
  }

  void capture(const CaptureRecord& capture) override {
    json_.begin_object();
    write_capture(json_, capture);
    list("nodes", capture.nodes, write_node);
    list("statistics", capture.statistics, write_statistic);
    list("findings", capture.findings, write_finding);
    list("rules", capture.rules, write_rule);
    json_.end_object();
    hand_over();
  }

  void end(const RunTotals& totals) override {
    json_.end_array().key("end").begin_object();
    write_end(json_, totals);
    json_.end_object().end_object();
    text_ += '\n';
    hand_over();
  }

 private:
  template <class Records, class Write>
  void list(std::string_view key, const Records& records, Write write) {
    json_.key(key).begin_array();
    for (const auto& record : records) {
      json_.begin_object();
      write(json_, record);
      json_.end_object();
    }
    json_.end_array();
  }

  void hand_over() {
    out().write(text_);
    text_.clear();
  }

  std::string text_;
  JsonWriter json_{text_, 1};
};

}  // namespace

std::unique_ptr<Output> make_json(Out& out, const OutputOptions&) { return std::make_unique<Json>(out); }

}  // namespace servotrace::replay
