// tests/sim/ground_drive.hpp: a robot with floor sensors that rolls slowly over ramps and trenches,
// without dynamics: it stands on its wheels and casters. The whole pipeline drives it.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "algo/diff_drive.hpp"
#include "algo/pipeline/pipeline.hpp"
#include "algo/terrain/ground_survey.hpp"
#include "sim/floor_sensors.hpp"
#include "sim/obstacle_set.hpp"

namespace ground_drive {

using algo::Pose2;
using algo::Vec2;

inline algo::Obstacle step(
    std::uint32_t id, const Pose2& pose, double length, double width, double height) {
  return {.id = id, .pose_W = pose, .shape = algo::Ramp{length, width, height}, .height = height};
}
inline algo::Obstacle ramp(
    std::uint32_t id, const Pose2& pose, double length, double width, double low, double high) {
  return {.id = id, .pose_W = pose, .shape = algo::Ramp{length, width, low}, .height = high};
}
inline algo::Obstacle trench(
    std::uint32_t id, const Pose2& pose, double length, double width, double depth) {
  return {.id = id, .pose_W = pose, .shape = algo::Trench{length, width, depth}};
}

/// Masuda's robot. `steepest` [m] is the highest edge that a wheel or caster met so far.
struct Drive {
  explicit Drive(const algo::ClimbLimits& limits, std::uint64_t seed = 1)
      : sensors(sim::FloorSensorConfig{}, seed) {
    const sim::FloorSensorConfig f;
    spec = {.radius = std::hypot(0.14, 0.11),
            .half_length = 0.14,
            .half_width = 0.11,
            .half_track = 0.12,
            .period = 0.025,
            .max_v = 0.3,
            .max_omega = 1.5,
            .max_acceleration = 0.5,
            .max_angular_acceleration = 6,
            .drives = true,
            .raw_stick = true,
            .axle = -0.09,
            .floor = algo::FloorSensors{f.x, f.height, f.half_spacing, f.angle, f.separation},
            .climbs = limits};
  }

  void add(const algo::Obstacle& obstacle) {
    sensors.add(obstacle);
    ground.add(obstacle);
  }

  void start(const std::string& controller = "go_to_goal") {
    pipeline = std::make_unique<algo::Pipeline>(
        algo::PipelineConfig{.controller = controller, .filter = algo::FilterKind::None}, spec);
    pipeline->reset(pose);
    for (std::size_t k = 0; k < contacts.size(); ++k) heights[k] = ground_under(k);
    stand();
  }

  double ground_under(std::size_t contact) const {
    return ground.ground_at(to_parent(pose, contacts[contact]));
  }

  /// Sets R on the axle and on the higher of the casters; notes the edges that were met.
  void stand() {
    std::array<double, 4> now{};
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      now[k] = ground_under(k);
      const double rise = now[k] - heights[k];
      highest = std::max(highest, rise);
      deepest = std::max(deepest, -rise);
    }
    heights = now;
    const double rear = (now[0] + now[1]) / 2;
    const double front = (now[2] + now[3]) / 2;
    const double base = contacts[2].x() - contacts[0].x();
    tilt.pitch = -std::atan2(front - rear, base);
    tilt.z = rear - contacts[0].x() * (front - rear) / base;
  }

  void tick() {
    algo::Observation& o = t.observation;
    o.clear_sensors();
    o.stamp = stamp;
    o.odometry = {stamp, pose, twist};
    algo::LaserScan& scan = o.scans.append();
    scan.stamp = stamp;
    scan.angle_min = -std::numbers::pi / 2;
    scan.angle_increment = std::numbers::pi / 360;
    scan.range_max = 8;
    scan.turns = 1;
    scan.turn_period = 0;
    scan.mount_R = {};
    scan.resize(361);
    for (std::size_t i = 0; i < scan.size(); ++i) {
      // A wall across the way; the robot looks over ramps and steps.
      const double ahead = wall - pose.x;
      const double along = std::cos(pose.heading + scan.angle(i));
      const double range = along > 0 ? ahead / along : 100;
      if (range < scan.range_max) {
        scan.set_ok(i, range);
      } else {
        scan.set_free(i);
      }
    }
    o.inclinometer = algo::Inclinometer{stamp, 0, tilt.pitch};
    if (stamp + 1e-9 >= next_reading) {
      if (senses) o.floor = sensors.read(stamp, pose, tilt);
      next_reading += 0.038;
    }
    pipeline->tick(t);
    t.requests.clear();
    twist = t.command.base;
    pose = algo::integrate_arc(pose, twist, spec.period, spec.axle);
    stand();
    stamp += spec.period;
    if (t.behaviour == algo::behaviours::kGround) ++surveyed;
  }
  bool arrived() const { return t.mission == algo::Mission::Arrived; }
  /// Drives to `goal` for `seconds` at most; true if it arrived.
  bool drive_to(const Vec2& goal, double seconds) {
    t.requests.push_back(algo::SetGoal{goal, std::nullopt});
    for (const double end = stamp + seconds; stamp < end;) {
      tick();
      if (arrived()) return true;
    }
    return false;
  }
  void push(double forward,
            double turn,
            double seconds,
            algo::StickMode mode = algo::StickMode::Raw) {
    for (const double end = stamp + seconds; stamp < end;) {
      t.requests.push_back(algo::Joystick{.forward = forward, .turn = turn, .mode = mode});
      tick();
    }
  }
  std::string verdict() const {
    for (const algo::Layer& layer : t.layers) {
      if (layer.name == "ground.verdict") return layer.text;
    }
    return {};
  }

  algo::RobotSpec spec{};
  sim::FloorSensorModel sensors;
  sim::ObstacleSet ground{};
  std::unique_ptr<algo::Pipeline> pipeline{};
  algo::Telemetry t{};
  Pose2 pose{};
  algo::Tilt tilt{};
  algo::Twist2 twist{};
  double stamp = 0;
  double next_reading = 0;
  bool senses = true;
  double wall = 100;   // [m] x in W of a wall across the way; add its obstacle, too
  int surveyed = 0;    // ticks
  double highest = 0;  // [m] that a wheel or caster went up at once,
  double deepest = 0;  // [m] and down
  const std::array<Vec2, 4> contacts{
      Vec2{-0.09, 0.12}, Vec2{-0.09, -0.12}, Vec2{0.10, 0.08}, Vec2{0.10, -0.08}};
  std::array<double, 4> heights{};
};

}  // namespace ground_drive
