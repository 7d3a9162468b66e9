// server/emulate/floor_rays.cpp: four rays from a robot that may be tilted.
#include "server/emulate/floor_rays.hpp"

#include <limits>
#include <numbers>

#include "sim/floor_beams.hpp"
#include "sim/obstacle_set.hpp"

namespace server::emulate {
namespace {

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
    caster_.move(obstacle.id, sim::pose_at(obstacle, now));
  }
  std::array<double, drivers::psd::kSensors> metres{};
  const auto beams = sim::floor_beams(sensors_, sim::space_pose(robot_W, tilt));
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const auto hit = caster_.cast(beams[i].from_W, beams[i].way_W, kFarthestFloor);
    metres[i] = hit ? hit->range : std::numeric_limits<double>::infinity();
  }
  return metres;
}

}  // namespace server::emulate
