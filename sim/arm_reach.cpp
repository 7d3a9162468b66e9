// sim/arm_reach.cpp: distances from the arm's links to the obstacles within its reach.
#include "sim/arm_reach.hpp"

#include <algorithm>
#include <cmath>

namespace sim {

ArmReach::ArmReach(const RobotModel& robot)
    : body_(body_of(*robot.arm, robot.radius, robot.hull_high)),
      reach_(robot.arm->shoulder_R.head<2>().norm() + robot.arm->upper_arm +
             std::hypot(robot.arm->elbow_offset, robot.arm->forearm) + robot.arm->hand +
             robot.arm->link_radius) {}

NearestPart ArmReach::nearest(const algo::BodyJoints& q, const ObstacleSet& obstacles) const {
  near_.clear();
  const algo::Vec2 here_W = q.head<2>();
  for (std::size_t k = 0; k < obstacles.size(); ++k) {
    if (obstacles.may_reach(k, here_W, reach_)) algo::append_solids(obstacles[k], near_);
  }
  const algo::BodyFrames frames = body_frames(body_, q);
  NearestPart found;
  for (std::size_t k = 1; k < algo::kBodyLinks; ++k) {  // the vehicle knows its base's contacts
    const auto part = static_cast<algo::BodyLink>(k);
    const algo::LinkAxis link = link_axis(body_, frames, part);
    for (const algo::Solid& solid : near_) {
      const double distance = algo::nearest(link, solid).distance;
      if (distance < found.distance) found = {distance, part};
    }
  }
  const double own = self_clearance(body_, frames);
  if (own < 0 && own < found.distance) found = {own, algo::BodyLink::Hand};
  return found;
}

NearestPart ArmReach::nearest(const VehicleState& state, const ObstacleSet& obstacles) const {
  return nearest(algo::body_joints(state.pose_W, algo::joints_of(state.arm.position)), obstacles);
}

algo::JointValues within_limits(const algo::JointValues& rates,
                                const algo::JointValues& position,
                                const ArmModel& arm,
                                double dt) {
  algo::JointValues out{};
  for (std::size_t k = 0; k < out.size(); ++k) {
    const double rate = std::isfinite(rates[k]) ? rates[k] : 0;
    const double low = std::min(0.0, (-arm.limits[k] - position[k]) / dt);
    const double high = std::max(0.0, (arm.limits[k] - position[k]) / dt);
    out[k] = std::clamp(std::clamp(rate, -arm.rates[k], arm.rates[k]), low, high);
  }
  return out;
}

}  // namespace sim
