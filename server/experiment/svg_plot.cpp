// server/experiment/svg_plot.cpp: metres to pixels.
#include "server/experiment/svg_plot.hpp"

#include <fmt/format.h>

namespace server::experiment {
namespace {

constexpr double kLineHeight = 18;  // [px]
constexpr double kMargin = 10;      // [px]

}  // namespace

SvgPlot::SvgPlot(const algo::Vec2& low_W,
                 const algo::Vec2& high_W,
                 double width,
                 std::size_t legend_lines,
                 std::string_view style_sheet)
    : low_W_(low_W),
      high_W_(high_W),
      scale_((width - 2 * kMargin) / (high_W - low_W).x()),
      plot_height_((high_W - low_W).y() * scale_ + 2 * kMargin),
      canvas_(width,
              plot_height_ + static_cast<double>(legend_lines) * kLineHeight + kMargin,
              style_sheet) {}

algo::Vec2 SvgPlot::pixel(const algo::Vec2& p_W) const {
  return {kMargin + (p_W.x() - low_W_.x()) * scale_, kMargin + (high_W_.y() - p_W.y()) * scale_};
}

std::vector<algo::Vec2> SvgPlot::pixels(std::span<const algo::Vec2> points_W) const {
  std::vector<algo::Vec2> out;
  out.reserve(points_W.size());
  for (const algo::Vec2& p_W : points_W) out.push_back(pixel(p_W));
  return out;
}

void SvgPlot::circle(const algo::Vec2& centre_W, double radius, std::string_view style) {
  canvas_.circle(pixel(centre_W), radius * scale_, style);
}

void SvgPlot::polygon(std::span<const algo::Vec2> points_W, std::string_view style) {
  canvas_.polygon(pixels(points_W), style);
}

void SvgPlot::polyline(std::span<const algo::Vec2> points_W, std::string_view style) {
  canvas_.polyline(pixels(points_W), style);
}

void SvgPlot::cells(const algo::Vec2& corner_W,
                    double cell,
                    std::span<const CellRun> runs,
                    std::string_view colour) {
  // One path in whole numbers; each run starts from the end of the last one. The path lies half a
  // cell up because a stroke covers both sides of its line.
  const algo::Vec2 p = pixel(corner_W + algo::Vec2(0, cell / 2));
  std::string steps;
  int x = 0;
  int y = 0;
  for (const CellRun& run : runs) {
    steps += fmt::format("m{} {}h{}", run.column - x, run.row - y, run.length);
    x = run.column + run.length;
    y = run.row;
  }
  canvas_.path(steps,
               fmt::format("transform=\"translate({:.2f} {:.2f}) scale({:.4f} -{:.4f})\" "
                           "stroke=\"{}\" stroke-width=\"1.05\"",
                           p.x(),
                           p.y(),
                           cell * scale_,
                           cell * scale_,
                           colour));
}

void SvgPlot::text(const algo::Vec2& at_W, std::string_view words) {
  canvas_.text(pixel(at_W), words);
}

void SvgPlot::legend(std::string_view style, std::string_view words) {
  const double y = plot_height_ + (static_cast<double>(legend_lines_++) + 0.5) * kLineHeight;
  canvas_.line({kMargin, y}, {kMargin + 30, y}, style);
  canvas_.text({kMargin + 38, y + 4}, words);
}

}  // namespace server::experiment
