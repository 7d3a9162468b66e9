// server/emulate/floor_rays.cpp: four rays from a robot that may be tilted.
#include "server/emulate/floor_rays.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

namespace server::emulate {
namespace {

using algo::Vec3;

constexpr double kFarthestFloor = 5;  // [m] a GP2D12 gives next to nothing there

}  // namespace

algo::FloorSensors usual_floor_sensors(double half_length) {
  constexpr double kOnFloor = 0.2;  // [m] along a near beam
  return {.x = half_length,
          .height = kOnFloor / std::numbers::sqrt2,
          .half_spacing = 0.1,
          .angle = std::numbers::pi / 4,
          .separation = 0.08};
}

FloorRays::FloorRays(const sim::Scenario& scenario, const algo::FloorSensors& sensors)
    : sensors_(sensors) {
  for (const algo::Obstacle& obstacle : scenario.obstacles) {
    caster_.add(obstacle);
    if (obstacle.path) moving_.push_back(obstacle);
  }
}

std::array<double, drivers::psd::kSensors> FloorRays::sense(double now,
                                                            const algo::Pose2& robot_W,
                                                            const algo::Tilt& tilt) {
  for (const algo::Obstacle& obstacle : moving_) {
    const algo::Vec2 at_W = obstacle.path->at(now);
    caster_.move(obstacle.id, {at_W.x(), at_W.y(), obstacle.pose_W.heading});
  }
  const Eigen::Matrix3d turn =
      (Eigen::AngleAxisd(robot_W.heading, Vec3::UnitZ()) *
       Eigen::AngleAxisd(tilt.pitch, Vec3::UnitY()) * Eigen::AngleAxisd(tilt.roll, Vec3::UnitX()))
          .toRotationMatrix();
  const Vec3 origin_W(robot_W.x, robot_W.y, tilt.z);
  const double c = std::cos(sensors_.angle);
  const double s = std::sin(sensors_.angle);
  const Vec3 far_R = sensors_.separation * Vec3(s, 0, c);  // from a near sensor to its far one
  const auto range = [&](double y, const Vec3& offset_R) {
    const Vec3 from_W = origin_W + turn * (Vec3(sensors_.x, y, sensors_.height) + offset_R);
    const auto hit = caster_.cast(from_W, turn * Vec3(c, 0, -s), kFarthestFloor);
    return hit ? hit->range : std::numeric_limits<double>::infinity();
  };
  const double left = sensors_.half_spacing;
  return {range(left, far_R),
          range(-left, far_R),
          range(left, Vec3::Zero()),
          range(-left, Vec3::Zero())};
}

}  // namespace server::emulate
