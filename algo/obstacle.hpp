// algo/obstacle.hpp: the shapes of a world's obstacles and of its ground. Pure geometry, no
// physics.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "algo/obstacle_path.hpp"
#include "algo/types.hpp"

namespace algo {

struct Cylinder {
  double radius = 0;  // [m]
  bool operator==(const Cylinder&) const = default;
};
struct Box {
  double length = 0;  // [m] along the obstacle's x axis
  double width = 0;   // [m] along its y axis
  bool operator==(const Box&) const = default;
};
/// Convex, vertices counter-clockwise in the obstacle's own frame.
struct Polygon {
  std::vector<Vec2> points{};  // [m] at least 3
  bool operator==(const Polygon&) const = default;
};
/// From (-length/2, 0) to (length/2, 0) of the obstacle's frame.
struct Wall {
  double length = 0;     // [m]
  double thickness = 0;  // [m]
  bool operator==(const Wall&) const = default;
};
/// Ground whose top rises evenly from `low` at x = -length/2 of its frame to the obstacle's height
/// at x = length/2. Equal heights make a step.
struct Ramp {
  double length = 0;  // [m] on the map
  double width = 0;   // [m] along its y axis
  double low = 0;     // [m] above the floor
  bool operator==(const Ramp&) const = default;
};
/// A hole in the floor with upright sides. Its obstacle has no height.
struct Trench {
  double length = 0;  // [m] along its x axis
  double width = 0;   // [m] along its y axis
  double depth = 0;   // [m] below the floor
  bool operator==(const Trench&) const = default;
};
using Shape = std::variant<Cylinder, Box, Polygon, Wall, Ramp, Trench>;

struct Obstacle {
  std::uint32_t id = 0;  // unique in its world
  Pose2 pose_W{};
  Shape shape{};
  double height = 1.0;  // [m] of its top above the floor
  /// Diffuse reflectivity of the surface to the laser, 0.02 to 1.
  double reflectivity = 0.5;
  bool specular = false;
  std::optional<ObstaclePath> path{};  // of its reference point, if it moves by itself
  double bottom = 0;                   // [m] above the floor: there is room below a table, a beam
  bool operator==(const Obstacle&) const = default;
};

/// True for ramps and trenches: a robot drives over them, so no distance to an obstacle counts
/// them.
bool is_ground(const Obstacle& obstacle);

/// [m] Height of the top of `ground` at `p_W`, which lies within its outline; below 0 in a trench.
double top_at(const Obstacle& ground, const Vec2& p_W);

/// True if one of `obstacles` moves by itself.
bool any_moves(const std::vector<Obstacle>& obstacles);

/// Vertices in W, counter-clockwise; empty for a cylinder. Four for all others but a polygon.
std::vector<Vec2> outline_W(const Obstacle& obstacle);

/// [m2] Squared distance from `p` to the segment from `a` to `b`.
double squared_distance(const Vec2& p, const Vec2& a, const Vec2& b);

/// [m] Distance from `p_W` to the nearest surface point; negative inside.
double signed_distance(const Obstacle& obstacle, const Vec2& p_W);

/// The defect of the shape as part of a sentence ("radius must be above 0"), or nothing.
std::optional<std::string> defect(const Obstacle& obstacle);

}  // namespace algo
