// SPDX-License-Identifier: MIT
// servotrace report: the post-mortem report.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "replay/capture/whole_file.hpp"
#include "replay/commands.hpp"
#include "replay/console.hpp"
#include "replay/exit_status.hpp"
#include "replay/inputs.hpp"
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

}  // namespace

int run_report(const Arguments& arguments) {
  CLI::App app("The post-mortem report of captures: what failed first, what preceded it, and the evidence.",
               "servotrace report");
  std::vector<std::string> captures;
  std::string out_path;
  app.add_option("CAPTURE", captures, "files or folders")->required();
  app.add_option("-o,--output-file", out_path, "where to write: FILE.html, FILE.md or FILE.json")->required();
  CaptureOptions options;
  options.add_to(app);
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
