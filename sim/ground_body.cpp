// sim/ground_body.cpp: Bullet shapes of ramps and trenches.
#include "sim/ground_body.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sim {
namespace {

// A thin plate lets a wheel through that is pressed into it; a deep solid pushes it out.
constexpr double kDepth = 1.0;   // [m] of the solids below the floor, or below a trench's bottom
constexpr double kRim = 0.10;    // [m] width of the rims of a trench
constexpr double kInner = 0.05;  // [m] of it, where the rims replace the floor

btTransform shifted(double x, double y, double z) {
  return btTransform(btQuaternion::getIdentity(), btVector3(x, y, z));
}

/// A box with its top at `top`, reaching down to `bottom`.
GroundPart block(
    double x, double y, double half_length, double half_width, double top, double bottom) {
  const double half = (top - bottom) / 2;
  return {make_bullet<btBoxShape>(btVector3(half_length, half_width, half)),
          shifted(x, y, bottom + half)};
}

/// A wedge: the margin lies outside the corners of a convex hull.
GroundPart wedge(const algo::Ramp& ramp, double high, double margin) {
  const double slope = (high - ramp.low) / ramp.length;
  const double off_top = margin * std::hypot(1, slope);  // upright, for `margin` at right angles
  const double x = ramp.length / 2 - margin;
  const double y = ramp.width / 2 - margin;
  const double middle = (ramp.low + high) / 2;
  auto hull = make_bullet<btConvexHullShape>();
  for (const double end : {-x, x}) {
    for (const double side : {-y, y}) {
      hull->addPoint(btVector3(end, side, -kDepth), false);
      hull->addPoint(btVector3(end, side, middle + slope * end - off_top), false);
    }
  }
  hull->recalcLocalAabb();
  return {std::move(hull), btTransform::getIdentity()};
}

std::vector<GroundPart> rims_and_bottom(const algo::Trench& trench) {
  const double bottom = -trench.depth - kDepth;
  const double x = trench.length / 2;
  const double y = trench.width / 2;
  const double half = kRim / 2;
  std::vector<GroundPart> parts;
  for (const double sign : {-1.0, 1.0}) {
    parts.push_back(block(sign * (x + half), 0, half, y + kRim, 0, bottom));
    parts.push_back(block(0, sign * (y + half), x, half, 0, bottom));
  }
  parts.push_back(block(0, 0, x + kRim, y + kRim, -trench.depth, bottom));
  return parts;
}

}  // namespace

std::vector<GroundPart> ground_parts(const algo::Obstacle& ground, double margin) {
  std::vector<GroundPart> parts;
  if (const auto* trench = std::get_if<algo::Trench>(&ground.shape)) {
    parts = rims_and_bottom(*trench);
  } else {
    const auto& ramp = std::get<algo::Ramp>(ground.shape);
    if (ramp.low == ground.height) {
      parts.push_back(block(0, 0, ramp.length / 2, ramp.width / 2, ramp.low, -kDepth));
    } else {
      parts.push_back(wedge(ramp, ground.height, margin));
    }
  }
  for (GroundPart& part : parts) part.shape->setMargin(margin);  // a box shrinks by it itself
  return parts;
}

Hole::Hole(const algo::Obstacle& trench) : id_(trench.id), pose_W_(trench.pose_W) {
  const auto& shape = std::get<algo::Trench>(trench.shape);
  half_length_ = shape.length / 2;
  half_width_ = shape.width / 2;
}

bool Hole::contains(const btVector3& p_W, bool with_rim) const {
  const algo::Vec2 p = algo::to_child(pose_W_, {p_W.x(), p_W.y()});
  const double more = with_rim ? kInner : 0;
  return std::abs(p.x()) < half_length_ + more && std::abs(p.y()) < half_width_ + more;
}

}  // namespace sim
