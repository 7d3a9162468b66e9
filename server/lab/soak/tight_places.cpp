// server/lab/soak/tight_places.cpp: a door, and a wall to leave.
#include "server/lab/soak/tight_places.hpp"

#include <cmath>
#include <cstdint>
#include <numbers>

#include "server/lab/soak/hand_drive.hpp"
#include "sim/random.hpp"

namespace server::soak {
namespace {

constexpr double kAcross = std::numbers::pi / 2;
constexpr double kPlaceWall = 0.1;   // [m] of a wall
constexpr double kBefore = 1.5;      // [m] from the start to the door
constexpr double kOffMiddle = 0.02;  // [m]
constexpr double kDoorTime = 30;     // [s]
constexpr double kFarther = 0.5;     // [m] farther from the wall: it has been left
constexpr double kLeaveTime = 60;    // [s]
constexpr double kPhase = 1.0;       // [s] of one deflection
constexpr double kMostSlant = 1.2;   // [rad] of the robot's way off the wall's normal
constexpr double kComesFrom = 0.8;   // [m] of the hull's circle from the wall at the start
constexpr double kStopped = 1.0;     // [s] without motion
constexpr double kFacesAway = 1.3;   // [rad] off the way from the wall: ahead still leads away
constexpr std::uint64_t kWallPurpose = 0x3A11;

void add_wall(sim::Scenario& scenario, const algo::Pose2& pose_W, double length) {
  algo::Obstacle wall;
  wall.id = static_cast<std::uint32_t>(scenario.obstacles.size() + 1);
  wall.pose_W = pose_W;
  wall.shape = algo::Wall{length, kPlaceWall};
  scenario.obstacles.push_back(wall);
}

/// A wall across x = 0 with a door about y = 0.
bool passes_door(sim::Scenario scenario, double off) {
  constexpr double kLength = 3;
  const double middle = (kDoor + kLength) / 2;
  add_wall(scenario, {0, middle, kAcross}, kLength);
  add_wall(scenario, {0, -middle, kAcross}, kLength);
  scenario.start = {-kBefore, off, 0};
  HandDrive robot(scenario, 1);
  const double beyond = robot.spec().radius + kPlaceWall;
  while (robot.observation().stamp < kDoorTime && !robot.truth().collided) {
    robot.tick({1, 0});
    if (robot.truth().pose.x > beyond) return true;
  }
  return false;
}

/// A wall along y = 0. The robot comes from above, until the guard stops it.
bool leaves_wall(sim::Scenario scenario, int pose) {
  sim::Random random(static_cast<std::uint64_t>(pose), kWallPurpose);
  constexpr double kLength = 16;
  add_wall(scenario, {0, -kPlaceWall / 2, 0}, kLength);
  const double heading = -kAcross + random.uniform(-kMostSlant, kMostSlant);
  scenario.start = {0, sim::hull_of(scenario.robot).radius + kComesFrom, algo::wrap_angle(heading)};
  HandDrive robot(scenario, 1);
  double newest = 0;  // [s] of motion
  algo::Pose2 before_W = robot.truth().pose;
  while (robot.observation().stamp - newest < kStopped) {
    robot.tick({1, 0});
    if (robot.truth().pose.position() != before_W.position()) newest = robot.observation().stamp;
    if (robot.observation().stamp > kLeaveTime) return false;  // it has not met the wall
    before_W = robot.truth().pose;
  }
  const double end = robot.observation().stamp + kLeaveTime;
  const double left = robot.truth().pose.y + kFarther;
  for (int phase = 0; robot.observation().stamp < end; ++phase) {
    const double off = algo::wrap_angle(kAcross - robot.truth().pose.heading);  // from the way out
    const double turn = off < 0 ? -1 : 1;
    const bool faces_away = std::abs(off) < kFacesAway;
    if (faces_away) {
      robot.hold({1, 0}, kPhase);
    } else if (phase % 2 == 0) {
      robot.hold({-1, 0}, kPhase);
    } else {
      robot.hold({0, turn}, kPhase);
    }
    if (robot.truth().collided) return false;
    if (robot.truth().pose.y > left) return true;
  }
  return false;
}

}  // namespace

TightPlaces drive_tight_places(const sim::Scenario& scenario) {
  TightPlaces places;
  for (int k = 0; k < kDoorPoses; ++k) {
    const double off = kOffMiddle * (2.0 * k / (kDoorPoses - 1) - 1);
    places.doors_passed += passes_door(scenario, off) ? 1 : 0;
  }
  for (int k = 0; k < kWallPoses; ++k) places.walls_left += leaves_wall(scenario, k) ? 1 : 0;
  return places;
}

}  // namespace server::soak
