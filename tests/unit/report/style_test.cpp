// SPDX-License-Identifier: MIT
// The colours of the report can be told apart by everybody: contrast by WCAG 2.1 (1.4.3 text, 1.4.11 graphics), in
// light, dark and print.
#include "replay/report/style.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace servotrace::test {
namespace {

using Colour = std::array<double, 3>;  // 0 to 255
using Palette = std::map<std::string, Colour>;

constexpr double kText = 4.5;
constexpr double kGraphics = 3;

Colour colour_of(std::string digits) {
  if (digits.size() == 3) digits = {digits[0], digits[0], digits[1], digits[1], digits[2], digits[2]};
  EXPECT_EQ(digits.size(), 6U) << digits;
  Colour colour{};
  for (std::size_t i = 0; i < 3; ++i) colour[i] = std::stoi(digits.substr(2 * i, 2), nullptr, 16);
  return colour;
}

// The :root blocks of the style sheet, in its order: light, dark, print; the latter two change some colours.
std::vector<std::pair<std::string, Palette>> palettes() {
  const std::string sheet(report::kStyle);
  std::vector<std::pair<std::string, Palette>> found;
  const std::vector<std::string> names = {"light", "dark", "print"};
  for (std::size_t at = sheet.find(":root{"); at != std::string::npos; at = sheet.find(":root{", at + 1)) {
    Palette palette = found.empty() ? Palette() : found.front().second;
    const std::string block = sheet.substr(at + 6, sheet.find('}', at) - at - 6);
    for (std::size_t item = block.find("--"); item != std::string::npos; item = block.find("--", item + 2)) {
      const std::size_t colon = block.find(":#", item);
      const std::string name = block.substr(item + 2, colon - item - 2);
      palette[name] = colour_of(block.substr(colon + 2, block.find_first_of(";}", colon) - colon - 2));
    }
    found.emplace_back(found.size() < names.size() ? names[found.size()] : "more", palette);
  }
  return found;
}

double luminance(const Colour& colour) {
  double sum = 0;
  const Colour weights = {0.2126, 0.7152, 0.0722};
  for (std::size_t i = 0; i < 3; ++i) {
    const double part = colour[i] / 255;
    sum += weights[i] * (part <= 0.03928 ? part / 12.92 : std::pow((part + 0.055) / 1.055, 2.4));
  }
  return sum;
}

double contrast(const Colour& left, const Colour& right) {
  const double one = luminance(left);
  const double other = luminance(right);
  return (std::max(one, other) + 0.05) / (std::min(one, other) + 0.05);
}

struct Pair {
  std::string front;
  std::vector<std::string> grounds;  // what it stands on somewhere
};

TEST(ReportStyle, TheFormulaIsThatOfWcag) {
  EXPECT_NEAR(contrast(colour_of("000"), colour_of("fff")), 21, 0.001);
  EXPECT_NEAR(contrast(colour_of("777777"), colour_of("ffffff")), 4.478, 0.001);  // the well-known grey just below AA
}

TEST(ReportStyle, TextIsReadable) {
  const std::vector<Pair> pairs = {
      {"ink", {"paper", "panel", "stripe", "mark", "bad-soft", "warn-soft", "good-soft"}},
      {"soft", {"paper", "panel", "stripe"}},
      {"accent", {"paper", "stripe", "bad-soft"}},
      {"bad", {"paper", "panel", "stripe", "bad-soft"}},
      {"warn", {"paper", "panel", "stripe", "bad-soft"}},
      {"note", {"paper", "stripe"}},
      {"good", {"paper", "stripe"}},
      {"bar-ink", {"bar"}},
      {"bad-ink", {"bad"}},
  };
  const auto all = palettes();
  ASSERT_EQ(all.size(), 3U);
  for (const auto& [name, palette] : all) {
    for (const Pair& pair : pairs) {
      for (const std::string& ground : pair.grounds)
        EXPECT_GE(contrast(palette.at(pair.front), palette.at(ground)), kText)
            << name << ": " << pair.front << " on " << ground;
    }
  }
  // Nothing of the style sheet is left out, but what only parts areas from each other.
  std::set<std::string> seen = {"line"};
  for (const Pair& pair : pairs) {
    seen.insert(pair.front);
    seen.insert(pair.grounds.begin(), pair.grounds.end());
  }
  for (const auto& [colour, value] : all.front().second) EXPECT_TRUE(seen.contains(colour)) << colour;
}

TEST(ReportStyle, PicturesAreVisible) {
  for (const auto& [name, palette] : palettes()) {
    for (const std::string front : {"bar", "bad", "warn", "note", "accent", "soft"}) {
      for (const std::string ground : {"paper", "stripe"})
        EXPECT_GE(contrast(palette.at(front), palette.at(ground)), kGraphics)
            << name << ": " << front << " on " << ground;
    }
    // How long a finding lasted is drawn translucent.
    const std::string sheet(report::kStyle);
    const std::size_t at = sheet.find("svg .episode{");
    ASSERT_NE(at, std::string::npos);
    const std::size_t opacity = sheet.find("opacity:", at);
    ASSERT_LT(opacity, sheet.find('}', at));
    const double part = std::stod("0" + sheet.substr(opacity + 8, 3));
    for (const std::string front : {"bad", "warn", "note"}) {
      Colour blended{};
      for (std::size_t i = 0; i < 3; ++i)
        blended[i] = part * palette.at(front)[i] + (1 - part) * palette.at("stripe")[i];
      EXPECT_GE(contrast(blended, palette.at("stripe")), kGraphics) << name << ": episode of " << front;
    }
  }
}

}  // namespace
}  // namespace servotrace::test
