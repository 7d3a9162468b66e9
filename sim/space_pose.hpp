// sim/space_pose.hpp: poses in space, of a tilted robot and of its sensors.
#pragma once

#include <cmath>

#include "algo/robot.hpp"
#include "algo/types.hpp"

namespace sim {

/// A frame in W: its origin, and its axes as columns.
struct SpacePose {
  algo::Vec3 origin_W{0, 0, 0};
  Eigen::Matrix3d axes_W = Eigen::Matrix3d::Identity();
};

/// The pose of R (algo::Tilt).
SpacePose space_pose(const algo::Pose2& pose_W, const algo::Tilt& tilt);

/// The pose of a sensor `height` [m] above R's plane.
SpacePose mounted(const SpacePose& robot, const algo::Pose2& mount_R, double height);

/// The way of a beam in the sensor's plane, by its bearing [rad].
inline algo::Vec3 beam_W(const SpacePose& sensor, double bearing) {
  return sensor.axes_W * algo::Vec3(std::cos(bearing), std::sin(bearing), 0);
}

}  // namespace sim
