// tests/server/emulate/floor_rays_test.cpp: the distances that emulated floor sensors see.
#include "server/emulate/floor_rays.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace server::emulate {
namespace {

sim::Scenario with(const algo::Obstacle& obstacle) {
  sim::Scenario scenario;
  scenario.obstacles = {obstacle};
  return scenario;
}

TEST(FloorRays, AFlatFloorIsAtTwentyAndTwentyEightCentimetres) {
  FloorRays rays({}, usual_floor_sensors(0.3));
  for (const algo::Pose2& pose : {algo::Pose2{}, algo::Pose2{3, -2, 2.5}}) {
    const auto metres = rays.sense(0, pose, {});
    EXPECT_NEAR(metres[0], 0.28, 1e-12);
    EXPECT_NEAR(metres[1], 0.28, 1e-12);
    EXPECT_NEAR(metres[2], 0.20, 1e-12);
    EXPECT_NEAR(metres[3], 0.20, 1e-12);
  }
}

/// A step of 1.3 cm under all beams shortens each by 0.013 / sin 45.
TEST(FloorRays, AStepIsNearerAndATrenchFarther) {
  const double c = std::numbers::sqrt2 / 2;
  FloorRays up(
      with({.id = 1, .pose_W = {0.5, 0, 0}, .shape = algo::Ramp{1, 1, 0.013}, .height = 0.013}),
      usual_floor_sensors(0.3));
  const auto step = up.sense(0, {}, {});
  EXPECT_NEAR(step[0], 0.28 - 0.013 / c, 1e-12);
  EXPECT_NEAR(step[2], 0.20 - 0.013 / c, 1e-12);
  FloorRays down(with({.id = 1, .pose_W = {0.5, 0.5, 0}, .shape = algo::Trench{1, 1, 0.05}}),
                 usual_floor_sensors(0.3));
  const auto trench = down.sense(0, {}, {});
  EXPECT_NEAR(trench[0], 0.28 + 0.05 / c, 1e-12);  // the left ones look into it
  EXPECT_NEAR(trench[1], 0.28, 1e-12);
}

/// Nose down by 0.1 rad about R: from (0.3, 0.1414) the beam goes down at 45 degrees + 0.1.
TEST(FloorRays, ATiltedRobotSeesTheFloorElsewhere) {
  const algo::FloorSensors sensors = usual_floor_sensors(0.3);
  FloorRays rays({}, sensors);
  const double pitch = 0.1;
  const auto metres = rays.sense(0, {0, 0, 1}, {.z = 0.02, .pitch = pitch});
  const double z = 0.02 - sensors.x * std::sin(pitch) + sensors.height * std::cos(pitch);
  EXPECT_NEAR(metres[2], z / std::sin(sensors.angle + pitch), 1e-12);
  // Left side up: the left sensors are higher.
  const auto rolled = rays.sense(0, {}, {.roll = 0.05});
  EXPECT_GT(rolled[2], rolled[3]);
}

TEST(FloorRays, AMovingObstacleIsMetWhereItIs) {
  algo::Obstacle walker{.id = 1, .pose_W = {5, 0, 0}, .shape = algo::Box{0.2, 1}};
  walker.path = {.period = 10, .phase = 0, .keys = {{0, {5, 0}}, {5, {0.48, 0}}}};
  FloorRays rays(with(walker), usual_floor_sensors(0.3));
  EXPECT_NEAR(rays.sense(0, {}, {})[0], 0.28, 1e-12);
  EXPECT_LT(rays.sense(5, {}, {})[0], 0.2);
}

TEST(FloorRays, AnObstacleThatIsAwayIsNotMet) {
  algo::Obstacle visitor{.id = 1, .pose_W = {0.48, 0, 0}, .shape = algo::Box{0.2, 1}};
  visitor.path = {.period = 10, .keys = {{4, {0.48, 0}}, {6, {0.48, 0}}}, .comes_and_goes = true};
  FloorRays rays(with(visitor), usual_floor_sensors(0.3));
  EXPECT_NEAR(rays.sense(3, {}, {})[0], 0.28, 1e-12);
  EXPECT_LT(rays.sense(5, {}, {})[0], 0.2);
  EXPECT_NEAR(rays.sense(7, {}, {})[0], 0.28, 1e-12);
}

}  // namespace
}  // namespace server::emulate
