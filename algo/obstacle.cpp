// algo/obstacle.cpp: outline, distance and validity of the planar shapes.
#include "algo/obstacle.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "algo/hull.hpp"

namespace algo {
namespace {

constexpr double kMaxSize = 1000.0;             // [m] of any length of a shape
constexpr std::size_t kMaxPolygonPoints = 256;  // keeps every check cheap for any input
constexpr double kMinReflectivity = 0.02;
constexpr double kMaxReflectivity = 1.0;
constexpr double kFlat = 1e-9;  // [rad] below it two edges count as one straight line

std::vector<Vec2> rectangle(double length, double width) {
  const double x = length / 2;
  const double y = width / 2;
  return {{-x, -y}, {x, -y}, {x, y}, {-x, y}};
}

struct OutlineInOwnFrame {
  std::vector<Vec2> operator()(const Cylinder&) const { return {}; }
  std::vector<Vec2> operator()(const Box& box) const { return rectangle(box.length, box.width); }
  std::vector<Vec2> operator()(const Polygon& polygon) const { return polygon.points; }
  std::vector<Vec2> operator()(const Wall& wall) const {
    return rectangle(wall.length, wall.thickness);
  }
  std::vector<Vec2> operator()(const Ramp& ramp) const {
    return rectangle(ramp.length, ramp.width);
  }
  std::vector<Vec2> operator()(const Trench& trench) const {
    return rectangle(trench.length, trench.width);
  }
};

struct DistanceInOwnFrame {
  Vec2 p;
  double operator()(const Cylinder& cylinder) const { return p.norm() - cylinder.radius; }
  double operator()(const Box& box) const { return to_rectangle(p, box.length / 2, box.width / 2); }
  double operator()(const Wall& wall) const {
    return to_rectangle(p, wall.length / 2, wall.thickness / 2);
  }
  double operator()(const Ramp& ramp) const {
    return to_rectangle(p, ramp.length / 2, ramp.width / 2);
  }
  double operator()(const Trench& trench) const {
    return to_rectangle(p, trench.length / 2, trench.width / 2);
  }
  double operator()(const Polygon& polygon) const {
    double nearest = std::numeric_limits<double>::infinity();  // squared
    bool inside = true;
    const std::size_t n = polygon.points.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Vec2& a = polygon.points[i];
      const Vec2& b = polygon.points[(i + 1) % n];
      nearest = std::min(nearest, squared_distance(p, a, b));
      inside = inside && cross(b - a, p - a) > 0;
    }
    return inside ? -std::sqrt(nearest) : std::sqrt(nearest);
  }
};

std::optional<std::string> size_defect(const char* what, double value) {
  const std::string name(what);
  if (!std::isfinite(value)) return name + " must be a finite number";
  if (!(value > 0)) return name + " must be above 0";
  if (value > kMaxSize) return name + " must be at most 1000 m";
  return std::nullopt;
}

std::optional<std::string> size_defect(const char* a, double va, const char* b, double vb) {
  if (auto wrong = size_defect(a, va)) return wrong;
  return size_defect(b, vb);
}

bool cross_each_other(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const double c_side = cross(b - a, c - a);
  const double d_side = cross(b - a, d - a);
  const double a_side = cross(d - c, a - c);
  const double b_side = cross(d - c, b - c);
  return c_side * d_side < 0 && a_side * b_side < 0;
}

bool crosses_itself(const std::vector<Vec2>& points) {
  const std::size_t n = points.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 2; j < n; ++j) {
      if (cross_each_other(points[i], points[i + 1], points[j], points[(j + 1) % n])) return true;
    }
  }
  return false;
}

std::string point_name(std::size_t i) {
  return "point " + std::to_string(i + 1);
}

/// Checks the points alone: count, finite, size, no two neighbours in the same place.
std::optional<std::string> points_defect(const std::vector<Vec2>& points) {
  const std::size_t n = points.size();
  if (n < 3) return "a polygon needs at least 3 points, this one has " + std::to_string(n);
  if (n > kMaxPolygonPoints) {
    return "a polygon has at most " + std::to_string(kMaxPolygonPoints) + " points, this one has " +
           std::to_string(n);
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (!points[i].allFinite()) return point_name(i) + " of the polygon must be finite numbers";
    if (points[i].cwiseAbs().maxCoeff() > kMaxSize) {
      return point_name(i) + " of the polygon is more than 1000 m from its origin";
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (points[i] == points[(i + 1) % n]) {
      return point_name(i) + " and " + point_name((i + 1) % n) +
             " of the polygon are in the same place";
    }
  }
  return std::nullopt;
}

/// In a convex outline the turns at the corners sum to one whole turn, and every corner turns left.
/// No other outline satisfies both.
std::optional<std::string> polygon_defect(const std::vector<Vec2>& points) {
  if (auto wrong = points_defect(points)) return wrong;
  const std::size_t n = points.size();
  double turned = 0;
  std::size_t left = 0;
  std::size_t right = 0;
  std::size_t first_left = 0;
  std::size_t first_right = 0;
  bool folds_back = false;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 in = points[i] - points[(i + n - 1) % n];
    const Vec2 out = points[(i + 1) % n] - points[i];
    const double turn = std::atan2(cross(in, out), in.dot(out));
    turned += turn;
    if (turn > kFlat && left++ == 0) first_left = i;
    if (turn < -kFlat && right++ == 0) first_right = i;
    folds_back = folds_back || std::abs(turn) > std::numbers::pi - kFlat;
  }
  if (left + right < 3 && (folds_back || left + right == 0)) {
    return "the points of the polygon lie on one line";
  }
  const bool one_turn = std::abs(std::abs(turned) - 2 * std::numbers::pi) < 1e-6;
  if (!one_turn || folds_back || crosses_itself(points)) return "the polygon crosses itself";
  if (turned > 0 && right > 0) return "the polygon is not convex at " + point_name(first_right);
  if (turned < 0 && left > 0) return "the polygon is not convex at " + point_name(first_left);
  if (turned < 0) return "the points of the polygon run clockwise; give them counter-clockwise";
  return std::nullopt;
}

struct ShapeDefect {
  using Answer = std::optional<std::string>;
  Answer operator()(const Cylinder& cylinder) const {
    return size_defect("radius", cylinder.radius);
  }
  Answer operator()(const Box& box) const {
    return size_defect("length", box.length, "width", box.width);
  }
  Answer operator()(const Polygon& polygon) const { return polygon_defect(polygon.points); }
  Answer operator()(const Wall& wall) const {
    return size_defect("length", wall.length, "thickness", wall.thickness);
  }
  Answer operator()(const Ramp& ramp) const {
    if (!(ramp.low >= 0 && ramp.low <= kMaxSize)) return "low must be from 0 to 1000 m";
    return size_defect("length", ramp.length, "width", ramp.width);
  }
  Answer operator()(const Trench& trench) const {
    if (auto wrong = size_defect("depth", trench.depth)) return wrong;
    return size_defect("length", trench.length, "width", trench.width);
  }
};

}  // namespace

double squared_distance(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 edge = b - a;
  const Vec2 to_p = p - a;
  const double square = edge.squaredNorm();
  const double along = square > 0 ? std::clamp(edge.dot(to_p) / square, 0.0, 1.0) : 0;
  return (to_p - along * edge).squaredNorm();
}

bool is_ground(const Obstacle& obstacle) {
  return std::holds_alternative<Ramp>(obstacle.shape) ||
         std::holds_alternative<Trench>(obstacle.shape);
}

double top_at(const Obstacle& ground, const Vec2& p_W) {
  if (const auto* trench = std::get_if<Trench>(&ground.shape)) return -trench->depth;
  const auto* ramp = std::get_if<Ramp>(&ground.shape);
  if (ramp == nullptr) return ground.height;
  const double share = to_child(ground.pose_W, p_W).x() / ramp->length + 0.5;
  return std::lerp(ramp->low, ground.height, share);
}

bool any_moves(const std::vector<Obstacle>& obstacles) {
  return std::ranges::any_of(obstacles, [](const Obstacle& o) { return o.path.has_value(); });
}

std::vector<Vec2> outline_W(const Obstacle& obstacle) {
  std::vector<Vec2> points = std::visit(OutlineInOwnFrame{}, obstacle.shape);
  for (Vec2& point : points) point = to_parent(obstacle.pose_W, point);
  return points;
}

double signed_distance(const Obstacle& obstacle, const Vec2& p_W) {
  return std::visit(DistanceInOwnFrame{to_child(obstacle.pose_W, p_W)}, obstacle.shape);
}

std::optional<std::string> defect(const Obstacle& obstacle) {
  if (!finite(obstacle.pose_W)) return "x, y and heading must be finite numbers";
  if (auto wrong = size_defect("height", obstacle.height)) return wrong;
  if (!(obstacle.bottom >= 0 && obstacle.bottom < obstacle.height)) {
    return "bottom must be at least 0 and below height";
  }
  if (obstacle.bottom > 0 && is_ground(obstacle)) return "bottom: a ramp or a trench has none";
  const double reflectivity = obstacle.reflectivity;
  if (!(reflectivity >= kMinReflectivity && reflectivity <= kMaxReflectivity)) {
    return "reflectivity must be from 0.02 to 1";
  }
  if (obstacle.path && (!(obstacle.path->period > 0) || obstacle.path->keys.empty())) {
    return "path must have a period above 0 and one key at least";
  }
  if (obstacle.path && is_ground(obstacle)) return "path: a ramp or a trench cannot move";
  return std::visit(ShapeDefect{}, obstacle.shape);
}

}  // namespace algo
