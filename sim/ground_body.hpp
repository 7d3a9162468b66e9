// sim/ground_body.hpp: ramps and trenches as solid bodies.
#pragma once

#include <vector>

#include <btBulletCollisionCommon.h>

#include "algo/obstacle.hpp"
#include "sim/bullet_ptr.hpp"

namespace sim {

/// A convex solid, fixed to the frame of an obstacle on the floor.
struct GroundPart {
  BulletPtr<btCollisionShape> shape{};
  btTransform at{};  // in the obstacle's frame
};

/// The solids of a ramp, or of the ground around a trench: its rims, level with the floor, and its
/// bottom. They reach far below the floor. Their tops and upright ends are exact: each is made
/// smaller by `margin` [m], which Bullet adds.
std::vector<GroundPart> ground_parts(const algo::Obstacle& ground, double margin);

/// The hole that a trench makes in the floor.
class Hole {
 public:
  explicit Hole(const algo::Obstacle& trench);

  /// True within the trench's outline; with the rim, also on the part of the rims near it.
  bool contains(const btVector3& p_W, bool with_rim) const;
  std::uint32_t id() const { return id_; }

 private:
  std::uint32_t id_ = 0;
  algo::Pose2 pose_W_{};
  double half_length_ = 0, half_width_ = 0;  // [m]
};

}  // namespace sim
