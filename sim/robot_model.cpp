// sim/robot_model.cpp: the outline, and the check that the machine stands on its wheels.
#include "sim/robot_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>

#include "algo/ring_axes.hpp"
#include "algo/types.hpp"
#include "sim/floor_beams.hpp"
#include "sim/sonar_model.hpp"

namespace sim {
namespace {

constexpr double kCasterTouching = 0.005;  // [m] a caster raised by more carries no load
constexpr double kFirmly = 0.01;          // [m] from the centre of mass to the line of two supports
constexpr double kAlike = 1e-6;           // [m] less difference of heights decides nothing
constexpr double kLeastWheelLoad = 0.05;  // of the weight; less drives nothing
constexpr double kMostBeside = 0.05;      // [m] from the hull to the middle of a wheel beside it
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

/// A wheel or caster on a level floor.
struct Support {
  algo::Vec2 at{};    // [m] in R
  double raised = 0;  // [m] above the lowest point of the wheels
  bool wheel = false;
};

/// The shares of the load of three supports when the mass lies over R; nothing if it lies beside
/// their triangle, or they are in one line.
std::optional<std::array<double, 3>> shares(const std::array<Support, 3>& three) {
  const auto& [a, b, c] = three;
  const auto cross = [](const algo::Vec2& p, const algo::Vec2& q) {
    return p.x() * q.y() - p.y() * q.x();
  };
  constexpr double kFlat = 1e-9;     // [m2]
  constexpr double kBeside = -1e-9;  // rounding
  const double area = cross(b.at - a.at, c.at - a.at);
  if (std::abs(area) < kFlat) return std::nullopt;
  const std::array<double, 3> out{
      cross(b.at, c.at) / area, cross(c.at, a.at) / area, cross(a.at, b.at) / area};
  if (std::ranges::any_of(out, [](double share) { return share < kBeside; })) return std::nullopt;
  return out;
}

using Three = std::array<Support, 3>;

/// True if none of `all` is lower than the plane through `three`, which are not in one line.
bool stands_on(const Three& three, const std::vector<Support>& all) {
  Eigen::Matrix3d rows;
  Eigen::Vector3d heights;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Support& each = three[static_cast<std::size_t>(i)];
    rows.row(i) << each.at.x(), each.at.y(), 1;
    heights[i] = each.raised;
  }
  const Eigen::Vector3d plane = rows.inverse() * heights;
  return std::ranges::none_of(all, [&](const Support& other) {
    const double there = plane.x() * other.at.x() + plane.y() * other.at.y() + plane.z();
    return other.raised < there - kAlike;
  });
}

/// The least share of the weight, 0 to 1, that the drive wheels carry at rest on a level floor. A
/// robot stands on three supports that no other one is lower than. If several triples are such, as
/// of four supports of one height, any of them may carry it, and the worst counts.
double least_wheel_load(const RobotModel& robot) {
  std::vector<Support> all;
  for (const double x : robot.wheels) {
    for (const double y : {robot.half_track, -robot.half_track}) all.push_back({{x, y}, 0, true});
  }
  for (const Caster& caster : robot.casters) {
    all.push_back({{caster.x, caster.y}, caster.raised, false});
  }
  double least = 1;
  const auto weigh = [&](const Three& three) {
    const auto load = shares(three);
    if (!load || !stands_on(three, all)) return;
    double on_wheels = 0;
    for (std::size_t i = 0; i < 3; ++i) on_wheels += three[i].wheel ? (*load)[i] : 0;
    least = std::min(least, on_wheels);
  };
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = i + 1; j < all.size(); ++j) {
      for (std::size_t k = j + 1; k < all.size(); ++k) weigh({all[i], all[j], all[k]});
    }
  }
  return least;
}

/// True if the caster lies under the hull. Otherwise an obstacle could stop the ball in Bullet
/// without touching the hull.
bool under_hull(const RobotModel& robot, const Caster& caster) {
  if (robot.round) return std::hypot(caster.x, caster.y) + caster.radius <= robot.radius;
  return std::abs(caster.x) + caster.radius <= robot.hull_length / 2 &&
         std::abs(caster.y) + caster.radius <= robot.hull_width / 2;
}

}  // namespace

bool Sensors::looks_ahead() const {
  // A scanner that looks back says nothing about the way ahead.
  return std::ranges::any_of(lasers, [](const LaserConfig& laser) {
    return std::abs(laser.mount_R.heading) <= std::numbers::pi / 2;
  });
}

bool Sensors::has_laser() const {
  return looks_ahead() || !sonar;
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

/// Only the hull collides, so the wheels must not stand far outside of it.
std::optional<std::string> wheel_defect(const RobotModel& robot) {
  const double beside = std::min(kMostBeside, robot.wheel_radius);
  for (const double x : robot.wheels) {
    if (std::abs(x) > robot.hull_length / 2) return "wheels: must be under the hull";
    const bool within = robot.round ? std::hypot(x, robot.half_track) <= robot.radius + beside
                                    : robot.half_track <= robot.hull_width / 2 + beside;
    if (!within) {
      return "track: the wheels would stand outside of the hull and pass through obstacles; they "
             "may stand out by their radius, and by 0.05 m at most";
    }
  }
  if (robot.wheel_radius > robot.hull_length / 2) {
    return "wheel_radius: the wheels would be longer than the hull and pass through obstacles";
  }
  return std::nullopt;
}

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
  if (auto problem = wheel_defect(robot)) return problem;
  if (!stands(robot)) {
    return "casters: the robot would tip over; its wheels and casters must surround the middle "
           "of the hull";
  }
  if (least_wheel_load(robot) < kLeastWheelLoad) {
    return "casters: they would carry the robot and leave its drive wheels without load; raise "
           "them, as by 0.001";
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
