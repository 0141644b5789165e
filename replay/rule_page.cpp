// SPDX-License-Identifier: MIT
#include "replay/rule_page.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "decoder/render/message.hpp"
#include "replay/examples/rule_examples.hpp"

namespace servotrace::replay {
namespace {

std::string part(std::string_view title, std::string_view text, const Style& style) {
  return fmt::format("\n{}{}{}\n{}", style.bold(), title, style.reset(), wrapped(text, 4));
}

// What stands at a place of a message, where nothing was found yet.
std::string placeholder(const Argument& argument) {
  switch (argument.format) {
    case ArgumentFormat::kMilliseconds:
    case ArgumentFormat::kMicroseconds:
      return "<time>";
    case ArgumentFormat::kParameter:
      return "<Pr number>";
    case ArgumentFormat::kMainSub:
      return "<main.sub (name)>";
    case ArgumentFormat::kExactly:
      return "<, exactly main.sub (name)>";
    case ArgumentFormat::kBits:
      return "<numbers>";
    case ArgumentFormat::kFlags:
      return "<names>";
    case ArgumentFormat::kDecimalName:
      return "<number (name)>";
    case ArgumentFormat::kHex2Name:
    case ArgumentFormat::kHex4Name:
    case ArgumentFormat::kHex8Name:
      return "<code (name)>";
    case ArgumentFormat::kHex2:
    case ArgumentFormat::kHex4:
    case ArgumentFormat::kHex8:
      return "<code>";
    case ArgumentFormat::kName: {
      constexpr std::size_t kMost = 48;  // of letters, for all the names
      std::string names;
      for (const ValueName& value : argument.names) {
        if (value.name.empty()) return "<name>";
        names += fmt::format("{}{}", names.empty() ? "" : " | ", value.name);
      }
      return names.empty() || names.size() > kMost ? "<name>" : "<" + names + ">";
    }
    case ArgumentFormat::kDecimal:
      break;
  }
  return "<number>";
}

// A trace as `check` and `decode --brief` print it.
std::string part_of(std::string_view title, const Example& example, const Style& style) {
  if (example.scenario.empty()) return "";
  std::string text = fmt::format("\n{}{}{}\n    {} (captures/scenarios/{}.toml)\n", style.bold(), title, style.reset(),
                                 example.title, example.scenario);
  for (std::string_view rest = example.trace; !rest.empty();) {
    const std::size_t end = std::min(rest.find('\n'), rest.size() - 1) + 1;
    text += fmt::format("    {}", rest.substr(0, end));
    rest.remove_prefix(end);
  }
  return text;
}

}  // namespace

std::string message_pattern(const Rule& row) {
  std::string text;
  for (std::string_view rest = row.message; !rest.empty();) {
    const MessagePart part = first_part(rest);
    if (part.is_argument) text += placeholder(row.arguments[part.argument]);
    text += part.is_argument && !part.text.empty() ? fmt::format(" {}s", part.text) : std::string(part.text);
    rest.remove_prefix(part.length);
  }
  return text;
}

std::string_view repeat_text(Repeat repeat) {
  switch (repeat) {
    case Repeat::kEach:
      return "every occurrence is a finding";
    case Repeat::kEpisode:
      return "one finding as long as the condition lasts, with its last frame and a count";
    case Repeat::kOnceNode:
      return "one finding a node, counted";
  }
  return "";
}

std::string wrapped(std::string_view text, std::size_t indent, std::size_t width) {
  std::string lines;
  std::string line(indent, ' ');
  bool is_empty = true;
  while (!text.empty()) {
    const std::size_t blank = std::min(text.find(' '), text.size());
    const std::string_view word = text.substr(0, blank);
    text.remove_prefix(std::min(blank + 1, text.size()));
    if (word.empty()) continue;
    if (!is_empty && line.size() + 1 + word.size() > width) {
      lines += line + "\n";
      line.assign(indent, ' ');
      is_empty = true;
    }
    if (!is_empty) line += ' ';
    line += word;
    is_empty = false;
  }
  return lines + line + "\n";
}

std::string rule_page(const Rule& row, const Style& style) {
  std::string text = fmt::format("{}{} {}{}\n{}", style.bold(), row.id, row.slug, style.reset(), wrapped(row.title, 4));
  text += part("Severity", fmt::format("{}; done by the {}", name_of(row.severity), name_of(row.actor)), style);
  text += part("Message", message_pattern(row), style);
  text += part("Why it matters", row.why, style);
  text += part("How to fix it", row.fix, style);
  text += part("Manual", row.section, style);
  if (!row.codes.names.empty()) text += fmt::format("\n{}Codes{}\n", style.bold(), style.reset());
  for (const ValueName& code : row.codes.names) {
    if (code.explanation.empty()) continue;
    text += wrapped(argument_text(row.codes, code.value), 4) + wrapped(code.explanation, 8);
  }
  std::string how(repeat_text(row.repeat));
  if (row.lowered_when_assumed) {
    how +=
        "; one severity lower, and once a node, where it rests on an assumption: nothing in the capture or the "
        "settings decides it";
  }
  if (row.needs_every_cycle) how += "; silent on sampled records, which do not show every cycle";
  if (row.hosts == Hosts::kOfflineOnly) how += "; in the command line only, a dissector does not see what shows it";
  text += part("How it is reported", how, style);
  if (const RuleExamples* const examples = find_examples(row.id)) {
    text += part_of("A trace that violates it", examples->violation, style);
    text += part_of("A trace that does not", examples->silent, style);
  }
  text += fmt::format("\n{}Leave it out{}\n    --ignore {}, or in servotrace.toml:  [rules] ignore = [\"{}\"]\n",
                      style.bold(), style.reset(), row.id, row.id);
  return text;
}

}  // namespace servotrace::replay
