// SPDX-License-Identifier: MIT
#include "replay/report/svg.hpp"

#include <fmt/format.h>

#include <cmath>

namespace servotrace::report {
namespace {

// The length of the UTF-8 sequence at `index`, 0 where it is not valid.
std::size_t utf8_length(std::string_view text, std::size_t index) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(index);
  std::size_t length = 0;
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first <= 0xDF) length = 2;
  if (first >= 0xE0 && first <= 0xEF) length = 3;
  if (first >= 0xF0 && first <= 0xF4) length = 4;
  if (length == 0 || index + length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(index + i) & 0xC0U) != 0x80) return 0;
  }
  return length;
}

}  // namespace

std::string escape_html(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text, i);
    if (length == 0) {
      result += '?';
      ++i;
      continue;
    }
    const char c = text[i];
    if (length > 1) {
      result += text.substr(i, length);
    } else if (c == '&') {
      result += "&amp;";
    } else if (c == '<') {
      result += "&lt;";
    } else if (c == '>') {
      result += "&gt;";
    } else if (c == '"') {
      result += "&quot;";
    } else if (c == '\'') {
      result += "&#39;";
    } else if (static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t') {
      result += c;
    }
    i += length;
  }
  return result;
}

// The attributes are for pages whose style sheet was stripped: any rule of a class overrides them.
Svg::Svg(double width, double height, std::string_view title)
    : head_(fmt::format(
          "<svg viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-label=\"{}\"><title>{}</title><g fill=\"#333\">\n",
          width, height, escape_html(title), escape_html(title))) {}

void Svg::line(double x1, double y1, double x2, double y2, std::string_view css_class) {
  body_ += fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"#999\" class=\"{}\"/>\n",
                       x1, y1, x2, y2, css_class);
}

void Svg::rectangle(double x, double y, double width, double height, std::string_view css_class,
                    std::string_view tooltip) {
  body_ += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\" class=\"{}\"", x,
                       y, width, height, css_class == "lane-back" ? "none" : "#9ab", css_class);
  body_ += tooltip.empty() ? "/>\n" : fmt::format("><title>{}</title></rect>\n", escape_html(tooltip));
}

void Svg::text(double x, double y, std::string_view text, std::string_view css_class, std::string_view anchor) {
  body_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" class=\"{}\" text-anchor=\"{}\">{}</text>\n", x, y, css_class,
                       anchor, escape_html(text));
}

void Svg::polyline(const std::vector<std::pair<double, double>>& points, std::string_view css_class) {
  if (points.empty()) return;
  body_ += fmt::format("<polyline fill=\"none\" stroke=\"#36c\" class=\"{}\" points=\"", css_class);
  for (const auto& [x, y] : points) body_ += fmt::format("{:.1f},{:.1f} ", x, y);
  body_.back() = '"';
  body_ += "/>\n";
}

void Svg::polygon(const std::vector<std::pair<double, double>>& points, std::string_view css_class,
                  std::string_view tooltip) {
  if (points.empty()) return;
  body_ += fmt::format("<polygon class=\"{}\" points=\"", css_class);
  for (const auto& [x, y] : points) body_ += fmt::format("{:.1f},{:.1f} ", x, y);
  body_.back() = '"';
  body_ += tooltip.empty() ? "/>\n" : fmt::format("><title>{}</title></polygon>\n", escape_html(tooltip));
}

void Svg::mark(Mark shape, double x, double y, std::string_view css_class, std::string_view tooltip) {
  switch (shape) {
    case Mark::kTriangle:
      polygon({{x, y - 6}, {x - 5.5, y + 4}, {x + 5.5, y + 4}}, css_class, tooltip);
      break;
    case Mark::kDiamond:
      polygon({{x, y - 5.5}, {x - 5, y}, {x, y + 5.5}, {x + 5, y}}, css_class, tooltip);
      break;
    case Mark::kCircle:
      body_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\" class=\"{}\"><title>{}</title></circle>\n", x,
                           y, css_class, escape_html(tooltip));
      break;
  }
}

std::string Svg::str() const { return head_ + body_ + "</g></svg>\n"; }

std::vector<double> ticks(double low, double high, int most) {
  std::vector<double> result;
  if (!(high > low) || most < 1) return result;
  double step = std::pow(10.0, std::floor(std::log10((high - low) / most)));
  for (const double factor : {1.0, 2.0, 5.0, 10.0}) {
    if ((high - low) / (step * factor) <= most) {
      step *= factor;
      break;
    }
  }
  for (double value = std::ceil(low / step) * step; value <= high + step * 1e-9 && result.size() < 100; value += step) {
    result.push_back(std::abs(value) < step * 1e-9 ? 0 : value);
  }
  return result;
}

}  // namespace servotrace::report
