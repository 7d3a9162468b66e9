// server/experiment/path_picture.cpp: the layout and the paths in colours.
#include "server/experiment/path_picture.hpp"

#include <array>

#include "algo/bounds.hpp"
#include "server/experiment/svg_plot.hpp"
#include "server/experiment/track.hpp"

namespace server::experiment {
namespace {

using algo::Vec2;

constexpr double kPictureWidth = 560;   // [px]
constexpr double kEdge = 0.6;           // [m] of margin around the drawing
constexpr double kDrawnSpacing = 0.03;  // [m] between the drawn points of a path
// Dashes as well, for colour-blind readers.
constexpr std::array<const char*, kMostPaths> kStrokes{
    "stroke=\"#d1495b\" stroke-width=\"2\"",
    "stroke=\"#8d6a9f\" stroke-width=\"2\" stroke-dasharray=\"8 3\"",
    "stroke=\"#3f88c5\" stroke-width=\"2\" stroke-dasharray=\"2 3\"",
    "stroke=\"#e09f3e\" stroke-width=\"2\" stroke-dasharray=\"10 3 2 3\"",
    "stroke=\"#2e8b47\" stroke-width=\"3\"",
    "stroke=\"#84897a\" stroke-width=\"1.5\" stroke-dasharray=\"5 5\"",
    "stroke=\"#0f8b8d\" stroke-width=\"1.5\" stroke-dasharray=\"12 4\"",
    "stroke=\"#b5651d\" stroke-width=\"1.5\"",
    "stroke=\"#c2418a\" stroke-width=\"2\" stroke-dasharray=\"2 6\"",
    "stroke=\"#5c6bc0\" stroke-width=\"1.5\" stroke-dasharray=\"14 3 2 3 2 3\"",
    "stroke=\"#7cb342\" stroke-width=\"2\" stroke-dasharray=\"6 2\"",
    "stroke=\"#9e9e9e\" stroke-width=\"1.2\""};

constexpr std::string_view kStyle =
    "rect{fill:#fff}text{fill:#17212b;font-size:13px}.obstacle{fill:#b8b8b8;stroke:#555}"
    ".ground{fill:#e4ddcc;stroke:#8a7f62}"
    ".outline{fill:none;stroke:#4d5b68}"
    "@media(prefers-color-scheme:dark){rect{fill:#12181f}text{fill:#e7edf2}"
    ".obstacle{fill:#46515c;stroke:#8794a0}.ground{fill:#2b2f2a;stroke:#7a7458}.outline{stroke:#"
    "a5b1bc}}";

Eigen::AlignedBox2d bounds_of(const sim::Scenario& scenario, std::span<const DrawnPath> paths) {
  Eigen::AlignedBox2d bounds(scenario.start.position());
  if (const auto end_W = scenario.end_W()) bounds.extend(*end_W);
  for (const algo::Obstacle& obstacle : scenario.obstacles) bounds.extend(bounds_W(obstacle));
  for (const DrawnPath& path : paths) {
    for (const Vec2& p_W : path.track_W) bounds.extend(p_W);
  }
  const Vec2 edge(kEdge, kEdge);
  return {bounds.min() - edge, bounds.max() + edge};
}

void draw_world(const sim::Scenario& scenario, double goal_radius, SvgPlot& plot) {
  for (const algo::Obstacle& obstacle : scenario.obstacles) {
    if (obstacle.path && !obstacle.path->is_there(0)) continue;
    if (const auto* cylinder = std::get_if<algo::Cylinder>(&obstacle.shape)) {
      plot.circle(obstacle.pose_W.position(), cylinder->radius, "class=\"obstacle\"");
    } else {
      const bool ground = algo::is_ground(obstacle);
      plot.polygon(algo::outline_W(obstacle), ground ? "class=\"ground\"" : "class=\"obstacle\"");
    }
  }
  const double radius = scenario.robot.radius;
  const Vec2 start_W = scenario.start.position();
  plot.circle(start_W, radius, "class=\"outline\" stroke-dasharray=\"3 3\"");
  plot.text(start_W + Vec2(0, -radius - 0.15), "start");
  const std::optional<Vec2> end_W = scenario.end_W();
  if (!end_W) return;
  plot.circle(*end_W, goal_radius, "class=\"outline\"");
  plot.text(*end_W + Vec2(0.15, 0.15), "goal");
}

}  // namespace

std::string draw_paths(std::string_view title,
                       const sim::Scenario& scenario,
                       double goal_radius,
                       std::span<const DrawnPath> paths) {
  const Eigen::AlignedBox2d bounds = bounds_of(scenario, paths);
  SvgPlot plot(bounds.min(), bounds.max(), kPictureWidth, paths.size(), kStyle);
  draw_world(scenario, goal_radius, plot);
  for (const DrawnPath& path : paths) {
    const char* const stroke = kStrokes.at(path.stroke);
    plot.polyline(thinned(path.track_W, kDrawnSpacing), stroke);
    plot.legend(stroke, path.words);
  }
  return plot.document(title);
}

}  // namespace server::experiment
