// SPDX-License-Identifier: MIT
// servotrace merge: joins the results of many checks. Associative, and independent of the order of the files.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>
#include <sstream>

#include "replay/commands.hpp"
#include "replay/console.hpp"
#include "replay/exit_status.hpp"
#include "replay/output/records.hpp"
#include "replay/output/targets.hpp"
#include "replay/results_reader.hpp"

namespace servotrace::replay {
namespace {

// Everything a capture's results say: what orders captures of one name.
std::string content(const CaptureRecord& capture) {
  std::string text;
  JsonWriter json(text);
  json.begin_object();
  write_capture(json, capture);
  for (const FindingRecord& finding : capture.findings) {
    json.key("finding").begin_object();
    write_finding(json, finding);
    json.end_object();
  }
  json.end_object();
  return text;
}

}  // namespace

int run_merge(const Arguments& arguments) {
  CLI::App app("Joins the results of many checks (--output jsonl) into one.", "servotrace merge");
  std::vector<std::string> files;
  std::vector<std::string> outputs;
  std::string fail_on = "error";
  bool statistics = false;
  app.add_option("RESULT", files, "Results of 'check --output jsonl=FILE'")->required();
  app.add_option("--output", outputs,
                 "Format, or FORMAT=FILE; several times. Formats: " + format_names() + " (default: jsonl)")
      ->type_name("FORMAT[=FILE]")
      ->allow_extra_args(false)
      ->take_all();
  app.add_option("--fail-on", fail_on, "JUnit: what is a failure: error, warning, note, never")
      ->type_name("SEVERITY")
      ->capture_default_str();
  app.add_flag("--statistics", statistics, "In text: how often each rule was looked at, and what was measured");
  app.footer(
      "Exit status: the worst of the results that are joined.\n\n"
      "Example:\n"
      "  parallel servotrace check {} --output jsonl={}.jsonl ::: *.pcapng\n"
      "  servotrace merge *.jsonl --output text --output junit=servotrace.xml");
  if (const std::optional<int> status = parse(app, arguments)) return *status;
  const std::optional<Severity> severity = severity_of(fail_on);
  if (!severity && fail_on != "never") {
    complain(Error{"--fail-on", fmt::format("'{}': must be error, warning, note or never", fail_on)});
    return kExitFailed;
  }
  Results results;
  for (const std::string& file : files) {
    std::ifstream stream(file, std::ios::binary);
    std::error_code code;
    if (!stream || std::filesystem::is_directory(file, code)) {
      complain(Error{file, "cannot be opened"});
      return kExitFailed;
    }
    std::ostringstream text;
    text << stream.rdbuf();
    if (const Result<void> parsed = parse_results(text.str(), file, results); !parsed) {
      complain(parsed.error());
      return kExitFailed;
    }
  }
  std::vector<const CaptureRecord*> order;
  for (const CaptureRecord& capture : results.captures) order.push_back(&capture);
  std::sort(order.begin(), order.end(), [](const CaptureRecord* left, const CaptureRecord* right) {
    return left->file != right->file ? left->file < right->file : content(*left) < content(*right);
  });
  Result<Targets> targets =
      Targets::open(outputs, "jsonl", {.style = Style(false), .fail_on = severity, .statistics = statistics});
  if (!targets) {
    complain(targets.error());
    return kExitFailed;
  }
  targets->begin();
  RunTotals totals;
  for (const CaptureRecord* const capture : order) {
    totals.add(*capture);
    targets->capture(*capture);
  }
  totals.status = worse_status(totals.status, results.status);
  targets->end(totals);
  if (const Result<void> finished = targets->finish(); !finished) {
    complain(finished.error());
    return kExitFailed;
  }
  return totals.status;
}

}  // namespace servotrace::replay
