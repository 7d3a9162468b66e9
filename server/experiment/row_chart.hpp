// server/experiment/row_chart.hpp: charts with one row a label and one axis below, as SVG that is
// readable in light and dark.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "server/experiment/statistics.hpp"
#include "server/experiment/svg_canvas.hpp"

namespace server::experiment {

/// CSS classes of charts: "muted", "grid", "bar", "mark", "box", "cell", "on" (text on a full
/// cell). Colours follow prefers-color-scheme. The same sheet serves any number of charts in one
/// HTML page.
std::string_view chart_style();

/// Rows from top to bottom. Values outside the axis are drawn at its end.
class RowChart {
 public:
  /// `axis` names the figure and its unit: "time [s]". The axis covers at least `range`; its ends
  /// are round numbers.
  RowChart(const std::vector<std::string>& labels, std::string_view axis, const Interval& range);

  /// A bar from the axis' low end to `value`, with `interval` as a line with ends.
  void bar(std::size_t row, double value, const Interval& interval);
  /// Box of the quartiles, bar at the median, whiskers to the least and the largest value.
  void box(std::size_t row, const Summary& summary);
  /// Words in place of a drawing.
  void words(std::size_t row, std::string_view text);

  std::string document(std::string_view title) const { return canvas_.document(title); }

 private:
  void draw_axis(std::string_view axis);
  double x(double value) const;     // [px]
  double y(std::size_t row) const;  // [px] of the row's middle
  void rectangle(double left, double right, double middle, double height, std::string_view style);

  std::size_t rows_ = 0;
  double left_ = 0;  // [px] where the axis begins
  double step_ = 1;  // between ticks, in units of the axis
  double low_ = 0;
  double high_ = 1;
  SvgCanvas canvas_;
};

/// A cell for each pair of values; rows from top to bottom. `values[row][column]`, from 0 to 1;
/// NaN: unknown. Each cell has its number and is the fuller the larger it is.
std::string heat_map(std::string_view title,
                     const std::string& row_axis,
                     const std::vector<std::string>& rows,
                     const std::string& column_axis,
                     const std::vector<std::string>& columns,
                     const std::vector<std::vector<double>>& values);

}  // namespace server::experiment
