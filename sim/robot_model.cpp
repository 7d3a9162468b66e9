// sim/robot_model.cpp: the outline, and the check that the machine stands on its wheels.
#include "sim/robot_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "algo/ring_axes.hpp"
#include "algo/types.hpp"
#include "sim/floor_beams.hpp"
#include "sim/sonar_model.hpp"

namespace sim {
namespace {

constexpr double kCasterTouching = 0.005;  // [m] a caster raised by more carries no load
constexpr double kFirmly = 0.01;  // [m] from the centre of mass to the line of two supports
constexpr int kDirections = 72;
constexpr double kFoldedRoom = 0.02;  // [m]
constexpr double kRoundOff = 1e-9;    // [s] of a product of periods

/// True if the supports extend beyond R in every direction.
bool stands(const RobotModel& robot) {
  std::vector<algo::Vec2> supports;
  for (const double x : robot.wheels) {
    supports.emplace_back(x, robot.half_track);
    supports.emplace_back(x, -robot.half_track);
  }
  for (const Caster& caster : robot.casters) {
    if (caster.raised <= kCasterTouching) supports.emplace_back(caster.x, caster.y);
  }
  for (int k = 0; k < kDirections; ++k) {
    const algo::Vec2 way = algo::direction(2 * std::numbers::pi * k / kDirections);
    const bool reached =
        std::ranges::any_of(supports, [&](const algo::Vec2& p) { return p.dot(way) > kFirmly; });
    if (!reached) return false;
  }
  return true;
}

/// True if the caster lies under the hull. Otherwise an obstacle could stop the ball in Bullet
/// without touching the hull.
bool under_hull(const RobotModel& robot, const Caster& caster) {
  if (robot.round) return std::hypot(caster.x, caster.y) + caster.radius <= robot.radius;
  return std::abs(caster.x) + caster.radius <= robot.hull_length / 2 &&
         std::abs(caster.y) + caster.radius <= robot.hull_width / 2;
}

}  // namespace

bool Sensors::has_laser() const {
  // A scanner that looks back says nothing about the way ahead.
  const bool looks_ahead = std::ranges::any_of(lasers, [](const LaserConfig& laser) {
    return std::abs(laser.mount_R.heading) <= std::numbers::pi / 2;
  });
  return looks_ahead || !sonar;
}

bool Sensors::has_ring() const {
  if (!sonar || sonar->count * sonar->ping > algo::kOldestEcho + kRoundOff) return false;
  constexpr auto kBearings = algo::ring_bearings();
  return std::ranges::all_of(kBearings, [this](double bearing) {
    for (std::uint32_t k = 0; k < sonar->count; ++k) {
      if (algo::in_cone(axis(*sonar, k), bearing)) return true;
    }
    return false;
  });
}

double Sensors::height() const {
  double highest = 0;
  for (const LaserConfig& laser : lasers) highest = std::max(highest, laser.height);
  if (sonar) highest = std::max(highest, sonar->height);
  for (const InfraredConfig& scanner : infrared) highest = std::max(highest, scanner.height);
  return highest;
}

void Machine::set_box(double length, double width) {
  round = false;
  hull_length = length;
  hull_width = width;
  radius = std::hypot(length / 2, width / 2);
}

void Machine::set_disc(double radius_m) {
  round = true;
  radius = radius_m;
  hull_length = 2 * radius_m;
  hull_width = 2 * radius_m;
}

namespace {

/// Of the arm on its base; the folded arm must be clear of the robot.
std::optional<std::string> arm_defect(const RobotModel& robot, const ArmModel& arm) {
  if (auto problem = defect(arm)) return "arm/" + *problem;
  if (arm.shoulder_R.z() <= robot.hull_high) return "arm/mount/z: must be above the hull";
  const algo::MobileArm body = body_of(arm, robot.radius, robot.hull_high);
  const algo::BodyFrames frames = body_frames(body, algo::body_joints({}, body.folded));
  const double room = self_clearance(body, frames);
  if (room < kFoldedRoom) {
    return "arm/rest_deg: the folded arm would be " +
           std::to_string(static_cast<int>(1000 * room)) +
           " mm from the robot itself; 20 mm are needed";
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> defect(const RobotModel& robot) {
  if (!(robot.hull_low < robot.hull_high)) return "hull/high: must be above hull/low";
  if (robot.wheels.empty()) return "wheels: there must be one on each side at least";
  if (robot.mass_height > robot.hull_high) return "mass_height: must not be above the hull";
  for (const Caster& caster : robot.casters) {
    if (!under_hull(robot, caster)) return "casters: must be under the hull";
  }
  for (const double x : robot.wheels) {
    if (std::abs(x) > robot.hull_length / 2) return "wheels: must be under the hull";
  }
  if (!stands(robot)) {
    return "casters: the robot would tip over; its wheels and casters must surround the middle "
           "of the hull";
  }
  return robot.arm ? arm_defect(robot, *robot.arm) : std::nullopt;
}

namespace {

std::optional<algo::FloorSensors> floor_of(const Sensors& sensors) {
  if (!sensors.floor) return std::nullopt;
  return geometry_of(*sensors.floor);
}

std::optional<algo::ArmSpec> arm_of(const RobotModel& robot) {
  if (!robot.arm) return std::nullopt;
  algo::ArmSpec arm = static_cast<const algo::ArmSpec&>(*robot.arm);  // without its dynamics
  arm.base_height = robot.hull_high;
  if (!robot.sensors.lasers.empty()) arm.scan_height = robot.sensors.lasers.front().height;
  return arm;
}

}  // namespace

algo::RobotSpec spec_of(const RobotModel& robot, double period) {
  const Hull hull = hull_of(robot);
  return {.name = robot.name,
          .radius = hull.radius,
          .half_length = hull.half_length,
          .half_width = hull.half_width,
          .half_track = robot.half_track,
          .period = period,
          .max_v = robot.max_v,
          .max_omega = robot.max_omega,
          .max_acceleration = robot.max_acceleration,
          .max_angular_acceleration = robot.max_angular_acceleration,
          .max_jerk = robot.max_jerk,
          .max_angular_jerk = robot.max_angular_jerk,
          .has_laser = robot.sensors.has_laser(),
          .has_ring = robot.sensors.has_ring(),
          .axle = axle_of(robot),
          .stance = robot.sensors.inclinometer ? std::optional(stance_of(robot)) : std::nullopt,
          .line = robot.sensors.line_camera,
          .floor = floor_of(robot.sensors),
          .climbs = robot.climbs,
          .arm = arm_of(robot)};
}

algo::Stance stance_of(const RobotModel& robot) {
  double front = -robot.hull_length;
  double back = robot.hull_length;
  const auto take = [&](double x) {
    front = std::max(front, x);
    back = std::min(back, x);
  };
  for (const double x : robot.wheels) take(x);
  for (const Caster& caster : robot.casters) {
    if (caster.raised <= kCasterTouching) take(caster.x);
  }
  return {robot.mass_height, 2 * robot.half_track, 2 * std::min(front, -back)};
}

double axle_of(const RobotModel& robot) {
  const double sum = std::accumulate(robot.wheels.begin(), robot.wheels.end(), 0.0);
  return sum / static_cast<double>(robot.wheels.size());
}

Hull hull_of(const RobotModel& robot) {
  if (robot.round) return {.radius = robot.radius};
  return {robot.radius, robot.hull_length / 2, robot.hull_width / 2};
}

}  // namespace sim
