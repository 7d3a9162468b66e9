// server/lab/climb/climb_study.cpp: the courses, and the search for the first that is too hard.
#include "server/lab/climb/climb_study.hpp"

#include <algorithm>
#include <cmath>

#include "algo/units.hpp"
#include "sim/bullet_vehicle.hpp"

namespace server::climb {
namespace {

constexpr double kPeriod = 0.026;     // [s]
constexpr double kSlow = 0.1;         // [m/s]
constexpr double kEdge = 1.5;         // [m] where the ground begins, ahead of the start
constexpr double kBeyond = 1.5;       // [m] past the end of the ground, where a drive has succeeded
constexpr double kSlope = 2.0;        // [m] length of a slope on the map
constexpr double kDepth = 0.3;        // [m] of a trench
constexpr double kWide = 4.0;         // [m]
constexpr double kFar = 12.0;         // [m] a platform's other end
constexpr double kSettled = 0.01;     // [m] of the height at the end
constexpr double kMillimetre = 1e-3;  // [m]
using algo::units::kRadiansPerDegree;
constexpr double kHighest = 0.3;  // [m] of all steps and trenches tried
constexpr double kSteepest = 45;  // [degrees]

/// Ground from `from` to `to` along x, with the heights of its two ends.
algo::Obstacle ramp(std::uint32_t id, double from, double to, double low, double high) {
  return {.id = id,
          .pose_W = {(from + to) / 2, 0, 0},
          .shape = algo::Ramp{to - from, kWide, low},
          .height = high};
}

struct Course {
  std::vector<algo::Obstacle> ground{};
  double end = 0;     // [m] x past which the robot has mastered it
  double height = 0;  // [m] of the ground there
};

Course course_of(Ground ground, double size) {
  const double rise = kSlope * std::tan(size);
  const double foot = kEdge + kSlope;
  switch (ground) {
    case Ground::StepUp:
      return {{ramp(1, kEdge, kFar, size, size)}, kEdge + kBeyond, size};
    case Ground::StepDown:
      return {{ramp(1, -kFar, kEdge, size, size)}, kEdge + kBeyond, 0};
    case Ground::Trench:
      return {{{.id = 1,
                .pose_W = {kEdge + size / 2, 0, 0},
                .shape = algo::Trench{size, kWide, kDepth}}},
              kEdge + size + kBeyond,
              0};
    case Ground::SlopeUp:
      return {
          {ramp(1, kEdge, foot, 0, rise), ramp(2, foot, kFar, rise, rise)}, foot + kBeyond, rise};
    case Ground::SlopeDown:
      return {
          {ramp(1, -kFar, kEdge, rise, rise), ramp(2, kEdge, foot, rise, 0)}, foot + kBeyond, 0};
  }
  return {};
}

bool drives_over(const sim::RobotModel& robot, const Course& course, double speed) {
  sim::BulletVehicle vehicle(robot, kPeriod);
  sim::ObstacleSet obstacles;
  sim::PoseTrail trail(sim::Substeps(kPeriod).length, kPeriod);
  vehicle.reset({});
  for (const algo::Obstacle& obstacle : course.ground) {
    obstacles.add(obstacle);
    vehicle.added(obstacle);
  }
  vehicle.stand_on(obstacles);
  constexpr double kPatience = 2;  // times the undisturbed drive
  const double most = kPatience * (course.end / speed + speed / robot.max_acceleration);
  for (double stamp = 0; stamp < most; stamp += kPeriod) {
    vehicle.drive({speed, 0}, obstacles, trail);
    const sim::VehicleState& state = vehicle.state();
    if (state.scrape || state.overturned()) return false;
    if (state.pose_W.x > course.end) return std::abs(state.z - course.height) < kSettled;
  }
  return false;
}

/// The largest size, in steps of `step`, that the robot masters together with all smaller ones.
double largest(const sim::RobotModel& robot, Ground ground, double step, double most) {
  int steps = 0;
  while ((steps + 1) * step <= most && masters(robot, ground, (steps + 1) * step)) ++steps;
  return steps * step;
}

}  // namespace

bool masters(const sim::RobotModel& robot, Ground ground, double size) {
  const Course course = course_of(ground, size);
  return drives_over(robot, course, std::min(kSlow, robot.max_v)) &&
         drives_over(robot, course, robot.max_v);
}

algo::ClimbLimits measure(const sim::RobotModel& robot) {
  return {largest(robot, Ground::StepUp, kMillimetre, kHighest),
          largest(robot, Ground::StepDown, kMillimetre, kHighest),
          largest(robot, Ground::Trench, kMillimetre, kHighest),
          largest(robot, Ground::SlopeUp, kRadiansPerDegree, kSteepest * kRadiansPerDegree),
          largest(robot, Ground::SlopeDown, kRadiansPerDegree, kSteepest * kRadiansPerDegree)};
}

}  // namespace server::climb
