// server/lab/reproduce/pictures.cpp: the layout and the paths in colours.
#include "server/lab/reproduce/pictures.hpp"

#include <array>

#include <fmt/format.h>

#include "algo/bounds.hpp"
#include "server/experiment/svg_plot.hpp"

namespace server::reproduce {
namespace {

using algo::Vec2;
using experiment::Series;
using experiment::SvgPlot;
constexpr double kWidth = 560;     // [px]
constexpr double kEdge = 0.6;      // [m] of margin around the drawing
constexpr double kSpacing = 0.03;  // [m] between the drawn points of a path
// In the order of readings(). Dashes as well, for colour-blind readers.
constexpr std::array<const char*, 7> kStyles{
    "stroke=\"#d1495b\" stroke-width=\"2\"",
    "stroke=\"#8d6a9f\" stroke-width=\"2\" stroke-dasharray=\"8 3\"",
    "stroke=\"#3f88c5\" stroke-width=\"2\" stroke-dasharray=\"2 3\"",
    "stroke=\"#e09f3e\" stroke-width=\"2\" stroke-dasharray=\"10 3 2 3\"",
    "stroke=\"#2e7d32\" stroke-width=\"3\"",
    "stroke=\"#6b705c\" stroke-width=\"1.5\" stroke-dasharray=\"5 5\"",
    "stroke=\"#111111\" stroke-width=\"1.5\" stroke-dasharray=\"12 4\""};

std::vector<Vec2> thinned(std::span<const Vec2> track_W) {
  std::vector<Vec2> kept_W;
  for (const Vec2& p_W : track_W) {
    if (kept_W.empty() || (p_W - kept_W.back()).norm() >= kSpacing) kept_W.push_back(p_W);
  }
  return kept_W;
}

/// Bounds of the drawing, with a margin.
Eigen::AlignedBox2d bounds_of(const sim::Scenario& scenario, std::span<const Series> rows) {
  Eigen::AlignedBox2d bounds(scenario.start.position());
  bounds.extend(scenario.goal->position_W);
  for (const algo::Obstacle& obstacle : scenario.obstacles) bounds.extend(bounds_W(obstacle));
  for (const Series& row : rows) {
    if (row.scenario != scenario.name) continue;
    for (const Vec2& p_W : row.runs.front().track_W) bounds.extend(p_W);
  }
  const Vec2 edge(kEdge, kEdge);
  return {bounds.min() - edge, bounds.max() + edge};
}

void draw_scene(const PaperConditions& paper, const sim::Scenario& scenario, SvgPlot& plot) {
  constexpr const char* kSolid = "fill=\"#b8b8b8\" stroke=\"#555555\"";
  for (const algo::Obstacle& obstacle : scenario.obstacles) {
    if (const auto* cylinder = std::get_if<algo::Cylinder>(&obstacle.shape)) {
      plot.circle(obstacle.pose_W.position(), cylinder->radius, kSolid);
    } else {
      plot.polygon(algo::outline_W(obstacle), kSolid);
    }
  }
  plot.circle(scenario.start.position(),
              kHullRadius,
              "fill=\"none\" stroke=\"#555555\" stroke-dasharray=\"3 3\"");
  plot.circle(scenario.goal->position_W, paper.arrival_radius, "fill=\"none\" stroke=\"#111111\"");
  plot.text(scenario.start.position() + Vec2(0, -kHullRadius - 0.15), "start");
  plot.text(scenario.goal->position_W + Vec2(0.15, 0.15), "goal");
}

}  // namespace

std::string draw_paths(const PaperConditions& paper,
                       const sim::Scenario& scenario,
                       std::span<const Series> rows) {
  const Eigen::AlignedBox2d bounds = bounds_of(scenario, rows);
  SvgPlot plot(bounds.min(), bounds.max(), kWidth, readings().size());
  draw_scene(paper, scenario, plot);
  for (std::size_t i = 0; i < readings().size(); ++i) {
    const Series* row = find_series(rows, scenario.name, readings()[i]);
    if (row == nullptr) continue;
    plot.polyline(thinned(row->runs.front().track_W), kStyles[i]);
    plot.legend(kStyles[i],
                fmt::format("{}: {}", readings()[i], algo::name(row->runs.front().outcome)));
  }
  return plot.document(fmt::format("{}: the path of each reading", scenario.name));
}

}  // namespace server::reproduce
