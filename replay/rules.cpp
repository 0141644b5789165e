// SPDX-License-Identifier: MIT
// servotrace rules: the catalogue.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iterator>

#include "decoder/findings/catalogue.hpp"
#include "decoder/render/json.hpp"
#include "replay/commands.hpp"
#include "replay/console.hpp"
#include "replay/exit_status.hpp"
#include "replay/rule_page.hpp"
#include "replay/settings/rule_filter.hpp"

namespace servotrace::replay {
namespace {

std::string as_text(const std::vector<const Rule*>& rows) {
  std::size_t widest = 0;
  for (const Rule* const row : rows) widest = std::max(widest, row->slug.size());
  std::string text;
  for (const Rule* const row : rows) {
    fmt::format_to(std::back_inserter(text), "{}  {:<7}  {:<7}  {:<{}}  {}\n", row->id, name_of(row->severity),
                   name_of(row->actor), row->slug, widest, row->title);
  }
  return text;
}

std::string as_json(const std::vector<const Rule*>& rows) {
  std::string text;
  JsonWriter json(text, 2);
  json.begin_array();
  for (const Rule* const row : rows) {
    json.begin_object()
        .member("id", row->id)
        .member("slug", row->slug)
        .member("severity", name_of(row->severity))
        .member("actor", name_of(row->actor))
        .member("title", row->title)
        .member("message", row->message)
        .member("section", row->section)
        .member("why", row->why)
        .member("fix", row->fix)
        .member("repeat", row->repeat == Repeat::kEach      ? "each"
                          : row->repeat == Repeat::kEpisode ? "episode"
                                                            : "once")
        .member("offline_only", row->hosts == Hosts::kOfflineOnly)
        .member("lowered_when_assumed", row->lowered_when_assumed)
        .member("needs_every_cycle", row->needs_every_cycle)
        .end_object();
  }
  json.end_array();
  return text + "\n";
}

// Text inside a Markdown table.
std::string cell(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '|' || c == '<' || c == '*' || c == '_' || c == '`') out += '\\';
    out += c;
  }
  return out;
}

std::string as_markdown(const std::vector<const Rule*>& rows) {
  std::string text = "| rule | severity | actor | slug | title | manual |\n|---|---|---|---|---|---|\n";
  for (const Rule* const row : rows) {
    fmt::format_to(std::back_inserter(text), "| {} | {} | {} | `{}` | {} | {} |\n", row->id, name_of(row->severity),
                   name_of(row->actor), row->slug, cell(row->title), cell(row->section));
  }
  return text;
}

}  // namespace

int run_rules(const Arguments& arguments) {
  CLI::App app("The catalogue of rules.", "servotrace rules");
  std::string format = "text";
  std::vector<std::string> select;
  app.add_option("--format", format, "text, json or markdown")
      ->check(CLI::IsMember({"text", "json", "markdown"}))
      ->capture_default_str();
  app.add_option("--select", select, "Only these rules: ids or prefixes (RX3, DN)")
      ->type_name("RULES")
      ->allow_extra_args(false);
  app.footer("Examples:\n  servotrace rules\n  servotrace rules --format json");
  if (const std::optional<int> status = parse(app, arguments)) return *status;
  RuleFilter filter;
  if (const Result<void> known = filter.select(split_list(select)); !known) {
    complain(Error{"--select", known.error().what});
    return kExitFailed;
  }
  std::vector<const Rule*> rows;
  for (std::size_t i = 0; i < kRuleCount; ++i) {
    if (filter.is_shown(static_cast<RuleId>(i))) rows.push_back(&kCatalogue[i]);
  }
  StandardOut out;
  out.write(format == "json" ? as_json(rows) : format == "markdown" ? as_markdown(rows) : as_text(rows));
  if (const Result<void> finished = out.finish(); !finished) {
    complain(finished.error());
    return kExitFailed;
  }
  return kExitClean;
}

}  // namespace servotrace::replay
