// server/serve/layers_json.cpp: one function per kind of layer turns its values into primitives.
#include "server/serve/layers_json.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <nlohmann/json.hpp>

#include "algo/diff_drive.hpp"
#include "server/serve/scene_shapes.hpp"

namespace server {
namespace {

using nlohmann::json;
using namespace scene;
using algo::Layer;
using algo::LayerKind;

constexpr double kHeight = 0.05;       // [m] above the ground, where the viewer draws its grid
constexpr double kThickness = 0.03;    // [m] of a line
constexpr double kThin = 0.01;         // [m]
constexpr double kDot = 0.08;          // [m]
constexpr double kShortest = 1e-3;     // [m] shortest arrow
constexpr double kFaint = 0.35;        // opacity
constexpr double kRing = 0.45;         // [m] from the robot to the foot of a polar sector,
constexpr double kTallest = 0.5;       // [m] its height from there at twice the level
constexpr double kLifetime = 0.5;      // [s]
constexpr double kGridLifetime = 6.0;  // [s] an unchanged grid comes every 5 s
constexpr int kCorners = 24;           // of a circle
constexpr int kArcSteps = 8;           // of an arc
constexpr std::uint8_t kEven = 127;

/// The page's own palette (design tokens of the light theme).
constexpr auto kColours = std::to_array<std::pair<algo::Tone, Colour>>({
    {algo::Tone::Accent, {0.66, 0.44, 0.0}},
    {algo::Tone::Internal, {0.0, 0.50, 0.42}},
    {algo::Tone::External, {0.76, 0.32, 0.05}},
    {algo::Tone::Elastic, {0.48, 0.25, 0.71}},
    {algo::Tone::Plan, {0.13, 0.38, 0.75}},
    {algo::Tone::Moving, {0.80, 0.47, 0.0}},
    {algo::Tone::Refused, {0.77, 0.15, 0.15}},
    {algo::Tone::Good, {0.10, 0.53, 0.25}},
    {algo::Tone::Muted, {0.42, 0.45, 0.50}},
});

Colour colour_of(const Layer& layer) {
  Colour colour =
      std::ranges::find(kColours, layer.tone, &decltype(kColours)::value_type::first)->second;
  if (layer.style == algo::LayerStyle::Faint) colour.a = kFaint;
  return colour;
}

/// The values of a layer as records of equal length.
class Records {
 public:
  Records(const Layer& layer, std::size_t more) : layer_(layer), length_(layer.axes + more) {}
  std::size_t size() const { return layer_.axes < 2 ? 0 : layer_.values.size() / length_; }
  double value(std::size_t record, std::size_t k) const {
    return static_cast<double>(layer_.values[record * length_ + k]);
  }
  Point position(std::size_t record) const {
    return {value(record, 0), value(record, 1), layer_.axes > 2 ? value(record, 2) : kHeight};
  }
  /// The values after the position.
  double after(std::size_t record, std::size_t k = 0) const {
    return value(record, layer_.axes + k);
  }

 private:
  const Layer& layer_;
  std::size_t length_;
};

void draw_points(const Layer& layer, const Point& robot, json& entity) {
  const Records records(layer, 0);
  std::vector<Point> ties;
  for (std::size_t k = 0; k < records.size(); ++k) {
    const Point p = records.position(k);
    entity["spheres"].push_back(sphere_json(p, kDot, colour_of(layer)));
    ties.insert(ties.end(), {robot, p});
  }
  if (layer.style != algo::LayerStyle::Dashed) return;
  entity["lines"].push_back(line_json(LineKind::List, ties, colour_of(layer), kThin));
}

void draw_polyline(const Layer& layer, const Point& /*robot*/, json& entity) {
  const Records records(layer, 0);
  std::vector<Point> line;
  const auto end = [&] {
    if (line.size() > 1) {
      entity["lines"].push_back(line_json(LineKind::Strip, line, colour_of(layer), kThickness));
    }
    line.clear();
  };
  for (std::size_t k = 0; k < records.size(); ++k) {
    const Point p = records.position(k);
    if (std::isnan(p.x)) {
      end();
    } else {
      line.push_back(p);
    }
  }
  end();
}

void draw_arrows(const Layer& layer, const Point& /*robot*/, json& entity) {
  const Records records(layer, layer.axes);
  for (std::size_t k = 0; k < records.size(); ++k) {
    const algo::Vec2 vector{records.after(k, 0), records.after(k, 1)};
    if (vector.norm() < kShortest) continue;
    entity["arrows"].push_back(arrow_json(records.position(k), vector, colour_of(layer)));
  }
}

void draw_circles(const Layer& layer, const Point& /*robot*/, json& entity) {
  const Records records(layer, 1);
  for (std::size_t k = 0; k < records.size(); ++k) {
    const Point p = records.position(k);
    std::vector<Point> corners;
    for (int i = 0; i < kCorners; ++i) {
      const algo::Vec2 way =
          records.after(k) * algo::direction(2 * std::numbers::pi * i / kCorners);
      corners.push_back({p.x + way.x(), p.y + way.y(), p.z});
    }
    entity["lines"].push_back(line_json(LineKind::Loop, corners, colour_of(layer), kThickness));
  }
}

void draw_arcs(const Layer& layer, const Point& /*robot*/, json& entity) {
  for (std::size_t k = 0; k + 1 < layer.values.size(); k += 2) {
    const algo::Twist2 twist{layer.values[k], layer.values[k + 1]};
    std::vector<Point> points;
    for (int i = 0; i <= kArcSteps; ++i) {
      const algo::Pose2 at = algo::integrate_arc({}, twist, static_cast<double>(i) / kArcSteps);
      points.push_back({at.x, at.y, kHeight});
    }
    entity["lines"].push_back(line_json(LineKind::Strip, points, colour_of(layer), kThin));
  }
}

/// Draws cells that are more likely occupied than free: one rectangle per run of them in a row.
void draw_grid(const Layer& layer, const Point& /*robot*/, json& entity) {
  if (layer.values.size() != 4 || !(layer.values[3] >= 1)) return;
  const double cell = layer.values[2];
  const auto columns = static_cast<std::size_t>(layer.values[3]);
  const auto occupied = [&](std::size_t at) {
    return layer.cells[at] > kEven && layer.cells[at] != algo::kUnknownCell;
  };
  std::vector<Point> triangles;
  for (std::size_t row = 0; (row + 1) * columns <= layer.cells.size(); ++row) {
    for (std::size_t begin = 0; begin < columns; ++begin) {
      std::size_t end = begin;
      while (end < columns && occupied(row * columns + end)) ++end;
      if (end == begin) continue;
      const double x0 = layer.values[0] + cell * static_cast<double>(begin);
      const double x1 = layer.values[0] + cell * static_cast<double>(end);
      const double y0 = layer.values[1] + cell * static_cast<double>(row);
      const double y1 = y0 + cell;
      const Point a{x0, y0, kThin}, b{x1, y0, kThin}, c{x1, y1, kThin}, d{x0, y1, kThin};
      triangles.insert(triangles.end(), {a, b, c, a, c, d});
      begin = end;
    }
  }
  Colour colour = colour_of(layer);
  colour.a = kFaint;
  if (!triangles.empty()) entity["triangles"].push_back(triangles_json(triangles, colour));
}

void draw_polar(const Layer& layer, const Point& centre, json& entity) {
  std::vector<Point> spokes;
  const auto sectors = static_cast<double>(layer.values.size());
  for (std::size_t k = 0; k < layer.values.size(); ++k) {
    const double share = layer.level > 0 ? layer.values[k] / (2 * layer.level) : 0;
    if (!(share > 0)) continue;
    const algo::Vec2 way =
        algo::direction(2 * std::numbers::pi * (static_cast<double>(k) + 0.5) / sectors);
    const auto at = [&](double distance) {
      return Point{centre.x + distance * way.x(), centre.y + distance * way.y(), kHeight};
    };
    spokes.insert(spokes.end(), {at(kRing), at(kRing + kTallest * std::min(1.0, share))});
  }
  if (spokes.empty()) return;
  entity["lines"].push_back(line_json(LineKind::List, spokes, colour_of(layer), kThickness));
}

void draw_text(const Layer& layer, const Point& /*robot*/, json& entity) {
  const Records records(layer, 0);
  std::size_t from = 0;
  for (std::size_t k = 0; k < records.size() && from <= layer.text.size(); ++k) {
    const std::size_t end = std::min(layer.text.find('\n', from), layer.text.size());
    entity["texts"].push_back(
        text_json(records.position(k), layer.text.substr(from, end - from), colour_of(layer)));
    from = end + 1;
  }
}

/// Indexed by the kind of the layer.
constexpr std::array kDraw{draw_points,
                           draw_polyline,
                           draw_arrows,
                           draw_circles,
                           draw_arcs,
                           draw_grid,
                           draw_polar,
                           draw_text};

json layer_entity(const algo::Telemetry& t, const Layer& layer) {
  const bool in_world = layer.frame == algo::LayerFrame::World;
  const bool grid = layer.kind == LayerKind::Grid;
  json entity = entity_json(t.observation.stamp,
                            std::string(layer.name),
                            in_world ? "map" : "base_link",
                            grid ? kGridLifetime : kLifetime);
  const algo::Pose2& pose = t.observation.odometry.pose;
  const Point robot = in_world ? Point{pose.x, pose.y, kHeight} : Point{0, 0, kHeight};
  kDraw.at(static_cast<std::size_t>(layer.kind))(layer, robot, entity);
  return entity;
}

}  // namespace

std::string layers_json(const algo::Telemetry& t) {
  json entities = json::array();
  for (const auto* list : {&t.layers, &t.output.layers}) {
    for (const Layer& layer : *list) {
      if (!layer.empty()) entities.push_back(layer_entity(t, layer));
    }
  }
  return scene_json(std::move(entities)).dump();
}

}  // namespace server
