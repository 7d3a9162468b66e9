// server/experiment/svg_canvas.hpp: the one writer of SVG: shapes in pixels.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "algo/types.hpp"

namespace server::experiment {

/// `text` with the reserved characters of XML and HTML as entities.
std::string xml_text(std::string_view text);

/// Shapes in pixels, rounded to a tenth, x to the right and y down. Later shapes lie on top.
/// `attributes` are written unchanged: "fill=\"none\" stroke=\"#555\"", "class=\"grid\"".
class SvgCanvas {
 public:
  /// `style_sheet`: CSS for the classes among the attributes.
  SvgCanvas(double width, double height, std::string_view style_sheet = "")
      : width_(width), height_(height), style_sheet_(style_sheet) {}

  void circle(const algo::Vec2& centre, double radius, std::string_view attributes);
  void line(const algo::Vec2& from, const algo::Vec2& to, std::string_view attributes);
  void polygon(std::span<const algo::Vec2> points, std::string_view attributes);
  void polyline(std::span<const algo::Vec2> points, std::string_view attributes);
  /// `steps` in the syntax of the attribute d: "M0 0L5 5".
  void path(std::string_view steps, std::string_view attributes);
  void text(const algo::Vec2& at, std::string_view words, std::string_view attributes = "");

  /// The SVG document. A screen reader reads `title`.
  std::string document(std::string_view title) const;

 private:
  double width_ = 0;
  double height_ = 0;
  std::string style_sheet_{};
  std::string body_{};
};

}  // namespace server::experiment
