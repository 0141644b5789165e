// SPDX-License-Identifier: MIT
// servotrace check: verifies captures against the rules.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>

#include "replay/capture/whole_file.hpp"
#include "replay/check.hpp"
#include "replay/command_line.hpp"
#include "replay/evidence.hpp"
#include "replay/exit_status.hpp"
#include "replay/output/output.hpp"

namespace servotrace::replay {
namespace {

// An output into a file, which appears whole or not at all.
class FileOut : public Out {
 public:
  explicit FileOut(std::unique_ptr<WholeFile> file) : file_(std::move(file)) {}
  void write(std::string_view text) override { file_->write(text); }
  Result<void> finish() override { return file_->finish(); }

 private:
  std::unique_ptr<WholeFile> file_;
};

struct Target {
  std::unique_ptr<Out> out;
  std::unique_ptr<Output> output;
};

struct CheckOptions {
  std::vector<std::string> captures;
  std::vector<std::string> select;
  std::vector<std::string> ignore;
  std::vector<std::string> actors;
  std::vector<std::string> outputs;
  std::string fail_on = "error";
  std::string colour = "auto";
  bool allow_empty = false;
};

std::string format_names() {
  std::string names;
  for (const OutputFormat& format : output_formats())
    names += fmt::format("{}{}", names.empty() ? "" : ", ", format.name);
  return names;
}

Result<std::vector<Target>> open_targets(const CheckOptions& options, const OutputOptions& output_options) {
  std::vector<std::string> words = options.outputs;
  if (words.empty()) words.push_back("text");
  std::vector<Target> targets;
  bool has_standard = false;
  for (const std::string& word : words) {
    const std::size_t equals = word.find('=');
    const std::string name = word.substr(0, equals);
    const std::string file = equals == std::string::npos ? "" : word.substr(equals + 1);
    const auto formats = output_formats();
    const auto format = std::find_if(formats.begin(), formats.end(), [&](const auto& row) { return row.name == name; });
    if (format == formats.end()) {
      return Error{"--output", fmt::format("no format '{}': must be one of {}", name, format_names())};
    }
    if (equals != std::string::npos && file.empty()) return Error{"--output " + word, "a file name is missing"};
    Target target;
    const bool standard = file.empty() || file == "-";
    if (standard) {
      if (has_standard)
        return Error{"--output", "two formats on standard output: give one of them a file (FORMAT=FILE)"};
      has_standard = true;
      target.out = std::make_unique<StandardOut>();
    } else {
      Result<std::unique_ptr<WholeFile>> opened = WholeFile::create(file);
      if (!opened) return opened.error();
      target.out = std::make_unique<FileOut>(std::move(*opened));
    }
    OutputOptions own = output_options;
    if (!standard) own.style = Style(false);
    target.output = format->make(*target.out, own);
    targets.push_back(std::move(target));
  }
  return targets;
}

}  // namespace

Result<Selection> Selection::make(const std::vector<std::string>& select, const std::vector<std::string>& ignore,
                                  const std::vector<std::string>& actors, std::string_view fail_on) {
  Selection selection;
  selection.select_ = split_list(select);
  selection.ignore_ = split_list(ignore);
  RuleFilter probe({}, Date{});
  if (const Result<void> known = probe.select(selection.select_); !known) return Error{"--select", known.error().what};
  if (const Result<void> known = probe.ignore(selection.ignore_); !known) return Error{"--ignore", known.error().what};
  for (const std::string& word : split_list(actors)) {
    const std::optional<Actor> actor = actor_of(word);
    if (!actor) return Error{"--actor", fmt::format("'{}': must be master, drive, network or capture", word)};
    selection.actors_.push_back(*actor);
  }
  if (fail_on != "never") {
    selection.fail_on_ = severity_of(fail_on);
    if (!selection.fail_on_) {
      return Error{"--fail-on", fmt::format("'{}': must be error, warning, note or never", fail_on)};
    }
  }
  return selection;
}

RuleFilter Selection::filter(const RuleSettings& settings) const {
  RuleFilter filter(settings, day_);
  // Both were probed when the selection was made.
  static_cast<void>(filter.select(select_));
  static_cast<void>(filter.ignore(ignore_));
  return filter;
}

bool Selection::is_of_actor(Actor actor) const {
  return actors_.empty() || std::find(actors_.begin(), actors_.end(), actor) != actors_.end();
}

int Selection::status(const CaptureRecord& capture) const {
  if (!capture.error.empty()) return kExitFailed;
  if (fail_on_ && capture.counts.at_least(*fail_on_) != 0) return kExitFindings;
  return capture.checked_frames == 0 && !allow_empty ? kExitNothing : kExitClean;
}

CaptureRecord judge(CaptureResult& result, const FileSettings& settings, const Selection& selection,
                    RuleFilter& filter) {
  CaptureRecord record = describe(result, settings.decoder);
  std::array<std::uint64_t, kRuleCount> kept = {};
  std::array<std::uint64_t, kRuleCount> shown = {};
  std::vector<Finding> findings;
  for (Finding& finding : result.findings) {
    const auto index = static_cast<std::size_t>(finding.rule);
    ++kept[index];
    if (!selection.is_of_actor(finding.actor) || !filter.apply(finding)) continue;
    ++shown[index];
    record.findings.push_back(make_record(finding, result, settings.decoder));
    record.counts.add(finding.severity);
    findings.push_back(finding);
  }
  for (std::size_t i = 0; i < kRuleCount; ++i) {
    const auto rule = static_cast<RuleId>(i);
    if (!filter.is_shown(rule)) continue;
    // Those above --max-findings are counted as far as the kept ones of the rule are shown.
    const std::uint64_t above = shown[i] == 0 ? 0 : result.total[i] - kept[i];
    record.counts.add(filter.severity(rule), above);
    record.rules.push_back({rule, result.checked[i], shown[i] + above});
  }
  record.suppressed = filter.suppressed();
  record.status = selection.status(record);
  result.findings = std::move(findings);
  return record;
}

int run_check(const Arguments& arguments) {
  CLI::App app("Verifies captures against the rules.", "servotrace check");
  CheckOptions options;
  CaptureOptions capture_options;
  app.add_option("CAPTURE", options.captures, "Files, folders, or - for standard input")->required();
  capture_options.add_to(app);
  app.add_option("--select", options.select, "Only these rules: ids or prefixes (RX3, DN)")->type_name("RULES");
  app.add_option("--ignore", options.ignore, "Not these rules: ids or prefixes")->type_name("RULES");
  app.add_option("--actor", options.actors, "Only findings of these: master, drive, network, capture")
      ->type_name("ACTORS");
  app.add_option("--fail-on", options.fail_on, "Exit with 1 from this severity on: error, warning, note, never")
      ->type_name("SEVERITY")
      ->capture_default_str();
  app.add_option("--output", options.outputs,
                 "Format, or FORMAT=FILE; several times. Formats: " + format_names() + " (default: text)")
      ->type_name("FORMAT[=FILE]")
      ->take_all();
  app.add_option("--max-findings", capture_options.max_findings, "Findings kept for each rule and node")
      ->type_name("N")
      ->check(CLI::Range(1U, 1'000'000'000U))
      ->capture_default_str();
  app.add_option("--color", options.colour, "auto, always or never")->type_name("WHEN")->capture_default_str();
  app.add_flag("--allow-empty", options.allow_empty, "Exit with 0 where nothing was checked");
  app.footer(
      "Exit status: 0 nothing at or above --fail-on, 1 findings, 2 could not do the job, 3 nothing was checked.\n\n"
      "Examples:\n"
      "  servotrace check run.pcapng\n"
      "  servotrace check captures/ --fail-on warning --actor master\n"
      "  servotrace check run.pcapng --output text --output jsonl=run.jsonl\n"
      "  dumpcap -i can0 -w - | servotrace check - --devicenet");
  if (const std::optional<int> status = parse(app, arguments)) return *status;

  const std::optional<When> colour = when_of(options.colour);
  if (!colour) {
    complain(fmt::format("--color: '{}': must be auto, always or never", options.colour));
    return kExitFailed;
  }
  Result<Selection> selection = Selection::make(options.select, options.ignore, options.actors, options.fail_on);
  if (!selection) {
    complain(selection.error());
    return kExitFailed;
  }
  selection->allow_empty = options.allow_empty;
  const Result<std::vector<CaptureInput>> inputs = expand_inputs(options.captures);
  if (!inputs) {
    complain(inputs.error());
    return kExitFailed;
  }
  // Every settings file is read before the first capture: a mistake in one is told at once.
  for (const CaptureInput& input : *inputs) {
    if (const auto settings = capture_options.settings(input.path); !settings) {
      complain(settings.error());
      return kExitFailed;
    }
  }
  OutputOptions output_options{.style = Style(use_colour(*colour, 1))};
  Result<std::vector<Target>> targets = open_targets(options, output_options);
  if (!targets) {
    complain(targets.error());
    return kExitFailed;
  }

  bool wants_evidence = false;
  for (const Target& target : *targets) {
    wants_evidence = wants_evidence || target.output->wants_evidence();
    target.output->begin();
  }
  RunTotals totals;
  SuppressionReport suppressions;
  for (const CaptureInput& input : *inputs) {
    const std::shared_ptr<const FileSettings> settings = *capture_options.settings(input.path);
    RuleFilter filter = selection->filter(settings->rules);
    StreamEvidence stream_evidence(settings->decoder);
    RunOptions run_options;
    if (input.is_stream() && wants_evidence) run_options.visitor = &stream_evidence;
    CaptureResult result = run_input(input, settings->decoder, run_options);
    CaptureRecord record = judge(result, *settings, *selection, filter);
    if (wants_evidence && input.is_stream()) stream_evidence.add_to(result.findings, record);
    if (wants_evidence && !input.is_stream()) add_evidence(input, settings->decoder, result.findings, record);
    if (!record.error.empty()) complain(record.error);
    suppressions.add(filter);
    totals.add(record);
    for (const Target& target : *targets) target.output->capture(record);
  }
  suppressions.complain_of_leftovers();
  bool written = true;
  for (const Target& target : *targets) target.output->end(totals);
  for (const Target& target : *targets) {
    if (const Result<void> finished = target.out->finish(); !finished) {
      complain(finished.error());
      written = false;
    }
  }
  return written ? totals.status : kExitFailed;
}

void SuppressionReport::add(const RuleFilter& filter) {
  for (const RuleFilter::Use& use : filter.uses()) {
    const auto [entry, is_new] = uses_.try_emplace(use.suppression.where, use);
    if (!is_new) entry->second.matched += use.matched;
  }
}

void SuppressionReport::complain_of_leftovers() const {
  for (const auto& [where, use] : uses_) {
    const Suppression& suppression = use.suppression;
    if (use.expired) {
      complain(Error{where, fmt::format("the suppression of {} has expired on {} ({})", suppression.rule,
                                        to_string(*suppression.until), suppression.reason)});
    } else if (use.matched == 0) {
      complain(
          Error{where, fmt::format("the suppression of {} hides nothing ({})", suppression.rule, suppression.reason)});
    }
  }
}

}  // namespace servotrace::replay
