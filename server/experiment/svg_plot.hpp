// server/experiment/svg_plot.hpp: a small picture of plane geometry, in metres.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "algo/types.hpp"
#include "server/experiment/svg_canvas.hpp"

namespace server::experiment {

/// Adjacent cells in one row of a grid.
struct CellRun {
  int column = 0;
  int row = 0;
  int length = 0;
};

/// Shapes in metres of W, drawn with x to the right and y up. Later shapes lie on top.
class SvgPlot {
 public:
  /// Shows the part of W between the corners `low_W` and `high_W` in a picture `width` pixels wide,
  /// with room for `legend_lines` lines of text below it. `style_sheet`: as in SvgCanvas.
  SvgPlot(const algo::Vec2& low_W,
          const algo::Vec2& high_W,
          double width,
          std::size_t legend_lines,
          std::string_view style_sheet = "");

  void circle(const algo::Vec2& centre_W, double radius, std::string_view style);
  void polygon(std::span<const algo::Vec2> points_W, std::string_view style);
  void polyline(std::span<const algo::Vec2> points_W, std::string_view style);
  /// Fills runs of cells with `colour`; cells have the edge `cell` [m] and count from `corner_W`.
  void cells(const algo::Vec2& corner_W,
             double cell,
             std::span<const CellRun> runs,
             std::string_view colour);
  void text(const algo::Vec2& at_W, std::string_view words);
  /// Adds a line to the legend: a stroke in `style` and its meaning.
  void legend(std::string_view style, std::string_view words);

  /// The SVG document. A screen reader reads `title`.
  std::string document(std::string_view title) const { return canvas_.document(title); }

 private:
  algo::Vec2 pixel(const algo::Vec2& p_W) const;
  std::vector<algo::Vec2> pixels(std::span<const algo::Vec2> points_W) const;

  algo::Vec2 low_W_{0, 0};
  algo::Vec2 high_W_{0, 0};
  double scale_ = 1;  // pixels per metre
  double plot_height_ = 0;
  std::size_t legend_lines_ = 0;  // lines written so far
  SvgCanvas canvas_;
};

}  // namespace server::experiment
