// SPDX-License-Identifier: MIT
#include "replay/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>

#include "replay/commands.hpp"
#include "replay/console.hpp"
#include "replay/exit_status.hpp"
#include "replay/settings/suggest.hpp"

namespace servotrace::replay {
namespace {

// "--slect" of "--slect=RX".
std::string option_word(const std::string& word) { return word.substr(0, word.find('=')); }

std::string unknown_words(const CLI::App& app, const std::string& word) {
  if (word.size() < 2 || word[0] != '-') return fmt::format("unexpected '{}'", word);
  std::vector<std::string> names;
  for (const CLI::Option* const option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  const std::vector<std::string_view> views(names.begin(), names.end());
  const std::string option = option_word(word);
  return fmt::format("unknown option '{}'{}", option, did_you_mean(option, views));
}

}  // namespace

std::optional<int> parse(CLI::App& app, const Arguments& arguments) {
  app.allow_extras();
  // "--output sarif=a.sarif run.pcapng": an option that may stand several times takes one word each time.
  for (CLI::Option* const option : app.get_options()) {
    if (!option->get_lnames().empty()) option->allow_extra_args(false);
  }
  try {
    std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
    app.parse(reversed);
    const std::vector<std::string> rest = app.remaining();
    if (rest.empty()) return {};
    complain(fmt::format("{}; see '{} --help'", unknown_words(app, rest.front()), app.get_name()));
  } catch (const CLI::CallForHelp&) {
    StandardOut out;
    out.write(app.help());
    return out.finish() ? kExitClean : kExitFailed;
  } catch (const CLI::ParseError& error) {
    // CLI11 takes a missing positional for the fault where an unknown option is.
    const std::vector<std::string> rest = app.remaining();
    const bool unknown = !rest.empty() && rest.front().size() > 1 && rest.front()[0] == '-';
    complain(
        fmt::format("{}; see '{} --help'", unknown ? unknown_words(app, rest.front()) : error.what(), app.get_name()));
  }
  return kExitFailed;
}

int run_servotrace(const Arguments& arguments) {
  const auto usage = [] {
    std::string text =
        "servotrace: decodes, checks and explains recorded servo drive traffic (RTEX, DeviceNet)\n\n"
        "Usage: servotrace COMMAND [OPTIONS] ...\n\nCommands:\n";
    for (const Command& command : commands()) text += fmt::format("  {:<10} {}\n", command.name, command.summary);
    text +=
        "\n'servotrace COMMAND --help' tells the options of a command.\n\n"
        "Examples:\n"
        "  servotrace check run.pcapng\n"
        "  servotrace check captures/ --output sarif=findings.sarif --fail-on warning\n"
        "  dumpcap -i can0 -w - | servotrace check - --devicenet\n"
        "  servotrace explain RX201\n";
    return text;
  };
  if (arguments.empty()) {
    complain("a command is missing; see 'servotrace --help'");
    return kExitFailed;
  }
  const std::string& word = arguments.front();
  if (word == "--help" || word == "-h" || word == "help") {
    StandardOut out;
    out.write(usage());
    return out.finish() ? kExitClean : kExitFailed;
  }
  if (word == "--version") {
    StandardOut out;
    out.write("servotrace " SERVOTRACE_VERSION "\n");
    return out.finish() ? kExitClean : kExitFailed;
  }
  for (const Command& command : commands()) {
    if (command.name == word) return command.run(Arguments(arguments.begin() + 1, arguments.end()));
  }
  std::vector<std::string_view> names;
  for (const Command& command : commands()) names.push_back(command.name);
  complain(fmt::format("unknown command '{}'{}; see 'servotrace --help'", word, did_you_mean(word, names)));
  return kExitFailed;
}

void CaptureOptions::add_config_to(CLI::App& app) {
  app.add_option("--config", config_, "Settings file (default: servotrace.toml found upward from the capture's folder)")
      ->type_name("FILE");
}

void CaptureOptions::add_to(CLI::App& app) {
  add_config_to(app);
  app.add_flag("--devicenet", devicenet_, "Take 11-bit CAN for DeviceNet without further evidence");
}

Result<std::shared_ptr<const FileSettings>> CaptureOptions::settings(const std::filesystem::path& capture) {
  std::filesystem::path path = config_;
  if (path.empty()) path = find_settings(capture).value_or("");
  std::shared_ptr<const FileSettings>& entry = read_[path.string()];
  if (entry != nullptr) return entry;
  FileSettings settings;
  if (!path.empty()) {
    Result<FileSettings> read = read_settings(path);
    if (!read) return read.error();
    settings = std::move(*read);
  }
  settings.decoder.devicenet.assumed = devicenet_;
  settings.decoder.max_findings = max_findings;
  entry = std::make_shared<const FileSettings>(std::move(settings));
  return entry;
}

std::optional<Severity> severity_of(std::string_view word) {
  for (const Severity severity : {Severity::kNote, Severity::kWarning, Severity::kError}) {
    if (name_of(severity) == word) return severity;
  }
  return {};
}

std::optional<Actor> actor_of(std::string_view word) {
  for (const Actor actor : {Actor::kMaster, Actor::kDrive, Actor::kNetwork, Actor::kCapture}) {
    if (name_of(actor) == word) return actor;
  }
  return {};
}

std::optional<std::pair<std::uint64_t, std::uint64_t>> parse_range(std::string_view word) {
  const auto number = [](std::string_view digits, std::uint64_t missing) -> std::optional<std::uint64_t> {
    if (digits.empty()) return missing;
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size() || value == 0) return {};
    return value;
  };
  const std::size_t dash = word.find('-');
  if (word.empty() || word == "-") return {};
  const std::string_view left = word.substr(0, dash);
  const auto first = number(left, 1);
  const auto last = dash == std::string_view::npos ? first : number(word.substr(dash + 1), UINT64_MAX);
  if (!first || !last || *first > *last) return {};
  return std::pair(*first, *last);
}

std::vector<std::string> split_list(const std::vector<std::string>& words) {
  std::vector<std::string> list;
  for (const std::string& word : words) {
    for (std::size_t start = 0; start <= word.size();) {
      const std::size_t comma = std::min(word.find(',', start), word.size());
      if (comma > start) list.push_back(word.substr(start, comma - start));
      start = comma + 1;
    }
  }
  return list;
}

}  // namespace servotrace::replay
