// SPDX-License-Identifier: MIT
// The shipped captures are what their scenarios make, byte for byte, and captures/README.md lists them. With
// SERVOTRACE_WRITE_CAPTURES set in the environment the test writes captures and list instead.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>

#include "replay/capture/pcapng_writer.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/scenarios.hpp"

namespace servotrace::test {
namespace {

constexpr std::uintmax_t kLargestCapture = 200'000;  // bytes
constexpr std::uintmax_t kAllCaptures = 4'000'000;   // bytes
constexpr std::string_view kListBegins = "<!-- list: begin -->\n";
constexpr std::string_view kListEnds = "<!-- list: end -->\n";

bool writes() { return std::getenv("SERVOTRACE_WRITE_CAPTURES") != nullptr; }

std::filesystem::path captures() { return source_dir() / "captures"; }

std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream content;
  content << file.rdbuf();
  return content.str();
}

void write_capture(const simulator::Simulation& simulation, const std::filesystem::path& path) {
  auto writer = replay::PcapngWriter::create(path);
  ASSERT_TRUE(writer) << writer.error().text();
  for (const simulator::SimulatedInterface& entry : simulation.interfaces)
    (*writer)->add_interface(entry.link_type, entry.name);
  for (const simulator::SimulatedFrame& frame : simulation.frames)
    (*writer)->write(frame.interface_id, frame.time_ns, frame.bytes, frame.original_length);
  const Result<void> finished = (*writer)->finish();
  ASSERT_TRUE(finished) << finished.error().text();
}

std::vector<simulator::Scenario> shipped() {
  std::vector<simulator::Scenario> scenarios;
  for (const std::filesystem::path& path : scenario_files()) {
    simulator::Scenario scenario = load_scenario(path);
    if (scenario.shipped) scenarios.push_back(std::move(scenario));
  }
  return scenarios;
}

TEST(ShippedCaptures, AreWhatTheirScenariosMake) {
  std::uintmax_t sum = 0;
  std::set<std::string> names;
  for (const simulator::Scenario& scenario : shipped()) {
    SCOPED_TRACE(scenario.name);
    const std::filesystem::path kept = captures() / (scenario.name + ".pcapng");
    const std::filesystem::path made =
        writes() ? kept : std::filesystem::path(::testing::TempDir()) / (scenario.name + ".pcapng");
    write_capture(simulate_scenario(scenario), made);
    const std::string bytes = content_of(made);
    EXPECT_EQ(content_of(kept) == bytes, true) << "run with SERVOTRACE_WRITE_CAPTURES=1 to write it again";
    if (!writes()) std::filesystem::remove(made);
    EXPECT_LE(bytes.size(), kLargestCapture);
    sum += bytes.size();
    names.insert(kept.filename().string());
  }
  EXPECT_LE(sum, kAllCaptures);
  for (const auto& entry : std::filesystem::directory_iterator(captures())) {
    if (entry.path().extension() != ".pcapng") continue;
    EXPECT_TRUE(names.contains(entry.path().filename().string())) << entry.path() << " has no scenario that ships it";
  }
}

TEST(ShippedCaptures, StandInTheReadme) {
  std::string list = "| capture | what is in it | findings |\n|---|---|---|\n";
  for (const simulator::Scenario& scenario : shipped()) {
    std::string rules;
    for (const std::string& rule : scenario.rules) rules += (rules.empty() ? "" : ", ") + rule;
    list += "| [`" + scenario.name + ".pcapng`](scenarios/" + scenario.name + ".toml) | " + scenario.title + " | " +
            (rules.empty() ? "none" : rules) + " |\n";
  }
  const std::filesystem::path path = captures() / "README.md";
  std::string readme = content_of(path);
  const std::size_t begin = readme.find(kListBegins);
  const std::size_t end = readme.find(kListEnds);
  ASSERT_TRUE(begin != std::string::npos && end != std::string::npos && begin < end);
  const std::size_t first = begin + kListBegins.size();
  if (writes()) {
    readme.replace(first, end - first, list);
    std::ofstream(path, std::ios::binary) << readme;
  } else {
    EXPECT_EQ(readme.substr(first, end - first), list) << "run with SERVOTRACE_WRITE_CAPTURES=1 to write it again";
  }
}

}  // namespace
}  // namespace servotrace::test
