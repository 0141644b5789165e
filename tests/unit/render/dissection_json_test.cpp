// SPDX-License-Identifier: MIT
// A writer that keeps its texts writes what one that has none writes.
#include "decoder/render/dissection_json.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "decoder/pipeline/pipeline.hpp"
#include "decoder/render/text_cache.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/scenarios.hpp"

namespace servotrace::test {
namespace {

std::string line_of(DissectionJson& writer, const Dissection& dissection) {
  std::string text;
  JsonWriter json(text);
  json.begin_object();
  writer.write(json, dissection);
  json.end_object();
  return text;
}

void compare(const simulator::Simulation& simulation, const Settings& settings) {
  Pipeline pipeline(settings);
  DissectionJson keeps(settings);
  const auto dissection = std::make_unique<Dissection>();
  for (std::size_t i = 0; i < simulation.frames.size(); ++i) {
    pipeline.push(raw_frame(simulation, i), dissection.get());
    if (i % 7 != 0) {
      line_of(keeps, *dissection);
      continue;
    }
    DissectionJson knows_nothing(settings);
    const std::string expected = line_of(knows_nothing, *dissection);
    ASSERT_EQ(line_of(keeps, *dissection), expected) << "frame " << i + 1;
    ASSERT_TRUE(nlohmann::json::accept(expected)) << expected;
  }
}

TEST(DissectionJson, KeptTextsAreTheSameTexts) {
  const std::vector<std::filesystem::path> paths = scenario_files();
  for (std::size_t i = 0; i < paths.size(); i += kSanitized ? 6 : 1) {
    const std::filesystem::path& path = paths[i];
    SCOPED_TRACE(path.stem().string());
    const simulator::Scenario scenario = load_scenario(path);
    compare(simulate_scenario(scenario), settings_of(scenario));
    if (HasFailure()) return;
  }
}

struct Number {
  std::uint64_t value = 0;
  bool operator==(const Number&) const = default;
  std::uint64_t hash() const { return value; }
};

TEST(TextCache, GivesTheTextOfItsKey) {
  TextCache<Number> cache(3);
  std::size_t made = 0;
  const auto text_of = [&](std::uint64_t value) {
    return std::string(cache.get({value}, [&](std::string& text) {
      text += std::to_string(value);
      ++made;
    }));
  };
  for (std::uint64_t value = 0; value < 1000; ++value) {
    EXPECT_EQ(text_of(value % 50), std::to_string(value % 50));
    EXPECT_EQ(text_of(7), "7");
  }
  EXPECT_LT(made, 1100U);
  made = 0;
  text_of(0);
  for (int i = 0; i < 10; ++i) text_of(0);
  EXPECT_LE(made, 1U);
}

}  // namespace
}  // namespace servotrace::test
