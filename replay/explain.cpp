// SPDX-License-Identifier: MIT
// servotrace explain: a rule's page.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "decoder/findings/catalogue.hpp"
#include "replay/commands.hpp"
#include "replay/console.hpp"
#include "replay/exit_status.hpp"
#include "replay/rule_page.hpp"

namespace servotrace::replay {

int run_explain(const Arguments& arguments) {
  CLI::App app("A rule's page: what, why, fix, manual section, traces that violate it and that do not.",
               "servotrace explain");
  std::vector<std::string> names;
  app.add_option("RULE", names, "Ids (RX201), slugs (update-counter-stuck) or prefixes (RX2)")->required();
  app.footer("Examples:\n  servotrace explain RX201\n  servotrace explain update-counter-stuck");
  if (const std::optional<int> status = parse(app, arguments)) return *status;
  std::vector<const Rule*> rows;
  for (const std::string& name : names) {
    std::string upper = name;
    std::transform(upper.begin(), upper.end(), upper.begin(),
                   [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
    const std::size_t before = rows.size();
    for (const Rule& row : kCatalogue) {
      if (row.slug == name || row.id.starts_with(upper)) rows.push_back(&row);
    }
    if (rows.size() == before) {
      complain(fmt::format("no rule '{}'{}; 'servotrace rules' lists them", name, did_you_mean_rule(upper)));
      return kExitFailed;
    }
  }
  StandardOut out;
  const Style style(use_colour(When::kAuto, 1));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i != 0) out.write("\n");
    out.write(rule_page(*rows[i], style));
  }
  if (const Result<void> finished = out.finish(); !finished) {
    complain(finished.error());
    return kExitFailed;
  }
  return kExitClean;
}

}  // namespace servotrace::replay
