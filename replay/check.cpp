// SPDX-License-Identifier: MIT
// servotrace check: verifies captures against the rules.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>

#include "replay/baseline.hpp"
#include "replay/capture/interrupt.hpp"
#include "replay/check_live.hpp"
#include "replay/commands.hpp"
#include "replay/evidence.hpp"
#include "replay/exit_status.hpp"
#include "replay/in_order.hpp"
#include "replay/judge.hpp"
#include "replay/output/targets.hpp"
#include "replay/progress.hpp"

namespace servotrace::replay {
namespace {

constexpr std::uint32_t kMostCounted = 1'000'000;  // findings a rule and node that a baseline can tell apart

struct CheckOptions {
  std::vector<std::string> captures;
  std::vector<std::string> select;
  std::vector<std::string> ignore;
  std::vector<std::string> actors;
  std::vector<std::string> outputs;
  std::string interface;
  std::string fail_on = "error";
  std::string baseline;
  std::string write_baseline;
  std::string colour = "auto";
  std::string progress = "auto";
  unsigned jobs = 1;
  std::uint32_t max_findings = 100;
  bool allow_empty = false;
  bool join = false;
  bool statistics = false;
};

// Says how many bytes of a source were read, as they are.
class Meter {
 public:
  explicit Meter(Progress& progress) : progress_(progress) {}
  void operator()(const Source& source) {
    const std::uint64_t now = source.consumed();
    if (now > last_) progress_.add(now - last_);
    last_ = std::max(last_, now);
  }

 private:
  Progress& progress_;
  std::uint64_t last_ = 0;
};

Checked check_file(const CaptureInput& input, const FileSettings& settings, const Selection& selection,
                   bool wants_evidence, Progress& progress) {
  Checked checked{.record = {}, .filter = selection.filter(settings.rules)};
  StreamEvidence stream_evidence(settings.decoder);
  RunOptions options{.visitor = {}, .stop = &interrupted(), .on_progress = Meter(progress)};
  if (input.is_stream() && wants_evidence) options.visitor = &stream_evidence;
  CaptureResult result = run_input(input, settings.decoder, options);
  checked.stopped = result.stopped && !input.is_stream();
  checked.record = judge(result, settings, selection, checked.filter);
  if (!wants_evidence) return checked;
  if (input.is_stream()) {
    stream_evidence.add_to(result.findings, checked.record);
  } else {
    add_evidence(input, settings.decoder, result.findings, checked.record);
  }
  return checked;
}

std::uint64_t total_size(const std::vector<CaptureInput>& inputs) {
  std::uint64_t total = 0;
  for (const CaptureInput& input : inputs) {
    std::error_code code;
    const std::uintmax_t size = input.is_stream() ? 0 : std::filesystem::file_size(input.path, code);
    if (input.is_stream() || code) return 0;
    total += size;
  }
  return total;
}

struct Preparation {
  std::vector<CaptureInput> inputs;
  std::vector<std::shared_ptr<const FileSettings>> settings;  // one an input
  Selection selection;
  Style style;
  When progress = When::kAuto;
};

// Everything that can be wrong before the first frame is read.
Result<Preparation> prepare(const CheckOptions& options, CaptureOptions& capture_options) {
  Preparation ready;
  const std::optional<When> colour = when_of(options.colour);
  if (!colour) return Error{"--color", fmt::format("'{}': must be auto, always or never", options.colour)};
  ready.style = Style(use_colour(*colour, 1));
  const std::optional<When> progress = when_of(options.progress);
  if (!progress) return Error{"--progress", fmt::format("'{}': must be auto, always or never", options.progress)};
  ready.progress = *progress;
  Result<Selection> selection = Selection::make(options.select, options.ignore, options.actors, options.fail_on);
  if (!selection) return selection.error();
  ready.selection = std::move(*selection);
  ready.selection.allow_empty = options.allow_empty;
  if (options.captures.empty() == options.interface.empty()) {
    return Error{"", options.captures.empty() ? "a CAPTURE is missing; see 'servotrace check --help'"
                                              : "--interface stands alone, without a CAPTURE"};
  }
  Result<std::vector<CaptureInput>> inputs = expand_inputs(options.captures);
  if (!inputs) return inputs.error();
  ready.inputs = std::move(*inputs);
  if (options.join && !ready.inputs.empty()) {
    Result<CaptureInput> joined = join_inputs(ready.inputs);
    if (!joined) return joined.error();
    ready.inputs = {std::move(*joined)};
  }
  if (!options.interface.empty()) ready.inputs.push_back({{}, options.interface});
  for (const CaptureInput& input : ready.inputs) {
    const auto settings = capture_options.settings(input.path);
    if (!settings) return settings.error();
    ready.settings.push_back(*settings);
  }
  return ready;
}

int check(const CheckOptions& options, CaptureOptions& capture_options) {
  const Result<Preparation> ready = prepare(options, capture_options);
  if (!ready) {
    complain(ready.error());
    return kExitFailed;
  }
  const Selection& selection = ready->selection;
  BaselineKeeper baseline;
  if (const Result<void> opened = baseline.open(options.baseline, options.write_baseline); !opened) {
    complain(opened.error());
    return kExitFailed;
  }
  Result<Targets> targets =
      Targets::open(options.outputs, "text",
                    {.style = ready->style, .fail_on = selection.fail_on(), .statistics = options.statistics});
  if (!targets) {
    complain(targets.error());
    return kExitFailed;
  }

  catch_interrupts();
  targets->begin();
  RunTotals totals;
  SuppressionReport suppressions;
  bool stopped = false;
  Progress progress(ready->progress, total_size(ready->inputs));
  const auto use = [&](Checked checked) {
    if (checked.stopped) {
      stopped = true;
      return false;
    }
    progress.clear();
    if (!checked.record.error.empty()) complain(checked.record.error);
    suppressions.add(checked.filter);
    baseline.apply(checked.record, selection, options.max_findings);
    totals.add(checked.record);
    targets->capture(checked.record);
    return true;
  };
  if (!options.interface.empty()) {
    Result<Checked> live = check_live(options.interface, *ready->settings[0], selection, ready->style);
    if (!live) {
      complain(live.error());
      return kExitFailed;
    }
    use(std::move(*live));
  } else {
    const bool wants_evidence = targets->wants_evidence();
    in_order(
        ready->inputs.size(), options.jobs,
        [&](std::size_t i) {
          return check_file(ready->inputs[i], *ready->settings[i], selection, wants_evidence, progress);
        },
        use);
  }
  progress.clear();
  if (stopped) {
    complain("interrupted: the results are not complete, no file was written");
    return kExitFailed;
  }
  suppressions.complain_of_leftovers();
  targets->end(totals);
  Result<void> written = baseline.finish();
  if (Result<void> finished = targets->finish(); !finished && written) written = finished;
  if (!written) {
    complain(written.error());
    return kExitFailed;
  }
  return totals.status;
}

}  // namespace

int run_check(const Arguments& arguments) {
  CLI::App app("Verifies captures against the rules.", "servotrace check");
  CheckOptions options;
  CaptureOptions capture_options;
  app.add_option("CAPTURE", options.captures, "Files, folders, or - for standard input");
  app.add_option("--interface", options.interface, "Check live traffic of this interface until Ctrl-C")
      ->type_name("NAME");
  capture_options.add_to(app);
  app.add_option("--select", options.select, "Only these rules: ids or prefixes (RX3, DN)")
      ->type_name("RULES")
      ->allow_extra_args(false);
  app.add_option("--ignore", options.ignore, "Not these rules: ids or prefixes")
      ->type_name("RULES")
      ->allow_extra_args(false);
  app.add_option("--actor", options.actors, "Only findings of these: master, drive, network, capture")
      ->type_name("ACTORS")
      ->allow_extra_args(false);
  app.add_option("--fail-on", options.fail_on, "Exit with 1 from this severity on: error, warning, note, never")
      ->type_name("SEVERITY")
      ->capture_default_str();
  app.add_option("--output", options.outputs,
                 "Format, or FORMAT=FILE; several times. Formats: " + format_names() + " (default: text)")
      ->type_name("FORMAT[=FILE]")
      ->allow_extra_args(false)
      ->take_all();
  app.add_option("--baseline", options.baseline, "Accept the findings this file counts; fail on new ones")
      ->type_name("FILE");
  app.add_option("--write-baseline", options.write_baseline, "Accept today's findings and count them into this file")
      ->type_name("FILE");
  app.add_option("--max-findings", options.max_findings, "Findings kept for each rule and node")
      ->type_name("N")
      ->check(CLI::Range(1U, 1'000'000'000U))
      ->capture_default_str();
  app.add_option("--jobs", options.jobs, "Files at once")
      ->type_name("N")
      ->check(CLI::Range(1U, 256U))
      ->capture_default_str();
  app.add_option("--color", options.colour, "auto, always or never")->type_name("WHEN")->capture_default_str();
  app.add_option("--progress", options.progress, "auto, always or never")->type_name("WHEN")->capture_default_str();
  app.add_flag("--join", options.join, "Take all files for parts of one recording, merged by time");
  app.add_flag("--statistics", options.statistics,
               "In text: how often each rule was looked at, and what was measured (the other formats always tell)");
  app.add_flag("--allow-empty", options.allow_empty, "Exit with 0 where nothing was checked");
  app.footer(
      "Exit status: 0 nothing at or above --fail-on, 1 findings, 2 could not do the job, 3 nothing was checked.\n\n"
      "Examples:\n"
      "  servotrace check run.pcapng\n"
      "  servotrace check captures/ --fail-on warning --actor master --jobs 4\n"
      "  servotrace check run.pcapng --output text --output sarif=run.sarif\n"
      "  dumpcap -i can0 -w - | servotrace check - --devicenet");
  if (const std::optional<int> status = parse(app, arguments)) return *status;
  // A baseline counts every finding: those above the limit are left out behind it.
  const bool counts_all = !options.baseline.empty() || !options.write_baseline.empty();
  capture_options.max_findings = counts_all ? std::max(options.max_findings, kMostCounted) : options.max_findings;
  return check(options, capture_options);
}

}  // namespace servotrace::replay
