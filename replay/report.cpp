// SPDX-License-Identifier: MIT
// servotrace report: the post-mortem report.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "replay/capture/whole_file.hpp"
#include "replay/commands.hpp"
#include "replay/console.hpp"
#include "replay/exit_status.hpp"
#include "replay/inputs.hpp"
#include "replay/report/compare.hpp"
#include "replay/report/pages.hpp"

namespace servotrace::replay {
namespace {

enum class Page : std::uint8_t { kHtml, kMarkdown, kJson };

std::optional<Page> page_of(const std::filesystem::path& path) {
  const std::string ending = path.extension().string();
  if (ending == ".html" || ending == ".htm") return Page::kHtml;
  if (ending == ".md") return Page::kMarkdown;
  if (ending == ".json") return Page::kJson;
  return std::nullopt;
}

Result<report::Built> build_other(const std::string& path, CaptureOptions& options) {
  const Result<CaptureInput> input = single_input(path);
  if (!input) return input.error();
  if (input->is_stream()) return Error{"-", "a report reads its capture twice; save the stream to a file first"};
  const Result<std::shared_ptr<const FileSettings>> settings = options.settings(input->path);
  if (!settings) return settings.error();
  return report::build_model(*input, settings.value()->decoder, RuleFilter(settings.value()->rules));
}

}  // namespace

int run_report(const Arguments& arguments) {
  CLI::App app("The post-mortem report of captures: what failed first, what preceded it, and the evidence.",
               "servotrace report");
  std::vector<std::string> captures;
  std::string out_path;
  app.add_option("CAPTURE", captures, "files or folders")->required();
  app.add_option("-o,--output", out_path, "where to write: FILE.html, FILE.md or FILE.json")
      ->required()
      ->type_name("FILE");
  std::string against;
  app.add_option("--against", against, "compare: show where CAPTURE and this one part (one CAPTURE only)")
      ->type_name("CAPTURE");
  CaptureOptions options;
  options.add_to(app);
  app.footer(
      "Exit status: 0 done, 2 could not do the job, 3 no frame of a known bus.\n\n"
      "Examples:\n  servotrace report run.pcapng -o run.html\n"
      "  servotrace report good.pcapng --against bad.pcapng -o parted.html");
  if (const auto status = parse(app, arguments)) return *status;

  const std::optional<Page> page = page_of(out_path);
  if (!page) {
    complain(fmt::format("{}: the ending says what to write: .html, .md or .json", out_path));
    return kExitFailed;
  }
  const Result<std::vector<CaptureInput>> inputs = expand_inputs(captures);
  if (!inputs) {
    complain(inputs.error());
    return kExitFailed;
  }
  if (!against.empty() && inputs->size() != 1) {
    complain("--against compares one capture with one other");
    return kExitFailed;
  }
  std::vector<report::Built> built;
  Settings shown;  // names of the first capture's settings stand on the page
  int status = kExitClean;
  for (const CaptureInput& input : inputs.value()) {
    if (input.is_stream()) {
      complain("standard input: a report reads its capture twice; save the stream to a file first");
      return kExitFailed;
    }
    const Result<std::shared_ptr<const FileSettings>> settings = options.settings(input.path);
    if (!settings) {
      complain(settings.error());
      return kExitFailed;
    }
    Settings decoder = settings.value()->decoder;
    Result<report::Built> made = report::build_model(input, decoder, RuleFilter(settings.value()->rules));
    if (!made) {
      complain(made.error());
      status = kExitFailed;
      continue;
    }
    if (!made->model.capture.broken.empty()) {
      complain(made->model.capture.broken);
      status = kExitFailed;
    } else if (made->model.verdict.kind == report::VerdictKind::kNothingChecked) {
      status = worse_status(status, kExitNothing);
    }
    if (!against.empty()) {
      Result<report::Built> other = build_other(against, options);
      if (!other) {
        complain(other.error());
        return kExitFailed;
      }
      made->model.comparison = report::compare(made->model, other->model);
    }
    if (built.empty()) shown = std::move(decoder);
    built.push_back(std::move(*made));
  }
  if (built.empty()) return kExitFailed;
  std::string text;
  switch (*page) {
    case Page::kHtml:
      text = report::html(built, shown);
      break;
    case Page::kMarkdown:
      text = report::markdown(built, shown);
      break;
    case Page::kJson:
      text = report::json(built, shown);
      break;
  }
  Result<std::unique_ptr<WholeFile>> file = WholeFile::create(out_path);
  if (!file) {
    complain(file.error());
    return kExitFailed;
  }
  file.value()->write(std::string_view(text));
  if (const Result<void> done = file.value()->finish(); !done) {
    complain(done.error());
    return kExitFailed;
  }
  for (const report::Built& entry : built) {
    StandardOut out;
    out.write(fmt::format("{}: {}\n", entry.model.capture.file, entry.model.verdict.headline));
    if (const Result<void> done = out.finish(); !done) {
      complain(done.error());
      return kExitFailed;
    }
  }
  return status;
}

}  // namespace servotrace::replay
