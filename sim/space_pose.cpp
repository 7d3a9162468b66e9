// sim/space_pose.cpp: the three turns of a tilted robot.
#include "sim/space_pose.hpp"

#include <cmath>

namespace sim {
namespace {

Eigen::Matrix3d turn_about_z(double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  Eigen::Matrix3d turn;
  turn << c, -s, 0, s, c, 0, 0, 0, 1;
  return turn;
}

}  // namespace

SpacePose space_pose(const algo::Pose2& pose_W, const algo::Tilt& tilt) {
  const double cp = std::cos(tilt.pitch);
  const double sp = std::sin(tilt.pitch);
  const double cr = std::cos(tilt.roll);
  const double sr = std::sin(tilt.roll);
  Eigen::Matrix3d pitch_and_roll;
  pitch_and_roll << cp, sp * sr, sp * cr, 0, cr, -sr, -sp, cp * sr, cp * cr;
  return {{pose_W.x, pose_W.y, tilt.z}, turn_about_z(pose_W.heading) * pitch_and_roll};
}

SpacePose mounted(const SpacePose& robot, const algo::Pose2& mount_R, double height) {
  return {robot.origin_W + robot.axes_W * algo::Vec3(mount_R.x, mount_R.y, height),
          robot.axes_W * turn_about_z(mount_R.heading)};
}

}  // namespace sim
