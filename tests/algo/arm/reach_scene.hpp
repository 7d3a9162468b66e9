// tests/algo/arm/reach_scene.hpp: a hand that shall get to a pose 2.5 m ahead of a folded arm.
#pragma once

#include <numbers>
#include <vector>

#include "algo/arm/reach_places.hpp"

namespace reach_scene {

struct Scene {
  algo::MobileArm body{};
  algo::BodyJoints start = algo::body_joints({}, algo::folded_arm());
  algo::Pose3 hand_W = algo::Pose3::Identity();
  std::vector<algo::Solid> solids{};
};

inline algo::Solid post(const algo::Vec2& at, const algo::Vec2& velocity_W = algo::Vec2::Zero()) {
  algo::Solid solid;
  solid.centre_W = at;
  solid.rounding = 0.10;
  solid.top = 1.6;
  solid.velocity_W = velocity_W;
  return solid;
}

inline algo::Solid board(const algo::Vec2& at, const algo::Vec2& half, double bottom, double top) {
  algo::Solid solid;
  solid.centre_W = at;
  solid.half = half;
  solid.bottom = bottom;
  solid.top = top;
  return solid;
}

/// The hand points ahead, `down` [rad] from upwards.
inline Scene free_goal(double z, double down = std::numbers::pi / 2) {
  Scene scene;
  scene.hand_W.linear() = Eigen::AngleAxisd(down, algo::Vec3::UnitY()).toRotationMatrix();
  scene.hand_W.translation() = algo::Vec3(2.5, 0, z);
  return scene;
}

/// A post stands on the straight way there.
inline Scene over_a_table() {
  Scene scene = free_goal(0.95, 2.0);
  scene.solids = {board({2.7, 0}, {0.35, 0.6}, 0.70, 0.74), post({1.2, 0.1})};
  return scene;
}

/// Between two boards and before a wall.
inline Scene in_a_shelf() {
  Scene scene = free_goal(1.10);
  for (const double z : {0.9, 1.3}) {
    scene.solids.push_back(board({2.6, 0}, {0.2, 0.5}, z - 0.02, z));
  }
  scene.solids.push_back(board({2.8, 0}, {0.01, 0.5}, 0, 1.5));
  return scene;
}

}  // namespace reach_scene
