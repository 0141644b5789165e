// SPDX-License-Identifier: MIT
// A small SVG writer: what the report's pictures need and no more. Colours are CSS classes, so that one picture serves
// light, dark and print.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace servotrace::report {

// Text made safe for HTML and SVG: & < > " ' are replaced, control characters dropped, invalid UTF-8 replaced by '?'.
std::string escape_html(std::string_view text);

class Svg {
 public:
  // Size in px; `title` is read aloud and shown where the picture is not.
  Svg(double width, double height, std::string_view title);

  void line(double x1, double y1, double x2, double y2, std::string_view css_class);
  void rectangle(double x, double y, double width, double height, std::string_view css_class,
                 std::string_view tooltip = {});
  void text(double x, double y, std::string_view text, std::string_view css_class, std::string_view anchor = "start");
  void polyline(const std::vector<std::pair<double, double>>& points, std::string_view css_class);
  void polygon(const std::vector<std::pair<double, double>>& points, std::string_view css_class,
               std::string_view tooltip = {});
  // A mark that points at (x, y): up to three shapes so that colour alone never carries the meaning.
  enum class Mark { kTriangle, kDiamond, kCircle };
  void mark(Mark shape, double x, double y, std::string_view css_class, std::string_view tooltip);
  // The whole element.
  std::string str() const;

 private:
  std::string head_;
  std::string body_;
};

// Round numbers between `low` and `high`, at most `most` of them.
std::vector<double> ticks(double low, double high, int most);

}  // namespace servotrace::report
