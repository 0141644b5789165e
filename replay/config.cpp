// SPDX-License-Identifier: MIT
// servotrace config --init: a commented servotrace.toml from what a capture shows.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iterator>
#include <set>

#include "decoder/pipeline/registry.hpp"
#include "decoder/render/json.hpp"
#include "replay/capture/whole_file.hpp"
#include "replay/commands.hpp"
#include "replay/console.hpp"
#include "replay/exit_status.hpp"
#include "replay/inputs.hpp"
#include "replay/results.hpp"
#include "replay/settings/limit_rows.hpp"

namespace servotrace::replay {
namespace {

std::string basis_comment(const Basis& basis) {
  if (basis.kind == BasisKind::kCapture) return fmt::format("  # frame {}", basis.frame);
  return basis.kind == BasisKind::kAssumed ? "  # assumed" : "";
}

const Fact* find_fact(const std::vector<Fact>& facts, std::string_view key) {
  for (const Fact& fact : facts) {
    if (fact.key == key && fact.basis.kind != BasisKind::kAssumed) return &fact;
  }
  return nullptr;
}

bool is_integer(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

// The whole number in front of a fact's value ("8 (frame 12)"), or empty.
std::string leading_integer(std::string_view value) {
  const std::size_t sign = !value.empty() && value[0] == '-' ? 1 : 0;
  const std::size_t end = std::min(value.find_first_not_of("0123456789", sign), value.size());
  return end == sign ? std::string() : std::string(value.substr(0, end));
}

// What of the ring's facts the settings have a key for.
void append_ring(std::string& text, const NodeRecord& ring) {
  const auto to = std::back_inserter(text);
  if (const Fact* const cycle = find_fact(ring.settings, "communication_cycle_us")) {
    fmt::format_to(to, "communication_cycle_us = {}{}\n", cycle->value, basis_comment(cycle->basis));
  } else {
    text += "# communication_cycle_us = 500        # not shown: 83.333, 166.667, 500 or 1000\n";
  }
  if (const Fact* const ratio = find_fact(ring.settings, "command_update_ratio"); ratio && is_integer(ratio->value)) {
    fmt::format_to(to, "command_update_ratio = {}{}\n", ratio->value, basis_comment(ratio->basis));
  } else {
    text += "# command_update_ratio = 1            # not shown: 1 or 2\n";
  }
  if (const Fact* const sync = find_fact(ring.settings, "sync")) {
    fmt::format_to(to, "sync = \"{}\"{}\n", sync->value, basis_comment(sync->basis));
  } else {
    text += "# sync = \"semi\"                       # or \"full\" (Pr7.22 bit 1)\n";
  }
}

void append_axis(std::string& text, const NodeRecord& axis) {
  const auto to = std::back_inserter(text);
  text += "\n[[rtex.axis]]\n";
  if (axis.node.bus.starts_with("ring") && is_integer(axis.node.bus.substr(4)) && axis.node.bus != "ring0") {
    fmt::format_to(to, "ring = {}\n", axis.node.bus.substr(4));
  }
  fmt::format_to(to, "mac_id = {}\n# name = \"X\"\n", *axis.node.mac_id);
  std::string parameters;
  for (const Fact& fact : axis.settings) {
    const bool known = fact.basis.kind == BasisKind::kCapture || fact.basis.kind == BasisKind::kConfigured;
    const std::string value = leading_integer(fact.value);
    // Single bits ("Pr7.23 bit 0") are no whole parameter.
    const bool whole = fact.key.starts_with("Pr") && fact.key.find_first_not_of("0123456789.", 2) == std::string::npos;
    if (!known || !whole || value.empty()) continue;
    parameters += fmt::format("{}\"{}\" = {}", parameters.empty() ? "" : ", ", fact.key.substr(2), value);
  }
  if (const Fact* const size = find_fact(axis.settings, "data_size"); size && is_integer(size->value)) {
    fmt::format_to(to, "data_size = {}{}\n", size->value, basis_comment(size->basis));
  }
  text +=
      "# control = \"semi-closed\"             # or \"full-closed\" (Pr0.01)\n"
      "# position = \"incremental\"            # or \"absolute\"\n";
  if (parameters.empty()) {
    text += "# parameters = { \"7.23\" = 0 }         # as the drive has them\n";
  } else {
    fmt::format_to(to, "parameters = {{ {} }}    # as the capture shows them\n", parameters);
  }
  text += "# max_speed = 200000                  # command units a second\n";
}

void append_node(std::string& text, const NodeRecord& node) {
  const auto to = std::back_inserter(text);
  fmt::format_to(to, "\n[[devicenet.node]]\nmac_id = {}\n# name = \"\"\n", *node.node.mac_id);
  const std::vector<std::string_view> keys = profile_keys();
  if (std::find(keys.begin(), keys.end(), node.profile) != keys.end()) {
    fmt::format_to(to, "profile = \"{}\"{}\n", node.profile,
                   node.recognised.empty() ? "" : fmt::format("    # {}", node.recognised));
  } else {
    fmt::format_to(to, "# profile = \"{}\"                 # one of: {}\n", keys.front(), fmt::join(keys, ", "));
  }
}

void append_limits(std::string& text) {
  const Limits limits;
  const auto line = [&text](std::string_view key, std::int64_t value) {
    fmt::format_to(std::back_inserter(text), "# {} = {}\n", key, value);
  };
  text += "\n[limits]                              # the defaults\n";
  for (const LimitRow& row : kLimitRows) line(row.key, limits.*row.member);
  fmt::format_to(std::back_inserter(text), "# moving_speed = {}                   # r/min; none where Pr7.25 = 1\n",
                 kDefaultMovingSpeed);
}

std::string settings_text(const CaptureRecord& capture) {
  std::string text = fmt::format("# Settings of servotrace, from what {} shows. Lines behind # are not in force.\n",
                                 valid_utf8(capture.file));
  bool has_ring = false;
  for (const NodeRecord& node : capture.nodes) {
    if (node.node.mac_id || node.node.protocol != "rtex") continue;
    if (!has_ring) {
      text += "\n[rtex]\n";
      append_ring(text, node);
    }
    has_ring = true;
  }
  for (const NodeRecord& node : capture.nodes) {
    if (node.node.mac_id && node.node.protocol == "rtex") append_axis(text, node);
  }
  // The settings name a DeviceNet node by its MAC ID alone, on whatever bus.
  std::set<int> nodes;
  for (const NodeRecord& node : capture.nodes) {
    const bool is_node = node.node.mac_id && node.node.protocol == "devicenet";
    if (is_node && nodes.insert(*node.node.mac_id).second) append_node(text, node);
  }
  append_limits(text);
  text +=
      "\n[rules]\n# ignore = []\n# severity = {}\n\n"
      "# [[suppress]]\n# rule = \"RX202\"\n# mac_id = 3\n# reason = \"why this is known and accepted\"\n"
      "# until = 2027-01-31\n";
  return text;
}

}  // namespace

int run_config(const Arguments& arguments) {
  CLI::App app("Writes a commented servotrace.toml from what a capture shows.", "servotrace config");
  std::string capture;
  std::string out_path;
  CaptureOptions capture_options;
  app.add_option("--init", capture, "The capture")->required()->type_name("CAPTURE");
  app.add_option("-o,--output", out_path, "The file to write (default: standard output)")->type_name("FILE");
  capture_options.add_to(app);
  app.footer(
      "Exit status: 0 done, 2 could not do the job, 3 no frame of a known bus.\n\n"
      "Example:\n  servotrace config --init run.pcapng -o servotrace.toml");
  if (const std::optional<int> status = parse(app, arguments)) return *status;
  const auto fail = [](const Error& error) {
    complain(error);
    return kExitFailed;
  };
  const Result<CaptureInput> input = single_input(capture);
  if (!input) return fail(input.error());
  const auto settings = capture_options.settings(input->path);
  if (!settings) return fail(settings.error());
  const CaptureResult result = run_input(*input, (*settings)->decoder);
  if (result.error) return fail(*result.error);
  const CaptureRecord record = describe(result, (*settings)->decoder);
  if (record.checked_frames == 0) {
    complain(Error{input->name, "no frame of a known bus"});
    return kExitNothing;
  }
  const std::string text = settings_text(record);
  // What is written must be read back: a node given twice on two buses, say, is no settings file.
  if (const Result<FileSettings> read = parse_settings(text, "the settings made"); !read) return fail(read.error());
  if (out_path.empty()) {
    StandardOut out;
    out.write(text);
    if (const Result<void> finished = out.finish(); !finished) return fail(finished.error());
    return kExitClean;
  }
  std::error_code code;
  if (std::filesystem::exists(out_path, code)) return fail({out_path, "exists already: it is not overwritten"});
  const Result<std::unique_ptr<WholeFile>> file = WholeFile::create(out_path);
  if (!file) return fail(file.error());
  (*file)->write(text);
  if (const Result<void> written = (*file)->finish(); !written) return fail(written.error());
  return kExitClean;
}

}  // namespace servotrace::replay
