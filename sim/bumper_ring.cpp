// sim/bumper_ring.cpp: locates a contact by the distances of the obstacles.
#include "sim/bumper_ring.hpp"

#include <cmath>
#include <numbers>

namespace sim {
namespace {

/// [rad] Bearing in R of the surface nearest to the robot's centre: against the gradient of the
/// distance.
double contact_bearing(const algo::Pose2& pose_W, const ObstacleSet& obstacles) {
  constexpr double kStep = 1e-4;  // [m]
  const algo::Vec2 p_W = pose_W.position();
  const auto slope = [&](const algo::Vec2& step) {
    return obstacles.distance(p_W + step) - obstacles.distance(p_W - step);
  };
  const double bearing = std::atan2(-slope({0, kStep}), -slope({kStep, 0}));
  return algo::wrap_angle(bearing - pose_W.heading);
}

}  // namespace

void BumperRing::sense(const Surroundings& around, algo::Observation& observation) {
  const double share = 2 * std::numbers::pi / count_;
  double bearing = 0;
  if (around.contact && around.vehicle.ground_contact) {
    bearing = *around.vehicle.ground_contact;
  } else if (around.contact && count_ > 1) {
    bearing = contact_bearing(around.vehicle.pose_W, around.obstacles);
  }
  const auto pressed = static_cast<std::uint32_t>(std::lround(bearing / share) + count_) % count_;
  for (std::uint32_t k = 0; k < count_; ++k) {
    const double heading = algo::wrap_angle(share * k);
    const algo::Vec2 place = radius_ * algo::direction(heading);
    observation.bumpers.append() = {.mount_R = {place.x(), place.y(), heading},
                                    .stamp = observation.stamp,
                                    .pressed = around.contact && k == pressed};
  }
}

}  // namespace sim
