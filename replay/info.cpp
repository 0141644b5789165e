// SPDX-License-Identifier: MIT
// servotrace info: what is in a capture.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iterator>

#include "decoder/render/json.hpp"
#include "decoder/render/value.hpp"
#include "replay/commands.hpp"
#include "replay/console.hpp"
#include "replay/exit_status.hpp"
#include "replay/inputs.hpp"
#include "replay/output/records.hpp"
#include "replay/results.hpp"
#include "replay/statistic_text.hpp"

namespace servotrace::replay {
namespace {

std::string basis_text(const Basis& basis) {
  switch (basis.kind) {
    case BasisKind::kNone:
      return "";
    case BasisKind::kConfigured:
      return " (configured)";
    case BasisKind::kCapture:
      return fmt::format(" (frame {})", basis.frame);
    case BasisKind::kAssumed:
      return " (assumed)";
  }
  return "";
}

void append(std::string& text, const CaptureRecord& capture, const CaptureResult& result) {
  const auto to = std::back_inserter(text);
  fmt::format_to(to, "{}\n", capture.file);
  if (!capture.format.empty()) fmt::format_to(to, "  format: {}\n", capture.format);
  for (std::size_t i = 0; i < result.interfaces.size(); ++i) {
    const InterfaceInfo& entry = result.interfaces[i];
    fmt::format_to(to, "  interface {}: {}link type {}, time resolution {}\n", i,
                   entry.name.empty() ? "" : entry.name + ", ", static_cast<unsigned>(entry.link_type),
                   duration_text(entry.time_resolution_ns));
  }
  fmt::format_to(to, "  frames: {} ({} of a known bus)\n", capture.frames, capture.checked_frames);
  if (result.summary.untracked_frames != 0) {
    fmt::format_to(to, "  frames not looked at (too many interfaces or buses): {}\n", result.summary.untracked_frames);
  }
  if (capture.first_time_ns) {
    fmt::format_to(to, "  time: {} to {} ({})\n", time_text(*capture.first_time_ns), time_text(*capture.last_time_ns),
                   duration_text(elapsed_ns(*capture.first_time_ns, *capture.last_time_ns)));
  }
  for (const NodeRecord& node : capture.nodes) {
    if (!node.node.mac_id) {
      fmt::format_to(to, "  bus {}: {}{}{}, {} frames{}\n", node.node.bus,
                     node.node.protocol.empty() ? "CAN, no evidence of DeviceNet" : node.node.protocol,
                     node.recognised.empty() ? "" : ", ", node.recognised, node.frames,
                     node.sampled ? ", sampled (rules that need every cycle are silent)" : "");
    } else {
      fmt::format_to(to, "    {}{}{}{}{}\n", node.node.text(), node.profile.empty() ? "" : ": ", node.profile,
                     node.recognised.empty() ? "" : ", ", node.recognised);
    }
    for (const Fact& fact : node.settings) {
      fmt::format_to(to, "{}{} = {}{}\n", node.node.mac_id ? "      " : "    ", fact.key, fact.value,
                     basis_text(fact.basis));
    }
  }
  if (!capture.statistics.empty()) fmt::format_to(to, "  measured ({}):\n", kStatisticColumns);
  for (const StatisticRecord& statistic : capture.statistics) {
    fmt::format_to(to, "    {}\n", statistic_text(capture, statistic));
  }
  for (const Finding& finding : result.findings) {
    const std::string_view id = rule_row(finding.rule).id;
    if (id == "CP101" || id == "CP103") {
      const FindingRecord record = make_record(finding, result, Settings{});
      fmt::format_to(to, "  frame {}: {}{}\n", record.frame, record.message,
                     record.count > 1 ? fmt::format(" ({} times)", record.count) : "");
    }
  }
}

void append_json(std::string& text, const CaptureRecord& capture) {
  const auto line = [&](std::string_view type, auto write, const auto& record) {
    JsonWriter json(text);
    json.begin_object().member("type", type);
    if (type != "capture") json.member("file", capture.file);
    write(json, record);
    json.end_object();
    text += '\n';
  };
  line("capture", write_capture, capture);
  for (const NodeRecord& node : capture.nodes) line("node", write_node, node);
  for (const StatisticRecord& statistic : capture.statistics) line("statistic", write_statistic, statistic);
}

}  // namespace

int run_info(const Arguments& arguments) {
  CLI::App app("What is in a capture: buses, rings, nodes, drives recognised, cycles, learnt settings, losses.",
               "servotrace info");
  std::vector<std::string> captures;
  std::string format = "text";
  CaptureOptions capture_options;
  app.add_option("CAPTURE", captures, "Files, folders, or - for standard input")->required();
  capture_options.add_to(app);
  app.add_option("--format", format, "text or jsonl")->check(CLI::IsMember({"text", "jsonl"}))->capture_default_str();
  app.footer(
      "Exit status: 0 done, 2 could not do the job, 3 no frame of a known bus.\n\n"
      "Examples:\n  servotrace info run.pcapng\n  servotrace info captures/ --format jsonl");
  if (const std::optional<int> status = parse(app, arguments)) return *status;
  const Result<std::vector<CaptureInput>> inputs = expand_inputs(captures);
  if (!inputs) {
    complain(inputs.error());
    return kExitFailed;
  }
  StandardOut out;
  int status = kExitClean;
  bool is_first = true;
  for (const CaptureInput& input : *inputs) {
    const auto settings = capture_options.settings(input.path);
    if (!settings) {
      complain(settings.error());
      return kExitFailed;
    }
    const CaptureResult result = run_input(input, (*settings)->decoder);
    const CaptureRecord record = describe(result, (*settings)->decoder);
    if (result.error) complain(*result.error);
    if (result.error) status = worse_status(status, kExitFailed);
    if (record.checked_frames == 0) status = worse_status(status, kExitNothing);
    if (result.format.empty()) continue;
    std::string text;
    if (format == "jsonl") {
      append_json(text, record);
    } else {
      if (!is_first) text += '\n';
      append(text, record, result);
    }
    is_first = false;
    out.write(text);
  }
  if (const Result<void> finished = out.finish(); !finished) {
    complain(finished.error());
    return kExitFailed;
  }
  return status;
}

}  // namespace servotrace::replay
