#include "algo/arm/solid.hpp"

#include <algorithm>
#include <array>

namespace algo {
namespace {

constexpr int kHalvings = 20;  // a link of 0.3 m to less than a micrometre

// [s] Moments at which a moving solid's place is kept free; before now, since it may turn back.
constexpr std::array kForeseen{-1.0, -0.5, 0.5, 1.0, 1.5, 2.0};

constexpr double kShadow = 100;  // [m] half of a shadow: far beyond any arm

/// [m] Half of the solid's extent along `axis`.
double half_extent(const Solid& solid, const Vec2& axis) {
  return solid.half.x() * std::abs(solid.axis_W.dot(axis)) +
         solid.half.y() * std::abs(cross(solid.axis_W, axis)) + solid.rounding;
}

struct MapDistance {
  double distance = 0;
  Vec2 away = Vec2::UnitX();
};

/// Of the rounded rectangle on the map.
MapDistance map_distance(const Solid& solid, const Vec2& p_W) {
  const Vec2 way = p_W - solid.centre_W;
  const Vec2 aside_W(-solid.axis_W.y(), solid.axis_W.x());
  const Vec2 local(solid.axis_W.dot(way), aside_W.dot(way));
  const Vec2 beyond = local.cwiseAbs() - solid.half;
  const auto signed_axis = [&](Eigen::Index k) -> Vec2 {
    return (local[k] < 0 ? -1.0 : 1.0) * (k == 0 ? solid.axis_W : aside_W);
  };
  if (beyond.x() > 0 && beyond.y() > 0) {
    const double length = beyond.norm();
    return {length - solid.rounding,
            (beyond.x() * signed_axis(0) + beyond.y() * signed_axis(1)) / length};
  }
  const Eigen::Index nearest = beyond.x() > beyond.y() ? 0 : 1;
  return {beyond[nearest] - solid.rounding, signed_axis(nearest)};
}

}  // namespace

SolidDistance distance_to(const Solid& solid, const Vec3& p_W) {
  const MapDistance map = map_distance(solid, p_W.head<2>());
  const bool below = solid.bottom - p_W.z() > p_W.z() - solid.top;
  const double height = below ? solid.bottom - p_W.z() : p_W.z() - solid.top;
  const Vec3 aside(map.away.x(), map.away.y(), 0);
  const Vec3 upright(0, 0, below ? -1.0 : 1.0);
  if (map.distance > 0 && height > 0) {
    const double distance = std::hypot(map.distance, height);
    return {distance, (map.distance * aside + height * upright) / distance};
  }
  if (map.distance >= height) return {map.distance, aside};
  return {height, upright};
}

NearestOnLink nearest_on_link(const Vec3& from_W, const Vec3& to_W, const Solid& solid) {
  const Vec3 way = to_W - from_W;
  const auto at = [&](double along) -> NearestOnLink {
    const Vec3 point = from_W + along * way;
    const SolidDistance there = distance_to(solid, point);
    return {along, there.distance, point, there.away};
  };
  // The distance is convex along the link, so the sign of its slope tells the side of the least.
  NearestOnLink low = at(0);
  if (low.away.dot(way) >= 0) return low;
  NearestOnLink high = at(1);
  if (high.away.dot(way) <= 0) return high;
  for (int n = 0; n < kHalvings; ++n) {
    const NearestOnLink middle = at((low.along + high.along) / 2);
    (middle.away.dot(way) < 0 ? low : high) = middle;
  }
  return low.distance < high.distance ? low : high;
}

Solid solid_shadow(const Solid& solid, const Vec2& ahead, const Vec2& shoulder_W) {
  const Vec2 left(-ahead.y(), ahead.x());
  const double outwards = left.dot(solid.centre_W - shoulder_W) < 0 ? -1.0 : 1.0;
  Solid shadow = solid;
  shadow.axis_W = ahead;
  shadow.half = {kShadow, kShadow};
  shadow.rounding = 0;
  shadow.centre_W += outwards * (kShadow - half_extent(solid, left)) * left;
  return shadow;
}

double gap_along(const Vec3& from_W, const Vec3& to_W, const Solid& solid, const Vec2& ahead) {
  const double centre = ahead.dot(solid.centre_W);
  const double from = ahead.dot(from_W.head<2>()) - centre;
  const double to = ahead.dot(to_W.head<2>()) - centre;
  return std::max(std::min(from, to), -std::max(from, to)) - half_extent(solid, ahead);
}

void keep_ahead_free(std::vector<Solid>& solids) {
  const std::size_t count = solids.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (solids[i].velocity_W.isZero()) continue;
    for (const double seconds : kForeseen) {
      Solid then = solids[i].after(seconds);
      then.velocity_W.setZero();
      then.foreseen = true;
      solids.push_back(then);
    }
  }
}

void append_solids(const Obstacle& obstacle, std::vector<Solid>& solids) {
  if (is_ground(obstacle)) return;
  Solid solid;
  solid.bottom = obstacle.bottom;
  solid.top = obstacle.height;
  if (const auto* cylinder = std::get_if<Cylinder>(&obstacle.shape)) {
    solid.centre_W = obstacle.pose_W.position();
    solid.rounding = cylinder->radius;
    solids.push_back(solid);
    return;
  }
  const std::vector<Vec2> outline = outline_W(obstacle);
  if (!std::holds_alternative<Polygon>(obstacle.shape)) {
    solid.centre_W = (outline[0] + outline[2]) / 2;
    solid.half = {(outline[1] - outline[0]).norm() / 2, (outline[2] - outline[1]).norm() / 2};
    solid.axis_W = direction(obstacle.pose_W.heading);
    solids.push_back(solid);
    return;
  }
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Vec2 edge = outline[(k + 1) % outline.size()] - outline[k];
    solid.centre_W = outline[k] + edge / 2;
    solid.half = {edge.norm() / 2, 0};
    solid.axis_W = edge.normalized();
    solids.push_back(solid);
  }
}

}  // namespace algo
