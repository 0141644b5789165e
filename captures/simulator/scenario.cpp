// SPDX-License-Identifier: MIT
#include "captures/simulator/scenario.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "captures/simulator/bus.hpp"
#include "decoder/findings/catalogue.hpp"

namespace servotrace::simulator {
namespace {

Result<toml::table> parse_toml(std::string_view text, const std::string& origin) {
  try {
    return toml::parse(text, origin);
  } catch (const toml::parse_error& error) {
    const toml::source_position at = error.source().begin;
    return Error{origin + ':' + std::to_string(at.line) + ':' + std::to_string(at.column),
                 std::string(error.description())};
  }
}

void check_rule(TableReader& reader, std::string_view key, const std::string& id) {
  if (find_rule(id) == kRuleCount) reader.fail(key, "there is no rule \"" + id + '"');
}

std::vector<std::string> read_rules(TableReader& reader, std::string_view key) {
  std::vector<std::string> rules = reader.texts(key);
  for (const std::string& id : rules) check_rule(reader, key, id);
  return rules;
}

ExpectedFinding read_expected(const toml::table& table, Problems& problems) {
  TableReader reader(table, problems);
  ExpectedFinding expected;
  expected.rule = reader.text("rule");
  if (!problems.any()) check_rule(reader, "rule", expected.rule);
  expected.any_node = !reader.has("mac_id");
  expected.mac_id = static_cast<int>(reader.integer("mac_id", -1, -1, 63));
  expected.channel = reader.choice<std::string>(
      "channel", "",
      {{"main", "main"}, {"sub", "sub"}, {"poll", "poll"}, {"explicit", "explicit"}, {"unconnected", "unconnected"}});
  expected.findings = static_cast<std::uint32_t>(reader.integer("findings", 1, 1, 1'000'000));
  expected.severity =
      reader.choice<std::string>("severity", "", {{"error", "error"}, {"warning", "warning"}, {"note", "note"}});
  expected.cause = reader.text("cause", "");
  if (!expected.cause.empty()) check_rule(reader, "cause", expected.cause);
  reader.done();
  return expected;
}

struct Bus {
  void (*simulate)(const BusJob&);
  std::size_t index;  // among buses of its kind
  const toml::table* table;
};

// In the order of the file, so that interfaces are numbered as one reads them.
std::vector<Bus> read_buses(TableReader& reader) {
  std::vector<Bus> buses;
  const auto append = [&](std::string_view key, void (*simulate)(const BusJob&)) {
    std::size_t index = 0;
    for (const toml::table* table : reader.tables(key)) buses.push_back({simulate, index++, table});
  };
  append("ring", simulate_ring);
  append("can", simulate_can);
  append("raw", simulate_raw);
  std::stable_sort(buses.begin(), buses.end(), [](const Bus& left, const Bus& right) {
    return left.table->source().begin.line < right.table->source().begin.line;
  });
  return buses;
}

struct Document {
  Scenario scenario;
  std::vector<Bus> buses;
};

Document read_document(const toml::table& root, Problems& problems) {
  Document document;
  Scenario& scenario = document.scenario;
  TableReader reader(root, problems);
  scenario.title = reader.text("title");
  scenario.description = reader.text("description", "");
  scenario.rules = read_rules(reader, "rules");
  scenario.silent = read_rules(reader, "silent");
  scenario.shipped = reader.boolean("shipped", false);
  if (const toml::table* settings = reader.table("settings")) {
    std::ostringstream text;
    text << toml::toml_formatter(*settings);
    scenario.settings = text.str();
  }
  for (const toml::table* entry : reader.tables("expect")) scenario.expect.push_back(read_expected(*entry, problems));
  document.buses = read_buses(reader);
  if (document.buses.empty()) problems.add(root.source(), "a scenario needs a [[ring]], a [[can]] or a [[raw]] table");
  reader.done();
  for (const std::string& id : scenario.rules) {
    const bool expected = std::any_of(scenario.expect.begin(), scenario.expect.end(),
                                      [&](const ExpectedFinding& entry) { return entry.rule == id; });
    if (!expected) reader.fail("rules", "\"rules\" names " + id + ", which no [[expect]] row does");
  }
  for (const ExpectedFinding& entry : scenario.expect) {
    if (std::find(scenario.silent.begin(), scenario.silent.end(), entry.rule) != scenario.silent.end())
      reader.fail("silent", "\"silent\" names " + entry.rule + ", which an [[expect]] row expects");
  }
  return document;
}

}  // namespace

Result<Scenario> parse_scenario(std::string_view text, std::string origin) {
  Result<toml::table> root = parse_toml(text, origin);
  if (!root) return root.error();
  Problems problems(origin);
  Scenario scenario = read_document(*root, problems).scenario;
  if (problems.any()) return problems.error();
  scenario.source = text;
  scenario.name = std::filesystem::path(origin).stem().string();
  scenario.origin = std::move(origin);
  return scenario;
}

Result<Scenario> read_scenario(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (file) text << file.rdbuf();
  if (!file || file.bad()) return Error{path.string(), "the scenario cannot be read"};
  return parse_scenario(text.str(), path.string());
}

Result<Simulation> simulate(const Scenario& scenario) {
  Result<toml::table> root = parse_toml(scenario.source, scenario.origin);
  if (!root) return root.error();
  Problems problems(scenario.origin);
  const Document document = read_document(*root, problems);
  Recording recording;
  for (const Bus& bus : document.buses) {
    if (problems.any()) break;
    bus.simulate({*bus.table, problems, recording, kSimulationStartNs, bus.index});
  }
  if (problems.any()) return problems.error();
  return recording.finish();
}

}  // namespace servotrace::simulator
