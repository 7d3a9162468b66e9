// server/experiment/svg_plot.cpp: shapes to text, tenths of a pixel.
#include "server/experiment/svg_plot.hpp"

#include <fmt/format.h>

namespace server::experiment {
namespace {

constexpr double kLineHeight = 18;  // [px]
constexpr double kMargin = 10;      // [px]

}  // namespace

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '&':
        out += "&amp;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

SvgPlot::SvgPlot(const algo::Vec2& low_W,
                 const algo::Vec2& high_W,
                 double width,
                 std::size_t legend_lines)
    : low_W_(low_W), high_W_(high_W), width_(width) {
  scale_ = (width - 2 * kMargin) / (high_W - low_W).x();
  plot_height_ = (high_W - low_W).y() * scale_ + 2 * kMargin;
  height_ = plot_height_ + static_cast<double>(legend_lines) * kLineHeight + kMargin;
}

algo::Vec2 SvgPlot::pixel(const algo::Vec2& p_W) const {
  return {kMargin + (p_W.x() - low_W_.x()) * scale_, kMargin + (high_W_.y() - p_W.y()) * scale_};
}

std::string SvgPlot::points(std::span<const algo::Vec2> points_W) const {
  std::string out;
  for (const algo::Vec2& p_W : points_W) {
    const algo::Vec2 p = pixel(p_W);
    out += fmt::format("{}{:.1f},{:.1f}", out.empty() ? "" : " ", p.x(), p.y());
  }
  return out;
}

void SvgPlot::circle(const algo::Vec2& centre_W, double radius, std::string_view style) {
  const algo::Vec2 c = pixel(centre_W);
  body_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" {}/>\n",
                       c.x(),
                       c.y(),
                       radius * scale_,
                       style);
}

void SvgPlot::polygon(std::span<const algo::Vec2> points_W, std::string_view style) {
  body_ += fmt::format("<polygon points=\"{}\" {}/>\n", points(points_W), style);
}

void SvgPlot::polyline(std::span<const algo::Vec2> points_W, std::string_view style) {
  body_ += fmt::format("<polyline points=\"{}\" fill=\"none\" {}/>\n", points(points_W), style);
}

void SvgPlot::cells(const algo::Vec2& corner_W,
                    double cell,
                    std::span<const CellRun> runs,
                    std::string_view colour) {
  // One path in whole numbers, each run from the end of the one before; half a cell up because a
  // stroke lies on both sides of its line.
  const algo::Vec2 p = pixel(corner_W + algo::Vec2(0, cell / 2));
  body_ += fmt::format(
      "<path transform=\"translate({:.2f} {:.2f}) scale({:.4f} -{:.4f})\" "
      "stroke=\"{}\" stroke-width=\"1.05\" d=\"",
      p.x(),
      p.y(),
      cell * scale_,
      cell * scale_,
      colour);
  int x = 0;
  int y = 0;
  for (const CellRun& run : runs) {
    body_ += fmt::format("m{} {}h{}", run.column - x, run.row - y, run.length);
    x = run.column + run.length;
    y = run.row;
  }
  body_ += "\"/>\n";
}

void SvgPlot::text(const algo::Vec2& at_W, std::string_view words) {
  const algo::Vec2 p = pixel(at_W);
  body_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", p.x(), p.y(), escaped(words));
}

void SvgPlot::legend(std::string_view style, std::string_view words) {
  const double y = plot_height_ + (static_cast<double>(legend_lines_++) + 0.5) * kLineHeight;
  body_ += fmt::format(
      "<line x1=\"{0:.1f}\" y1=\"{1:.1f}\" x2=\"{2:.1f}\" y2=\"{1:.1f}\" {3}/>\n"
      "<text x=\"{4:.1f}\" y=\"{5:.1f}\">{6}</text>\n",
      kMargin,
      y,
      kMargin + 30,
      style,
      kMargin + 38,
      y + 4,
      escaped(words));
}

std::string SvgPlot::document(std::string_view title) const {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" "
      "height=\"{1:.0f}\" role=\"img\" font-family=\"sans-serif\" font-size=\"12\">\n"
      "<title>{2}</title>\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n{3}</svg>\n",
      width_,
      height_,
      escaped(title),
      body_);
}

}  // namespace server::experiment
