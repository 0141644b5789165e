// SPDX-License-Identifier: MIT
// servotrace merge: joins the results of many checks. Associative, and independent of the order of the files.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "replay/commands.hpp"
#include "replay/console.hpp"
#include "replay/exit_status.hpp"
#include "replay/output/targets.hpp"
#include "replay/results_index.hpp"

namespace servotrace::replay {

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
  ResultsIndex results;
  for (const std::string& file : files) {
    if (const Result<void> added = results.add(file); !added) {
      complain(added.error());
      return kExitFailed;
    }
  }
  results.sort();
  Result<Targets> targets =
      Targets::open(outputs, "jsonl", {.style = Style(false), .fail_on = severity, .statistics = statistics});
  if (!targets) {
    complain(targets.error());
    return kExitFailed;
  }
  targets->begin();
  RunTotals totals;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Result<CaptureRecord> capture = results.read(i);
    if (!capture) {
      complain(capture.error());
      return kExitFailed;
    }
    totals.add(*capture);
    targets->capture(*capture);
  }
  totals.status = worse_status(totals.status, results.status());
  targets->end(totals);
  if (const Result<void> finished = targets->finish(); !finished) {
    complain(finished.error());
    return kExitFailed;
  }
  return totals.status;
}

}  // namespace servotrace::replay
